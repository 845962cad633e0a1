// Runs as wholes: the same bits however the work is split, honest error bars, interruption, and refusals.
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "pathtracer/accumulation.h"
#include "pathtracer/reference_error.h"
#include "scenes/builtin.h"
#include "scenes/scene_error.h"
#include "tests/pathtracer/test_scenes.h"
#include "tests/temporary_folder.h"

namespace plumb {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

const std::vector<std::string> all_planes = {"ao",       "direct", "indirect", "indirect.2", "irradiance",
                                             "emission", "total",  "depth",    "normal",     "layer2.depth"};

View cornell_view(const Scene& scene, int width = 40, int height = 33) { return View(scene.cameras[0], width, height); }

TEST(Reference, HasTheSameBitsWhateverTheNumberOfThreads) {
    const Scene scene = make_cornell();
    const PathTracer tracer(scene);
    for (const bool antialias : {false, true}) {
        auto settings = settings_for(all_planes, 16, 2);
        settings.antialias = antialias;
        const Frame one = tracer.render(cornell_view(scene), settings, {.threads = 1}).frame;
        for (const int threads : {2, 3}) {
            expect_same_bits(one, tracer.render(cornell_view(scene), settings, {.threads = threads}).frame);
        }
        expect_same_bits(one, PathTracer(scene).render(cornell_view(scene), settings).frame);  // another tree
    }
}

TEST(Reference, GivesHalvesThatAverageToTheMeanAndVarianceFromTheirDifference) {
    const Scene scene = make_cornell();
    const Frame frame = PathTracer(scene).render(cornell_view(scene), settings_for({"ao", "indirect"}, 8)).frame;
    for (const std::string plane : {"ao", "indirect"}) {
        const auto mean = frame.plane(plane).values(), a = frame.plane("half_a." + plane).values(),
                   b = frame.plane("half_b." + plane).values(), variance = frame.plane("variance." + plane).values();
        std::size_t different_halves = 0;
        for (std::size_t i = 0; i < mean.size(); ++i) {
            EXPECT_EQ(mean[i], 0.5f * (a[i] + b[i]));
            EXPECT_FLOAT_EQ(variance[i], 0.25f * (a[i] - b[i]) * (a[i] - b[i]));
            different_halves += a[i] != b[i] ? 1 : 0;
        }
        EXPECT_GT(different_halves, mean.size() / 4);
    }
    EXPECT_FALSE(frame.has("half_a.emission"));
}

// Over seeds the spread of the pixel means is what the variance planes claim, on average over pixels. 16 seeds and 300
// pixels give either side a relative error of some 3 %; 15 % is four of their common standard deviations.
TEST(Reference, VarianceIsThatOfTheMeansOverSeeds) {
    Scene scene = make_cornell();
    const View view = cornell_view(scene, 20, 15);
    const PathTracer tracer(scene);
    constexpr int seeds = 16;
    auto settings = settings_for({"ao", "direct"}, 32);
    for (const std::string plane : {"ao", "direct"}) {
        std::vector<double> sum(std::size_t{3} * static_cast<std::size_t>(view.width()) *
                                static_cast<std::size_t>(view.height())),
            square(sum.size());
        double claimed = 0.0;
        for (int seed = 0; seed < seeds; ++seed) {
            settings.seed = 100 + static_cast<std::uint64_t>(seed);
            const Frame frame = tracer.render(view, settings).frame;
            const auto mean = frame.plane(plane).values(), variance = frame.plane("variance." + plane).values();
            for (std::size_t i = 0; i < mean.size(); ++i) {
                sum[i] += mean[i], square[i] += static_cast<double>(mean[i]) * mean[i];
                claimed += variance[i];
            }
        }
        double spread = 0.0;
        for (std::size_t i = 0; i < sum.size(); ++i) spread += (square[i] - sum[i] * sum[i] / seeds) / (seeds - 1);
        claimed /= seeds;
        EXPECT_GT(spread, 0.0);
        EXPECT_NEAR(claimed / spread, 1.0, 0.15) << plane;
    }
}

// mean((I - A)(I - B)) is the squared error of I without the reference's noise, which needs independent halves: here I
// is the truth itself (a long run), so that it must be 0 within its spread over pixels.
TEST(Reference, HalvesHaveIndependentErrors) {
    const Scene scene = make_cornell();
    const View view = cornell_view(scene, 48, 48);
    const PathTracer tracer(scene);
    auto settings = settings_for({"ao"}, 4096);
    settings.seed = 99;
    const Frame truth = tracer.render(view, settings).frame;
    settings.samples = 16, settings.seed = 1;
    const Frame coarse = tracer.render(view, settings).frame;
    double sum = 0.0, square = 0.0;
    const auto i = truth.plane("ao").values(), a = coarse.plane("half_a.ao").values(),
               b = coarse.plane("half_b.ao").values();
    for (std::size_t p = 0; p < i.size(); ++p) {
        const double product = (static_cast<double>(i[p]) - a[p]) * (static_cast<double>(i[p]) - b[p]);
        sum += product, square += product * product;
    }
    const double standard_error = std::sqrt(square);
    EXPECT_LT(std::abs(sum), 4.0 * standard_error);
    EXPECT_GT(standard_error, 0.0);
}

TEST(Reference, StopsAtATargetErrorAtTheSameSampleWhateverThePace) {
    const Scene scene = make_cornell();
    const PathTracer tracer(scene);
    auto settings = settings_for({"ao"}, 4096);
    settings.target_error = 0.05;
    const ReferenceResult one = tracer.render(cornell_view(scene), settings, {.threads = 1});
    const ReferenceResult two = tracer.render(cornell_view(scene), settings, {.threads = 2});
    EXPECT_TRUE(one.complete);
    EXPECT_EQ(one.samples, two.samples);
    EXPECT_LT(one.samples, 4096);
    EXPECT_GE(one.samples, 16);
    expect_same_bits(one.frame, two.frame);
}

class Checkpoints : public testing::Test {
protected:
    void SetUp() override {
        folder_ = std::filesystem::temp_directory_path() / fmt::format("plumbline_checkpoints_{}", ::getpid());
        std::filesystem::create_directories(folder_);
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    // Stops after the first pass that progress is told of.
    ReferenceResult interrupted(const Scene& scene, const View& view, const ReferenceSettings& settings) {
        std::atomic<bool> stop{false};
        ReferenceControl control;
        control.checkpoint = path();
        control.stop = &stop;
        control.on_progress = [&](const ReferenceProgress&) { stop = true; };
        return PathTracer(scene).render(view, settings, control);
    }
    std::filesystem::path path() const { return folder_ / "run.checkpoint"; }

    std::filesystem::path folder_;
};

TEST_F(Checkpoints, AResumedRunHasTheBitsOfAnUninterruptedOne) {
    const Scene scene = make_cornell();
    const View view = cornell_view(scene);
    for (const bool antialias : {false, true}) {
        auto settings = settings_for(all_planes, 1024, 2);
        settings.antialias = antialias;
        const ReferenceResult part = interrupted(scene, view, settings);
        ASSERT_FALSE(part.complete);
        ASSERT_LT(part.samples, 1024);
        ASSERT_TRUE(std::filesystem::exists(path()));
        settings.samples = part.samples + 10;  // a resumed run may ask for another number
        const ReferenceResult resumed = PathTracer(scene).render(view, settings, {.threads = 1, .checkpoint = path()});
        const ReferenceResult whole = PathTracer(scene).render(view, settings);
        EXPECT_TRUE(resumed.complete);
        EXPECT_EQ(resumed.samples, settings.samples);
        EXPECT_EQ(resumed.rays, whole.rays);
        expect_same_bits(resumed.frame, whole.frame);
        std::filesystem::remove(path());
    }
}

TEST_F(Checkpoints, OfAnotherRunOrDamagedAreRefused) {
    const Scene scene = make_cornell();
    const View view = cornell_view(scene);
    const auto settings = settings_for({"ao"}, 4096);
    ASSERT_FALSE(interrupted(scene, view, settings).complete);
    const auto resume = [&](const Scene& with_scene, const View& with_view, const ReferenceSettings& with_settings) {
        return [&, with_settings] { PathTracer(with_scene).render(with_view, with_settings, {.checkpoint = path()}); };
    };
    Scene other_scene = scene;
    other_scene.materials[0].base_colour.x *= 0.5f;
    EXPECT_THAT(resume(other_scene, view, settings), ThrowsMessage<ReferenceError>(HasSubstr("another scene")));
    EXPECT_THAT(resume(scene, View(scene.cameras[1], 40, 33), settings),
                ThrowsMessage<ReferenceError>(HasSubstr("another view")));
    auto other = settings;
    other.seed = 2;
    EXPECT_THAT(resume(scene, view, other), ThrowsMessage<ReferenceError>(HasSubstr("other settings")));
    other = settings;
    other.quantities.ao_radius = 0.5f;
    EXPECT_THAT(resume(scene, view, other), ThrowsMessage<ReferenceError>(HasSubstr("other settings")));

    const auto size = std::filesystem::file_size(path());

    std::fstream file(path(), std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(static_cast<std::streamoff>(size / 2));
    file.put('\x55').put('\xaa');
    file.close();
    EXPECT_THAT(resume(scene, view, settings), ThrowsMessage<ReferenceError>(HasSubstr("is damaged")));
    std::filesystem::resize_file(path(), size - 100);
    EXPECT_THAT(resume(scene, view, settings), ThrowsMessage<ReferenceError>(HasSubstr("is cut off")));
    std::filesystem::resize_file(path(), 10);
    EXPECT_THAT(resume(scene, view, settings), ThrowsMessage<ReferenceError>(HasSubstr("cut off")));
}

TEST_F(Checkpoints, AppearAfterTheirTimeWhileTheRunGoesOn) {
    const Scene scene = make_cornell();
    const View view = cornell_view(scene);
    // In passes of at most 16 samples and about a second: when the second is told of, the first has left its checkpoint
    // or, with a minute to go, has not.
    for (const double period : {0.0, 60.0}) {
        std::atomic<bool> stop{false};
        ReferenceControl control;
        control.checkpoint = path();
        control.checkpoint_seconds = period;
        control.stop = &stop;
        int passes = 0;
        bool found = false;
        control.on_progress = [&](const ReferenceProgress&) {
            if (++passes < 2) return;
            found = std::filesystem::exists(path());
            stop = true;
        };
        EXPECT_FALSE(PathTracer(scene).render(view, settings_for({"ao"}, 1 << 20), control).complete);
        EXPECT_EQ(found, period == 0.0) << "every " << period << " s";
        std::filesystem::remove(path());
    }
}

// What a power cut does: the process is gone in the middle of a pass. googletest runs the test once more, in the
// process that is to die, so the file's name is handed on in the environment.
TEST(KilledRunDeathTest, IsResumedFromItsLastCheckpointToTheBitsOfAnUninterruptedRun) {
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    constexpr const char* variable = "PLUMBLINE_TEST_KILLED_RUN";
    std::optional<TemporaryFolder> folder;
    if (!std::getenv(variable)) ::setenv(variable, (folder.emplace() / "run.checkpoint").c_str(), 1);
    const Scene scene = make_cornell();
    const View view = cornell_view(scene);
    auto settings = settings_for(all_planes, 1 << 20, 2);
    ReferenceControl control;
    control.checkpoint = std::getenv(variable);
    control.checkpoint_seconds = 0.0;
    const auto die_in_the_second_pass = [&] {
        control.on_progress = [](const ReferenceProgress& progress) {
            if (progress.samples_done > 16) std::raise(SIGKILL);
        };
        PathTracer(scene).render(view, settings, control);
    };
    EXPECT_EXIT(die_in_the_second_pass(), testing::KilledBySignal(SIGKILL), "");
    ::unsetenv(variable);

    ASSERT_TRUE(std::filesystem::exists(control.checkpoint));
    settings.samples = 48;
    int first_told = 0;
    control.on_progress = [&](const ReferenceProgress& progress) {
        if (first_told == 0) first_told = progress.samples_done;
    };
    const ReferenceResult resumed = PathTracer(scene).render(view, settings, control);
    EXPECT_GT(first_told, 16) << "the first pass is not done again";
    const ReferenceResult whole = PathTracer(scene).render(view, settings);
    EXPECT_EQ(resumed.rays, whole.rays);
    expect_same_bits(resumed.frame, whole.frame);
}

TEST(Reference, RefusesSenselessSettings) {
    const Scene scene = make_cornell();
    const View view = cornell_view(scene, 4, 4);
    const PathTracer tracer(scene);
    const auto refuses = [&](auto&& change, const char* message) {
        auto settings = settings_for({"ao", "indirect"}, 2);
        change(settings);
        EXPECT_THAT([&] { tracer.render(view, settings); }, ThrowsMessage<ReferenceError>(HasSubstr(message)));
    };
    refuses([](auto& s) { s.samples = 3; }, "even");
    refuses([](auto& s) { s.samples = 0; }, "even");
    refuses([](auto& s) { s.samples = -2; }, "even");
    refuses([](auto& s) { s.target_error = -0.1; }, "target error");
    refuses([](auto& s) { s.minimum_separation = -1.0f; }, "separation");
    refuses([](auto& s) { s.quantities.ao_radius = 0.0f; }, "ao radius");
    refuses([](auto& s) { s.quantities.indirect_radius = std::nanf(""); }, "indirect radius");
    refuses([](auto& s) { s.quantities.reflection_radius = 0.0f; }, "reflection radius");
    refuses([](auto& s) { s.quantities.bounces = -1; }, "bounces");
    refuses([](auto& s) { s.quantities.bounces = 100000; }, "bounces");
    refuses([](auto& s) { s.quantities.planes = {"colour"}; }, "no plane 'colour'");
    refuses([](auto& s) { s.quantities.planes = {"indirect.0"}; }, "no plane 'indirect.0'");
    refuses([](auto& s) { s.quantities.planes = {"layer1.depth"}; }, "no plane 'layer1.depth'");
    refuses([](auto& s) { s.quantities.planes = {"layer2.ao"}; }, "no plane 'layer2.ao'");
    refuses([](auto& s) { s.quantities.planes = {"indirect.2"}; }, "raise bounces");
    EXPECT_THROW(tracer.render(view, settings_for({"ao"}, 2), {.threads = -1}), ReferenceError);
}

TEST(Accumulation, TellsOfASampleThatIsNoNumber) {
    EstimationPlan plan;
    plan.ao = plan.direct = true;
    for (const double value : {std::nan(""), HUGE_VAL}) {
        Accumulation sums(3, 2, plan, false, 1.0);
        EXPECT_TRUE(sums.is_exact());
        const std::size_t pixel = 4, channels = 4;
        sums.values()[(2 * pixel + 1) * channels + 2] = value;
        EXPECT_THAT([&] { sums.is_exact(); },
                    ThrowsMessage<ReferenceError>(testing::AllOf(HasSubstr("pixel (1, 1)"), HasSubstr("texture"))));
    }
}

TEST(Reference, SaysHowMuchMemoryItWantsWhereThereIsNotAsMuch) {
    int overcommit = 1;
    std::ifstream("/proc/sys/vm/overcommit_memory") >> overcommit;
    if (overcommit == 1) GTEST_SKIP() << "this system promises any amount of memory";
    const Scene scene = make_cornell();
    const View view = cornell_view(scene, 1 << 14, 1 << 14);
    // 2 x 3 x 2048 numbers of 8 bytes, 2^28 times.
    EXPECT_THAT([&] { PathTracer(scene).render(view, settings_for({"indirect"}, 2, 2048)); },
                ThrowsMessage<ReferenceError>(testing::AllOf(HasSubstr("24576.0 GiB"), HasSubstr("fewer bounces"))));
}

TEST(PathTracerScene, RefusesIndicesThatPointNowhere) {
    const auto refuses = [](auto&& change, const char* message) {
        Scene scene;
        add_quads(scene, add_material(scene, glm::vec3(0.5f)), {floor_quad(1.0f)});
        change(scene);
        EXPECT_THAT([&] { PathTracer tracer(scene); }, ThrowsMessage<SceneError>(HasSubstr(message)));
    };
    refuses([](Scene& s) { s.instances[0].mesh = 1; }, "mesh 1");
    refuses([](Scene& s) { s.meshes[0].material = -1; }, "material -1");
    refuses([](Scene& s) { s.meshes[0].triangles[0].y = 4; }, "vertex 4");
    refuses([](Scene& s) { s.meshes[0].normals.resize(3); }, "3 normals");
}

// What nobody asked for costs nothing: the counts of rays tell.
TEST(Reference, TracesOnlyWhatTheWantedPlanesNeed) {
    Scene scene;
    add_quads(scene, add_material(scene, glm::vec3(0.5f)), room_quads());
    scene.point_lights.push_back({"lamp", {0, 0, 0}, glm::vec3(1.0f)});
    const View view = view_of({0.1f, 0.1f, 0.1f}, {0, -1, 0.2f}, 1.0f, 8);
    const PathTracer tracer(scene);
    const auto rays_per_sample = [&](std::vector<std::string> planes, int bounces) {
        const auto result = tracer.render(view, settings_for(std::move(planes), 16, bounces));
        return static_cast<double>(result.rays) / (64.0 * 16.0);
    };
    const double primary = 1.0 / 16.0;
    EXPECT_EQ(rays_per_sample({"depth", "albedo"}, 1), primary);
    EXPECT_EQ(rays_per_sample({"emission"}, 1), primary);
    EXPECT_EQ(rays_per_sample({"direct"}, 1), 2 * primary);  // one shadow ray per pixel, once
    EXPECT_EQ(rays_per_sample({"ao"}, 3), 1 + primary);
    EXPECT_EQ(rays_per_sample({"indirect"}, 1), 2 + primary);        // bounce, shadow
    EXPECT_EQ(rays_per_sample({"indirect", "ao"}, 1), 2 + primary);  // the bounce serves both
    EXPECT_EQ(rays_per_sample({"total"}, 3), 6 + 2 * primary);
    EXPECT_EQ(rays_per_sample({"indirect.1"}, 3), 2 + primary);
}

}  // namespace
}  // namespace plumb
