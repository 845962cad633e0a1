// The experiments that reproduce the literature: that every one can be read, what mistakes in them are told, and what
// is made of measurements.
#include "experiments/reproduction.h"

#include <cmath>
#include <fstream>
#include <iterator>
#include <map>
#include <set>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "experiments/claims_report.h"
#include "experiments/experiment_file.h"
#include "experiments/figures.h"
#include "experiments/svg_raster.h"
#include "experiments/svg_table.h"
#include "frames/atomic_file.h"
#include "frames/image_error.h"
#include "frames/picture.h"
#include "rasterizer/pass_plan.h"
#include "rasterizer/passes.h"
#include "scenes/builtin.h"
#include "scenes/scene_error.h"
#include "tests/experiments/sample_results.h"
#include "tests/message_of.h"
#include "tests/temporary_folder.h"

namespace plumb {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

constexpr const char* experiment_text = R"(
title = "A trial"
planes = ["ao"]
[[scenes]]
scene = "cornell"
[[methods]]
name = "one"
base = "one_layer"
[[methods]]
name = "two"
base = "two_layers"
)";

Reproduction load_text(const std::string& more) {
    const TemporaryFolder folder;
    const std::filesystem::path file = folder.path / "trial.toml";
    write_text_atomically(file, std::string(experiment_text).append(more));
    return load_reproduction(file.string());
}

std::string complaint_about(const std::string& more) {
    return message_of<ConfigError>([&] { load_text(more); });
}

std::string claim_with(const std::string& lines) {
    return std::string("[[claims]]\nclaim = \"c\"\nsource = \"s\"\ntest = \"t\"\nmeasure = \"rmse\"\n").append(lines);
}

TEST(Reproductions, EveryOneCanBeReadAndSaysWhereItStands) {
    const std::vector<std::string> names = reproduction_names();
    EXPECT_GE(names.size(), 20u);
    std::size_t claims = 0;
    for (const std::string& name : names) {
        SCOPED_TRACE(name);
        const Reproduction reproduction = load_reproduction(name);
        EXPECT_FALSE(reproduction.title.empty());
        EXPECT_FALSE(reproduction.question.empty());
        const std::vector<std::string> sources = reproduction.sources();
        EXPECT_FALSE(sources.empty());
        EXPECT_THAT(sources, testing::Each(testing::MatchesRegex("00[0-3], [^;]*")));
        EXPECT_EQ(std::set<std::string>(sources.begin(), sources.end()).size(), sources.size());
        EXPECT_FALSE(reproduction.presentation.figures.empty() && reproduction.drawings.empty());
        claims += reproduction.presentation.claims.size();
    }
    EXPECT_GE(claims, 24u);
}

// In the scenes that are part of the program; as a pipeline does, but without OpenGL.
TEST(Reproductions, NoMethodIsRefusedInItsScenes) {
    std::map<std::string, Scene> scenes;
    for (const std::string& name : builtin_scene_names()) scenes.emplace(name, make_builtin_scene(name));
    int planned = 0;
    for (const std::string& name : reproduction_names()) {
        const Reproduction reproduction = load_reproduction(name);
        if (!reproduction.drawings.empty() ||
            kind_of(reproduction.table, reproduction.file) != ExperimentKind::comparison)
            continue;
        const Experiment experiment = parse_experiment(reproduction.table, reproduction.file);
        for (const ExperimentScene& entry : experiment.scenes) {
            const auto scene = scenes.find(entry.scene);
            if (scene == scenes.end()) continue;
            for (const std::string& plane : experiment.planes) {
                const Quantities quantities = quantities_of(experiment, entry, plane);
                for (const Method& method : experiment.methods) {
                    SCOPED_TRACE(fmt::format("{} / {} / {} / {}", name, entry.scene, plane, method.name));
                    EXPECT_NO_THROW({
                        const Method in_scene = method_in_scene(method, entry, name);
                        plan_passes(declare_passes(scene->second, in_scene, quantities), quantities.planes);
                    });
                    ++planned;
                }
            }
        }
    }
    EXPECT_GT(planned, 100);
}

TEST(Reproductions, AMisspeltNameIsToldWithTheNearest) {
    EXPECT_THAT(message_of<ConfigError>([] { load_reproduction("thesis-gbuffer-tim"); }),
                HasSubstr("did you mean 'thesis-gbuffer-time'?"));
}

