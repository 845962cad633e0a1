// Unit vectors in few bytes, and the C++ side of normal_encoding.glsl.
//
//   format      texture         bytes  encoding                                           largest error, degrees
//   oct32       RG16                4  octahedral, world space                                             0.004
//   oct16       RG8                 2  octahedral, world space                                               1.0
//   rgb32f      RGBA32F            16  as it is: OpenGL need not draw into three channels                   1e-5
//   rgb16f      RGBA16F             8  as it is                                                             0.03
//   rgb10a2     RGB10_A2            4  n / 2 + 1/2                                                           0.1
//   r11g11b10f  R11F_G11F_B10F      4  n / 2 + 1/2: 6 and 5 bits after the point, finer near -1              2.2
//   xy8         RG8                 2  camera space, n_xy / 2 + 1/2, n_z = sqrt(1 - n_x^2 - n_y^2)   see below
//
// xy8 loses the sign of n_z: a normal that leans away from the viewer comes back as its mirror image, leaning towards
// him. In perspective such surfaces are seen away from the middle of the view, and interpolated normals lean away at
// any silhouette. What leans towards him comes back to 0.4 degrees where it faces him; where n_z is small the root
// magnifies the rounding, to some 7 degrees at n_z = 0.
//   Sources: Cigolle, Donow, Evangelakos, Mara, McGuire, Meyer 2014, "A Survey of Efficient Representations for
//   Independent Unit Vectors", JCGT 3(2), whose names oct32 and oct16 are; RGB10_A2 and R11F_G11F_B10F: the demo of
//   Mara et al. 2016; RGB16F and XY: Nielsen 2015.
#pragma once

#include <glm/glm.hpp>

#include "rasterizer/method.h"
#include "rasterizer/shader.h"

namespace plumb {

// Octahedral, in [0, 1]^2.
glm::vec2 encode_normal(const glm::vec3& normal);
glm::vec3 decode_normal(const glm::vec2& encoded);

// That of the G-buffer: what comes from the truth is always oct32.
NormalFormat normal_format_of(const Method& method);
GLenum texture_format(NormalFormat format);
int channels_of(NormalFormat format);  // that mean something
// For normal_encoding.glsl, in every shader.
ShaderDefines normal_defines(NormalFormat format);
// World space, of unit length.
glm::vec3 normal_of_texel(NormalFormat format, const glm::vec3& texel, const glm::mat3& world_from_camera);

}  // namespace plumb
