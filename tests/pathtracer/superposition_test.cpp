// Light adds up: lights with each other, planes to the total; and scales.
#include <glm/gtc/constants.hpp>
#include <gtest/gtest.h>

#include "tests/pathtracer/test_scenes.h"

namespace plumb {
namespace {

TEST(TwoLights, GiveTheSumOfEachAlone) {
    const auto scene_with = [](bool lamp, bool panel, bool sky) {
        Scene scene;
        const int white = add_material(scene, glm::vec3(0.7f));
        const int light = add_material(scene, glm::vec3(0.2f), glm::vec3(panel ? 5.0f : 0.0f));
        auto walls = room_quads();
        walls.pop_back();  // open towards +Z
        add_quads(scene, white, walls);
        add_quads(scene, light, {{{-0.3f, 0.9f, -0.3f}, {0.3f, 0.9f, -0.3f}, {0.3f, 0.9f, 0.3f}, {-0.3f, 0.9f, 0.3f}}});
        if (lamp) scene.point_lights.push_back({"lamp", {0.5f, -0.2f, 0.3f}, glm::vec3(0.8f)});
        if (sky) scene.environment.radiance = glm::vec3(0.6f);
        return scene;
    };
    const View view = view_of({0.2f, 0.1f, 3.5f}, {0, 0, 0}, 0.7f);
    const auto settings = settings_for({"direct", "indirect"}, 256, 2);
    const auto render = [&](bool lamp, bool panel, bool sky) {
        return PathTracer(scene_with(lamp, panel, sky)).render(view, settings).frame;
    };
    const Frame all = render(true, true, true), lamp = render(true, false, false), panel = render(false, true, false),
                sky = render(false, false, true);
    for (const char* plane : {"direct", "indirect"}) {
        double difference = 0.0, sum = 0.0, variance = 0.0;
        for (int y = 0; y < all.height(); ++y) {
            for (int x = 0; x < all.width(); ++x) {
                difference += all.plane(plane).at(x, y);
                sum += all.plane(plane).at(x, y);
                for (const Frame* one : {&lamp, &panel, &sky}) {
                    difference -= one->plane(plane).at(x, y);
                    variance += one->plane(std::string("variance.") + plane).at(x, y);
                }
                variance += all.plane(std::string("variance.") + plane).at(x, y);
            }
        }
        EXPECT_NEAR(difference, 0.0, 4.0 * std::sqrt(variance)) << plane;
        EXPECT_LT(4.0 * std::sqrt(variance), 0.03 * sum) << plane << ": too noisy to prove anything";
    }
}

TEST(Total, IsExactlyEmissionPlusDirectPlusTheBounces) {
    Scene scene;
    add_quads(scene, add_material(scene, {0.7f, 0.5f, 0.3f}, {0.2f, 0.1f, 0.05f}), room_quads());
    scene.point_lights.push_back({"lamp", {0.1f, 0.2f, 0.3f}, {1, 2, 3}});
    const auto settings = settings_for({"emission", "direct", "indirect", "indirect.1", "indirect.2", "total"}, 8, 2);
    const Frame frame = PathTracer(scene).render(view_of({0, 0, 0}, {0, -1, 0.4f}, 1.5f), settings).frame;
    for (const std::string half : {"half_a.", "half_b."}) {
        for (int y = 0; y < frame.height(); ++y) {
            for (int x = 0; x < frame.width(); ++x) {
                for (int c = 0; c < 3; ++c) {
                    const auto at = [&](const std::string& plane) { return frame.plane(plane).at(x, y, c); };
                    EXPECT_EQ(at(half + "indirect"), at(half + "indirect.1") + at(half + "indirect.2"));
                    EXPECT_EQ(at(half + "total"), (at("emission") + at(half + "direct")) + at(half + "indirect"));
                }
            }
        }
    }
}

}  // namespace
}  // namespace plumb
