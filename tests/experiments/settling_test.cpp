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

}  // namespace
}  // namespace plumb
