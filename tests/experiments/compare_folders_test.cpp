#include <gmock/gmock.h>

#include "frames/exr.h"
#include "tests/experiments/program.h"
#include "tests/temporary_folder.h"

namespace plumb {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

constexpr int side = 32;

// Three frames of a wall that a still camera sees; the test is brighter by 0.1, 0.2 and 0.1.
class CompareFolders : public testing::Test {
protected:
    void SetUp() override {
        for (int i = 0; i < 3; ++i) {
            Frame truth(side, side), test(side, side);
            truth.set("ao", Image(side, side, 1, 0.5f));
            truth.set("depth", Image(side, side, 1, 2.0f));
            truth.set("motion", Image(side, side, 2));
            truth.set("position", Image(side, side, 3, -2.0f));
            Image& normal = truth.set("normal", Image(side, side, 3));
            for (int y = 0; y < side; ++y) {
                for (int x = 0; x < side; ++x) normal.at(x, y, 2) = 1.0f;
            }
            test.set("ao", Image(side, side, 1, i == 1 ? 0.7f : 0.6f));
            const std::string name = "frame_" + std::to_string(i) + ".exr";
            write_exr(folder_.path / "truth" / name, truth);
            write_exr(folder_.path / "test" / name, test);
        }
    }

    ProgramRun compare(std::vector<std::string> arguments) const {
        arguments.insert(arguments.begin(),
                         {"compare", (folder_.path / "test").string(), (folder_.path / "truth").string()});
        return run_plumbline(arguments);
    }

    TemporaryFolder folder_;
};

TEST_F(CompareFolders, PrintsFramesMeansAndFlickerAndHoldsLimitsOnThem) {
    // Mean square 0.02, so 0.141421 of RMSE; changes of 0.1.
    const ProgramRun run = compare({"--regions", "--fail-above", "rmse=0.15,flicker=0.11,rmse@border=0.15",
                                    "--fail-below", "psnr=16.9", "--heat-map", (folder_.path / "maps").string()});
    EXPECT_EQ(run.exit_code, 0) << run.output;
    EXPECT_THAT(run.output, AllOf(HasSubstr("frame_1.exr"), HasSubstr("All 3 frames"), HasSubstr("0.141421"),
                                  HasSubstr("0.1 [0.1, 0.1]"), HasSubstr("border")));
    EXPECT_TRUE(std::filesystem::exists(folder_.path / "maps" / "frame_2.ao.error.png"));

    const ProgramRun flickers = compare({"--fail-above", "flicker=0.09,rmse=0.2"});
    EXPECT_EQ(flickers.exit_code, 1) << run.output;
    EXPECT_THAT(flickers.output, AllOf(HasSubstr("ao: flicker = 0.1 is above 0.09"), Not(HasSubstr("rmse = "))));
    const ProgramRun region = compare({"--regions", "--fail-above", "maximum@rest=0.15"});
    EXPECT_EQ(region.exit_code, 1);
    EXPECT_THAT(region.output, HasSubstr("ao: maximum@rest = 0.2 is above 0.15"));
    // Only with --regions are there regions, and a limit that nothing is held against is not kept.
    EXPECT_EQ(compare({"--fail-above", "maximum@rest=0.3"}).exit_code, 1);
}

TEST_F(CompareFolders, JsonHasEveryFrame) {
    const ProgramRun run = compare({"--json"});
    EXPECT_EQ(run.exit_code, 0) << run.output;
    EXPECT_THAT(run.output, AllOf(HasSubstr("\"frame\": \"frame_0.exr\""), HasSubstr("\"flicker\": 0.0999999"),
                                  HasSubstr("\"only_in_reference\"")));
}

TEST_F(CompareFolders, NamesFramesWithoutPartner) {
    std::filesystem::remove(folder_.path / "truth" / "frame_1.exr");
    EXPECT_THAT(compare({}).output, HasSubstr("test': frame_1.exr"));
    const ProgramRun mixed =
        run_plumbline({"compare", (folder_.path / "test").string(), (folder_.path / "truth" / "frame_0.exr").string()});
    EXPECT_EQ(mixed.exit_code, 2);
    EXPECT_THAT(mixed.output, HasSubstr("is a folder"));
}

}  // namespace
}  // namespace plumb
