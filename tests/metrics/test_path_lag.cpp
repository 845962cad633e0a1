#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include <gmock/gmock.h>

#include "frames/image_error.h"
#include "metrics/path_lag.h"
#include "tests/metrics/panned_wall.h"

namespace plumb {
namespace {

using namespace test;

// Sums of some hundred values near 1 in single precision, as a share of the change that they are divided by.
constexpr double float32 = 1e-3;

using Course = std::function<double(double s, int t)>;  // of surface point s in frame t

Frame wall_at(const Course& course, int t) {
    return wall(0, [&](double s) { return course(s, t); });
}

// `path` frames with the truth, then held ones of the method alone.
Estimate lag_of(const Course& method, const Course& truth, int path, int held) {
    PathLag lag("direct");
    for (int t = 0; t < path; ++t) lag.add(wall_at(method, t), wall_at(truth, t));
    Image sum(wall_width, wall_height, 1), last;
    for (int t = path; t < path + held; ++t) {
        last = wall_at(method, t).plane("direct");
        for (std::size_t i = 0; i < sum.values().size(); ++i) sum.values()[i] += last.values()[i];
    }
    lag.hold(sum, last, held);
    return lag.result();
}

double change(double s) { return 0.3 + 0.02 * s; }
double step(double s, int t) { return texture(s) + (t > 0 ? change(s) : 0.0); }

// M_t = (1 - alpha) X_t + alpha M_{t-1} of what was always X_0 before.
Course filtered(const Course& input, double alpha) {
    return [=](double s, int t) {
        double value = input(s, 0);
        for (int k = 1; k <= t; ++k) value = (1.0 - alpha) * input(s, k) + alpha * value;
        return value;
    };
}

TEST(PathLag, OfAnExponentialFilterIsAlphaOverOneMinusAlpha) {
    for (const double alpha : {0.0, 0.5, 0.85, 0.95, 0.97}) {
        // Until less than a millionth of the change is to come.
        const int held = alpha > 0.0 ? static_cast<int>(std::ceil(std::log(1e-6) / std::log(alpha))) : 1;
        const double expected = alpha / (1.0 - alpha);
        const Estimate lag = lag_of(filtered(step, alpha), step, 3, held);
        EXPECT_NEAR(lag.value, expected, float32 * (1.0 + expected)) << alpha;
        EXPECT_NEAR(lag.lower, expected, float32 * (1.0 + expected)) << "every pixel lags alike";
        EXPECT_NEAR(lag.upper, expected, float32 * (1.0 + expected));
    }
}

TEST(PathLag, OfARampIsThatOfAStep) {
    const auto ramp = [](double s, int t) { return texture(s) + 0.1 * std::min(t, 5) * change(s); };
    EXPECT_NEAR(lag_of(filtered(ramp, 0.9), ramp, 8, 150).value, 9.0, 10.0 * float32);
}

TEST(PathLag, OfAPictureThatComesSomeFramesLateIsThatManyFrames) {
    for (const int late : {0, 1, 4}) {
        const auto delayed = [&](double s, int t) { return step(s, t - late); };
        EXPECT_NEAR(lag_of(delayed, step, 3, 10).value, late, float32) << late;
    }
}

TEST(PathLag, IsBlindToErrorsThatAreConstantInTimeAndToAFactor) {
    const auto wrong = [](double s, int t) { return 0.6 * step(s, t) + 0.2 * std::sin(s); };
    EXPECT_NEAR(lag_of(filtered(wrong, 0.8), step, 3, 80).value, 4.0, 5.0 * float32);
}

TEST(PathLag, OfAMethodAheadOfTheTruthIsNegative) {
    const auto truth = [](double s, int t) { return step(s, t - 2); };
    EXPECT_NEAR(lag_of(step, truth, 5, 5).value, -2.0, float32);
}

// Python 3.11, from the formula's curves u_t and v_t frame by frame:
//
//   f = lambda v: struct.unpack('f', struct.pack('f', v))[0]
//   truth = lambda t, half: [f(0.5 + 0.1 * min(t, 3) * (1 + x / 16) ** t + 0.01 * half * math.cos(x + t)) for x in xs]
//   method = lambda t: [f(0.4 + 0.2 * (1 - 0.5 ** t) * (1 + 0.5 * math.sin(x))) for x in xs]          # xs = range(16)
//   A, B = ([truth(min(t, 3), half) for t in range(44)] for half in (1, -1)); M = [method(t) for t in range(44)]
//   DA, DB = sub(A[-1], A[0]), sub(B[-1], B[0]); D = (DA + DB) / 2
//   sum((dot(sub(a, A[0]), DB) + dot(sub(b, B[0]), DA)) / 2 / dot(DA, DB)
//       - dot(sub(m, M[0]), D) / dot(sub(M[-1], M[0]), D) for a, b, m in zip(A, B, M))
TEST(PathLag, MatchesTheCurvesOfTheFormulaInPython) {
    const auto truth = [](double half) {
        return [half](double x, int t) {
            return 0.5 + 0.1 * std::min(t, 3) * std::pow(1 + x / 16, t) + 0.01 * half * std::cos(x + t);
        };
    };
    const auto method = [](double x, int t) { return 0.4 + 0.2 * (1 - std::pow(0.5, t)) * (1 + 0.5 * std::sin(x)); };
    PathLag lag("direct");
    for (int t = 0; t < 4; ++t) {
        Frame both = wall_at(truth(0), t);
        both.set("half_a.direct", wall_at(truth(1), t).plane("direct"));
        both.set("half_b.direct", wall_at(truth(-1), t).plane("direct"));
        lag.add(wall_at(method, t), both);
    }
    Image sum(wall_width, wall_height, 1), last;
    for (int t = 4; t < 44; ++t) {
        last = wall_at(method, t).plane("direct");
        for (std::size_t i = 0; i < sum.values().size(); ++i) sum.values()[i] += last.values()[i];
    }
    lag.hold(sum, last, 40);
    EXPECT_NEAR(lag.result().value, -0.48980424390198396, 1e-4);
}

TEST(PathLag, LeavesOutPixelsWhoseSurfaceMovedOrWasCovered) {
    PathLag lag("direct");
    for (int t = 0; t < 3; ++t) {
        Frame method = wall_at(step, t), truth = wall_at(step, t);
        for (int y = 0; y < wall_height; ++y) {
            // Column 3 slides within its plane and column 5 is covered by a post in frame 1: both would show the change
            // a frame late.
            if (t == 1) {
                method.plane("direct").at(3, y) = method.plane("direct").at(5, y) = 0.0f;
                truth.plane("motion").at(3, y, 1) = 0.5f;
                truth.plane("position").at(5, y, 2) = -1.0f;
            }
        }
        lag.add(method, truth);
    }
    const Image last = wall_at(step, 3).plane("direct");
    lag.hold(last, last, 1);
    EXPECT_NEAR(lag.result().value, 0.0, float32);
}

TEST(PathLag, IsNotBiasedByTheNoiseOfATruthInHalves) {
    // Noise as large as the change: with products of one half alone D would hold twice its variance.
    std::mt19937 random(3);
    std::normal_distribution<double> normal;
    const auto noisy = [&](int t) {
        Frame truth = wall_at(step, t);
        for (const char* half : {"half_a.direct", "half_b.direct"})
            truth.set(half, wall(0, [&](double s) { return step(s, t) + 0.3 * normal(random); }).plane("direct"));
        return truth;
    };
    const Course late = [](double s, int t) { return step(s, t - 1); };
    double sum = 0.0;
    constexpr int draws = 100;
    for (int draw = 0; draw < draws; ++draw) {
        PathLag lag("direct");
        for (int t = 0; t < 6; ++t) lag.add(wall_at(late, t), noisy(t));
        const Image last = wall_at(late, 6).plane("direct");
        lag.hold(last, last, 1);
        sum += lag.result().value;
    }
    // One draw's standard error is about 0.1 frames (128 pixels, four frames of noise of the change's size).
    EXPECT_NEAR(sum / draws, 1.0, 0.05);
}

TEST(PathLag, WithoutAChangeOrWithoutHeldFramesThereIsNone) {
    const auto still = [](double s, int) { return texture(s); };
    EXPECT_TRUE(std::isnan(lag_of(still, still, 3, 3).value));
    PathLag lag("direct");
    EXPECT_THROW(lag.hold(Image(4, 4, 1), Image(4, 4, 1), 1), ImageError);
    for (int t = 0; t < 3; ++t) lag.add(wall_at(step, t), wall_at(step, t));
    EXPECT_TRUE(std::isnan(lag.result().value)) << "nothing was held";
    EXPECT_THROW(lag.hold(Image(4, 4, 1), Image(4, 4, 1), 1), ImageError);
    EXPECT_THROW(lag.add(Frame(wall_width, wall_height), Frame(wall_width, wall_height)), ImageError);
}

}  // namespace
}  // namespace plumb
