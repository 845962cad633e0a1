#include "experiments/experiment_file.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "experiments/loaded_scenes.h"
#include "experiments/view_truths.h"
#include "tests/message_of.h"
#include "tests/temporary_folder.h"

namespace plumb {
namespace {

using testing::AllOf;
using testing::HasSubstr;

const std::string valid = R"(planes = ["ao"]
methods = ["one_layer", {name = "mine", base = "two_layers", ao.samples = 6}]
[[scenes]]
scene = "cornell"
ao_radius = 0.2
)";

Experiment parse(const std::string& text) { return parse_experiment(parse_config(text, "e.toml"), "e.toml"); }

std::string parse_failure(const std::string& text) {
    return message_of<ConfigError>([&] { parse(text); });
}

TEST(ExperimentFile, ReadsScenesMethodsAndDefaults) {
    const Experiment experiment = parse(valid);
    ASSERT_EQ(experiment.scenes.size(), 1u);
    EXPECT_EQ(experiment.scenes[0].scene, "cornell");
    EXPECT_FLOAT_EQ(experiment.scenes[0].ao_radius, 0.2f);
    ASSERT_EQ(experiment.methods.size(), 2u);
    EXPECT_EQ(experiment.methods[1].ao.samples, 6);
    EXPECT_EQ(experiment.baseline, "one_layer");
    EXPECT_EQ(experiment.name, "e");
}

TEST(ExperimentFile, TheShippedExperimentIsValid) {
    const Experiment experiment = load_experiment(PLUMBLINE_SOURCE_DIR "/experiments/one_vs_two_layers.toml");
    EXPECT_THAT(experiment.planes, testing::ElementsAre("ao", "indirect", "total"));
    EXPECT_EQ(experiment.scenes.size(), 3u);
    EXPECT_EQ(experiment.methods.size(), 2u);
}

TEST(ExperimentFile, SaysWhichFlipIsMeasuredAndOnWhatScreen) {
    EXPECT_EQ(parse(valid).measures.flip, FlipRange::by_plane);
    const Experiment experiment = parse("measures = { flip = \"none\", pixels_per_degree = 40 }\n" + valid);
    EXPECT_EQ(experiment.measures.flip, FlipRange::none);
    EXPECT_EQ(experiment.measures.pixels_per_degree, 40.0);
    EXPECT_THAT(parse_failure("measures = { flip = \"displayd\" }\n" + valid),
                AllOf(HasSubstr("no range 'displayd'"), HasSubstr("did you mean 'displayed'?")));
}

TEST(ExperimentFile, AGateIsAnExperimentTooWhoseLimitsARunLeavesAlone) {
    const Experiment gate = load_experiment(PLUMBLINE_SOURCE_DIR "/experiments/ci.toml");
    EXPECT_FALSE(gate.methods.empty());
    EXPECT_EQ(parse(valid + "[[thresholds]]\nname = \"ao\"\n").methods.size(), 2u);
}

TEST(ExperimentFile, MistakesAreReportedWithTheirLine) {
    EXPECT_THAT(parse_failure("plane = [\"ao\"]\n" + valid),
                AllOf(HasSubstr("e.toml:1: plane"), HasSubstr("did you mean 'planes'?")));
    EXPECT_THAT(parse_failure(valid + "ao_raduis = 0.1\n"),
                AllOf(HasSubstr("e.toml:6"), HasSubstr("did you mean 'ao_radius'?")));
    EXPECT_THAT(parse_failure(valid + "method.ao.bais = 0.1\n"),
                AllOf(HasSubstr("e.toml:6: ao.bais"), HasSubstr("'ao.bias'")));
    EXPECT_THAT(parse_failure(valid + "[reference]\nsamples = 33\n"),
                AllOf(HasSubstr("e.toml:7: reference.samples"), HasSubstr("even")));
    EXPECT_THAT(parse_failure("resolution = [1, 2, 3]\n" + valid), HasSubstr("[width, height]"));
    EXPECT_THAT(parse_failure("baseline = \"mien\"\n" + valid),
                AllOf(HasSubstr("e.toml:1: baseline"), HasSubstr("did you mean 'mine'?")));
}

TEST(ExperimentFile, ASweepMakesAMethodOfEachValue) {
    const std::string sweep = R"(planes = ["ao"]
methods = ["one_layer", {name = "mine", base = "two_layers", sweep = {"ao.samples" = [6, 20]}}]
[[scenes]]
scene = "cornell"
[[scenes.paths]]
path = "push"
frames = 5
)";
    const Experiment experiment = parse(sweep);
    ASSERT_EQ(experiment.methods.size(), 3u);
    EXPECT_EQ(experiment.methods[2].name, "mine, ao.samples = 20");
    EXPECT_EQ(experiment.methods[2].ao.samples, 20);
    EXPECT_EQ(experiment.methods[2].gbuffer.layers, 2);
    const SweepPoint& point = experiment.sweep_points.at("mine, ao.samples = 6");
    EXPECT_EQ(point.curve, "mine");
    EXPECT_EQ(point.parameter, "ao.samples");
    EXPECT_EQ(point.value, 6.0);
    ASSERT_EQ(experiment.scenes[0].paths.size(), 1u);
    EXPECT_EQ(experiment.scenes[0].paths[0].frames, 5);