TEST(Presentation, MethodsThatTheExperimentDoesNotHaveAreTold) {
    EXPECT_THAT(complaint_about(claim_with("ratio = [{ method = \"tow\" }, { method = \"one\" }]\nbelow = 1.0\n")),
                AllOf(HasSubstr("trial.toml"), HasSubstr("claim 'c'"), HasSubstr("did you mean 'two'?")));
}

TEST(Presentation, ClaimsNeedAQuantityAndARange) {
    EXPECT_THAT(complaint_about(claim_with("below = 1.0\n")), HasSubstr("one of 'value', 'ratio'"));
    EXPECT_THAT(complaint_about(claim_with("value = {}\nslope = {}\nbelow = 1.0\n")), HasSubstr("one of 'value'"));
    EXPECT_THAT(complaint_about(claim_with("value = {}\n")), HasSubstr("'above', 'below', or both"));
    EXPECT_THAT(complaint_about(claim_with("value = {}\nabove = 2.0\nbelow = 1.0\n")), HasSubstr("leaves nothing"));
    EXPECT_THAT(complaint_about(claim_with("ratio = { method = \"one\" }\nbelow = 1.0\n")),
                HasSubstr("array of two tables"));
    EXPECT_THAT(complaint_about(claim_with("value = { scen = \"cornell\" }\nbelow = 1.0\n")),
                HasSubstr("did you mean 'scene'?"));
    EXPECT_THAT(complaint_about(claim_with("value = {}\nbelow = 1.0\nbelwo = 2.0\n")), HasSubstr("'below'"));
}

TEST(Presentation, OriginalsAreDividedByRowsThatThereAre) {
    EXPECT_THAT(complaint_about("[[originals]]\ntitle = \"o\"\nsource = \"s\"\nmeasure = \"ms\"\n"
                                "rows = [{ name = \"a\", original = 1.0, over = \"b\" }]\n"),
                HasSubstr("'a' is over no row 'b'"));
}

TEST(LoadedScenes, AreReadOnceUntilTheyAreReleased) {
    const TemporaryFolder folder;
    folder.write("box.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    folder.write("box.toml", "mesh = \"box.obj\"\n");
    const SceneFinder finder({folder.path});
    LoadedScenes scenes(finder);
    const std::string file = (folder.path / "box.toml").string();
    const Scene& scene = scenes.load(file);
    std::filesystem::remove(folder.path / "box.obj");
    EXPECT_EQ(&scenes.load(file), &scene);
    scenes.release(file);
    EXPECT_THROW(scenes.load(file), SceneError) << "it is read again";
    EXPECT_THROW(scenes.load(file), SceneError) << "and what is not there is told each time";
}

TEST(OptionalScenes, AreLeftOutWithTheReasonUnlessNoneIsLeft) {
    Experiment experiment;
    experiment.file = "trial.toml";
    experiment.scenes.resize(2);
    experiment.scenes[0].scene = "cornell";
    experiment.scenes[1].scene = "nowhere/missing.toml", experiment.scenes[1].optional = true;
    const SceneFinder finder({});
    LoadedScenes scenes(finder);
    const std::vector<LeftOutScene> left_out = leave_out_absent_scenes(experiment, scenes);
    ASSERT_EQ(left_out.size(), 1u);
    EXPECT_THAT(left_out[0].message, HasSubstr("nowhere/missing.toml: "));
    EXPECT_THAT(left_out[0].kept, HasSubstr("nowhere/missing.toml: "));
    ASSERT_EQ(experiment.scenes.size(), 1u);
    experiment.scenes[0].scene = "nowhere/missing.toml", experiment.scenes[0].optional = true;
    EXPECT_THAT(message_of<SceneError>([&] { leave_out_absent_scenes(experiment, scenes); }),
                HasSubstr("all of its scenes are optional"));
}

