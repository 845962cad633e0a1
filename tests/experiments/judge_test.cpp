#include <cmath>
#include <fstream>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "experiments/camera_frames.h"
#include "experiments/config_error.h"
#include "experiments/foreign_frame.h"
#include "frames/exr.h"
#include "frames/image_error.h"
#include "scenes/builtin.h"
#include "tests/experiments/program.h"
#include "tests/temporary_folder.h"

namespace plumb {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using Json = nlohmann::json;

TEST(ForeignFrame, TakesNamesInAnyCaseRenamingsAndGreysOfThreeChannels) {
    Frame frame(2, 2);
    frame.set("AO", Image(2, 2, 3, 0.5f));
    frame.set("ViewLayer.DiffInd", Image(2, 2, 3, 0.25f));
    const Frame ours = with_our_names(frame, parse_renamings({"ViewLayer.DiffInd=indirect"}), "a.exr");
    EXPECT_EQ(ours.plane("ao").channels(), 1);
    EXPECT_EQ(ours.plane("ao").at(1, 1), 0.5f);
    EXPECT_EQ(ours.plane("indirect").channels(), 3);

    frame.plane("AO").at(1, 0, 2) = 0.75f;
    EXPECT_THROW(with_our_names(frame, {}, "a.exr"), ImageError) << "coloured visibility";
    EXPECT_THROW(with_our_names(frame, {{"DiffInd", "indirect"}}, "a.exr"), ImageError) << "no such plane";
    frame.set("ao", Image(2, 2, 1));
    EXPECT_THROW(with_our_names(frame, {}, "a.exr"), ImageError) << "two of one name";
    EXPECT_THROW(parse_renamings({"indirect"}), ConfigError);
}

TEST(CameraFrames, IntrinsicsAndMatricesSeePointsWhereTheViewSeesThem) {
    const Scene scene = make_builtin_scene("cornell");
    CameraSequence cameras;
    cameras.path = "strafe", cameras.start = 0.25, cameras.frames_per_second = 10, cameras.frames = 3;
    cameras.width = 64, cameras.height = 36;
    const Json json = cameras_json(scene, "cornell", cameras);
    ASSERT_EQ(json["frames"].size(), 3u);
    EXPECT_DOUBLE_EQ(json["frames"][2]["time"].get<double>(), 0.45);
    const Json& frame = json["frames"][2];
    const View view(scene.path("strafe").at(0.45f), 64, 36);
    const glm::vec3 world = scene.bounds().centre() + glm::vec3(0.03f, -0.05f, 0.02f);
    const glm::vec3 expected = view.project(world);

    // By eye, axes and intrinsics.
    double along[3] = {};
    const char* axes[] = {"right", "up", "forward"};
    for (int a = 0; a < 3; ++a) {
        for (int i = 0; i < 3; ++i) {
            const double offset = world[i] - frame["eye"][i].get<double>();
            along[a] += offset * frame[axes[a]][i].get<double>();
        }
    }
    const double x = frame["fx"].get<double>() * along[0] / along[2] + frame["cx"].get<double>();
    const double y = frame["fy"].get<double>() * -along[1] / along[2] + frame["cy"].get<double>();
    // float32 at about 50 pixels resolves 4e-6.
    EXPECT_NEAR(x, expected.x, 1e-4);
    EXPECT_NEAR(y, expected.y, 1e-4);
    EXPECT_NEAR(along[2], expected.z, 1e-6);

    // By the projection matrix, of the point in camera space.
    const double camera_space[4] = {along[0], along[1], -along[2], 1.0};
    double clip[4] = {};
    for (int row = 0; row < 4; ++row) {
        for (int column = 0; column < 4; ++column)
            clip[row] += frame["clip_from_camera"][row][column].get<double>() * camera_space[column];
    }
    EXPECT_NEAR((clip[0] / clip[3] + 1) * 32, expected.x, 1e-4);
    EXPECT_NEAR((1 - clip[1] / clip[3]) * 18, expected.y, 1e-4);
    EXPECT_GT(clip[2] / clip[3], -1.0);
    EXPECT_LT(clip[2] / clip[3], 1.0);
    EXPECT_EQ(frame["world_from_camera"][0][3], frame["eye"][0]) << "rows first";
}

class Judge : public testing::Test {
protected:
    ProgramRun judge(std::vector<std::string> arguments) const {
        arguments.insert(arguments.begin(), "judge");
        for (const std::string& more : {std::string("--cache-dir"), (folder_.path / "cache").string()})
            arguments.push_back(more);
        return run_plumbline(arguments);
    }

    // The truth of frame `index` of the path, `brighter` than it is, as another program would write it: AO as a grey
    // of three channels.
    void write_frame(int index, float brighter) const {
        const std::string time = fmt::format("{}", 0.5 * index);
        const ProgramRun run = run_plumbline({"reference", "cornell", "--path", "strafe", "--time", time, "--size",
                                              "48", "27", "--samples", "64", "--seed", "9", "--planes", "ao",
                                              "--output", (folder_.path / "made").string()});
        ASSERT_EQ(run.exit_code, 0) << run.output;
        std::filesystem::path file;
        for (const auto& entry : std::filesystem::directory_iterator(folder_.path / "made")) {
            if (entry.path().extension() == ".exr") file = entry.path();
        }
        const Frame made = read_exr(file);
        std::filesystem::remove(file);
        Frame frame(48, 27);
        Image& ao = frame.set("AO", Image(48, 27, 3));
        for (int y = 0; y < 27; ++y) {
            for (int x = 0; x < 48; ++x) {
                for (int c = 0; c < 3; ++c) ao.at(x, y, c) = made.plane("ao").at(x, y) + brighter;
            }
        }
        write_exr(folder_.path / "frames" / fmt::format("f{}.exr", index), frame);
    }