    const auto failure = [&](const std::string& from, const std::string& to) {
        std::string text = sweep;
        return parse_failure(text.replace(text.find(from), from.size(), to));
    };
    EXPECT_THAT(failure("[6, 20]", "[6]"), AllOf(HasSubstr("e.toml:2"), HasSubstr("two values or more")));
    EXPECT_THAT(failure("[6, 20]", "[6, \"many\"]"), HasSubstr("must hold numbers"));
    EXPECT_THAT(failure("ao.samples", "ao.smaples"), HasSubstr("'ao.samples'"));
    EXPECT_THAT(failure("[6, 20]", "[6, 6]"), HasSubstr("two methods are called"));
    EXPECT_THAT(failure("frames = 5", "frames = 1"), HasSubstr("e.toml:7: paths[1].frames"));
}

TEST(ExperimentFile, TheTruthSpreadsItsRaysOverThePixelWhereItSaysSo) {
    const Experiment plain = parse(valid), spread = parse(valid + "[reference]\nantialias = true\n");
    EXPECT_FALSE(full_truth_settings(plain, plain.scenes[0]).antialias);
    EXPECT_TRUE(full_truth_settings(spread, spread.scenes[0]).antialias);
}

TEST(ExperimentFile, TheOracleHasFewerBouncesThanTheTruth) {
    const auto with = [](const std::string& bounces, const std::string& planes) {
        return fmt::format(
            "planes = {}\noracle_bounces = {}\nmethods = [\"one_layer\"]\n[quantities]\nbounces = 4\n"
            "[[scenes]]\nscene = \"cornell\"\n",
            planes, bounces);
    };
    EXPECT_EQ(parse(with("[3, 1]", "[\"ao\", \"total\"]")).oracle_bounces, (std::vector{3, 1}));
    const auto failure = [&](const std::string& bounces, const std::string& planes = "[\"indirect\"]") {
        return parse_failure(with(bounces, planes));
    };
    EXPECT_THAT(failure("[1, 4]"), AllOf(HasSubstr("e.toml:2: oracle_bounces: holds 4"), HasSubstr("which are 4"),
                                         HasSubstr("take fewer, or raise 'bounces' in [quantities]")));
    EXPECT_THAT(failure("[0]"), HasSubstr("e.toml:2: oracle_bounces: holds 0, but must hold 1 to"));
    EXPECT_THAT(failure("[1, 2, 1]"), HasSubstr("e.toml:2: oracle_bounces: holds 1 twice; remove one"));
    EXPECT_THAT(failure("[1]", "[\"ao\", \"indirect.1\"]"),
                AllOf(HasSubstr("e.toml:2: oracle_bounces: no plane of ao, indirect.1 has light of bounces"),
                      HasSubstr("compare indirect, irradiance, reflection or total, or remove it")));
}

TEST(ExperimentFile, RowsAreNotListedTwice) {
    const auto failure = [](const std::string& line) {
        return parse_failure(line + "\nmethods = [\"one_layer\"]\n[[scenes]]\nscene = \"cornell\"\n");
    };
    EXPECT_THAT(failure("oracle = [1, 2, 1]"), HasSubstr("e.toml:1: oracle: holds 1 twice; remove one"));
    EXPECT_THAT(failure("path_tracer_samples = [4, 4]"),
                HasSubstr("e.toml:1: path_tracer_samples: holds 4 twice; remove one"));
}

TEST(ExperimentFile, TakesMethodsFromFilesBesideIt) {
    const TemporaryFolder folder;
    Method tuned = load_method("two_layers");
    tuned.name = "two_tuned", tuned.ao.samples = 11;
    folder.write("tuned/two.toml", print_method(tuned));
    const std::string text = R"(planes = ["ao"]
methods = ["one_layer", "tuned/two.toml", {name = "more", base = "tuned/two.toml", ao.blur.radius = 3},
           {name = "curve", base = "two_tuned", sweep = {"ao.samples" = [6, 20]}}]
[[scenes]]
scene = "cornell"
)";
    const std::filesystem::path file = folder.path / "e.toml";
    const auto parse_there = [&](const MethodFiles& kept) {
        return parse_experiment(parse_config(text, file.string()), file, kept);
    };
    const Experiment experiment = parse_there({});
    ASSERT_EQ(experiment.methods.size(), 5u);
    EXPECT_EQ(experiment.methods[1].name, "two_tuned");
    EXPECT_EQ(method_hash(experiment.methods[1]), method_hash(tuned));
    EXPECT_EQ(experiment.methods[2].ao.samples, 11);
    EXPECT_EQ(experiment.methods[2].ao.blur.radius, 3);
    EXPECT_EQ(experiment.methods[3].name, "curve, ao.samples = 6");

    // A record keeps their texts: the file may change, or go.
    const MethodFiles kept = experiment.method_files;
    ASSERT_EQ(kept.size(), 1u);
    folder.write("tuned/two.toml", "name = \"two_tuned\"\nao.smaples = 3\n");
    EXPECT_EQ(method_hash(parse_there(kept).methods[1]), method_hash(tuned));
    EXPECT_THAT(message_of<ConfigError>([&] { parse_there({}); }),
                AllOf(HasSubstr("tuned/two.toml:2: ao.smaples"), HasSubstr("'ao.samples'")));
    std::filesystem::remove(folder.path / "tuned/two.toml");
    EXPECT_EQ(method_hash(parse_there(kept).methods[2]), method_hash(experiment.methods[2]));
    EXPECT_THAT(message_of<ConfigError>([&] { parse_there({}); }),
                AllOf(HasSubstr("e.toml"), HasSubstr("no method file 'tuned/two.toml'"),
                      HasSubstr((folder.path / "tuned/two.toml").string()), HasSubstr("plumbline tune")));
}

