#include "experiments/settling.h"

#include <gtest/gtest.h>

namespace plumb {
namespace {

TEST(Settling, WhatKeepsNothingIsDoneWithItsFirstFrame) {
    Method method;
    EXPECT_EQ(frames_to_settle(method), 1);
    method.ao.enabled = false;
    method.ao.temporal.alpha = 0.9f;
    EXPECT_EQ(frames_to_settle(method), 1);
}

TEST(Settling, EachHistoryFadesToAHundredth) {
    Method method;
    method.ao.temporal.alpha = 0.5f;
    EXPECT_EQ(frames_to_settle(method), 1 + 7);  // 1 / 128
    method.antialias = {.temporal = true, .alpha = 0.9f};
    EXPECT_EQ(frames_to_settle(method), 1 + 7 + 44);  // 0.9^44 = 0.0097
    method.radiosity.carry = true;
    EXPECT_EQ(frames_to_settle(method), 1 + 7 + 44 + 21);  // 0.8^21 = 0.0092
}

TEST(Settling, LightThatIsCarriedOnThroughATemporalFilterTakesItsTime) {
    Method method;
    method.radiosity.carry = true;
    method.radiosity.temporal.alpha = 0.9f;
    // Each frame adds a tenth, of which four fifths are carried on: 0.9 + 0.1 0.8 = 0.98 is left, 0.98^228 = 0.00998.
    EXPECT_EQ(frames_to_settle(method), 1 + 228);
}

}  // namespace
}  // namespace plumb
