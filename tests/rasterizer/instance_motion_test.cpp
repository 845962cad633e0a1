// The numbers of the instances that move.
#include "rasterizer/instance_motion.h"

#include <gtest/gtest.h>

namespace plumb {
namespace {

Instance moving() {
    Instance instance;
    instance.motion.keys.resize(2);
    return instance;
}

TEST(InstanceMotion, CountsThoseThatMoveFromOne) {
    Scene scene;
    scene.instances = {Instance{}, moving(), Instance{}, moving()};
    EXPECT_EQ(moving_instance_numbers(scene), (std::vector{0, 1, 0, 2}));
}

// 0 is no number, so that 16 bits count 65,535.
TEST(InstanceMotion, NumbersAreWideEnough) {
    Scene scene;
    scene.instances.assign(10, Instance{});
    scene.instances.resize(10 + 65535, moving());
    EXPECT_EQ(moving_instance_numbers(scene).back(), 65535);
    EXPECT_EQ(moving_instance_format(scene), static_cast<GLenum>(GL_R16UI));
    scene.instances.push_back(moving());
    EXPECT_EQ(moving_instance_format(scene), static_cast<GLenum>(GL_R32UI));
}

}  // namespace
}  // namespace plumb
