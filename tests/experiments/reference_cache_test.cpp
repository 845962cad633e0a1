#include "experiments/reference_cache.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <fstream>
#include <functional>
#include <limits>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenes/builtin.h"
#include "tests/temporary_folder.h"

namespace plumb {
namespace {

using testing::HasSubstr;

ReferenceResult make_result(float value) {
    ReferenceResult result;
    result.frame = Frame(3, 2);
    Image plane(3, 2, 1, value);
    plane.at(1, 1) = std::numeric_limits<float>::infinity();
    result.frame.set("ao", plane);
    result.frame.set("half_a.ao", Image(3, 2, 1, value));
    result.frame.set("total", Image(3, 2, 3, 2 * value));
    result.samples = 8;
    result.seconds = 1.5;
    result.rays = 1234567890123;
    return result;
}

// A renderer that counts how often it runs.
struct Renderer {
    std::atomic<int> runs{0};
    ReferenceResult operator()(const std::filesystem::path&) {
        ++runs;
        return make_result(0.25f);
    }
};

TEST(ReferenceCache, RendersOnceAndReadsEveryBitAfterwards) {
    const TemporaryFolder folder;
    const ReferenceCache cache(folder.path);
    Renderer renderer;
    const CachedReference first = cache.get("key", std::ref(renderer));
    const CachedReference second = cache.get("key", std::ref(renderer));
    EXPECT_EQ(renderer.runs, 1);
    EXPECT_FALSE(first.from_cache);
    EXPECT_TRUE(second.from_cache);
    EXPECT_EQ(second.result.samples, 8);
    EXPECT_EQ(second.result.seconds, 1.5);
    EXPECT_EQ(second.result.rays, 1234567890123u);
    for (const std::string& plane : first.result.frame.plane_names()) {
        const auto a = first.result.frame.plane(plane).values(), b = second.result.frame.plane(plane).values();
        EXPECT_TRUE(std::equal(a.begin(), a.end(), b.begin(), b.end())) << plane;
    }
}

TEST(ReferenceCache, AnotherKeyIsAnotherReference) {
    const TemporaryFolder folder;
    const ReferenceCache cache(folder.path);
    Renderer renderer;
    cache.get("key", std::ref(renderer));
    cache.get("other", std::ref(renderer));
    EXPECT_EQ(renderer.runs, 2);
}

TEST(ReferenceCache, ADamagedFileIsReportedAndRenderedAgain) {
    const TemporaryFolder folder;
    const ReferenceCache cache(folder.path);
    Renderer renderer;
    const auto file = cache.get("key", std::ref(renderer)).file;
    const auto size = std::filesystem::file_size(file);

    // Cut short, as by a full disk; and no EXR at all.
    std::filesystem::resize_file(file, size / 2);
    const CachedReference cut = cache.get("key", std::ref(renderer));
    EXPECT_FALSE(cut.from_cache);
    EXPECT_THAT(cut.warning, HasSubstr(file.string()));
    std::ofstream(file) << "not an image";
    EXPECT_THAT(cache.get("key", std::ref(renderer)).warning, HasSubstr("rendering it again"));
    EXPECT_EQ(renderer.runs, 3);
    EXPECT_TRUE(cache.get("key", std::ref(renderer)).from_cache);
}

TEST(ReferenceCache, AFileThatHoldsAnotherReferenceIsNotUsed) {
    const TemporaryFolder folder;
    const ReferenceCache cache(folder.path);
    Renderer renderer;
    const auto file = cache.get("key", std::ref(renderer)).file;
    std::filesystem::copy_file(file, cache.file_of("other"));
    EXPECT_THAT(cache.get("other", std::ref(renderer)).warning, HasSubstr("another reference"));
    EXPECT_EQ(renderer.runs, 2);
}

TEST(ReferenceCache, OfManyThatWantTheSameOneRendersAndTheOthersWait) {
    const TemporaryFolder folder;
    Renderer renderer;
    std::atomic<int> hits{0};
    std::vector<std::thread> threads;
    threads.reserve(8);
    // flock() locks per open file, so threads exclude each other just as programs do.
    for (int i = 0; i < 8; ++i) {
        threads.emplace_back([&] {
            const CachedReference reference = ReferenceCache(folder.path).get("key", std::ref(renderer));
            hits += reference.from_cache ? 1 : 0;
            EXPECT_EQ(reference.result.frame.plane("ao").at(0, 0), 0.25f);
            EXPECT_EQ(reference.warning, "");
        });
    }
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(renderer.runs, 1);
    EXPECT_EQ(hits, 7);
}

TEST(ReferenceCache, AnIncompleteReferenceIsNotKept) {
    const TemporaryFolder folder;
    const ReferenceCache cache(folder.path);
    const auto stopped = [](const std::filesystem::path&) {
        ReferenceResult result = make_result(0.5f);
        result.complete = false;
        return result;
    };
    EXPECT_TRUE(cache.get("key", stopped).file.empty());
    Renderer renderer;
    EXPECT_FALSE(cache.get("key", std::ref(renderer)).from_cache);
    EXPECT_EQ(renderer.runs, 1);
}

TEST(ReferenceCache, ARendererThatThrowsLeavesNothingBehindAndTheLockFree) {
    const TemporaryFolder folder;
    const ReferenceCache cache(folder.path);
    const auto failing = [](const std::filesystem::path&) -> ReferenceResult { throw std::runtime_error("no memory"); };
    EXPECT_THROW(cache.get("key", failing), std::runtime_error);
    Renderer renderer;
    EXPECT_FALSE(cache.get("key", std::ref(renderer)).from_cache);
}

TEST(ReferenceKey, ChangesWithEverythingThatCanChangeAPixelAndWithNothingElse) {
    const Scene scene = make_cornell();
    const View view(scene.camera("front"), 32, 18);
    ReferenceSettings settings;
    settings.quantities.planes = {"ao", "total"};
    const std::string key = reference_key(scene, view, settings);
    EXPECT_EQ(reference_key(make_cornell(), View(make_cornell().camera("front"), 32, 18), settings), key);

    const auto changed = [&](auto change) {
        ReferenceSettings other = settings;
        change(other);
        return reference_key(scene, view, other);
    };
    EXPECT_NE(changed([](auto& s) { s.samples = 512; }), key);
    EXPECT_NE(changed([](auto& s) { s.seed = 2; }), key);
    EXPECT_NE(changed([](auto& s) { s.target_error = 0.1; }), key);
    EXPECT_NE(changed([](auto& s) { s.minimum_separation = 0.2f; }), key);
    EXPECT_NE(changed([](auto& s) { s.antialias = true; }), key);
    EXPECT_NE(changed([](auto& s) { s.emitter_sampling = EmitterSampling::lights; }), key);
    EXPECT_NE(changed([&](auto& s) { s.previous_view = view; }), key);
    EXPECT_NE(changed([](auto& s) { s.first_sample = 2; }), key);
    EXPECT_NE(changed([](auto& s) { s.roulette_after = 0; }), key);
    EXPECT_NE(changed([](auto& s) { s.points = SamplePoints::random; }), key);
    EXPECT_NE(changed([&](auto& s) { s.view_at_shutter_opening = view; }), key);
    EXPECT_NE(changed([](auto& s) { s.quantities.ao_radius = 2.0f; }), key);
    EXPECT_NE(changed([](auto& s) { s.quantities.ao_falloff = Falloff::cubic; }), key);
    EXPECT_NE(changed([](auto& s) { s.quantities.bounces = 2; }), key);
    EXPECT_NE(changed([](auto& s) { s.quantities.indirect_radius = 1.0f; }), key);
    EXPECT_NE(changed([](auto& s) { s.quantities.reflection_radius = 1.0f; }), key);
    EXPECT_NE(changed([](auto& s) { s.quantities.reflection_falloff = Falloff::cubic; }), key);
    EXPECT_NE(changed([](auto& s) { s.quantities.planes = {"ao"}; }), key);
    EXPECT_EQ(changed([](auto& s) {
                  s.quantities.planes = {"total", "ao"};
              }),
              key)
        << "the order of planes changes nothing";

    EXPECT_NE(reference_key(scene, View(scene.camera("front"), 33, 18), settings), key);
    EXPECT_NE(reference_key(scene, View(scene.camera("gap"), 32, 18), settings), key);
    EXPECT_NE(reference_key(scene, view, settings, {0.0, 0.5}), key);
    EXPECT_NE(reference_key(scene, view, settings, {0.25, 0.5}), reference_key(scene, view, settings, {0.0, 0.5}));
    EXPECT_NE(reference_key(scene, view, settings, {0.0, 0.25}), reference_key(scene, view, settings, {0.0, 0.5}));
    Camera lens = scene.camera("front");
    lens.aperture_radius = 0.01f;
    const std::string with_lens = reference_key(scene, View(lens, 32, 18), settings);
    EXPECT_NE(with_lens, key);
    lens.focus_distance += 0.5f;
    EXPECT_NE(reference_key(scene, View(lens, 32, 18), settings), with_lens);
    Camera moved = scene.camera("front");
    moved.world_from_camera[3][0] = std::nextafter(moved.world_from_camera[3][0], 1.0f);
    EXPECT_NE(reference_key(scene, View(moved, 32, 18), settings), key) << "a camera moved by one last bit";
    Scene painted = scene;
    painted.materials[0].base_colour.x += 0.01f;
    EXPECT_NE(reference_key(painted, view, settings), key);
}

TEST(ReferenceKey, ChangesWithEverythingThatAnOracleIsMadeOf) {
    const Scene scene = make_cornell();
    const View view(scene.camera("front"), 32, 18);
    const auto key_of = [&](const std::optional<OracleSettings>& oracle) {
        ReferenceSettings settings;
        settings.quantities.planes = {"ao"};
        settings.oracle = oracle;
        return reference_key(scene, view, settings);
    };
    const std::string key = key_of(OracleSettings{view, 1, 0.1f});
    EXPECT_EQ(key_of(OracleSettings{view, 1, 0.1f}), key);
    EXPECT_NE(key_of(std::nullopt), key);
    EXPECT_NE(key_of(OracleSettings{view, 2, 0.1f}), key);
    EXPECT_NE(key_of(OracleSettings{view, 1, 0.2f}), key);
    EXPECT_NE(key_of(OracleSettings{View(scene.camera("gap"), 32, 18), 1, 0.1f}), key);
    EXPECT_NE(key_of(OracleSettings{view.with_guard_band(4), 1, 0.1f}), key);
    // As many pixels, but they see less.
    EXPECT_NE(key_of(OracleSettings{View(scene.camera("front"), 40, 26), 1, 0.1f}),
              key_of(OracleSettings{view.with_guard_band(4), 1, 0.1f}));
}

}  // namespace
}  // namespace plumb