TEST(OptionalScenes, WhatIsKeptOfThemNamesTheRemedyAndNoFolder) {
    const TemporaryFolder folder;
    const std::string here = folder.path.string();
    folder.write("lamp.toml", "mesh = \"lamps/lamp.obj\"\n");
    folder.write("broken.toml", "mesh = 1\n");
    Experiment experiment;
    experiment.scenes.resize(5);
    experiment.scenes[0].scene = "cornell";
    experiment.scenes[1].scene = "dragon", experiment.scenes[2].scene = "lamp.toml";
    experiment.scenes[3].scene = here + "/lamp.toml", experiment.scenes[4].scene = "broken.toml";
    for (std::size_t i = 1; i < 5; ++i) experiment.scenes[i].optional = true;
    const SceneFinder finder({folder.path});
    LoadedScenes scenes(finder);
    const std::vector<LeftOutScene> left_out = leave_out_absent_scenes(experiment, scenes);
    ASSERT_EQ(left_out.size(), 4u);
    for (const LeftOutScene& scene : left_out) {
        EXPECT_THAT(scene.message, HasSubstr(here));
        EXPECT_THAT(scene.kept, AllOf(HasSubstr("--scenes-dir"), Not(HasSubstr(here))));
    }
    EXPECT_THAT(left_out[0].kept, testing::StartsWith("dragon: scene 'dragon.toml': "));
    EXPECT_EQ(left_out[1].kept,
              "lamp.toml: scene 'lamp.toml': 'lamps/lamp.obj' not found. Name the folder that holds it with "
              "--scenes-dir or PLUMBLINE_SCENES");
    EXPECT_EQ(left_out[2].kept, left_out[1].kept);
    EXPECT_THAT(left_out[3].kept, testing::StartsWith("broken.toml: it cannot be loaded"));
}

// Two views, three methods of which two make a curve.
std::vector<Cell> sample_cells() {
    std::vector<Cell> cells;
    for (const double view : {1.0, 2.0}) {
        const std::string place = view == 1.0 ? "front" : "left";
        for (const double taps : {10.0, 20.0}) {
            Cell cell{"cornell", place, "ao", "", taps == 10.0 ? "taps = 10" : "taps = 20", "taps", taps};
            cell.set("rmse", view * 0.1 / taps);
            cell.set("ms", view * taps);
            cells.push_back(cell);
        }
        Cell other{"cornell", place, "ao", "", "other", ""};
        other.set("rmse", view * 0.02);
        other.set("ms", view * 5.0);
        cells.push_back(other);
    }
    return cells;
}

std::string png_of(const std::string& svg) { return rasterise_svg(svg, 1.0); }
const std::string png_signature = "\x89PNG";

TEST(MeasuredCells, OraclesOfBouncesAreACurveWithoutTimes) {
    RunResults results;
    results.rows = {sample_row("front", "one", 0.1, 2.0), sample_row("front", oracle_name_of_bounces(2), 0.05, 0.0)};
    results.rows.back().oracle.bounces = 2;
    const std::vector<Cell> cells = cells_of(results);
    ASSERT_EQ(cells.size(), 2u);
    EXPECT_EQ(attribute_of(cells[0], "curve"), "");
    EXPECT_EQ(attribute_of(cells[1], "method"), "oracle, 2 bounces");
    EXPECT_EQ(attribute_of(cells[1], "curve"), "oracle, bounces");
    EXPECT_EQ(attribute_of(cells[1], "parameter"), "2");
    EXPECT_EQ(measure_of(cells[0], "ms"), 2.0);
    EXPECT_TRUE(std::isnan(measure_of(cells[1], "ms")));
}

TEST(Figures, CurvesAverageOverViewsAndAreWellFormed) {
    Figure figure;
    figure.title = "Error <over> taps & more", figure.series = "curve";
    const ResultTable numbers = chart_numbers(figure, sample_cells());
    ASSERT_EQ(numbers.rows.size(), 2u);
    EXPECT_EQ(numbers.rows[0][2], "10");
    EXPECT_EQ(numbers.rows[0][3], "0.0141421");  // the geometric mean of 0.01 and 0.02
    EXPECT_EQ(numbers.rows[0][6], "2");
    EXPECT_THAT(png_of(print_chart(figure, sample_cells())), testing::StartsWith(png_signature));
}

