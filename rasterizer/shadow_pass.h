// Shadow maps of all lights: depth only, 32-bit float, largest nearest to the light.
//
// Point lights and emissive surfaces get a cube of six square views around the light's position (or the emitter's
// sample points), spot lights one view of their cone (a cube where it is very wide), directional lights an orthographic
// view fitted to the scene's bounds. The cubes keep near / z along the face's axis, from which the lookup gets linear
// metres.
//   Good for: any number of lights within memory. Bad for: lamps inside narrow shades (what is closer than a centimetre
//   casts no shadow), penumbras of large emitters unless direct.shadow.emitter_samples is raised.
//
// Textures: `shadow.points` and `shadow.emitters` (cube arrays), `shadow.maps` (2D array), for comparing lookups.
#pragma once

#include <vector>

#include "rasterizer/light_set.h"
#include "rasterizer/pass.h"
#include "rasterizer/scene_geometry.h"

namespace plumb {

class ShadowPass final : public Pass {
public:
    explicit ShadowPass(const PassResources& resources);
    void execute(const PassFrame& frame) override;

private:
    struct Target {
        GlFramebuffer framebuffer;
        glm::mat4 clip_from_world{1.0f};
        int ignored_instance = -1;
        glm::vec4 front_plane{0.0f, 0.0f, 0.0f, 1.0f};
        bool clips = false;
    };
    void add_cubes(PlaneTextures& planes, const std::string& name, const std::vector<ShadowCube>& cubes, int size);
    void add_maps(PlaneTextures& planes, const std::vector<ShadowMap>& maps, int size);
    void draw(const Target& target);

    GlContext& context_;
    const Scene& scene_;
    const SceneGeometry& geometry_;
    std::vector<Target> targets_;
    std::vector<MaterialVariant> coverage_;                     // per variant of the geometry
    std::vector<const Program*> programs_, clipping_programs_;  // per variant of the geometry
};

// Names of the shadow textures that the scene's lights need.
std::vector<std::string> shadow_textures(const LightSet& lights);
PassDeclaration declare_shadows(const LightSet& lights, const Method& method);

}  // namespace plumb
