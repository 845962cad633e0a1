// The invariants of a scene that both renderers rely on.
#pragma once

#include "scenes/scene.h"

namespace plumb {

// Throws SceneError that names the scene, the element and the value for: a mesh, material or texture index out of
// range; sizes that do not fit; anything not finite; a normal that is not unit length; a triangle of zero area or wound
// against its normals; an instance that mirrors or flattens; keys of a motion out of order; colours, roughness,
// transmission, attenuation or light that no surface or lamp can have; a texture whose texels do not fit its size.
void validate(const Scene& scene);

}  // namespace plumb