TEST(Figures, BarsRelativeToAMethodAreRatiosWithIntervals) {
    Figure figure;
    figure.title = "Bars", figure.kind = FigureKind::bars, figure.x = "scene", figure.series = "method";
    figure.linear_y = true;
    figure.relative_to.wanted["method"] = {"other"};
    const ResultTable numbers = chart_numbers(figure, sample_cells());
    ASSERT_EQ(numbers.rows.size(), 2u) << "the base itself has no bar";
    EXPECT_EQ(numbers.rows[0][1], "taps = 10");
    EXPECT_EQ(numbers.rows[0][3], "0.5");  // 0.01 / 0.02 in both views
    EXPECT_THAT(png_of(print_chart(figure, sample_cells())), testing::StartsWith(png_signature));
}

TEST(Figures, NothingMeasuredMakesNoFigure) {
    EXPECT_EQ(print_chart({}, {}), "");
    EXPECT_EQ(print_picture_sheet({}, {}, "."), "");
}

TEST(Figures, TablesAverageOverThePlacesThatAllRowsHave) {
    Figure figure;
    figure.title = "Errors", figure.kind = FigureKind::table, figure.rows = {"method"}, figure.columns = {"rmse", "ms"};
    std::vector<Cell> cells = sample_cells();
    // The hard view of one method was refused: only its easy one would count.
    for (Cell& cell : cells) {
        if (cell.method == "other" && cell.place == "left") cell.values.erase(cell.values.begin());
    }
    const ResultTable table = make_table(figure, cells);
    EXPECT_THAT(table.rows[0], testing::ElementsAre("taps = 10", "0.01 (1 of 2)", "15"));
    EXPECT_THAT(table.rows[2], testing::ElementsAre("other", "0.02 (1 of 2)", "7.5"));
    // A row per view and method: nothing is averaged.
    figure.rows = {"place", "method"};
    const ResultTable each = make_table(figure, cells);
    EXPECT_THAT(each.rows[0], testing::ElementsAre("front", "taps = 10", "0.01", "10"));
    EXPECT_THAT(each.rows[5], testing::ElementsAre("left", "other", "-", "10"));
    // Rows that share no view tell their own.
    std::erase_if(cells, [](const Cell& cell) { return cell.method == "taps = 10" && cell.place == "front"; });
    figure.rows = {"method"};
    const ResultTable apart = make_table(figure, cells);
    EXPECT_THAT(apart.rows[0], testing::ElementsAre("taps = 20", "0.0075", "40 (1 of 2)"));
    EXPECT_THAT(apart.rows[1], testing::ElementsAre("other", "0.02 (1 of 2)", "10 (1 of 2)"));
    EXPECT_THAT(apart.rows[2], testing::ElementsAre("taps = 10", "0.02 (1 of 2)", "20 (1 of 2)"));
}

TEST(Figures, OriginalsStandBesideOursAsRatios) {
    Originals originals;
    originals.title = "Time", originals.measure = "ms", originals.unit = "ms";
    Selector few, many, nowhere;
    few.wanted["parameter"] = {"10"}, many.wanted["parameter"] = {"20"}, nowhere.wanted["scene"] = {"dragon"};
    originals.rows = {{"few", 1.0, few, ""}, {"many", 3.0, many, "few"}, {"elsewhere", 4.0, nowhere, "few"}};
    const ResultTable table = make_originals_table(originals, sample_cells());
    EXPECT_THAT(table.rows[0], testing::ElementsAre("few", "1", "14.1", "14.1", "-", "-", "-", "2"));
    EXPECT_THAT(table.rows[1], testing::ElementsAre("many", "3", "28.3", "9.43", "few", "3", "2", "2"));
    EXPECT_THAT(table.rows[2], testing::ElementsAre("elsewhere", "4", "not here", "-", "few", "4", "-", "0"));
}

double attribute(const std::string& element, const std::string& name) {
    return std::stod(element.substr(element.find(" " + name + "=\"") + name.size() + 3));
}

