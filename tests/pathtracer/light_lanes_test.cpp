// Lights sampled for many vertices side by side: bit by bit what each vertex samples alone.
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "chi_square.h"
#include "pathtracer/direction_sampling.h"
#include "pathtracer/discrete_distribution.h"
#include "pathtracer/light_table.h"
#include "test_scenes.h"

namespace plumb {
namespace {

// A scene whose lights are sampled in a way of its own.
struct LitScene {
    const char* name;
    std::function<void(Scene&)> add_lights;
    double least_bright = 0.4;  // share of the samples in which light must be found, for the scene to prove anything
};

// Squares of two triangles each, of several powers and sides. Nothing of it has a texture, moves or lies infinitely far
// away: only such emitters are sampled side by side.
void add_lamps(Scene& scene, std::size_t squares) {
    struct Lamp {
        glm::vec3 emission;
        bool two_sided;
        std::vector<glm::vec3> corners;
    };
    const std::vector<Lamp> lamps = {
        {{1, 1, 1}, false, {{-1, 2, -1}, {1, 2, -1}, {1, 2, 1}, {-1, 2, 1}}},
        {{4, 1, 2}, true, {{2, 0, -2}, {2, 1, -2}, {2, 1, 0}, {2, 0, 0}}},
        {{0.5f, 2, 1}, true, {{-3, -1, 0}, {-3, 1, 1}, {-2, 1, 2}, {-2, -1, 1}}},
        {{1, 1, 1}, false, {{2, 2, -1}, {3, 2, -1}, {3, 2, 1}, {2, 2, 1}}},
        {{2, 0, 3}, true, {{-1, -2, 1}, {1, -2, 1}, {1, -2, 2}, {-1, -2, 2}}},
    };
    for (std::size_t i = 0; i < squares; ++i) {
        add_quads(scene, add_material(scene, glm::vec3(0.5f), lamps[i].emission, lamps[i].two_sided),
                  {lamps[i].corners});
    }
}

void add_point(Scene& scene, const glm::vec3& position, const Attenuation& attenuation = {}) {
    scene.point_lights.push_back({"point", position, {3, 2, 1}, attenuation});
}
void add_spot(Scene& scene, const glm::vec3& position) {
    scene.spot_lights.push_back({"spot", position, glm::normalize(-position), {1, 2, 4}, 0.1f, 0.4f});
}
void add_sun(Scene& scene, const glm::vec3& direction) {
    scene.directional_lights.push_back({"sun", glm::normalize(direction), {1, 2, 3}});
}

// Up to four emitters are set lane by lane together, more are looked up; up to eight are chosen by counting, more by
// bisection.
const std::vector<LitScene>& lit_scenes() {
    static const std::vector<LitScene> all = {
        {"TwoEmitters", [](Scene& scene) { add_lamps(scene, 1); }, 0.3},  // not from above
        {"FourEmitters", [](Scene& scene) { add_lamps(scene, 2); }},
        {"EightEmitters", [](Scene& scene) { add_lamps(scene, 4); }},
        {"TenEmitters", [](Scene& scene) { add_lamps(scene, 5); }},
        {"OneSun",
         [](Scene& scene) {
             add_sun(scene, {1, -3, 2});
         },
         1.0},
        {"OnePoint",
         [](Scene& scene) {
             add_point(scene, {0.2f, 0.1f, 2});
         },
         1.0},
        {"OneAttenuatedPoint",
         [](Scene& scene) {
             add_point(scene, {0.2f, 0.1f, 2}, {0.5f, 0.2f, 0.1f});
         },
         1.0},
        {"OneSpot",
         [](Scene& scene) {
             add_spot(scene, {2, 1, 0.5f});
         },
         0.3},  // that much of the cube is in its cone
        {"OneSpotWithAHardEdge",
         [](Scene& scene) {
             add_spot(scene, {2, 1, 0.5f});
             scene.spot_lights[0].inner_angle = scene.spot_lights[0].outer_angle = 0.25f;
         },
         0.3},
        {"SeveralPoints",
         [](Scene& scene) {
             add_point(scene, {0.2f, 0.1f, 2}), add_point(scene, {-2, 1, 0}, {1, 0, 0});
             add_point(scene, {0.1f, -0.2f, 0.1f}, {0.5f, 0.2f, 0.1f});  // amidst the receivers
         }},
        {"TwoSuns",
         [](Scene& scene) {
             add_sun(scene, {1, -3, 2}), add_sun(scene, {-1, 1, 1});
         }},
        {"AllWithoutExtent",
         [](Scene& scene) {
             add_point(scene, {0.2f, 0.1f, 2}), add_point(scene, {-2, 1, 0});
             add_spot(scene, {2, 1, 0.5f}), add_sun(scene, {1, -3, 2});
         }},
    };
    return all;
}

// One batch of receivers in the unit cube that face anywhere, and the random numbers of each.
struct Receivers {
    VertexBatch vertices;
    Lanes<std::uint32_t> x;
    Lanes<float> y;