    TemporaryFolder folder_;
};

TEST_F(Judge, FindsTheErrorThatWasPutIntoTheFramesAndItsFlicker) {
    // Errors of 0.2, 0.3 and 0.2: mean square 0.17 / 3, changes of 0.1.
    for (int i = 0; i < 3; ++i) write_frame(i, i == 1 ? 0.3f : 0.2f);
    const std::vector<std::string> common = {(folder_.path / "frames").string(),
                                             "--scene",
                                             "cornell",
                                             "--path",
                                             "strafe",
                                             "--frames-per-second",
                                             "2",
                                             "--samples",
                                             "64",
                                             "--regions"};
    auto arguments = common;
    arguments.insert(arguments.begin(), "judge");
    arguments.insert(arguments.end(), {"--json", "--heat-map", (folder_.path / "maps").string(), "--cache-dir",
                                       (folder_.path / "cache").string()});
    // Standard output alone is JSON.
    const auto remarks = folder_.path / "remarks.txt";
    const ProgramRun run = run_shell(fmt::format("({} 2> '{}')", quoted_command(arguments), remarks.string()));
    std::ifstream stream(remarks);
    const std::string said((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
    ASSERT_EQ(run.exit_code, 0) << said;
    EXPECT_THAT(said, AllOf(HasSubstr("cornell, path strafe: 3 frames of 48x27"), HasSubstr("first camera: eye")));
    EXPECT_TRUE(std::filesystem::exists(folder_.path / "maps" / "f1.ao.error.png"));
    const Json json = Json::parse(run.output);
    const Json& ao = json["planes"]["ao"];
    // 64 samples leave a noise of 0.02 in the frames and in the truth, whose squares are 1 % of 0.24^2, and in 1296
    // pixels 0.0006 of noise in the mean.
    EXPECT_NEAR(ao["unbiased_rmse"].get<double>(), std::sqrt(0.17 / 3), 0.005) << run.output;
    EXPECT_NEAR(ao["bias"].get<double>(), 0.7 / 3, 0.003);
    // The frames' own noise, and edges that move by fractions of pixels, add to the flicker.
    EXPECT_NEAR(ao["flicker"].get<double>(), 0.1, 0.03);
    EXPECT_EQ(ao["trustworthy"], 1.0);
    EXPECT_EQ(json["frames"].size(), 3u);
    EXPECT_TRUE(json["regions"]["ao"].contains("silhouettes"));
    EXPECT_TRUE(json["regions"]["ao"].contains("newly_seen"));

    auto gated = common;
    gated.insert(gated.end(), {"--fail-above", "rmse=0.2,flicker=0.2"});
    const ProgramRun failed = judge(gated);
    EXPECT_EQ(failed.exit_code, 1);
    EXPECT_THAT(failed.output, AllOf(HasSubstr("ao: rmse = 0.2"), HasSubstr("is above 0.2"), HasSubstr("f1.exr"),
                                     Not(HasSubstr("ao: flicker ="))));
}

TEST_F(Judge, SaysWhatItCannotJudge) {
    write_frame(0, 0.0f);
    const std::string file = (folder_.path / "frames" / "f0.exr").string();
    const auto expect = [&](std::vector<std::string> more, int code, const std::string& text) {
        more.insert(more.begin(), {file, "--scene", "cornell", "--path", "strafe", "--samples", "4"});
        const ProgramRun run = judge(more);
        EXPECT_EQ(run.exit_code, code) << run.output;
        EXPECT_THAT(run.output, HasSubstr(text));
    };
    expect({}, 0, "not measured: the truth's noise");
    expect({"--planes", "indirect"}, 2, "there is no plane 'indirect' (there are ao)");
    expect({"--rename", "GI=indirect"}, 2, "there is no plane 'GI'");
    expect({"--size", "64", "36"}, 2, "48x27, not 64x36");
    expect({"--frames", "2"}, 2, "holds 1 images");
    expect({"--fail-above", "rsme=1"}, 2, "did you mean 'rmse'?");
    const ProgramRun nothing = judge({"--scene", "cornell"});
    EXPECT_EQ(nothing.exit_code, 2);
    EXPECT_THAT(nothing.output, HasSubstr("--export-cameras"));
}

TEST_F(Judge, WritesCamerasBeforeThereAreFrames) {
    const auto file = folder_.path / "cameras.json";
    const ProgramRun run = judge({"--scene", "cornell", "--path", "strafe", "--frames", "4", "--size", "64", "36",
                                  "--export-cameras", file.string()});
    ASSERT_EQ(run.exit_code, 0) << run.output;
    std::ifstream stream(file);
    const Json json = Json::parse(stream);
    EXPECT_EQ(json["path"], "strafe");
    EXPECT_EQ(json["width"], 64);
    EXPECT_EQ(json["frames"].size(), 4u);
}

}  // namespace
}  // namespace plumb