TEST(Figures, TablesAreDrawnRowByRowWithinTheirSheet) {
    ResultTable table;
    table.columns = {"method", "ms"}, table.rows = {{"one", "1.5"}, {"a < b", "20"}};
    const std::string svg = print_svg_table(table, "Times & errors");
    EXPECT_THAT(svg, AllOf(HasSubstr(">Times &amp; errors</text>"), HasSubstr(">a &lt; b</text>")));
    EXPECT_THAT(png_of(svg), testing::StartsWith(png_signature));
    const auto element = [&](const std::string& content) {
        const std::size_t end = svg.find(">" + content + "</text>");
        return end == std::string::npos ? "" : svg.substr(svg.rfind("<text", end), end - svg.rfind("<text", end));
    };
    const std::string sheet = svg.substr(0, svg.find('>'));
    double last = 0.0;
    for (const std::size_t row : {0u, 1u}) {
        const std::string name = element(row == 0 ? "one" : "a &lt; b"), number = element(table.rows[row][1]);
        EXPECT_EQ(attribute(name, "y"), attribute(number, "y"));
        EXPECT_GT(attribute(name, "y"), last);
        last = attribute(name, "y");
        EXPECT_EQ(attribute(name, "x"), attribute(element("method"), "x")) << "names stand to the left";
        EXPECT_EQ(attribute(number, "x"), attribute(element("ms"), "x"));
        EXPECT_THAT(number, HasSubstr("text-anchor=\"end\"")) << "numbers to the right";
        EXPECT_LT(attribute(number, "x"), attribute(sheet, "width"));
    }
    EXPECT_LT(last, attribute(sheet, "height"));
}

TEST(Figures, PictureSheetsHoldTheirPictures) {
    const TemporaryFolder folder;
    write_png(folder.path / "truth.png", Image(16, 9, 3));
    write_png(folder.path / "two.png", Image(16, 9, 3));
    PictureSet set;
    set.scene = "cornell", set.view = "front", set.plane = "total";
    set.images = {{"truth", "truth", "truth.png", ""}, {"two", "method", "two.png", ""}};
    Figure figure;
    figure.title = "Sheet", figure.kind = FigureKind::pictures;
    const std::string svg = print_picture_sheet(figure, {set}, folder.path);
    EXPECT_THAT(svg, AllOf(HasSubstr("data:image/png;base64,"), HasSubstr("cornell / front: total"),
                           HasSubstr("height=\"135\"")));  // 240 pixels wide, 16 to 9
    EXPECT_THAT(png_of(svg), testing::StartsWith(png_signature));
    figure.where.wanted["place"] = {"left"};
    EXPECT_EQ(print_picture_sheet(figure, {set}, folder.path), "");
    EXPECT_TRUE(picture_numbers(figure, {set}, {}).rows.empty());
}

TEST(Figures, PictureSheetsHaveTheNumbersOfTheirPictures) {
    PictureSet set;
    set.scene = "cornell", set.view = "left", set.plane = "indirect", set.truth = "within 0.3 m", set.error_scale = 0.5;
    set.images = {{"truth", "truth", "a.png", ""},
                  {"other", "method", "b.png", ""},
                  {"taps = 10", "method", "c.png", ""},
                  {"taps = 10", "error", "d.png", ""},
                  {"taps = 20", "method", "e.png", ""}};
    std::vector<Cell> cells = sample_cells();
    for (Cell& cell : cells) cell.plane = "indirect", cell.truth = "limited";
    Figure figure;
    figure.title = "Sheet", figure.kind = FigureKind::pictures, figure.show = {"truth", "taps = 10", "other", "absent"};
    const ResultTable numbers = picture_numbers(figure, {set}, cells);
    EXPECT_EQ(numbers.print_csv(),
              "scene,place,plane,truth,method,rmse,bias,ssim,ms,last colour of the error map\n"
              "cornell,left,indirect,limited,taps = 10,0.02,,,20,0.5\n"
              "cornell,left,indirect,limited,other,0.04,,,10,\n");
}

TEST(Drawings, TapsThatTurnOnceEachLieOnALine) {
    Drawing drawing;
    drawing.title = "Spiral";
    drawing.spirals = {{.samples = 4, .turns = 4, .spin = 0.25}};
    const ResultTable taps = drawing_numbers(drawing);
    ASSERT_EQ(taps.rows.size(), 4u);
    // Half a turn and a quarter on from the right: downwards, at 1/8, 3/8, 5/8 and 7/8 of the radius.
    EXPECT_NEAR(std::stod(taps.rows[1][2]), 0.0, 1e-12);
    EXPECT_NEAR(std::stod(taps.rows[1][3]), -0.375, 1e-12);
    EXPECT_THAT(png_of(print_drawing(drawing)), testing::StartsWith(png_signature));
}

