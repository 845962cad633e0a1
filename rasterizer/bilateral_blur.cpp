#include "rasterizer/bilateral_blur.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "rasterizer/depth_key_pass.h"
#include "rasterizer/gbuffer_planes.h"
#include "rasterizer/gl_error.h"

namespace plumb {
namespace {

constexpr GLuint blur_key_unit = 4;

// What G3D weighs the centre and the pixels beside it with, before it adds 0.3 to all but the centre.
constexpr std::array<float, 2> g3d_weights_1 = {0.5f, 0.25f};
constexpr std::array<float, 5> g3d_weights_4 = {0.153170f, 0.144893f, 0.122649f, 0.092902f, 0.062970f};
constexpr std::array<float, 7> g3d_weights_6 = {0.111220f, 0.107798f, 0.098151f, 0.083953f,
                                                0.067458f, 0.050920f, 0.036108f};
constexpr float g3d_weight_of_neighbours = 0.3f;

void require_sound(const BilateralBlurRequest& request) {
    const BilateralBlurSettings& settings = request.settings;
    if (settings.radius < 1 || settings.radius > 64 || settings.step < 1) {
        throw MethodError(
            fmt::format("{}: blur radius {} and step {} are out of range; use a radius of 0 (off) to 64 and "
                        "a step of at least 1",
                        request.name, settings.radius, settings.step));
    }
    if (settings.depth_key_bits != 8 && settings.depth_key_bits != 16 && settings.depth_key_bits != 32) {
        throw MethodError(
            fmt::format("{}: the blur's depth_key_bits is {}; use 8, 16 or 32", request.name, settings.depth_key_bits));
    }
    if (settings.weights == BlurWeights::g3d && settings.radius > 6) {
        throw MethodError(fmt::format(
            "{}: blur weights \"g3d\" are known for a radius of 1 to 6, but the radius is {}; lower it, or set "
            "weights to \"gaussian\"",
            request.name, settings.radius));
    }
    if (!(settings.plane_exemption >= 0.0f && std::isfinite(settings.plane_exemption))) {
        throw MethodError(fmt::format("{}: blur plane_exemption {} must be 0 or more square metres and finite",
                                      request.name, settings.plane_exemption));
    }
    for (const float sharpness : {settings.depth_sharpness, settings.normal_sharpness, settings.plane_sharpness}) {
        if (!(sharpness >= 0.0f && std::isfinite(sharpness))) {
            throw MethodError(
                fmt::format("{}: blur sharpness {} must be 0 or more and finite", request.name, sharpness));
        }
    }
}

// Of a kind that compares surfaces, not only depths.
bool compares_surfaces(const BilateralBlurSettings& settings) { return settings.kind == BlurKind::bilateral; }

// The plane of the keys that depths are compared by; empty: by the depths themselves.
std::string key_plane(const BilateralBlurSettings& settings) {
    const bool compared = compares_surfaces(settings) && settings.depth_sharpness > 0.0f;
    const bool stored = settings.depth_key_bits == 8 || settings.depth_key_bits == 16;
    return compared && stored ? depth_key_plane(settings.depth_key_bits) : "";
}

float g3d_weight(int radius, int distance) {
    const auto i = static_cast<std::size_t>(distance);
    const float weight = radius == 1 ? g3d_weights_1.at(i) : radius <= 4 ? g3d_weights_4.at(i) : g3d_weights_6.at(i);
    return distance == 0 ? weight : g3d_weight_of_neighbours + weight;
}

// Of a pixel so many steps away, before what its surface tells.
float weight_of_distance(const BilateralBlurSettings& settings, int distance) {
    if (compares_surfaces(settings) && settings.weights == BlurWeights::g3d)
        return g3d_weight(settings.radius, distance);
    const double sigma = settings.radius / (compares_surfaces(settings) ? 2.0 : 3.0);
    return static_cast<float>(std::exp(-0.5 * distance * distance / (sigma * sigma)));
}

std::string weights_of_distances(const BilateralBlurSettings& settings) {
    std::string weights;
    for (int i = 0; i <= settings.radius; ++i) {
        weights += i == 0 ? "" : ", ";
        weights += shader_literal(weight_of_distance(settings, i));
    }
    return weights;
}

ShaderDefines defines_along(const char* direction, const BilateralBlurRequest& request) {
    require_sound(request);
    const BilateralBlurSettings& settings = request.settings;
    ShaderDefines defines = {{"DIRECTION", direction},
                             {"LAYER", std::to_string(request.layer)},
                             {"BLUR_RADIUS", std::to_string(settings.radius)},
                             {"STEP", std::to_string(settings.step)},
                             {"BILATERAL", "0"},
                             {"GAUSSIAN_2015", "1"},
                             {"GAUSSIAN_2015_LISTING", "2"},
                             {"KIND", std::to_string(static_cast<int>(settings.kind))},
                             {"WEIGHTS", weights_of_distances(settings)}};
    if (!compares_surfaces(settings)) return defines;
    defines.emplace_back("MONOTONIC", settings.monotonic ? "1" : "0");
    defines.emplace_back("DEPTH_SHARPNESS", shader_literal(settings.depth_sharpness / request.quantity_radius));
    defines.emplace_back("NORMAL_SHARPNESS", shader_literal(settings.normal_sharpness));
    defines.emplace_back("PLANE_SHARPNESS", shader_literal(settings.plane_sharpness));
    if (settings.plane_exemption > 0.0f)
        defines.emplace_back("PLANE_EXEMPTION", shader_literal(settings.plane_exemption));
    defines.emplace_back("STORED_KEYS", key_plane(settings).empty() ? "0" : "1");
    return defines;
}

GlFramebuffer framebuffer_of(const GlTexture& texture, int layer) {
    const GlAttachment attachment{&texture, layer, 0};
    return GlFramebuffer(texture.context(), {&attachment, 1}, {}, "bilateral blur");
}

// Whichever layer's pass is made first allocates for both.
const GlTexture& output_of(const PassResources& resources, const BilateralBlurRequest& request, GLenum format) {
    if (resources.planes.has(request.output)) return resources.planes.get(request.output);
    return resources.planes.create(request.output, format, resources.layers_of(request.output));
}

// Blurred along the rows only.
std::string half_blurred_plane(const BilateralBlurRequest& request) { return request.name + ", half done"; }

}  // namespace

int blur_reach(const BilateralBlurSettings& settings) { return settings.radius * settings.step; }

BilateralBlurPass::BilateralBlurPass(const PassResources& resources, const BilateralBlurRequest& request)
    : noisy_(resources.planes.get(request.input)),
      depth_(resources.planes.get("depth")),
      layer_(request.layer),
      half_blurred_(resources.planes.create(half_blurred_plane(request), noisy_.format(), 1)),
      along_rows_(resources.context, resources.programs, "bilateral_blur.frag", defines_along("ivec2(1, 0)", request)),
      along_columns_(resources.context, resources.programs, "bilateral_blur.frag",
                     defines_along("ivec2(0, 1)", request)),
      half_blurred_target_(framebuffer_of(half_blurred_, 0)),
      target_(framebuffer_of(output_of(resources, request, noisy_.format()), request.layer)),
      area_of_rows_(resources, {0, blur_reach(request.settings)}, request.read_beyond),
      area_(resources, {0, 0}, request.read_beyond) {
    if (!compares_surfaces(request.settings)) return;
    normal_ = &resources.planes.get("normal");
    position_ = stored_positions(resources);
    const std::string keys = key_plane(request.settings);
    if (!keys.empty()) keys_ = &resources.planes.get(keys);
}

void BilateralBlurPass::execute(const PassFrame&) {
    noisy_.bind(0);
    depth_.bind(1);
    if (normal_) normal_->bind(2);
    if (position_) position_->bind(stored_position_unit);
    if (keys_) keys_->bind(blur_key_unit);
    {
        const InnerArea::Restriction restriction(area_of_rows_);
        along_rows_.program().set("noisy_layer", layer_);
        along_rows_.draw(half_blurred_target_);
    }
    half_blurred_.bind(0);
    const InnerArea::Restriction restriction(area_);
    along_columns_.program().set("noisy_layer", 0);
    along_columns_.draw(target_);
}

PassDeclaration declare_bilateral_blur(const BilateralBlurRequest& request) {
    const std::string prefix = layer_prefix(request.layer);
    PassDeclaration pass{.name = request.name,
                         .inputs = {prefix + request.input, prefix + "depth"},
                         .outputs = {prefix + request.output},
                         .create =
                             [request](const PassResources& resources) {
                                 return std::make_unique<BilateralBlurPass>(resources, request);
                             },
                         .scratch = {half_blurred_plane(request)},
                         // Along the columns, what is only half blurred is read.
                         .in_place = PassDeclaration::InPlace{request.output, request.input}};
    if (compares_surfaces(request.settings)) {
        pass.inputs.push_back(prefix + "normal");
        if (request.stored_positions) pass.inputs.push_back(prefix + "camera_position");
        const std::string keys = key_plane(request.settings);
        if (!keys.empty()) pass.inputs.push_back(prefix + keys);
    }
    return pass;
}

}  // namespace plumb
