// Lights sampled for many vertices side by side, as plain scenes are: bit by bit what each vertex samples alone.
#include <memory>

#include <gtest/gtest.h>

#include "chi_square.h"
#include "pathtracer/direction_sampling.h"
#include "pathtracer/light_table.h"
#include "test_scenes.h"

namespace plumb {
namespace {

// Lamps of several triangles, powers and sides. Nothing of it has a texture, moves or lies infinitely far away: only
// such lights are sampled side by side.
Scene plain_lamps(bool with_bulges) {
    Scene scene;
    add_quads(scene, add_material(scene, glm::vec3(0.5f), {1, 1, 1}, false),
              {{{-1, 2, -1}, {1, 2, -1}, {1, 2, 1}, {-1, 2, 1}}, {{2, 2, -1}, {3, 2, -1}, {3, 2, 1}, {2, 2, 1}}});
    add_quads(scene, add_material(scene, glm::vec3(0.5f), {4, 1, 2}), {{{2, 0, -2}, {2, 1, -2}, {2, 1, 0}, {2, 0, 0}}});
    add_quads(scene, add_material(scene, glm::vec3(0.5f), {0.5f, 2, 1}),
              {{{-3, -1, 0}, {-3, 1, 1}, {-2, 1, 2}, {-2, -1, 1}}});
    if (with_bulges) add_smooth_ball(scene, add_material(scene, glm::vec3(0.5f)), 1, {0, -4, 0});
    return scene;
}

TEST(LightLanes, HoldTheBitsOfSamplesOneByOne) {
    for (const bool with_bulges : {false, true}) {
        const Scene scene = plain_lamps(with_bulges);
        const TracedScene traced(scene);
        ASSERT_EQ(traced.anything_bulges(), with_bulges);
        const EnvironmentDistribution none(scene);
        const LightTable lights(traced, none, EmitterSampling::both);
        const auto vertices = std::make_unique<VertexBatch>();
        const auto samples = std::make_unique<LightLanes>();
        int bright = 0, risen = 0, different = 0, in_all = 0;
        for (int batch = 0; batch < 80; ++batch) {
            vertices->count = batch % 8 == 5 ? 37 : most_lanes;  // also one that is not full
            Lanes<std::uint32_t> x;
            Lanes<float> y;
            for (int i = 0; i < most_lanes; ++i) {
                const int index = batch * most_lanes + i;
                const IndependentNumbers place(1, index), turn(2, index), light(3, index);
                vertices->ray_origin.set(i, glm::vec3(place.u, place.thinning.x) - 0.5f);
                const glm::vec3 normal = sample_cone({0, 1, 0}, 2.0f, turn.u);  // anywhere on the sphere
                vertices->shading_normal.set(i, normal);
                vertices->geometric_normal.set(i, sample_cone(normal, 0.3f, turn.thinning));
                vertices->bulge[i] = with_bulges && i % 3 == 0 ? 0.1f : 0.0f;
                vertices->time[i] = now;
                // All 32 bits, of which a float would keep 24.
                x[i] = mix_word(static_cast<std::uint32_t>(index));
                y[i] = light.u.y;
            }
            lights.sample_extended(*vertices, x, y, *samples);
            for (int i = 0; i < vertices->count; ++i, ++in_all) {
                const LightSample alone = lights.sample_extended(vertices->receiver(i), 0x1p-32 * x[i], y[i]);
                // The same operations in the same order, in a library that contracts none of them.
                bool equal = samples->radiance.get(i) == alone.radiance && samples->density[i] == alone.density;
                if (alone.density > 0.0f) {
                    equal = equal && samples->direction.get(i) == alone.direction &&
                            samples->shadow_ray.get(i) == alone.shadow_ray && samples->rise[i] == alone.rise &&
                            samples->farthest[i] == alone.farthest;
                    ++bright;
                }
                risen += alone.rise > 0.0f ? 1 : 0;
                different += equal ? 0 : 1;
            }
        }
        EXPECT_EQ(different, 0) << "of " << in_all << ", bulges: " << with_bulges;
        EXPECT_GT(bright, in_all / 2);
        EXPECT_EQ(risen > 100, with_bulges) << risen;
    }
}

}  // namespace
}  // namespace plumb
