// The planes of the G-buffer: what they hold, in which formats, and how many bytes they take.
//
// Array textures, layer k of the G-buffer in layer k. Of these only the ones that somebody reads exist:
//
//   depth            R32F       metres along -Z, +infinity where nothing is
//   normal           normal_encoding.h has the formats; turned to the viewer
//   albedo           RGBA16F
//   diffuse_albedo   RGBA16F    what the diffuse lobe reflects, seen from the camera: albedo (1 - E(o)), E the specular
//                               albedo (scenes/specular_albedo.h)
//   specular         RGBA16F    f0 in rgb, f90 in a (scenes/material.h); 0: there is no specular lobe
//   roughness        R16F       perceptual
//   emission         RGBA16F    in the first layer also the environment's radiance where nothing is in front of it;
//                               RGBA32F where the scene holds brighter light than half floats do
//   moving_instance  R16UI      the number of the instance among those that move (instance_motion.h), 0 where nothing
//                               does; R32UI where more than 65,535 move
//   camera_position  RGBA32F    camera space; only where the method stores positions (gbuffer.position)
//   previous_depth   R32F       what `depth` held in the frame before: the two trade places (plane_history.h)
//
// The hardware's depth buffer, which is no plane, is 32-bit float.
#pragma once

#include <string>
#include <vector>

#include "rasterizer/pass.h"

namespace plumb {

// The names of the planes of `layer`, counted from 0.
std::vector<std::string> gbuffer_outputs(const Method& method, int layer);
// The parameters that shape them, however they are drawn.
std::vector<ParameterUse> gbuffer_parameters(int layer);
// Those of how the layers behind the first come about, which concern `planes`.
std::vector<ParameterUse> layer_parameters(const std::vector<std::string>& planes);

bool any_layer_is_read(const PassResources& resources, std::string_view plane);

// Allocates `depth` with `depth_layers` layers, and the other planes that somebody reads with at least `least_layers`.
// Returns `depth`.
GlTexture& create_gbuffer_planes(const PassResources& resources, int depth_layers, int least_layers);

// What a program that draws into the planes is made from.
struct GBufferTargets {
    std::vector<GlAttachment> colours;  // `depth` first
    ShaderDefines defines;              // where each output goes
};
// `layer` -1: all layers at once. `depth` may be another texture than the plane of that name.
GBufferTargets gbuffer_targets(const PassResources& resources, const GlTexture& depth, int layer);

// Whether the screen-space passes read positions (depth_mip_chain.glsl); those of the truth are never stored.
bool stores_positions(const Method& method);
// The plane camera_position where there is one, else null, and where those passes bind it.
const GlTexture* stored_positions(const PassResources& resources);
constexpr GLuint stored_position_unit = 3;
// What every shader of a pipeline must know of the G-buffer's formats.
ShaderDefines gbuffer_defines(const Method& method);

// Whether anything in the scene has a specular lobe.
bool has_specular_lobes(const Scene& scene);
// The plane that diffuse reflection multiplies with: diffuse_albedo where the scene has specular lobes. Planes from the
// truth have the albedo only: there, surfaces with a specular lobe reflect too much diffusely.
std::string diffuse_albedo_plane(const Scene& scene, const Method& method);

// Metres along the view axis.
float separation_in_metres(const GBufferSettings& settings, const Camera& camera);

// The format of what holds emitted light as it is: with 16 bits, or 32 where the scene has brighter light.
GLenum emission_format(const Scene& scene);
// The format of lit radiance.
GLenum texture_format(RadianceFormat format);

// True for the textures that make up the G-buffer: its planes, the light of its layers, its depth buffer, the keys that
// filters compare its depths by (depth_key_pass.h) and what it keeps for the next frame.
bool belongs_to_gbuffer(std::string_view texture);
constexpr std::string_view gbuffer_depth_buffer = "gbuffer.depth_buffer";
constexpr std::string_view gbuffer_history = "previous_depth";

}  // namespace plumb
