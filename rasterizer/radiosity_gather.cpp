#include "rasterizer/radiosity_gather.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "rasterizer/bilateral_blur.h"
#include "rasterizer/depth_mip_chain.h"
#include "rasterizer/falloff.h"
#include "rasterizer/gbuffer_planes.h"
#include "rasterizer/gl_error.h"
#include "rasterizer/radiosity_planes.h"
#include "rasterizer/temporal_filter.h"

namespace plumb {
namespace {

// Stands for an infinite radius in the shader, where its square must be a float: farther than any point, nearer than
// what stands for no point.
constexpr float farthest = 1e11f;

std::string depth_plane(const RadiositySettings& settings) {
    return settings.use_mip_chain ? std::string(depth_mip_chain_plane) : "depth";
}

bool reads_chains(const RadiositySettings& settings) {
    return settings.use_mip_chain && settings.mip_normals_and_radiance;
}

// What taps read of a plane: the plane itself, or its MIP chain.
std::string tap_plane(const RadiositySettings& settings, const std::string& plane) {
    return reads_chains(settings) ? mip_chain_of(plane) : plane;
}

bool emission_is_sent(const RadiositySettings& settings, int bounce) { return settings.emitters_shine && bounce == 1; }

void require_sound_gather(const Method& method) {
    const RadiositySettings& settings = method.radiosity;
    const bool infinite = std::isinf(settings.radius) && settings.spread_pixels > 0;
    if (!(settings.radius > 0.0f) || !(std::isfinite(settings.radius) || infinite)) {
        throw MethodError(
            fmt::format("radiosity.radius is {}; use a finite length in metres, as large as the room at most: the taps "
                        "spread over it (or say over how many pixels they shall: radiosity.spread_pixels)",
                        settings.radius));
    }
    if (settings.spread_pixels < 0) {
        throw MethodError(
            fmt::format("radiosity.spread_pixels is {}; use a number of pixels, or 0 to spread the taps "
                        "over radiosity.radius",
                        settings.spread_pixels));
    }
    if (settings.layers < 1 || settings.layers > 2) {
        throw MethodError(fmt::format("radiosity.layers is {}; use 1 or 2", settings.layers));
    }
    if (settings.mip_offset < 0) {
        throw MethodError(
            fmt::format("radiosity.mip_offset is {}; use 0 or more (the source: 4)", settings.mip_offset));
    }
    if (settings.minimum_mip_level < 0 || settings.minimum_mip_level > 5) {
        throw MethodError(fmt::format("radiosity.minimum_mip_level is {}; use 0 to 5", settings.minimum_mip_level));
    }
    if (!settings.use_mip_chain && settings.minimum_mip_level > 0) {
        throw MethodError(
            fmt::format("radiosity.minimum_mip_level is {}, but radiosity.use_mip_chain is false; set one "
                        "of them to its default",
                        settings.minimum_mip_level));
    }
    require_points_at_taps("radiosity", settings.use_mip_chain, settings.mip_points, method);
}

ShaderDefines shader_defines(const PassResources& resources, int bounce, int layer) {
    const RadiositySettings& settings = resources.method.radiosity;
    require_sound_gather(resources.method);
    const int coarsest = settings.use_mip_chain ? coarsest_mip(resources.planes.width(), resources.planes.height()) : 0;
    ShaderDefines defines = SampleSpiral::defines(settings.samples, settings.pattern, taps_vary(settings.temporal));
    const bool nielsen = settings.estimator == RadiosityEstimator::nielsen2015;
    const ShaderDefines chosen = {
        {"MARA2016", "0"},
        {"NIELSEN2015", "1"},
        {"ESTIMATOR", nielsen ? "NIELSEN2015" : "MARA2016"},
        {"HITS", "0"},
        {"SAMPLES", "1"},
        {"NORMALISATION", settings.normalisation == RadiosityNormalisation::hits ? "HITS" : "SAMPLES"},
        {"TAPS", std::to_string(nielsen ? settings.layers * settings.samples : settings.samples)},
        {"RECEIVER_LAYER", std::to_string(layer)},
        {"LAYERS", std::to_string(settings.layers)},
        {"SENDING_LAYERS", std::to_string(sending_layers(settings, bounce))},
        {"EMITTERS_SHINE", emission_is_sent(settings, bounce) ? "1" : "0"},
        {"TEST_TAP_NORMAL", settings.test_tap_normal ? "1" : "0"},
        {"FAR_TAPS_HIT", settings.test_tap_normal && !nielsen ? "1" : "0"},
        {"MIP_NORMALS_AND_RADIANCE", reads_chains(settings) ? "1" : "0"},
        {"RADIUS", shader_literal(std::min(settings.radius, farthest))},
        {"SPREAD_PIXELS", std::to_string(settings.spread_pixels)},
        {"MIP_OFFSET", std::to_string(settings.mip_offset)},
        {"POINTS_AT_TAPS", settings.mip_points == MipTapPoint::sao2012 ? "1" : "0"},
        {"FINEST_LEVEL", std::to_string(std::min(settings.minimum_mip_level, coarsest))},
        {"COARSEST_LEVEL", std::to_string(coarsest)}};
    defines.insert(defines.end(), chosen.begin(), chosen.end());
    const ShaderDefines of_falloff = falloff_defines(resources.quantities.indirect_falloff);
    defines.insert(defines.end(), of_falloff.begin(), of_falloff.end());
    return defines;
}

GlFramebuffer make_gather_target(const PassResources& resources, int bounce, int layer) {
    const std::string name = gathered_plane(resources.method.radiosity, bounce);
    PlaneTextures& planes = resources.planes;
    if (!planes.has(name)) planes.create(name, GL_RGBA32F, resources.layers_of(name));
    const GlAttachment attachment{&planes.get(name), layer, 0};
    return GlFramebuffer(resources.context, {&attachment, 1}, {}, "radiosity");
}

std::string name_of(int bounce, int layer) {
    std::string name = "radiosity";
    if (bounce > 1) name += fmt::format(" bounce {}", bounce);
    if (layer > 0) name += fmt::format(" of layer {}", layer + 1);
    return name;
}

}  // namespace

std::string_view to_string(RadiosityEstimator estimator) {
    return estimator == RadiosityEstimator::mara2016 ? "mara2016" : "nielsen2015";
}

std::string_view to_string(RadiosityNormalisation normalisation) {
    return normalisation == RadiosityNormalisation::hits ? "hits" : "samples";
}

RadiosityGatherPass::RadiosityGatherPass(const PassResources& resources, int bounce, int layer)
    : depth_(resources.planes.get(depth_plane(resources.method.radiosity))),
      normal_(resources.planes.get("normal")),
      position_(stored_positions(resources)),
      sent_(
          resources.planes.get(tap_plane(resources.method.radiosity, sent_plane(resources.method.radiosity, bounce)))),
      spiral_(resources.context, resources.method.radiosity.samples),
      draw_(resources.context, resources.programs, "radiosity_gather.frag", shader_defines(resources, bounce, layer)),
      target_(make_gather_target(resources, bounce, layer)),
      area_(resources, glm::ivec2(blur_reach(resources.method.radiosity.blur)),
            plane_of_later_bounces(resources.method.radiosity, bounce)) {
    const RadiositySettings& settings = resources.method.radiosity;
    if (emission_is_sent(settings, bounce)) emission_ = &resources.planes.get(tap_plane(settings, "emission"));
    if (reads_chains(settings) && settings.test_tap_normal)
        normal_chain_ = &resources.planes.get(mip_chain_of("normal"));
}

void RadiosityGatherPass::execute(const PassFrame&) {
    depth_.bind(0);
    normal_.bind(1);
    if (position_) position_->bind(stored_position_unit);
    sent_.bind(2);
    if (emission_) emission_->bind(4);
    if (normal_chain_) normal_chain_->bind(5);
    spiral_.bind();
    const InnerArea::Restriction restriction(area_);
    draw_.draw(target_);
}

std::vector<PassDeclaration> declare_gathered_chains(const RadiositySettings& settings, int bounce) {
    std::vector<PassDeclaration> passes;
    if (!reads_chains(settings)) return passes;
    const auto add = [&](const std::string& plane) {
        for (int layer = 0; layer < settings.layers; ++layer) {
            passes.push_back(
                declare_mip_chain(layer_prefix(layer) + plane + " MIP chain", plane, mip_chain_of(plane), layer));
        }
    };
    if (bounce == 1) add("normal");
    add(sent_plane(settings, bounce));
    if (emission_is_sent(settings, bounce)) add("emission");
    return passes;
}

PassDeclaration declare_radiosity_gather(const Scene& scene, const Method& method, int bounce, int layer) {
    const RadiositySettings& settings = method.radiosity;
    PassDeclaration pass;
    pass.name = name_of(bounce, layer);
    const auto add_inputs = [&](const std::string& plane, int layers) {
        for (int of = 0; of < layers; ++of) pass.inputs.push_back(layer_prefix(of) + plane);
    };
    pass.inputs = {layer_prefix(layer) + "depth"};
    add_inputs(depth_plane(settings), settings.layers);
    add_inputs("normal", settings.layers);
    if (reads_chains(settings) && settings.test_tap_normal) add_inputs(mip_chain_of("normal"), settings.layers);
    add_inputs(tap_plane(settings, sent_plane(settings, bounce)), sending_layers(settings, bounce));
    if (emission_is_sent(settings, bounce)) add_inputs(tap_plane(settings, "emission"), settings.layers);
    if (stores_positions(method)) add_inputs("camera_position", settings.layers);
    if (settings.carry && layer == 0) {  // the next frame reads all layers
        for (int other = 1; other < receiving_layers(settings, bounce); ++other)
            pass.inputs.push_back(layer_prefix(other) + radiosity_plane(bounce));
    }
    pass.outputs = {layer_prefix(layer) + gathered_plane(settings, bounce)};
    // With those of its filters, which run where it runs.
    for (const char* name : {"enabled", "estimator", "samples", "layers", "radius", "spread_pixels", "test_tap_normal",
                             "normalisation", "use_mip_chain", "mip_offset", "minimum_mip_level",
                             "mip_normals_and_radiance", "mip_points", "pattern", "blur.", "temporal.", "carry"})
        pass.parameters.push_back({fmt::format("radiosity.{}", name)});
    pass.parameters.push_back({"gbuffer.guard_band"});
    if (scene.has_emissive_surfaces()) pass.parameters.push_back({"radiosity.emitters_shine"});
    if (bounce > 1) {
        for (const char* name : {"radiosity.bounces", "radiosity.second_layer"}) pass.parameters.push_back({name});
    }
    pass.create = [bounce, layer](const PassResources& resources) {
        return std::make_unique<RadiosityGatherPass>(resources, bounce, layer);
    };
    pass.remark =
        fmt::format("{}, {} taps, {} layer{}, divided by the {}{}", to_string(settings.estimator), settings.samples,
                    settings.layers, settings.layers == 1 ? "" : "s", to_string(settings.normalisation),
                    emission_is_sent(settings, bounce) ? ", emitters shine" : "");
    return pass;
}

}  // namespace plumb
