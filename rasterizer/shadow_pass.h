// Shadow maps of all lights: depth only, 32-bit float, largest nearest to the light.
//
// Point lights, and spot lights wider than 1.1 radians (half angle), see all around:
//   ShadowSettings::point_map cube: six square views. cube_generation six_views draws each face by itself, of what its
//     frustum may see; one_pass draws once and a geometry shader sends each triangle to the faces that it may touch:
//     six times fewer draws, for the price of that shader. cube_distance reciprocal keeps near / z along the face's
//     axis, which needs no fragment shader; linear keeps 1 - distance / range.
//       Source: Nielsen 2015, "Deep G-buffers", section 2.2: one pass, linear distance.
//   dual_paraboloid: two maps, a third of the memory and a third of the draws.
//       Source: Brabec, Annen, Seidel 2002, "Shadow Mapping for Hemispherical and Omnidirectional Light Sources";
//       proposed by Nielsen 2015 in place of the cube. It is only projected at vertices: great circles, which straight
//       edges are seen from the light, become arcs of circles, but are drawn straight. An edge that covers the angle
//       phi is displaced by up to phi^2 / 8 radians (the arc's sagitta, largest along the horizon of a half; zero
//       through its middle). Edges are therefore cut until that is a texel, phi = 4 / sqrt(size), but into
//       paraboloid_tessellation segments at most: 1 is the method as published, good for fine meshes only; 8 still
//       shade whole patches of a ceiling of few triangles with a lamp under it (Conference) wrongly.
// Spot lights have one view of their cone, directional lights an orthographic view fitted to the scene's bounds; both
// are filtered over pcf_radius texels. Emissive surfaces have a cube around each of their sample points, which moves
// along with them.
//   Good for: any number of lights within memory. Bad for: lamps inside narrow shades (what is closer than a centimetre
//   casts no shadow), penumbras of large emitters unless direct.shadow.emitter_samples is raised, and those of suns: a
//   directional light's angular radius is not simulated; a pcf_radius of (half the penumbra's width) / (texel) can
//   stand in for it where all occluders are about equally far from their receivers.
//
// Textures: `shadow.points` and `shadow.emitters` (cube arrays), `shadow.paraboloids` (2D array, two layers each),
// `shadow.maps` (2D array), for comparing lookups (shadow_lookup.glsl).
#pragma once

#include <map>
#include <vector>

#include "rasterizer/light_set.h"
#include "rasterizer/moving_emitters.h"
#include "rasterizer/pass.h"
#include "rasterizer/scene_geometry.h"

namespace plumb {

class ShadowPass final : public Pass {
public:
    explicit ShadowPass(const PassResources& resources);
    void execute(const PassFrame& frame) override;

private:
    enum class Projection { flat, cube_face, whole_cube, paraboloid };
    struct Target {
        std::size_t framebuffer = 0;
        Projection projection = Projection::flat;
        glm::mat4 clip_from_world{1.0f};  // flat and cube_face
        ShadowCube cube = {};             // the others
        int first_layer = 0;              // whole_cube
        int face = 0;                     // cube_face
        float side = 1.0f;                // paraboloid: 1 the half towards +z, -1 the other
        int emitter_cube = -1;            // of an emitter: index into LightSet::emitter_cubes
        bool clips() const { return glm::vec3(cube.front_plane) != glm::vec3(0.0f); }
    };
    // Each for a texture that somebody reads.
    void add_cubes(const PassResources& resources, const std::string& name, const std::vector<ShadowCube>& cubes,
                   int size);
    void add_paraboloids(const PassResources& resources, const std::vector<ShadowCube>& cubes, int size);
    void add_maps(const PassResources& resources, const std::vector<ShadowMap>& maps, int size);
    void follow_emitters(const PassFrame& frame);
    void find_programs(ProgramCache& programs);
    void draw(const Target& target) const;
    void set_uniforms(const Program& program, const Target& target) const;
    bool may_see(const Target& target, const Frustum& frustum, const Bounds& box) const;
    bool is_linear(Projection projection) const;

    GlContext& context_;
    const Scene& scene_;
    const ShadowSettings settings_;
    const SceneGeometry& geometry_;
    LightSet lights_;
    MovingEmitters moving_;
    std::vector<GlFramebuffer> framebuffers_;
    std::vector<Target> targets_;
    std::vector<MaterialVariant> coverage_;  // per variant of the geometry
    // Per projection, and whether it clips: per variant of the geometry.
    std::map<std::pair<Projection, bool>, std::vector<const Program*>> programs_;
};

// Names of the shadow textures that the scene's lights need.
std::vector<std::string> shadow_textures(const LightSet& lights, LightKinds kinds = LightKinds::all);
// The defines of shadow_lookup.glsl.
ShaderDefines shadow_defines(const LightSet& lights, const ShadowSettings& settings);
PassDeclaration declare_shadows(const LightSet& lights, const Method& method);

}  // namespace plumb
