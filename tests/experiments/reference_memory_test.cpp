// The memory that `plumbline reference` takes for a large image with every plane there is.
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "tests/experiments/program.h"
#include "tests/temporary_folder.h"

namespace plumb {
namespace {

class ReferenceMemory : public testing::TestWithParam<int> {};

TEST_P(ReferenceMemory, OfCrytekSponzaInFullHdWithEveryPlaneIsBelowTwoGibibytes) {
    const char* scenes = std::getenv("PLUMBLINE_SCENES");
    if (!scenes || !std::filesystem::exists(std::filesystem::path(scenes) / "crytek-sponza"))
        GTEST_SKIP() << "PLUMBLINE_SCENES has no crytek-sponza";
    const int bounces = GetParam();
    std::string planes = "ao,direct,indirect,irradiance,reflection,emission,total";
    for (int k = 1; k <= bounces; ++k) planes += ",indirect." + std::to_string(k);
    const std::string layer = "depth,normal,albedo,position,motion,seen_before,instance";
    planes += "," + layer + ",layer2.emission";
    for (std::size_t begin = 0; begin < layer.size();) {
        const std::size_t end = std::min(layer.find(',', begin), layer.size());
        planes += ",layer2." + layer.substr(begin, end - begin);
        begin = end + 1;
    }
    const TemporaryFolder folder;
    const ProgramRun run =
        measure_plumbline({"reference", "crytek-sponza", "--size", "1920", "1080", "--samples", "2", "--bounces",
                           std::to_string(bounces), "--planes", planes, "--output", folder.path.string()});
    ASSERT_EQ(run.exit_code, 0) << run.output;
    EXPECT_LT(run.peak_bytes, 2l << 30) << bounces << " bounces";
    RecordProperty("peak_mebibytes", static_cast<int>(run.peak_bytes >> 20));
}

INSTANTIATE_TEST_SUITE_P(Bounces, ReferenceMemory, testing::Values(3, 8));

}  // namespace
}  // namespace plumb
