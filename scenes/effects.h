// Which effects a scene calls for, and why: both renderers obey this plan, and `--explain` prints it.
#pragma once

#include <string>
#include <vector>

#include "scenes/scene.h"

namespace plumb {

enum class EffectKind {
    emissive_surfaces,
    point_lights,
    spot_lights,
    directional_lights,
    environment,
    environment_image,
    glossy_surfaces,  // with a specular lobe
    alpha_masks,
    textures,
    one_sided_surfaces,
    transparency,    // thin sheets that light passes straight through
    moving_objects,  // instances with a motion
    lens,            // cameras or camera paths with an aperture
    attenuation,     // lamps that fall off otherwise than with the squared distance
    sun_discs,       // directional lights with an angular radius
};

const char* to_string(EffectKind kind);

struct Effect {
    EffectKind kind;
    bool on = false;
    std::string reason;  // "3 of 12 materials in use: leaf, chain, vase_plant"
};

struct EffectPlan {
    std::vector<Effect> effects;  // one of each kind, in the order of EffectKind

    bool on(EffectKind kind) const;
    const Effect& operator[](EffectKind kind) const { return effects[static_cast<std::size_t>(kind)]; }
};

// Only materials that an instance uses count.
EffectPlan plan_effects(const Scene& scene);

}  // namespace plumb
