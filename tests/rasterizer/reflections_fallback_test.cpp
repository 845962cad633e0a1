// What screen-space reflections show beside the layers' direct light, pixel by pixel: where rays find nothing, the
// environment or a probe, by direction and roughness; of what they hit, indirect light too; with a guard band and with
// stored positions.
#include <gmock/gmock.h>

#include "gl_test.h"
#include "reflection_run.h"
#include "screen_space_run.h"

namespace plumb {
namespace {

// Through EGL alone: what takes time is compiling shaders, and both compile the same.
GlContext& egl_context() { return test_context(GlBackend::egl); }

constexpr float layer_separation = 0.1f;

Method reflecting(ReflectionSettings settings) {
    settings.enabled = true;
    Method method;
    method.gbuffer.minimum_separation = layer_separation;
    method.environment = {.size = 128, .samples = 128};
    method.probe.size = 128;
    method.reflections = settings;
    return method;
}

struct Comparison {
    int compared = 0, hits = 0, misses = 0, wrong = 0;
};

// Of the pixels inside the guard band. What is fallen back on has the error `fallback_error`, relative to itself.
Comparison expect_reflections(const counterpart::Layers& layers, const counterpart::Gloss& gloss, const Method& method,
                              const counterpart::Radiance& fallback, const Image& reflection, double tolerance,
                              double fallback_error = 0.0) {
    counterpart::ReflectionRequest request;
    request.settings = method.reflections;
    request.settings.thickness = layer_separation;
    const counterpart::ReflectionTracer hits_alone(layers, gloss, request);
    if (fallback) {
        request.fallback = [&](const glm::dvec3& direction, double roughness) {
            // Smooth skies and lobes: 120 rings are good to a thousandth.
            return counterpart::glossy_radiance(fallback, direction, roughness, 120);
        };
    }
    const counterpart::ReflectionTracer tracer(layers, gloss, request);
    const int band = method.gbuffer.guard_band;
    Comparison result;
    for (int y = band; y < layers.height() - band; ++y) {
        for (int x = band; x < layers.width() - band; ++x) {
            const counterpart::Reflected expected = tracer.reflect({x, y});
            if (expected.ambiguous || expected.rays == 0) continue;
            ++result.compared;
            result.hits += expected.hits, result.misses += expected.rays - expected.hits;
            const glm::dvec3 fallen_back = expected.radiance - hits_alone.reflect({x, y}).radiance;
            const auto found = reflection.pixel(x, layers.height() - 1 - y);
            bool right = true;
            for (int c = 0; c < 3; ++c) {
                right =
                    right && std::abs(found[c] - expected.radiance[c]) < tolerance + fallback_error * fallen_back[c];
            }
            if (!right && ++result.wrong < 5) {
                ADD_FAILURE() << "pixel (" << x << ", " << y << ") from the bottom left: " << found[0] << " "
                              << found[1] << " " << found[2] << "; expected " << expected.radiance.x << " "
                              << expected.radiance.y << " " << expected.radiance.z << ", " << expected.hits << " of "
                              << expected.rays << " rays hit";
            }
        }
    }
    EXPECT_EQ(result.wrong, 0);
    return result;
}

// As in reflections_test.cpp: half floats of the MIP chain, 8 bits of the split sum's weights.
constexpr double tolerance_of_one_ray = 1.5e-3;

struct FallbackCase {
    const char* name;
    ReflectionSettings settings;
    float roughness;
    // Texels of the cubes are read bilinearly: 0.7 degrees wide in the sharpest level, 3 to 6 in those next to a
    // roughness of 0.5, in a sky with a glow 13 degrees wide, and 23 degrees in the blurriest, where between two texels
    // a tenth is missing or too much; and made of 128 directions each.
    double error;
};

std::vector<FallbackCase> fallback_cases(ReflectionFallback fallback) {
    using Roughness = ReflectionRoughness;
    return {{"a lobe between two levels", {.roughness = Roughness::mirror, .fallback = fallback}, 0.5f, 0.05},
            {"the widest lobe", {.roughness = Roughness::mip, .fallback = fallback}, 1.0f, 0.12},
            {"rays over a lobe", {.roughness = Roughness::samples, .samples = 5, .fallback = fallback}, 0.5f, 0.01}};
}

TEST(ReflectionsFallback, TheEnvironmentAnswersByDirectionAndRoughness) {
    const View view = slanted_view(27, 18);
    const counterpart::Layers noise = counterpart::random_layers(view, 4);
    ReflectionSurroundings surroundings;
    counterpart::give_sky(surroundings.environment);
    const auto sky = [&](const glm::dvec3& d) {
        return glm::dvec3(surroundings.environment.environment_radiance(glm::vec3(d)));
    };
    for (const FallbackCase& c : fallback_cases(ReflectionFallback::environment)) {
        SCOPED_TRACE(c.name);
        const Method method = reflecting(c.settings);
        const counterpart::Gloss gloss = even_gloss(view, {0.9f, 0.5f, 0.2f}, 1.0f, c.roughness);
        ReflectionRun run(egl_context(), noise, gloss, method, {.planes = {"reflection"}}, surroundings);
        const Comparison result =
            expect_reflections(run.layers(), gloss, method, sky, run.render(), tolerance_of_one_ray, c.error);
        EXPECT_GT(result.misses, 50);
        EXPECT_GT(result.hits, 50);
    }
}

TEST(ReflectionsFallback, AProbeAnswersByDirectionAndRoughness) {
    const View view = slanted_view(27, 18);
    const counterpart::Layers noise = counterpart::random_layers(view, 5);
    ReflectionSurroundings surroundings(glm::vec3(9.0f));  // an environment that must not be taken instead
    // No two directions send the same.
    surroundings.probe = [](const glm::dvec3& d) {
        return glm::dvec3(1.0 + 0.8 * d.x + 0.1 * d.y, 1.0 + 0.7 * d.y - 0.2 * d.z * d.x, 1.0 - 0.9 * d.z);
    };
    for (const FallbackCase& c : fallback_cases(ReflectionFallback::probe)) {
        SCOPED_TRACE(c.name);
        const Method method = reflecting(c.settings);
        const counterpart::Gloss gloss = even_gloss(view, {0.9f, 0.5f, 0.2f}, 1.0f, c.roughness);
        ReflectionRun run(egl_context(), noise, gloss, method, {.planes = {"reflection"}}, surroundings);
        const Comparison result = expect_reflections(run.layers(), gloss, method, surroundings.probe, run.render(),
                                                     tolerance_of_one_ray, c.error);
        EXPECT_GT(result.misses, 50);
    }
}

struct HitCase {
    const char* name;
    ReflectionSettings settings;
    float roughness = 0.0f;
};

const std::vector<HitCase> hit_cases = {
    {"mirror", {.roughness = ReflectionRoughness::mirror}},
    {"mirror of one layer", {.roughness = ReflectionRoughness::mirror, .layers = 1, .border_fade = 0}},
    {"MIP chain", {.roughness = ReflectionRoughness::mip}, 0.3f},
    {"three rays", {.roughness = ReflectionRoughness::samples, .samples = 3}, 0.4f}};

double tolerance_of(const HitCase& c) {
    // Float directions and weights.
    return c.settings.roughness == ReflectionRoughness::samples ? 1e-4 : tolerance_of_one_ray;
}

// What hits in the first layer send besides direct light, but not in the guard band, where nothing is gathered.
counterpart::Layers with_indirect(counterpart::Layers layers, const Image& indirect, int band) {
    for (int y = band; y < layers.height() - band; ++y) {
        for (int x = band; x < layers.width() - band; ++x) {
            for (int c = 0; c < 3; ++c) layers.radiance[0].at(x, y, c) += indirect.at(x, y, c);
        }
    }
    return layers;
}

TEST(ReflectionsFallback, HitsSendIndirectLightAfterTwoBouncesButNotInTheGuardBand) {
    struct IndirectCase {
        std::size_t hits;
        int band, bounces;
    };
    for (const auto& [index, band, bounces] : {IndirectCase{0, 9, 2}, IndirectCase{2, 9, 2}, IndirectCase{3, 9, 2},
                                               IndirectCase{1, 0, 2}, IndirectCase{0, 0, 1}}) {
        const HitCase& c = hit_cases[index];
        SCOPED_TRACE(testing::Message() << c.name << ", guard band " << band << ", bounces " << bounces);
        const View view = slanted_view(35, 24).with_guard_band(band);
        const counterpart::Layers noise = counterpart::random_layers(view, 7);
        ReflectionSurroundings surroundings;
        // The radiance of the second layer shows what indirect light there would look like.
        surroundings.indirect = noise.radiance[1];
        for (float& value : surroundings.indirect->values()) value = 0.2f + 0.5f * value;
        const counterpart::Gloss gloss = even_gloss(view, {0.9f, 0.5f, 0.2f}, 1.0f, c.roughness);
        Method method = reflecting(c.settings);
        method.gbuffer.guard_band = band;
        ReflectionRun run(egl_context(), noise, gloss, method, {.planes = {"reflection"}, .bounces = bounces},
                          surroundings);
        const counterpart::Layers sending =
            bounces == 2 ? with_indirect(run.layers(), *surroundings.indirect, band) : run.layers();
        const Comparison result = expect_reflections(sending, gloss, method, {}, run.render(), tolerance_of(c));
        EXPECT_GT(result.hits, 50);
    }
}

// Without emissive surfaces nothing that rays hit has sent light before the first bounce.
TEST(ReflectionsFallback, WithoutBouncesOnlyTheFallbackIsReflected) {
    const View view = slanted_view(35, 24);
    const counterpart::Layers noise = counterpart::random_layers(view, 7);
    counterpart::Layers dark = noise;
    for (Image& radiance : dark.radiance) radiance = Image(view.width(), view.height(), 3);
    const glm::vec3 sky(0.3f, 0.6f, 0.9f);
    struct DarkCase {
        std::size_t hits;
        ReflectionFallback fallback;
    };
    for (const auto& [index, fallback] :
         {DarkCase{0, ReflectionFallback::none}, DarkCase{2, ReflectionFallback::none},
          DarkCase{3, ReflectionFallback::none}, DarkCase{0, ReflectionFallback::environment}}) {
        HitCase c = hit_cases[index];
        SCOPED_TRACE(testing::Message() << c.name << ", fallback " << to_string(fallback));
        c.settings.fallback = fallback;
        const counterpart::Gloss gloss = even_gloss(view, {0.9f, 0.5f, 0.2f}, 1.0f, c.roughness);
        const Method method = reflecting(c.settings);
        ReflectionRun run(egl_context(), noise, gloss, method, {.planes = {"reflection"}, .bounces = 0}, sky);
        dark.normal = run.layers().normal;
        counterpart::Radiance even_sky;
        if (fallback == ReflectionFallback::environment) even_sky = [&](const glm::dvec3&) { return glm::dvec3(sky); };
        expect_reflections(dark, gloss, method, even_sky, run.render(), tolerance_of(c));
    }
}

TEST(ReflectionsFallback, StoredPositionsAreWhatIsReflectedAndHit) {
    const View view = slanted_view(35, 24);
    counterpart::Layers noise = counterpart::random_layers(view, 8);
    // As deep as depth says, but up to 0.3 pixels beside the pixels' centres: what only a stored position tells.
    std::mt19937 generator(3);
    std::uniform_real_distribution<float> aside(-0.3f, 0.3f);
    std::vector<Image> positions;
    for (int layer = 0; layer < 2; ++layer) {
        Image position(view.width(), view.height(), 3);
        for (int y = 0; y < view.height(); ++y) {
            for (int x = 0; x < view.width(); ++x) {
                const glm::dvec3 point = counterpart::point_at(noise, layer, {x, view.height() - 1 - y});
                const double pixel = -point.z / view.pixels_per_metre();
                position.at(x, y, 0) = static_cast<float>(point.x + pixel * aside(generator));
                position.at(x, y, 1) = static_cast<float>(point.y + pixel * aside(generator));
                position.at(x, y, 2) = static_cast<float>(point.z);
            }
        }
        positions.push_back(position);
    }
    noise.position = positions;
    for (const HitCase& c : hit_cases) {
        SCOPED_TRACE(c.name);
        const counterpart::Gloss gloss = even_gloss(view, {0.9f, 0.5f, 0.2f}, 1.0f, c.roughness);
        Method method = reflecting(c.settings);
        method.gbuffer.position = PositionSource::stored;
        ReflectionRun run(egl_context(), noise, gloss, method, {.planes = {"reflection"}});
        const Comparison result = expect_reflections(run.layers(), gloss, method, {}, run.render(), tolerance_of(c));
        EXPECT_GT(result.hits, 50);
    }
}

}  // namespace
}  // namespace plumb
