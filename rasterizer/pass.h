// A pass: one step of the pipeline, with a shader or two beside it.
//
// A pass is first *declared*: its name, what it reads and writes (plane names), and how to make it. Only passes whose
// outputs are read are made (pass_plan.h); what is not made allocates nothing and compiles nothing.
//
// Names of planes are those of the Frame ("depth", "normal", "ao", "irradiance"...); "layer2.depth" stands for the
// second layer of the array texture "depth". Everything a pass allocates is allocated in its constructor.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "frames/frame.h"
#include "frames/quantities.h"
#include "rasterizer/method.h"
#include "rasterizer/moment.h"
#include "rasterizer/plane_textures.h"
#include "rasterizer/shader.h"
#include "scenes/camera.h"
#include "scenes/scene.h"

namespace plumb {

class SceneGeometry;

// What a pass is made from; all references outlive it.
struct PassResources {
    GlContext& context;
    const Scene& scene;
    const Method& method;
    const Quantities& quantities;
    PlaneTextures& planes;  // a pass creates its outputs here and looks up its inputs
    ProgramCache& programs;
    const std::set<std::string, std::less<>>&
        read;  // planes that somebody reads: an output not among them can be left out
    std::function<const SceneGeometry&()> geometry;  // the scene's triangles on the GPU, uploaded at the first call

    bool is_read(std::string_view plane) const { return read.find(plane) != read.end(); }
    // The deepest layer of `plane` that somebody reads, counted from 1; 1 where nobody reads any.
    int layers_of(std::string_view plane) const {
        int layers = most_layers;
        while (layers > 1 && !is_read(layer_prefix(layers - 1) + std::string(plane))) --layers;
        return layers;
    }
};

// What changes from frame to frame. The uniform block of view.glsl is bound and holds the views already, and the
// scene's geometry stands as it does now. Views are with the guard band.
struct PassFrame {
    const View& view;
    const View& previous;
    const Frame* truth = nullptr;
    const View* next = nullptr;  // as known or, else, as foreseen; null: nobody looks ahead
    // The frame that was rendered before this one is `previous`: what a pass kept of it can be found again. False on
    // the first frame and on cuts.
    bool continues = false;
    // The frame before was told of this very one as its next.
    bool foretold = false;
    int number = 0;                   // frames since the last cut: 0 unless `continues`
    std::optional<double> time = {};  // of the instances that move (Moment::time)
};

class Pass {
public:
    virtual ~Pass() = default;
    // Finds depth test, blending and culling off, and leaves them so.
    virtual void execute(const PassFrame& frame) = 0;
};

// A parameter of the method that a pass reads, by its name ("ao.samples"), or all of a group ("ao."). Where `planes`
// are named, of the pass's outputs only these depend on it. What only decides whether the pass can run need not be
// named.
struct ParameterUse {
    std::string name;
    std::vector<std::string> planes = {};
};

struct PassDeclaration {
    std::string name;
    std::vector<std::string> inputs, outputs;
    std::function<std::unique_ptr<Pass>(const PassResources&)> create;
    std::string disabled =
        {};  // why it cannot run with this scene and method ("method.ao.enabled is false"); empty: it can
    std::string remark = {};                    // what is worth knowing when it runs ("3 point lights")
    std::vector<ParameterUse> parameters = {};  // with this scene: those that nothing in it is concerned with are not
                                                // among them
    // Planes, without a layer's prefix: of those that it reads or writes the ones whose contents must last until the
    // next frame, and those that it makes for itself and that are of no use once it has run.
    std::vector<std::string> kept = {}, scratch = {};
    // The output that may overwrite an input, layer by layer, because the pass has read that before; or the input may
    // be the finest level of the output. Both names without a layer's prefix.
    struct InPlace {
        std::string output, input;
        bool is_chain = false;
        bool operator==(const InPlace&) const = default;
    };
    std::optional<InPlace> in_place = {};
};

}  // namespace plumb
