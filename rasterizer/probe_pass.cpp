#include "rasterizer/probe_pass.h"

#include <algorithm>
#include <optional>

#include <fmt/format.h>
#include <glm/gtc/constants.hpp>

#include "rasterizer/cube_faces.h"
#include "rasterizer/gbuffer_planes.h"
#include "rasterizer/normal_encoding.h"
#include "rasterizer/pass_plan.h"
#include "rasterizer/passes.h"
#include "rasterizer/scene_reach.h"
#include "rasterizer/shadow_pass.h"
#include "rasterizer/view_uniforms.h"

namespace plumb {
namespace {

// What closer things than this would show is cut away: the probe is meant to stand in free space.
constexpr float near_plane = 0.01f;

Camera camera_of(const CubeFace& face, const glm::vec3& position, float farthest) {
    Camera camera;
    camera.name = "probe";
    camera.world_from_camera = glm::mat4(face.axes());
    camera.world_from_camera[3] = glm::vec4(position, 1.0f);
    camera.vertical_fov = glm::half_pi<float>();
    camera.near_plane = near_plane;
    camera.far_plane = farthest;
    return camera;
}

}  // namespace

Method method_of_probe_faces(const Method& method) {
    Method faces = method;
    // Encodings stay: the programs that the passes share are made for them.
    faces.gbuffer.normal_format = normal_format_of(method);
    if (!stores_positions(method)) faces.gbuffer.position = PositionSource::from_depth;
    faces.gbuffer.source = SourceOfStage::method;
    faces.gbuffer.generation = LayerGeneration::peel;
    faces.gbuffer.layer_selection = LayerSelection::geometry_shader;
    faces.gbuffer.guard_band = 0;
    faces.gbuffer.layers = faces.ao.layers = 1;
    // Of so few lines it would reject every one.
    if (method.ao.normals == ObscuranceNormals::g3d_demo) faces.ao.normals = ObscuranceNormals::interpolated;
    faces.direct.source = SourceOfStage::method;
    faces.radiosity.enabled = faces.reflections.enabled = false;
    // Every face is a first frame, of which these leave each bit as it is; they only want a second layer, and memory.
    faces.ao.temporal = {};
    faces.antialias = {};
    faces.composite = {};
    return faces;
}

// A small pipeline of its own for square views; the geometry is shared.
class ProbePass::Capture {
public:
    explicit Capture(const PassResources& outer)
        : context_(outer.context),
          method_(method_of_probe_faces(outer.method)),
          planes_(context_, outer.method.probe.size, outer.method.probe.size),
          view_uniforms_(context_) {
        const std::vector<PassDeclaration> declarations = declare_passes(outer.scene, method_, outer.quantities);
        plan_ = plan_passes(declarations, {"total"});
        const PassResources resources{context_, outer.scene,    method_,    outer.quantities,
                                      planes_,  outer.programs, plan_.read, outer.geometry};
        // Shadow maps do not depend on the view.
        const std::vector<std::string> shadows = shadow_textures(LightSet(outer.scene, method_.direct));
        for (const std::string& texture : shadows) planes_.borrow(texture, outer.planes.get(texture));
        for (const std::size_t index : plan_.order) {
            if (declarations[index].outputs != shadows) passes_.push_back(declarations[index].create(resources));
        }
        const ProbeSettings& probe = outer.method.probe;
        const glm::vec3 position(probe.x, probe.y, probe.z);
        const float farthest = reach(bounds_over_time(outer.scene), position);
        for (const CubeFace& face : cube_faces) {
            views_.emplace_back(camera_of(face, position, farthest), probe.size, probe.size);
        }
        source_ = GlFramebuffer(context_, std::array{GlAttachment{&planes_.get("total")}}, {}, "probe");
    }

    void draw_face(int face, const GlFramebuffer& target, const std::optional<double>& time) const {
        const View& view = views_[static_cast<std::size_t>(face)];
        view_uniforms_.update(view, view, 0);
        for (const std::unique_ptr<Pass>& pass : passes_) {
            view_uniforms_.bind();
            pass->execute({.view = view, .previous = view, .time = time});
        }
        // Both have their lower row first.
        const int size = planes_.width();
        context_.gl.BlitNamedFramebuffer(source_.id(), target.id(), 0, 0, size, size, 0, 0, size, size,
                                         GL_COLOR_BUFFER_BIT, GL_NEAREST);
    }

private:
    GlContext& context_;
    const Method method_;
    PlaneTextures planes_;
    ViewUniforms view_uniforms_;
    PassPlan plan_;
    std::vector<std::unique_ptr<Pass>> passes_;
    std::vector<View> views_;
    GlFramebuffer source_;
};

ProbePass::ProbePass(const PassResources& resources)
    : maps_(resources, "probe", resources.method.probe.size, resources.method.environment.samples),
      every_frame_(resources.method.probe.every_frame),
      capture_(std::make_unique<Capture>(resources)) {}

ProbePass::~ProbePass() = default;

void ProbePass::execute(const PassFrame& frame) {
    if (!capture_) return;
    for (int face = 0; face < 6; ++face) capture_->draw_face(face, maps_.face(face), frame.time);
    maps_.filter();
    if (!every_frame_) capture_.reset();
}

PassDeclaration declare_probe(const Scene& scene, const LightSet& lights, const Method& method) {
    const ProbeSettings& probe = method.probe;
    PassDeclaration pass;
    pass.name = "probe";
    pass.inputs = shadow_textures(lights);
    pass.outputs = RadianceMaps::outputs("probe");
    for (const char* name : {"probe.x", "probe.y", "probe.z", "probe.size"}) pass.parameters.push_back({name});
    if (std::ranges::any_of(scene.instances, &Instance::moves)) pass.parameters.push_back({"probe.every_frame"});
    pass.parameters.push_back({"environment.samples", {"probe.prefiltered"}});
    pass.create = [](const PassResources& resources) { return std::make_unique<ProbePass>(resources); };
    pass.remark = fmt::format("from ({}, {}, {}), faces of {}^2, {}", probe.x, probe.y, probe.z, probe.size,
                              probe.every_frame ? "every frame" : "once");
    return pass;
}

}  // namespace plumb