    void fill(int batch, bool with_bulges) {
        vertices.count = batch % 8 == 5 ? 37 : most_lanes;  // also one that is not full
        for (int i = 0; i < most_lanes; ++i) {
            const int index = batch * most_lanes + i;
            const IndependentNumbers place(1, index), turn(2, index), light(3, index);
            vertices.ray_origin.set(i, glm::vec3(place.u, place.thinning.x) - 0.5f);
            const glm::vec3 normal = sample_cone({0, 1, 0}, 2.0f, turn.u);  // anywhere on the sphere
            vertices.shading_normal.set(i, normal);
            vertices.geometric_normal.set(i, sample_cone(normal, 0.3f, turn.thinning));
            vertices.bulge[i] = with_bulges && i % 3 == 0 ? 0.1f : 0.0f;
            vertices.time[i] = now;
            // All 32 bits, of which a float would keep 24.
            x[i] = mix_word(static_cast<std::uint32_t>(index));
            y[i] = light.u.y;
        }
    }
};

// The same operations in the same order, in a library that contracts none of them. Of a sample that brings no light
// nobody reads where it came from.
bool holds(const LightLanes& samples, int lane, const LightSample& alone) {
    if (samples.radiance.get(lane) != alone.radiance || samples.density[lane] != alone.density) return false;
    return alone.radiance == glm::vec3(0.0f) ||
           (samples.direction.get(lane) == alone.direction && samples.shadow_ray.get(lane) == alone.shadow_ray &&
            samples.rise[lane] == alone.rise && samples.farthest[lane] == alone.farthest);
}

class LightLanesOf : public testing::TestWithParam<int> {};

TEST_P(LightLanesOf, HoldTheBitsOfSamplesOneByOne) {
    const LitScene& lit = lit_scenes()[static_cast<std::size_t>(GetParam())];
    for (const bool with_bulges : {false, true}) {
        Scene scene;
        lit.add_lights(scene);
        const int grey = add_material(scene, glm::vec3(0.5f));
        if (with_bulges) {
            add_smooth_ball(scene, grey, 1, {0, -4, 0});
        } else {
            add_quads(scene, grey, {floor_quad(1.0f, -4.0f)});
        }
        const TracedScene traced(scene);
        ASSERT_EQ(traced.anything_bulges(), with_bulges);
        const EnvironmentDistribution none(scene);
        const LightTable lights(traced, none, EmitterSampling::both);
        const bool has_extent = lights.has_extended_lights();
        ASSERT_NE(has_extent, lights.lights_without_extent() > 0);
        const auto receivers = std::make_unique<Receivers>();
        const auto samples = std::make_unique<LightLanes>();
        int bright = 0, risen = 0, different = 0, in_all = 0;
        for (int batch = 0; batch < 40; ++batch) {
            receivers->fill(batch, with_bulges);
            const auto& [vertices, x, y] = *receivers;
            if (has_extent) {
                lights.sample_extended(vertices, x, y, *samples);
            } else {
                lights.sample_without_extent(vertices, y, *samples);
            }
            for (int i = 0; i < vertices.count; ++i, ++in_all) {
                const LightReceiver here = vertices.receiver(i);
                const LightSample alone = has_extent ? lights.sample_extended(here, 0x1p-32 * x[i], y[i])
                                                     : lights.sample_without_extent(here, y[i]);
                bright += alone.radiance != glm::vec3(0.0f) ? 1 : 0;
                risen += alone.radiance != glm::vec3(0.0f) && alone.rise > 0.0f ? 1 : 0;
                different += holds(*samples, i, alone) ? 0 : 1;
            }
        }
        EXPECT_EQ(different, 0) << "of " << in_all << ", bulges: " << with_bulges;
        EXPECT_GE(bright, lit.least_bright * in_all);
        EXPECT_EQ(risen > 20, with_bulges) << risen;
    }
}

INSTANTIATE_TEST_SUITE_P(All, LightLanesOf, testing::Range(0, static_cast<int>(lit_scenes().size())),
                         [](const auto& test) { return lit_scenes()[static_cast<std::size_t>(test.param)].name; });

// On both sides of the number of items up to which they are counted; items of no weight first, in the middle and last;
// and numbers at the very ends of the shares.
TEST(DiscreteDistributionLanes, ChooseTheItemsOfNumbersOneByOne) {
    for (const std::size_t size : {1u, 2u, 8u, 9u, 50u}) {
        std::vector<double> weights;
        for (std::size_t i = 0; i < size; ++i) weights.push_back(size > 2 && i % 7 == 0 ? 0.0 : 1.0 + 0.3 * i);
        if (size > 2) weights.back() = 0.0;
        const DiscreteDistribution distribution(weights);
        std::vector<std::uint32_t> numbers = {0u, 1u, 0x7fffffffu, 0x80000000u, 0xfffffffeu, 0xffffffffu};
        double before = 0.0;
        for (const double weight : weights) {
            before += weight;
            const auto edge = static_cast<std::uint32_t>(std::min(before / distribution.sum() * 0x1p32, 0x1p32 - 1.0));
            numbers.insert(numbers.end(), {edge - 1, edge, edge + 1});
        }
        for (std::uint32_t i = 0; i < 1000; ++i) numbers.push_back(mix_word(i));
        int different = 0, impossible = 0;
        for (std::size_t first = 0; first < numbers.size(); first += most_lanes) {
            const std::size_t count = std::min<std::size_t>(most_lanes, numbers.size() - first);
            Lanes<std::uint32_t> u{}, items{};
            std::copy_n(numbers.begin() + static_cast<std::ptrdiff_t>(first), count, u.begin());
            distribution.sample(u, static_cast<int>(count), items);
            for (std::size_t i = 0; i < count; ++i) {
                const std::size_t alone = distribution.sample(0x1p-32 * u[i]);
                different += items[i] == alone ? 0 : 1;
                impossible += weights[alone] > 0.0 ? 0 : 1;
            }
        }
        EXPECT_EQ(different, 0) << size << " items";
        EXPECT_EQ(impossible, 0) << size << " items";
    }
}

}  // namespace
}  // namespace plumb
