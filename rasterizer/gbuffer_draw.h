// Draws the scene's triangles into the G-buffer, and the environment behind them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "rasterizer/environment_light.h"
#include "rasterizer/fullscreen.h"
#include "rasterizer/gbuffer_planes.h"
#include "rasterizer/pass.h"
#include "rasterizer/scene_geometry.h"

namespace plumb {

// What follows from the depth mapping (DepthMapping).
struct DepthTest {
    explicit DepthTest(DepthMapping mapping);
    float farthest;  // what the depth buffer is cleared to
    GLenum nearer;   // passes what is nearer
    ShaderDefines defines;
};

// Binds and clears; the first of its colours is the depth plane.
void clear_gbuffer(const GlFramebuffer& target, const DepthTest& test);

// The programs of gbuffer.vert, .geom and .frag for every variant of the scene's materials.
class GBufferDraw {
public:
    GBufferDraw(const PassResources& resources, const std::vector<std::string>& files, const ShaderDefines& defines);

    template <typename Value>
    void set(std::string_view uniform, const Value& value) const {
        for (const Program* program : programs_) program->set(uniform, value);
    }
    // Draws the instances that `frustum` may see, or `next` in the frame to come, `copies` times each.
    void draw(const Frustum& frustum, const Frustum* next = nullptr, int copies = 1) const;

private:
    const Scene& scene_;
    const SceneGeometry& geometry_;
    std::vector<const Program*> programs_;        // one per variant of the geometry
    const GlTexture* specular_albedo_ = nullptr;  // where the diffuse albedo is written
};

// The environment's radiance in the plane `emission` of the first layer, where nothing is in front of it.
class BackgroundDraw {
public:
    // Draws nothing where nobody reads it or there is none.
    BackgroundDraw(const PassResources& resources, const GlTexture& depth_buffer);
    // With the depth test on.
    void draw() const;

private:
    GlContext& context_;
    DepthTest test_;
    std::optional<FullscreenDraw> draw_;
    std::optional<EnvironmentLight> environment_;
    GlFramebuffer target_;
};

}  // namespace plumb