TEST(ExperimentFile, AMethodFileMaySetUpOtherStagesButNoLayersForNobody) {
    const TemporaryFolder folder;
    const auto parse_with = [&](const std::string& method) {
        folder.write("mine.toml", "name = \"mine\"\n" + method);
        const std::filesystem::path file = folder.path / "e.toml";
        const std::string text = "planes = [\"ao\"]\nmethods = [\"mine.toml\"]\nscenes = [{ scene = \"cornell\" }]";
        return parse_experiment(parse_config(text, file.string()), file);
    };
    EXPECT_NO_THROW(parse_with("radiosity.samples = 4")) << "another experiment asks for indirect light";
    EXPECT_THAT(message_of<ConfigError>([&] { parse_with("gbuffer.layers = 3"); }),
                AllOf(HasSubstr("mine.toml:2: gbuffer.layers"), HasSubstr("no plane of layer 3")));
}

// And none sets what nothing in its scenes is concerned with, as far as these are part of the program.
TEST(ExperimentFile, EveryOneThatIsShippedCanBeRead) {
    int read = 0;
    const SceneFinder finder({});
    LoadedScenes scenes(finder);
    for (const char* folder : {PLUMBLINE_SOURCE_DIR "/experiments", PLUMBLINE_SOURCE_DIR "/experiments/reproduce"}) {
        for (const auto& entry : std::filesystem::directory_iterator(folder)) {
            const std::filesystem::path& file = entry.path();
            const std::string stem = file.stem().string();
            if (file.extension() != ".toml" || stem.ends_with("thresholds") || stem.ends_with("drawings")) continue;
            SCOPED_TRACE(file);
            EXPECT_NO_THROW({
                const ConfigValue table = read_config(file);
                if (kind_of(table, file) == ExperimentKind::comparison)
                    require_effects_in_scenes(parse_experiment(table, file), scenes);
            });
            ++read;
        }
    }
    EXPECT_GE(read, 30);
}

TEST(ExperimentFile, AnUnknownPlaneIsAnErrorThatNamesTheNearest) {
    std::string text = valid;
    text.replace(text.find("ao"), 2, "indirekt");
    EXPECT_THAT(parse_failure(text), AllOf(HasSubstr("e.toml:1: planes"), HasSubstr("did you mean 'indirect'?")));
}

TEST(ExperimentFile, MissingPartsAreNamed) {
    EXPECT_THAT(parse_failure("methods = [\"one_layer\"]"), HasSubstr("'scenes' is missing"));
    EXPECT_THAT(parse_failure("[[scenes]]\nscene = \"cornell\""), HasSubstr("'methods' is missing"));
    EXPECT_THAT(parse_failure("methods = [\"one_layer\"]\n[[scenes]]\nviews = []"),
                AllOf(HasSubstr("e.toml:2"), HasSubstr("'scene' is missing")));
}

TEST(ExperimentFile, ASceneGivesItsRadiusSeparationAndOverridesToEveryMethod) {
    const Experiment experiment =
        parse(valid + "indirect_radius = 0.4\nminimum_separation = 0.03\nmethod.ao.bias = 0.001\n");
    const Method two = method_in_scene(experiment.methods[1], experiment.scenes[0], "e.toml");
    EXPECT_FLOAT_EQ(two.radiosity.radius, 0.4f);
    EXPECT_FLOAT_EQ(two.gbuffer.minimum_separation, 0.03f);
    EXPECT_FLOAT_EQ(two.ao.bias, 0.001f);
    EXPECT_EQ(two.ao.samples, 6);
}

TEST(ExperimentFile, TheQuickVariantAsksTheSameQuestionOfLess) {
    Experiment experiment = parse(valid);
    make_quick(experiment);
    EXPECT_LE(experiment.width, 480 / 4);
    EXPECT_LE(experiment.reference.samples, 64);
    EXPECT_TRUE(experiment.quick);
    EXPECT_EQ(experiment.methods.size(), 2u);
}

}  // namespace
}  // namespace plumb
