// The error bars that a reference carries, over many independent runs of a small scene: do intervals contain what a
// long run finds as often as they say, and is the error measured against a noisy reference the true one on average?
#include <cmath>
#include <random>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "metrics/referenced_error.h"
#include "tests/pathtracer/test_scenes.h"

namespace plumb {
namespace {

constexpr int samples = 32;

// A coloured room with a lamp and a square light; something of everything: corners, shadows, bounces. `glossy`: with a
// gloss over its walls.
Scene small_scene(bool glossy) {
    Scene scene;
    add_quads(scene, add_material(scene, {0.7f, 0.5f, 0.3f}), room_quads());
    if (glossy) scene.materials[0].dielectric_reflectance = 0.04f, scene.materials[0].roughness = 0.5f;
    add_quads(scene, add_material(scene, glm::vec3(0.3f), glm::vec3(5.0f)),
              {{{-0.5f, 0.9f, -0.5f}, {0.5f, 0.9f, -0.5f}, {0.5f, 0.9f, 0.5f}, {-0.5f, 0.9f, 0.5f}}});
    add_quads(scene, 0, {floor_quad(0.3f, -0.5f)});
    scene.point_lights.push_back({"lamp", {0.5f, -0.2f, 0.3f}, glm::vec3(0.3f)});
    return scene;
}

View small_scene_view(int size) { return view_of({0, 0, 0.9f}, {0.1f, -0.6f, -0.8f}, 1.0f, size); }

// All runs, and one of 64 times as many samples: its own error is an eighth of theirs at most, which adds less than 1 %
// to what they differ by.
struct Runs {
    std::vector<std::string> planes;
    std::vector<Frame> frames;
    Frame truth;
};
Runs make_runs(bool glossy, std::vector<std::string> planes, int bounces, int size, std::uint64_t count) {
    const Scene scene = small_scene(glossy);
    const PathTracer tracer(scene);
    const View view = small_scene_view(size);
    Runs runs;
    auto settings = settings_for(planes, samples, bounces);
    for (std::uint64_t seed = 1; seed <= count; ++seed) {
        settings.seed = seed;
        runs.frames.push_back(tracer.render(view, settings).frame);
    }
    settings.seed = 1000, settings.samples = 64 * samples;
    runs.truth = tracer.render(view, settings).frame;
    runs.planes = std::move(planes);
    return runs;
}
const Runs& diffuse_runs() {
    static const Runs runs = make_runs(false, {"ao", "direct", "indirect"}, 2, 32, 200);
    return runs;
}
// Paths through gloss take several times as long: half as many runs of a quarter of the pixels.
const Runs& glossy_runs() {
    static const Runs runs = make_runs(true, {"direct", "reflection"}, 1, 16, 100);
    return runs;
}

// The share of intervals that contain the long run's answer has to lie between 90 and 99 %. `count` independent
// intervals that are right at 95 % give a share with a standard deviation of 0.22 / sqrt(count).
void expect_coverage(int inside, int count, const std::string& what) {
    const double share = static_cast<double>(inside) / count;
    EXPECT_GE(share, 0.90) << what << ": " << inside << " of " << count;
    EXPECT_LE(share, 0.99) << what << ": " << inside << " of " << count;
}

bool contains_truth(const Frame& frame, const Frame& long_run, const std::string& plane, int channel, int left, int top,
                    int block) {
    const Image &mean = frame.plane(plane), &truth = long_run.plane(plane);
    const Image& variance_of_mean = frame.plane("variance." + plane);
    double difference = 0.0, variance = 0.0;
    for (int y = top; y < top + block; ++y) {
        for (int x = left; x < left + block; ++x) {
            difference += mean.at(x, y, channel) - truth.at(x, y, channel);
            variance += variance_of_mean.at(x, y, channel);
        }
    }
    return std::abs(difference) <= 1.96 * std::sqrt(variance);
}

void expect_coverage_of_blocks(const Runs& runs, int block) {
    const int across = runs.truth.width() / block;
    for (const std::string& plane : runs.planes) {
        for (int channel = 0; channel < runs.truth.plane(plane).channels(); ++channel) {
            int inside = 0, count = 0;
            for (const Frame& frame : runs.frames) {
                for (int i = 0; i < across * across; ++i) {
                    const int left = i % across * block, top = i / across * block;
                    inside += contains_truth(frame, runs.truth, plane, channel, left, top, block) ? 1 : 0, ++count;
                }
            }
            expect_coverage(inside, count, fmt::format("{}, channel {}, blocks of {} pixels", plane, channel, block));
        }
    }
}

// The variance planes have one degree of freedom per pixel; over a block of 64 or more pixels they make an interval for
// the block's mean: 1.96 standard errors. Runs and blocks are independent: for each channel 3200 intervals of 64
// pixels, of gloss 400.
TEST(ErrorBars, OfVariancePlanesContainTheLongRunsAnswer) {
    expect_coverage_of_blocks(diffuse_runs(), 8);
    expect_coverage_of_blocks(diffuse_runs(), 16);
    expect_coverage_of_blocks(glossy_runs(), 8);
}

// The standard error that the variance planes claim is that of the runs' true errors: 200 runs of 1024 pixels, whose
// errors squared spread about as the squares of normal numbers do, give the ratio to within 1 %, heavy tails to within
// some; 10 % is the 5 % in standard error that would change nobody's mind.
TEST(ErrorBars, OfVariancePlanesAreTheTrueErrorsOnAverage) {
    for (const Runs* runs : {&diffuse_runs(), &glossy_runs()}) {
        for (const std::string& plane : runs->planes) {
            double claimed = 0.0, found = 0.0;
            for (const Frame& frame : runs->frames) {
                const auto mean = frame.plane(plane).values(), truth = runs->truth.plane(plane).values();
                for (const float variance : frame.plane("variance." + plane).values()) claimed += variance;
                for (std::size_t i = 0; i < mean.size(); ++i) {
                    found += (static_cast<double>(mean[i]) - truth[i]) * (static_cast<double>(mean[i]) - truth[i]);
                }
            }
            EXPECT_NEAR(claimed / found, 1.0, 0.1) << plane;
        }
    }
}

// A wrong image: the truth and an error of `amplitude` times its mean. Even errors have the same size in all pixels and
// a random sign; uneven ones grow from nothing at the left to the full at the right.
struct WrongImage {
    Image image;
    double mse = 0.0;
};
WrongImage wrong_image(const Image& truth, double amplitude, bool even, unsigned seed) {
    double mean = 0.0;
    for (const float value : truth.values()) mean += value / static_cast<double>(truth.values().size());
    WrongImage wrong{truth};
    std::mt19937 random(seed);
    for (int y = 0; y < truth.height(); ++y) {
        for (int x = 0; x < truth.width(); ++x) {
            for (int c = 0; c < truth.channels(); ++c) {
                const double size_here = amplitude * mean * (even ? 1.0 : (x + 0.5) / truth.width());
                wrong.image.at(x, y, c) += static_cast<float>(random() % 2 == 0 ? size_here : -size_here);
                const double error = static_cast<double>(wrong.image.at(x, y, c)) - truth.at(x, y, c);
                wrong.mse += error * error / static_cast<double>(truth.values().size());
            }
        }
    }
    return wrong;
}

// mean((I - A)(I - B)) is the true squared error on average over the runs, within four standard errors of their mean,
// whether the error is lost in the reference's noise, like it, or far above.
void expect_true_squared_error_on_average(const Runs& runs, const std::string& plane, double amplitude, bool even) {
    const WrongImage wrong = wrong_image(runs.truth.plane(plane), amplitude, even, 7);
    const auto count = static_cast<double>(runs.frames.size());
    double sum = 0.0, squares = 0.0, plain = 0.0;
    for (const Frame& frame : runs.frames) {
        const ReferencedError error =
            referenced_error(wrong.image, frame.plane("half_a." + plane), frame.plane("half_b." + plane), samples);
        sum += error.mse / count, squares += error.mse * error.mse / count;
        plain += error.plain_mse / count;
    }
    const double standard_error = std::sqrt((squares - sum * sum) / (count - 1.0));
    const std::string what = fmt::format("{}, amplitude {}, {}", plane, amplitude, even ? "even" : "uneven");
    EXPECT_NEAR(sum, wrong.mse, 4.0 * standard_error) << what;
    // Without the halves it would not be: the noise adds to it.
    if (amplitude < 0.1) {
        EXPECT_GT(plain, wrong.mse + 10.0 * standard_error) << what;
    }
}

TEST(ErrorBars, TheProductOfTheHalvesErrorsIsTheTrueSquaredErrorOnAverage) {
    for (const Runs* runs : {&diffuse_runs(), &glossy_runs()}) {
        for (const std::string& plane : runs->planes) {
            for (const double amplitude : {0.0, 0.03, 0.3}) {
                for (const bool even : {true, false}) {
                    expect_true_squared_error_on_average(*runs, plane, amplitude, even);
                }
            }
        }
    }
}

// The interval of the squared error is that of a bootstrap over blocks of pixels. It counts as chance what differs
// between runs, and also how the error happens to be spread over the image. So it covers the true squared error as
// often as it says where the noise of the reference decides (an error that is the same everywhere), and more often
// where it does not: then it answers another question, how much the picture's parts differ. Each run with an image of
// its own: where noise decides, the product of the halves' noise is the same for any image, and one more would add
// nothing.
TEST(ErrorBars, OfTheSquaredErrorContainItAsOftenAsTheySay) {
    const Runs& all = diffuse_runs();
    const auto runs = static_cast<unsigned>(all.frames.size());
    for (const std::string& plane : all.planes) {
        for (const double amplitude : {0.03, 0.3}) {
            for (const bool even : {true, false}) {
                int inside = 0;
                for (unsigned run = 0; run < runs; ++run) {
                    const Frame& frame = all.frames[run];
                    const WrongImage wrong = wrong_image(all.truth.plane(plane), amplitude, even, run + 1);
                    const ReferencedError error = referenced_error(wrong.image, frame.plane("half_a." + plane),
                                                                   frame.plane("half_b." + plane), samples);
                    inside += error.lower <= wrong.mse && wrong.mse <= error.upper ? 1 : 0;
                }
                const std::string what =
                    fmt::format("{}, amplitude {}, {}", plane, amplitude, even ? "even" : "uneven");
                if (even) {
                    expect_coverage(inside, static_cast<int>(runs), what);
                } else {
                    EXPECT_GE(inside, 0.90 * runs) << what;
                }
            }
        }
    }
}

// A run told to stop at a relative error has it: over a quarter of the runs the true one is the target's, less what the
// last step overshoots (each step adds an eighth to a quarter of samples).
TEST(ErrorBars, OfARunWithATargetAreTheTarget) {
    const Runs& all = diffuse_runs();
    const Scene scene = small_scene(false);
    const PathTracer tracer(scene);
    constexpr double target = 0.2;
    double squared_error = 0.0, square = 0.0;
    for (std::uint64_t seed = 1; seed <= all.frames.size() / 4; ++seed) {
        auto settings = settings_for({"indirect"}, 1024, 2);
        settings.target_error = target, settings.seed = seed;
        const Frame frame = tracer.render(small_scene_view(32), settings).frame;
        const auto mean = frame.plane("indirect").values(), truth = all.truth.plane("indirect").values();
        for (std::size_t i = 0; i < mean.size(); ++i) {
            squared_error += (static_cast<double>(mean[i]) - truth[i]) * (static_cast<double>(mean[i]) - truth[i]);
            square += static_cast<double>(truth[i]) * truth[i];
        }
    }
    const double relative_error = std::sqrt(squared_error / square);
    EXPECT_LT(relative_error, 1.05 * target);
    EXPECT_GT(relative_error, 0.8 * target);
}

}  // namespace
}  // namespace plumb
