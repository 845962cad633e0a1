// What Embree does apart from our tree: other instruction sets, and what tells them apart.
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pathtracer/checkpoint.h"
#include "pathtracer/embree_fingerprint.h"
#include "pathtracer/integrator_hash.h"
#include "pathtracer/reference_error.h"
#include "pathtracer/traced_scene.h"
#include "scenes/builtin.h"
#include "tests/pathtracer/test_scenes.h"
#include "tests/temporary_folder.h"

namespace plumb {
namespace {

std::uint64_t fingerprint_with(const char* settings) {
    const RTCDevice device = rtcNewDevice(settings);
    const std::uint64_t fingerprint = embree_fingerprint(device);
    rtcReleaseDevice(device);
    return fingerprint;
}

TEST(EmbreeFingerprint, IsTheSameForEachDeviceAndTellsInstructionSetsApart) {
    EXPECT_EQ(fingerprint_with(nullptr), fingerprint_with(nullptr));
    EXPECT_EQ(fingerprint_with("isa=avx2"), fingerprint_with("isa=avx2"));
    EXPECT_NE(fingerprint_with("isa=avx2"), fingerprint_with("isa=sse4.2"));
    const Scene scene = make_cornell();
    EXPECT_EQ(TracedScene(scene).embree_fingerprint(), fingerprint_with(nullptr));
}

TEST(CheckpointKey, OfAnotherMachineOrBuildKeepsACheckpointFromBeingContinued) {
    const TemporaryFolder folder;
    const auto file = folder / "run.checkpoint";
    const CheckpointKey here{1, 2, 3, 4, 5};
    CheckpointKey other_machine = here, other_build = here;
    other_machine.embree = 6, other_build.integrator = 6;
    const std::vector<double> written = {1.0, 2.0, 4.0};
    using Case = std::pair<CheckpointKey, const char*>;
    for (const auto& [there, remedy] : {Case{other_machine, "render all parts on machines of a kind"},
                                        Case{other_build, "render all parts with one build"}}) {
        write_checkpoint(file, there, {0, 16, 100, 1.0}, written);
        std::vector<double> sums(written.size());
        EXPECT_THAT([&] { add_checkpoint(file, here, sums); },
                    testing::ThrowsMessage<ReferenceError>(
                        testing::AllOf(testing::HasSubstr(file.string()), testing::HasSubstr(remedy))));
        add_checkpoint(file, there, sums);
        EXPECT_EQ(sums, written);
        add_checkpoint(file, there, sums);
        EXPECT_EQ(sums, (std::vector<double>{2.0, 4.0, 8.0}));
    }
}

// The key that runs use holds the hash of this build.
TEST(CheckpointKey, HoldsTheBuild) {
    const Scene scene = make_cornell();
    const auto key = CheckpointKey::of(scene, {}, View(scene.cameras[0], 4, 4), settings_for({"ao"}, 2), 5);
    EXPECT_EQ(key.embree, 5u);
    EXPECT_NE(key.integrator, 0u);
    EXPECT_THAT(std::string(integrator_hash()), testing::MatchesRegex("[0-9a-f]{16}"));
}

// A processor without AVX-512 has no packets of sixteen, one without AVX none of eight: there, Embree does not look at
// which lanes are idle. What stands in those is anything at all.
TEST(Packets, OfRaysThatAreFewLeaveTheIdleLanesAlone) {
    const Scene scene = make_clutter();
    for (const char* settings : {static_cast<const char*>(nullptr), "isa=avx2", "isa=sse4.2"}) {
        const TracedScene traced(scene, {}, settings);
        const View view(scene.cameras[0], 16, 16);
        for (int count = 1; count <= 17; ++count) {
            RayBatch rays;
            for (Lanes<float>* lanes :
                 {&rays.origin.x, &rays.origin.y, &rays.origin.z, &rays.direction.x, &rays.direction.y,
                  &rays.direction.z, &rays.nearest, &rays.farthest, &rays.time})
                lanes->std::array<float, most_lanes + lane_group>::fill(infinite_distance);
            for (int i = 0; i < count; ++i) {
                const Ray ray = view.pixel_ray(static_cast<float>(i % 16), static_cast<float>(count % 16));
                rays.add(ray.origin, ray.direction, infinite_distance, now);
            }
            HitBatch hits;
            Lanes<int> blocked;
            traced.intersect(rays, hits);
            traced.occluded(rays, blocked);
            for (int i = 0; i < count; ++i) {
                const SurfaceHit single = traced.intersect(rays.origin.get(i), rays.direction.get(i));
                EXPECT_EQ(blocked[i] != 0, !single.missed());
                EXPECT_EQ(hits.get(i).instance, single.instance);
                EXPECT_EQ(hits.get(i).distance, single.distance);
            }
        }
    }
}

}  // namespace
}  // namespace plumb
