// Irradiance from point and spot lights, lit volume by volume: the planes `local_irradiance` and
// `layer2.local_irradiance`, RGBA32F, which the full-screen pass of direct light adds to what else there is.
//
// Each light's volume (light_volumes.h) is drawn over the layer, and its fragments shade the pixels that they cover;
// blending adds the lights up. Sums are of 32-bit floats: a thousand lights would lose what is small in half floats.
//   LocalLights::volume: all volumes of a kind in one instanced draw, without a depth test. As seed of the idea, Meiri,
//     "OGLdev", tutorial 36, which names its own two problems. First, VolumeFaces::front draws nothing, and the light
//     is gone, where the camera stands inside the volume; VolumeFaces::back draws the far side, which is there from
//     everywhere; VolumeFaces::both, without culling, counts the light twice outside. Second, pixels are shaded whose
//     surface lies before or behind the volume and only appears in front of it: wasted work, and light below the
//     threshold that ends where the volume's outline happens to lie on the screen.
//   LocalLights::volume_stencil: a pixel is lit only if its surface is inside the volume. Back faces behind the surface
//     count up in the stencil, front faces behind it down; what is left above zero is inside, also when the camera is,
//     as faces nearer than it add nothing. Then the back faces shade where the stencil is not zero, and reset it. Two
//     draws a light, a hardware depth buffer made from the layer's own depth, so that each layer has its own test, and
//     no clipping at the near plane.
//       Source: Meiri, "OGLdev", tutorial 37; the counting behind the surface: Carmack 2000, Bilodeau and Songy 1999.
//   Good for: many lights of small radius. Bad for: few lights that fill the view, where full-screen shading does the
//   same work without the blending.
#pragma once

#include <cstdint>
#include <optional>

#include "rasterizer/fullscreen.h"
#include "rasterizer/light_buffers.h"
#include "rasterizer/light_volumes.h"
#include "rasterizer/pass.h"

namespace plumb {

class Frustum;

class LightVolumePass final : public Pass {
public:
    // `counts_fragments`: for fragments_shaded(); it costs an atomic operation each.
    LightVolumePass(const PassResources& resources, int layer, bool counts_fragments = false);
    void execute(const PassFrame& frame) override;

    // Fragments that the lights have shaded in the last frame; waits for the GPU.
    std::uint64_t fragments_shaded() const;

private:
    // Volumes of one mesh and one kind of light.
    struct Group {
        const Program* program;
        GLsizei index_count;
        std::size_t first_index;
        GLint first_vertex;
        GLuint first_instance;
        std::vector<Bounds> bounds;  // world space, of each volume
    };
    void upload(const LightVolumes& volumes, ProgramCache& programs, const ShaderDefines& shadows,
                bool counts_fragments);
    void create_targets(PlaneTextures& planes, int layers);
    void draw_depth() const;
    void draw_instances(const Group& group, std::size_t first, std::size_t count) const;
    void draw_whole_groups() const;
    void draw_by_stencil(const Frustum& frustum) const;

    GlContext& context_;
    int layer_;
    bool uses_stencil_;
    VolumeFaces faces_;  // that shade
    LightBuffers lights_;
    GlBuffer mesh_vertices_, mesh_indices_, instances_, fragment_counter_;
    GlVertexArray vertex_array_;
    std::vector<Group> groups_;
    const Program* stencil_program_ = nullptr;
    std::optional<FullscreenDraw> depth_draw_;
    const GlTexture &depth_, &normal_;
    GlFramebuffer target_;
};

PassDeclaration declare_light_volumes(const Scene& scene, const LightSet& lights, const Method& method, int layer);
// Whether the scene has point or spot lights that the method lights by their volumes.
bool uses_light_volumes(const Scene& scene, const Method& method);

}  // namespace plumb
