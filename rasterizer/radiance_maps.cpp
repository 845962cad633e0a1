#include "rasterizer/radiance_maps.h"

#include <algorithm>
#include <bit>

#include <fmt/format.h>

#include "rasterizer/gl_error.h"
#include "scenes/ggx.h"

namespace plumb {
namespace {

constexpr int irradiance_size = 16;      // irradiance_cube.frag
constexpr int largest_summed_size = 32;  // of the radiance's level that irradiance is summed over

int halvings(int size) { return static_cast<int>(std::bit_width(static_cast<unsigned>(size))) - 1; }

int power_of_two(int size) {
    if (size < smallest_radiance_cube || !std::has_single_bit(static_cast<unsigned>(size))) {
        throw MethodError(
            fmt::format("a cube of radiance of {} texels per side cannot be filtered; use a power of two of "
                        "at least {}",
                        size, smallest_radiance_cube));
    }
    return size;
}

std::array<GlFramebuffer, 6> faces_of(GlContext& context, const GlTexture& texture, int level) {
    std::array<GlFramebuffer, 6> faces;
    for (int face = 0; face < 6; ++face) {
        faces[static_cast<std::size_t>(face)] =
            GlFramebuffer(context, std::array{GlAttachment{&texture, face, level}}, {}, "face of a radiance cube");
    }
    return faces;
}

}  // namespace

std::vector<std::string> RadianceMaps::outputs(const std::string& name) {
    return {name + ".radiance", name + ".irradiance", name + ".prefiltered"};
}

RadianceMaps::RadianceMaps(const PassResources& resources, const std::string& name, int size, int samples)
    : context_(resources.context),
      samples_(samples),
      irradiance_draw_(context_, resources.programs, "irradiance_cube.frag"),
      prefilter_draw_(context_, resources.programs, "prefilter_cube.frag"),
      radiance_(resources.planes.adopt(name + ".radiance",
                                       GlTexture::cube(context_, GL_RGBA32F, power_of_two(size), halvings(size) + 1))),
      irradiance_(
          resources.planes.adopt(name + ".irradiance", GlTexture::cube(context_, GL_RGBA32F, irradiance_size, 1))),
      prefiltered_(resources.planes.adopt(name + ".prefiltered",
                                          GlTexture::cube(context_, GL_RGBA32F, size, prefiltered_levels))),
      faces_(faces_of(context_, radiance_, 0)),
      irradiance_faces_(faces_of(context_, irradiance_, 0)) {
    for (int level = 1; level < prefiltered_levels; ++level) {
        prefiltered_faces_[static_cast<std::size_t>(level)] = faces_of(context_, prefiltered_, level);
    }
}

void RadianceMaps::filter() const {
    context_.gl.GenerateTextureMipmap(radiance_.id());
    radiance_.bind(0);
    const int level = radiance_.width() > largest_summed_size ? halvings(radiance_.width() / largest_summed_size) : 0;
    context_.gl.CopyImageSubData(radiance_.id(), GL_TEXTURE_CUBE_MAP, 0, 0, 0, 0, prefiltered_.id(),
                                 GL_TEXTURE_CUBE_MAP, 0, 0, 0, 0, radiance_.width(), radiance_.width(), 6);
    for (int face = 0; face < 6; ++face) {
        const auto index = static_cast<std::size_t>(face);
        const Program& summing = irradiance_draw_.program();
        summing.set("face", face);
        summing.set("level", level);
        summing.set("level_size", radiance_.width() >> level);
        irradiance_draw_.draw(irradiance_faces_[index]);
        const Program& prefiltering = prefilter_draw_.program();
        prefiltering.set("face", face);
        prefiltering.set("samples", samples_);
        prefiltering.set("source_size", static_cast<float>(radiance_.width()));
        for (int target = 1; target < prefiltered_levels; ++target) {
            const float roughness = static_cast<float>(target) / (prefiltered_levels - 1);
            prefiltering.set("output_size", static_cast<float>(prefiltered_.width() >> target));
            prefiltering.set("alpha", ggx_alpha(roughness));
            prefilter_draw_.draw(prefiltered_faces_[static_cast<std::size_t>(target)][index]);
        }
    }
}

}  // namespace plumb
