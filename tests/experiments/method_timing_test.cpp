#include "experiments/method_timing.h"

#include <atomic>
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

std::vector<PassTiming> one_pass(double milliseconds) { return {{"pass", milliseconds}}; }

TEST(PathTiming, AllPlayThePathSideBySideAnotherFirstAtEachFrame) {
    std::string order;
    const auto subject = [&](const std::string& name) {
        return TimedPath{[&order, name] { order += name + "! "; },
                         [&order, name](int frame) {
                             order += name + std::to_string(frame) + " ";
                             return one_pass(1.0);
                         }};
    };
    time_along_path({subject("a"), subject("b"), subject("c")}, 2, {2, 1});
    EXPECT_EQ(order,
              "a! b! c! a! b! c! a0 b0 c0 b1 c1 a1 "
              "a! b! c! a! b! c! c0 a0 b0 a1 b1 c1 ");
}

TEST(PathTiming, NobodyIsChargedForWhatWentBefore) {
    // What renders behind the path tracer finds cold caches, and takes ten times as long.
    bool cold = true;
    const auto render = [&](double milliseconds) {
        const double factor = cold ? 10.0 : 1.0;
        cold = false;
        return factor * milliseconds;
    };
    const auto subject = [&](double milliseconds) {
        return TimedPath{[&render, milliseconds] { render(milliseconds); },
                         [&render, milliseconds](int) { return one_pass(render(milliseconds)); }};
    };
    for (const Timing& timing : time_along_path({subject(3.0), subject(3.0)}, 2, {0, 1})) {
        EXPECT_EQ(timing.median, 3.0);
        EXPECT_EQ(timing.upper_quartile, 3.0);
    }
}

TEST(PathTiming, EveryFrameHasItsHistoryAndThePathIsPlayedUntilAllWereTimedOftenEnough) {
    constexpr int frames = 3;
    int before = -2;  // the frame that is kept; -1: what the path begins with
    // 4 ms with the frame before, 100 ms without it, 8 ms of them for the last frame.
    const TimedPath with_history{[&] { before = -1; },
                                 [&](int frame) {
                                     const bool continues = before == frame - 1;
                                     before = frame;
                                     return one_pass(!continues ? 100.0 : frame == 2 ? 8.0 : 4.0);
                                 }};
    const std::vector<Timing> often = time_along_path({with_history}, frames, {1, 7});
    ASSERT_EQ(often.size(), 1u);
    EXPECT_EQ(often[0].repetitions, 9) << "three times three frames are seven at least";
    EXPECT_EQ(often[0].median, 4.0);
    EXPECT_EQ(often[0].upper_quartile, 8.0);
    EXPECT_EQ(often[0].passes.at(0).milliseconds, 4.0);
    EXPECT_EQ(time_along_path({with_history}, frames, {1, 1})[0].repetitions, 6) << "never once alone";
}

TEST(PathTiming, GivesNothingOnceItIsStopped) {
    std::atomic<bool> stop = false;
    int rendered = 0;
    const TimedPath subject{[] {},
                            [&](int) {
                                stop = ++rendered == 2;
                                return one_pass(1.0);
                            }};
    EXPECT_TRUE(time_along_path({subject}, 4, {1, 1}, &stop).empty());
    EXPECT_EQ(rendered, 2);
}

}  // namespace
}  // namespace plumb