TEST(Drawings, TheFilterSpreadsAPixelAndKeepsItsLight) {
    Drawing drawing;
    drawing.title = "Filter", drawing.kind = Drawing::Kind::filter, drawing.size = 13, drawing.radius = 3;
    double sum = 0.0;
    for (const auto& row : drawing_numbers(drawing).rows) sum += std::stod(row[3]);
    // No pixel that the white one reaches has neighbours beyond the border. Six digits are printed.
    EXPECT_NEAR(sum, 1.0, 1e-5);
    // Standard deviation 1: weights 1, e^-1/2, e^-2, e^-9/2 to each side.
    const double weights = 1.0 + 2.0 * (std::exp(-0.5) + std::exp(-2.0) + std::exp(-4.5));
    EXPECT_NEAR(std::stod(drawing_numbers(drawing).rows[13 * 6 + 6][3]), 1.0 / (weights * weights), 1e-6);
    EXPECT_THAT(png_of(print_drawing(drawing)), testing::StartsWith(png_signature));
}

TEST(SvgRaster, SaysWhatIsWrongWithTextThatIsNoSvg) {
    EXPECT_THAT(message_of<ImageError>([] { rasterise_svg("<svg"); }), HasSubstr("cannot draw the SVG"));
}

TEST(Measurements, AClaimThatCouldNotBeTestedSaysSo) {
    Reproduction reproduction = load_text(claim_with("value = { method = \"one\" }\nbelow = 1.0\n"));
    Measurements measurements;
    measurements.cells.push_back({"cornell", "front", "ao", "", "two", ""});
    const TemporaryFolder folder;
    present(reproduction, measurements, folder.path);
    std::ifstream stream(folder.path / "README.md");
    const std::string readme{std::istreambuf_iterator<char>(stream), {}};
    EXPECT_THAT(readme, AllOf(HasSubstr("**untested**"), HasSubstr("It could not be tested: nothing was measured."),
                              testing::Not(HasSubstr("It depends"))));
}

TEST(Measurements, ReadBackAndPresentedFilesAreWhole) {
    Reproduction reproduction =
        load_text("[[figures]]\ntitle = \"A table\"\nkind = \"table\"\nrows = [\"method\"]\ncolumns = [\"rmse\"]\n");
    Claim claim;
    claim.claim = "more taps err less", claim.source = "000, section 1", claim.test = "RMSE, 20 over 10",
    claim.below = 1.0;
    claim.quantity = {"rmse", QuantityKind::ratio, {}, {}, {}};
    claim.quantity.first.wanted["parameter"] = {"20"}, claim.quantity.second.wanted["parameter"] = {"10"};
    reproduction.presentation.claims.push_back(claim);
    Measurements measurements;
    measurements.experiment = "trial", measurements.renderer = "a renderer";
    measurements.program = "1.0 (abc)", measurements.key = "0123";
    measurements.cells = sample_cells();
    measurements.left_out = {"dragon: not found"};
    const TemporaryFolder folder;
    const PresentedReproduction presented = present(reproduction, measurements, folder.path);
    ASSERT_EQ(presented.claims.size(), 1u);
    EXPECT_EQ(presented.claims[0].verdict, ClaimVerdict::holds) << presented.claims[0].reason;
    for (const char* name : {"measurements.json", "numbers.csv", "claims.json", "figure-1.csv", "README.md"})
        EXPECT_TRUE(std::filesystem::exists(folder.path / name)) << name;
    std::ifstream stream(folder.path / "README.md");
    const std::string readme{std::istreambuf_iterator<char>(stream), {}};
    EXPECT_THAT(readme, AllOf(HasSubstr("# A trial"), HasSubstr("Left out: dragon: not found"),
                              HasSubstr("**holds** more taps err less"), HasSubstr("| taps = 10 | 0.015 |"),
                              HasSubstr("Program 1.0 (abc); key `0123`")));
    EXPECT_EQ(read_claims_json(folder.path / "claims.json").at(0).key, "0123");
    const Measurements again = read_measurements_json(folder.path / "measurements.json");
    EXPECT_EQ(print_cells_csv(again.cells), print_cells_csv(measurements.cells));
    EXPECT_EQ(again.left_out, measurements.left_out);
}

}  // namespace
}  // namespace plumb
