#include "experiments/method_timing.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumb {
namespace {

TEST(MethodTiming, AllWarmUpBeforeTheClockRunsThenTakeTurns) {
    std::string order;
    const auto subject = [&](char name) {
        return [&order, name] {
            order.push_back(name);
            return std::vector<PassTiming>{{"pass", 1.0}};
        };
    };
    time_interleaved(std::vector<TimedFrame>{subject('a'), subject('b'), subject('c')}, {2, 3});
    EXPECT_EQ(order,
              "abcabc"
              "abcabcabc");
}

TEST(MethodTiming, MediansAndQuartilesAreOfTheFramesBehindTheWarmUp) {
    double frame = 0.0;
    // 100 and 200 ms while it warms up; then 3, 6, 9, 12 and 15, a third of it in the first pass.
    const TimedFrame slowing = [&] {
        ++frame;
        const double sum = frame <= 2.0 ? 100.0 * frame : 3.0 * (frame - 2.0);
        return std::vector<PassTiming>{{"gbuffer", sum / 3.0}, {"ao", 2.0 * sum / 3.0}};
    };
    const TimedFrame steady = [] { return std::vector<PassTiming>{{"gbuffer", 7.0}}; };
    const std::vector<Timing> timings = time_interleaved(std::vector{slowing, steady}, {2, 5});
    ASSERT_EQ(timings.size(), 2u);
    EXPECT_DOUBLE_EQ(timings[0].median, 9.0);
    EXPECT_DOUBLE_EQ(timings[0].lower_quartile, 6.0);
    EXPECT_DOUBLE_EQ(timings[0].upper_quartile, 12.0);
    EXPECT_EQ(timings[0].repetitions, 5);
    ASSERT_EQ(timings[0].passes.size(), 2u);
    EXPECT_EQ(timings[0].passes[1].pass, "ao");
    EXPECT_DOUBLE_EQ(timings[0].passes[1].milliseconds, 6.0);
    EXPECT_DOUBLE_EQ(timings[1].median, 7.0);
}

}  // namespace
}  // namespace plumb
