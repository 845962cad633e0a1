// The lights of a scene as the shaders of deferred light read them: their records in storage buffers, at the bindings
// of local_light.glsl and direct_light.frag, and their shadow maps, at the texture units of shadow_lookup.glsl.
#pragma once

#include <array>
#include <optional>

#include "rasterizer/light_set.h"
#include "rasterizer/moving_emitters.h"
#include "rasterizer/pass.h"

namespace plumb {

class LightBuffers {
public:
    // Takes the shadow textures that are there: their pass is made before.
    LightBuffers(const PassResources& resources, LightKinds kinds);

    const LightSet& lights() const { return lights_; }
    // What shadow_lookup.glsl must know.
    ShaderDefines shadow_defines() const;
    // Emissive surfaces that move are brought to where they are at `time` (Moment::time).
    void bind(const std::optional<double>& time = {});

private:
    DirectSettings settings_;
    LightSet lights_;
    MovingEmitters moving_;
    GlBuffer points_, spots_, directionals_, emitters_, pieces_, emitter_cubes_;
    std::array<const GlTexture*, 4> shadows_{};  // null: there is none
};

// POINT_LIGHTS, SPOT_LIGHTS, DIRECTIONAL_LIGHTS and EMITTERS with their numbers, where not zero. Without `local`: those
// of point and spot lights are left out.
ShaderDefines light_count_defines(const LightSet& lights, bool local = true);

}  // namespace plumb
