// Every way of generating the second layer, against the exact layers that rays find: small, but the real thing.
#include "experiments/generation.h"

#include <algorithm>
#include <map>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "experiments/config_error.h"

namespace plumb {
namespace {

using testing::HasSubstr;

constexpr const char* walks = R"(kind = "generation"
resolution = [160, 90]
frames = 4
frames_per_second = 15
[[walks]]
name = "still"
scene = "clutter"
path = "strafe"
start = 0.5
camera_speed = 0.0
minimum_separation = 0.05
[[walks]]
name = "slow"
scene = "clutter"
path = "strafe"
start = 0.5
camera_speed = 0.25
minimum_separation = 0.05
[[walks]]
name = "fast"
scene = "clutter"
path = "strafe"
start = 0.5
camera_speed = 2.0
minimum_separation = 0.05
[[walks]]
name = "object"
scene = "clutter-moving"
path = "strafe"
start = 0.5
camera_speed = 0.0
object_speed = 1.0
minimum_separation = 0.05
[[walks]]
name = "both"
scene = "clutter-moving"
path = "strafe"
start = 0.5
camera_speed = 1.0
object_speed = 1.0
minimum_separation = 0.05
)";

std::string with_methods() {
    std::string text = walks;
    for (const char* generation : {"peel", "delay", "previous", "predict", "reproject"}) {
        text += fmt::format("[[methods]]\nname = \"{0}\"\nbase = \"two_layers\"\ngbuffer.generation = \"{0}\"\n",
                            generation);
    }
    return text;
}

TEST(Generation, PeelAndDelayAreExactAndTheOthersAreWhereNothingMoves) {
    const GenerationExperiment experiment = parse_generation(parse_config(with_methods(), "walks.toml"), "walks.toml");
    const GenerationResults results = run_generation(experiment, SceneFinder({}), {});
    ASSERT_EQ(results.rows.size(), 25u);
    std::map<std::string, std::map<std::string, GenerationRow>> walk;
    for (const GenerationRow& row : results.rows) walk[row.walk][row.method] = row;
    for (const auto& [method, row] : walk["still"]) {
        // At silhouettes the rasteriser's sub-pixel grid of 1/256 shows another surface in some pixels of a thousand.
        EXPECT_LT(row.wrong, 0.002) << method;
        EXPECT_EQ(row.inside, 0.0) << method;
        EXPECT_EQ(row.violations, 0.0) << method;
        EXPECT_EQ(row.pixels_per_frame, 0.0) << method;
    }
    for (const char* name : {"slow", "fast", "object", "both"}) {
        SCOPED_TRACE(name);
        std::map<std::string, GenerationRow>& rows = walk[name];
        for (const char* method : {"peel", "delay"}) {
            EXPECT_LT(rows[method].wrong, 0.002) << method;
            EXPECT_EQ(rows[method].inside, 0.0) << method;
            EXPECT_EQ(rows[method].violations, 0.0) << method;
        }
        // A prediction from the velocity errs by the acceleration; the previous frame errs by the velocity.
        EXPECT_LT(rows["predict"].wrong, 0.5 * rows["previous"].wrong);
        EXPECT_GE(rows["previous"].violations, rows["predict"].violations);
        EXPECT_GT(rows["previous"].wrong, 0.0);
        EXPECT_GT(rows["reproject"].wrong, 0.0);
    }
    EXPECT_LT(walk["both"]["predict"].wrong, 0.3 * walk["both"]["previous"].wrong);
    EXPECT_GT(walk["both"]["peel"].pixels_per_frame, 0.3);
    // The faster the camera, the farther off are those that look at the frame before.
    EXPECT_NEAR(walk["fast"]["peel"].pixels_per_frame, 8.0 * walk["slow"]["peel"].pixels_per_frame,
                2.0 * walk["slow"]["peel"].pixels_per_frame);
    EXPECT_GT(walk["fast"]["previous"].wrong, 2.0 * walk["slow"]["previous"].wrong);
    // Slanted surfaces, which half a pixel moves by the separation, are wrong at any speed.
    EXPECT_GT(walk["fast"]["reproject"].wrong, walk["slow"]["reproject"].wrong);
    EXPECT_THAT(print_generation_table(results), HasSubstr("reproject"));
}

TEST(Generation, AWalkThatFailsDoesNotEndTheOthers) {
    std::string text = with_methods();
    text.replace(text.find("\"clutter\""), 9, "\"no_such_scene\"");
    GenerationExperiment experiment = parse_generation(parse_config(text, "walks.toml"), "walks.toml");
    experiment.width = 32, experiment.height = 18, experiment.frames = 2;
    const GenerationResults results = run_generation(experiment, SceneFinder({}), {});
    EXPECT_EQ(results.rows.size(), 20u) << "four walks by five methods";
    for (const GenerationRow& row : results.rows) EXPECT_NE(row.walk, "still");
    ASSERT_EQ(results.failures.size(), 1u);
    EXPECT_EQ(results.failures[0].cell, "still");
    EXPECT_THAT(results.failures[0].message, HasSubstr("no_such_scene"));
}

TEST(Generation, MethodsThatHaveNoSecondLayerAreRefused) {
    std::string text(walks);
    text += "[[methods]]\nname = \"one\"\nbase = \"one_layer\"\n";
    try {
        parse_generation(parse_config(text, "walks.toml"), "walks.toml");
        FAIL() << "took a method with one layer";
    } catch (const ConfigError& error) {
        EXPECT_THAT(error.what(), HasSubstr("all must render two layers"));
    }
}

}  // namespace
}  // namespace plumb
