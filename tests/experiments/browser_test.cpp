// The report page in a real browser: it draws, and answers mouse, touch and keys, without a script error.
#include "tests/experiments/browser.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "experiments/page.h"
#include "frames/atomic_file.h"
#include "frames/colour_map.h"
#include "frames/exr.h"
#include "frames/image_file.h"
#include "tests/experiments/page_sample.h"
#include "tests/temporary_folder.h"

namespace plumb {
namespace {

using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::StartsWith;

class PageInBrowser : public testing::Test {
protected:
    // One browser and one page for all tests, each of which opens the page anew.
    static void SetUpTestSuite() {
        if (Browser::program().empty()) return;
        folder_ = std::make_unique<TemporaryFolder>();
        write_text_atomically(page(), print_page(full_sample(folder_->path), folder_->path));
        browser_ = std::make_unique<Browser>(folder_->path / "profile");
    }
    static void TearDownTestSuite() { browser_.reset(), folder_.reset(); }
    void SetUp() override {
        if (!browser_) GTEST_SKIP() << "no Chromium here (Debian package chromium)";
    }

    static std::filesystem::path page() { return folder_->path / "index.html"; }
    static Browser& browser() { return *browser_; }
    static void expect_no_error() {
        EXPECT_THAT(browser().errors(), IsEmpty()) << "the console told of errors";
        EXPECT_EQ(browser().text("document.getElementById('script-errors').textContent"), "");
    }
    // Shows one picture alone, so that the first canvas is that of `key`.
    static void show_alone(const std::string& key) {
        browser().choose("#picture-controls label:nth-of-type(4) select", "by turns");
        browser().run("document.activeElement.blur()");
        browser().move_to("#pictures canvas");
        browser().press(key);
    }
    // The colour in the canvas at a place, fractions of its size, once it is drawn.
    static std::string colour_at_place(const std::string& canvas, double x, double y) {
        return browser().text(
            "new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => {"
            "const canvas = document.querySelector('" +
            canvas +
            "'), one = new OffscreenCanvas(1, 1).getContext('2d');"
            "one.drawImage(canvas, Math.floor(" +
            std::to_string(x) + " * canvas.width), Math.floor(" + std::to_string(y) +
            " * canvas.height), 1, 1, 0, 0, 1, 1);"
            "done([...one.getImageData(0, 0, 1, 1).data].slice(0, 3).join(' ')); })))");
    }
    static std::string value_row(int row) {
        return browser().text("[...document.querySelectorAll('#picture-values tbody tr')[" + std::to_string(row) +
                              "].cells].map((cell) => cell.textContent).join(' ')");
    }

    static inline std::unique_ptr<TemporaryFolder> folder_;
    static inline std::unique_ptr<Browser> browser_;
};

TEST_F(PageInBrowser, LoadsInLightAndDarkWithoutAnErrorAndWithoutANetwork) {
    for (const bool dark : {false, true}) {
        Screen screen;
        screen.dark = dark;
        browser().open(page(), screen);
        expect_no_error();
        EXPECT_THAT(browser().network_requests(),
                    Each(testing::AnyOf(StartsWith("file:"), StartsWith("data:"), StartsWith("blob:"))));
        EXPECT_EQ(browser().text("getComputedStyle(document.body).backgroundColor"),
                  dark ? "rgb(21, 24, 28)" : "rgb(251, 250, 247)");
        EXPECT_THAT(browser().text("document.getElementById('summary').textContent"), HasSubstr("0.5 times the RMSE"));
        EXPECT_THAT(browser().text("document.getElementById('failures').textContent"), HasSubstr("<b>: went wrong"));
    }
}

TEST_F(PageInBrowser, DrawsARunInWhichEverythingFailed) {
    RunResults results = sample_results();
    results.rows.clear();
    results.failures = {{"cornell", "no such scene"}};
    const auto empty_page = folder_->path / "empty.html";
    write_text_atomically(empty_page, print_page(results, folder_->path));
    browser().open(empty_page);
    expect_no_error();
    for (const char* section : {"chart", "pictures", "paths", "waterfall"}) {
        EXPECT_TRUE(browser().truth("document.getElementById('" + std::string(section) + "-section').hidden"))
            << section;
    }
}

TEST_F(PageInBrowser, AScriptErrorWouldBeSeen) {
    // The page is made to fail, which proves that the other tests can.
    std::string text = print_page(sample_results(), folder_->path);
    const std::string call = "\ndrawTable();";
    text.replace(text.rfind(call), call.size(), "\nnoSuchFunction();");
    const auto broken_page = folder_->path / "broken.html";
    write_text_atomically(broken_page, text);
    browser().open(broken_page);
    EXPECT_THAT(browser().text("document.getElementById('script-errors').textContent"),
                HasSubstr("noSuchFunction is not defined"));
    EXPECT_THAT(browser().errors(), ElementsAre(HasSubstr("noSuchFunction")));
}

TEST_F(PageInBrowser, SortsByMouseAndByKeyboardWithRefusalsLast) {
    browser().open(page());
    const auto column = [&](int number) {
        return browser().text("[...document.querySelectorAll('#table tbody tr')].map((row) => row.cells[" +
                              std::to_string(number) + "].firstChild?.textContent.trim() ?? '').join(' ')");
    };
    browser().click("#table th:nth-child(6) button");
    EXPECT_EQ(browser().text("document.querySelector('#table th:nth-child(6)').ariaSort"), "ascending");
    EXPECT_THAT(column(5), StartsWith("0.0100 0.0375 0.0500 0.0500 0.0500 0.0700"));
    EXPECT_THAT(column(5), testing::EndsWith("4096 samples per pixel would do"));
    browser().press("Enter");  // the title has the focus still
    EXPECT_EQ(browser().text("document.querySelector('#table th:nth-child(6)').ariaSort"), "descending");
    EXPECT_THAT(column(5), StartsWith("0.150 0.141 0.100 0.100 0.100"));
    EXPECT_THAT(column(5), testing::EndsWith("4096 samples per pixel would do"));
    expect_no_error();
}

TEST_F(PageInBrowser, ShowsRegionsAndStabilityWhenAskedTo) {
    browser().open(page());
    const std::string heads = "document.querySelector('#table thead').textContent";
    EXPECT_THAT(browser().text(heads), Not(HasSubstr("silhouettes")));
    browser().click("#table-controls label:nth-of-type(4) input");
    browser().click("#table-controls label:nth-of-type(5) input");
    EXPECT_THAT(browser().text(heads),
                testing::AllOf(HasSubstr("RMSE of silhouettes"), HasSubstr("flicker"), HasSubstr("temporal variance")));
    const std::string table = browser().text("document.querySelector('#table tbody').textContent");
    EXPECT_THAT(table, HasSubstr("0.200 [0.173, 0.224]")) << "twice the RMSE of 0.1; roots of 3 and 5 times 0.01";
    EXPECT_THAT(table, HasSubstr("0.0400 [0.0360, 0.0440]")) << "the flicker of method one";
    expect_no_error();
}

TEST_F(PageInBrowser, ChartsTheParetoFrontSweepsAndOraclesAndIsWalkedByKeys) {
    browser().open(page());
    browser().choose("#chart-controls label:nth-of-type(2) select", "cornell / front");
    const std::string sets = "Chart.getChart('chart').data.datasets";
    // By hand: `sao` at 1.6, 3.2 and 6.4 ms has 0.15, 0.075 and 0.0375; one (2 ms, 0.1) and two (4 ms, 0.05) lie
    // between, each better than what is faster.
    EXPECT_EQ(
        browser().text(
            sets + ".find((set) => set.label.startsWith('Pareto')).data.map((point) => point.y.toFixed(4)).join(' ')"),
        "0.1500 0.1000 0.0750 0.0500 0.0375");
    EXPECT_EQ(browser().text(sets + ".find((set) => set.label === 'sao').showLine"), "true");
    EXPECT_EQ(
        browser().text(sets + ".find((set) => set.label === 'oracle, 1 layer').data.map((point) => point.y).join(' ')"),
        "0.01 0.01");
    browser().run("document.getElementById('chart').focus()");
    browser().press("ArrowRight");
    EXPECT_EQ(browser().text("document.getElementById('chart-spoken').textContent"),
              "sao, ao.samples = 2: cornell / front, RMSE 0.150 [0.135, 0.165], 1.60 ms");
    // Half way between 2 and 4 ms in logarithms the path tracer's error is 0.2 / sqrt(2 sqrt(2)) = 0.119; here 2 ms:
    // 0.141.
    EXPECT_THAT(browser().text("[...document.querySelectorAll('#equal-cost tbody tr')].map((row) => "
                               "[...row.cells].map((cell) => cell.textContent).join(' ')).join('; ')"),
                testing::AllOf(HasSubstr("one 0.100 2.00 0.141 4.00"), HasSubstr("two 0.0500 4.00 0.100 above 8.00")));
    browser().choose("#chart-controls label:nth-of-type(3) select", "RMSE of silhouettes");
    EXPECT_EQ(browser().text(sets + ".find((set) => set.label === 'one').data[0].y"), "0.2");
    expect_no_error();
}

TEST_F(PageInBrowser, APointOfTheChartUnderThePointerTellsItsValues) {
    browser().open(page());
    browser().choose("#chart-controls label:nth-of-type(2) select", "cornell / front");
    const std::string chart = "Chart.getChart('chart')";
    const std::string point = "(() => { const chart = " + chart +
                              "; return chart.getDatasetMeta(chart.data.datasets.findIndex((set) => set.label === "
                              "'two')).data[0]; })()";
    EXPECT_EQ(browser().number(chart + ".tooltip.opacity"), 0.0);
    browser().move_to("#chart", browser().number(point + ".x / " + chart + ".width"),
                      browser().number(point + ".y / " + chart + ".height"));
    browser().wait_for(chart + ".tooltip.opacity > 0");
    EXPECT_EQ(browser().text(chart + ".tooltip.body.map((entry) => entry.lines.join(', ')).join('; ')"),
              "two: cornell / front, RMSE 0.0500 [0.0450, 0.0550], 4.00 ms");
    browser().move_to("#table");
    browser().wait_for(chart + ".tooltip.opacity === 0");
    expect_no_error();
}

TEST_F(PageInBrowser, LegendsTellWhatTheColoursOfErrorsMean) {
    browser().open(page());
    const std::string legend = "document.getElementById('picture-legend')", ramp = ".querySelector('.ramp')";
    const auto ends = [&](const std::string& of) {
        return browser().text("[..." + of +
                              ".querySelectorAll('.ends span')].map((end) => end.textContent).join(', ')");
    };
    EXPECT_EQ(ends(legend), "0, 0.200, 0.400 and more");
    EXPECT_THAT(browser().text(legend + ".textContent"),
                testing::AllOf(HasSubstr("Error: |difference|, averaged over channels"),
                               HasSubstr("exposure 0.5 stops"), HasSubstr("Magenta is no number")));
    const std::string dark_to_bright = browser().text(legend + ramp + ".style.background");
    EXPECT_THAT(dark_to_bright, StartsWith("linear-gradient(to right, rgb("));

    browser().choose("#picture-looks label:nth-of-type(2) select", "signed");
    // Colours change with the next frame of the screen.
    const auto wait_for_ends = [&](const std::string& wanted) {
        browser().wait_for("[..." + legend +
                           ".querySelectorAll('.ends span')].map((end) => end.textContent).join(', ') "
                           "=== '" +
                           wanted + "'");
    };
    wait_for_ends("-0.400, 0, 0.400 and more");
    EXPECT_THAT(browser().text(legend + ".textContent"), HasSubstr("method minus truth"));
    EXPECT_NE(browser().text(legend + ramp + ".style.background"), dark_to_bright);
    browser().run("document.querySelector('#picture-looks label:nth-of-type(3) input').focus()");
    for (int i = 0; i < 2; ++i) browser().press("ArrowRight");  // each half a stop
    wait_for_ends("-0.800, 0, 0.800 and more");

    const std::string of_path = "document.getElementById('path-legend')";
    EXPECT_EQ(browser().text(of_path + ramp + ".style.background"), dark_to_bright);
    EXPECT_EQ(ends(of_path), browser().text("'0, ' + short(data.paths[0].error_scale / 2) + ', ' + "
                                            "short(data.paths[0].error_scale) + ' and more'"));
    expect_no_error();
}

TEST_F(PageInBrowser, PicturesSideBySideComeAndGoByKeyAndButton) {
    browser().open(page());
    const auto shown = [] {
        return browser().text(
            "[...document.querySelectorAll('#pictures figure figcaption')].map((caption) => "
            "caption.firstChild.textContent.trim()).join(', ')");
    };
    const std::string second = "#picture-buttons button:nth-of-type(2)";
    EXPECT_EQ(shown(), "truth, one, two, one: error, two: error");
    browser().move_to("#pictures canvas");
    browser().press("2");
    EXPECT_EQ(shown(), "truth, two, one: error, two: error");
    EXPECT_EQ(browser().text("document.querySelector('" + second + "').ariaPressed"), "false");
    browser().click(second);
    EXPECT_EQ(shown(), "truth, one, two, one: error, two: error");
    EXPECT_EQ(browser().text("document.querySelector('" + second + "').ariaPressed"), "true");
    for (const char* key : {"3", "4", "5"}) browser().press(key);
    EXPECT_EQ(shown(), "truth, one");
    expect_no_error();
}

// The curve of IEC 61966-2-1.
double srgb_level(double value) {
    const double bounded = std::min(value, 1.0);
    return 255.0 * (bounded <= 0.0031308 ? 12.92 * bounded : 1.055 * std::pow(bounded, 1.0 / 2.4) - 0.055);
}

TEST_F(PageInBrowser, ExposureIsInStopsBeforeTheSrgbCurve) {
    browser().open(page());
    show_alone("1");
    browser().run("document.querySelector('#picture-looks input').focus()");
    double stops = 0.5;                    // of the set
    for (const int presses : {0, 6, 3}) {  // each a quarter stop less
        for (int i = 0; i < presses; ++i) browser().press("ArrowLeft");
        stops -= 0.25 * presses;
        std::istringstream levels(colour_at_place("#pictures canvas", 12.5 / sample_width, 9.5 / sample_height));
        for (int c = 0; c < 3; ++c) {
            double level = 0.0;
            levels >> level;
            // A level of rounding, and 0.1 % of the packed plane.
            EXPECT_NEAR(level, srgb_level(sample_truth().at(12, 9, c) * std::exp2(stops)), 1.3)
                << stops << " stops, channel " << c;
        }
    }
    expect_no_error();
}

TEST_F(PageInBrowser, ShowsTheValuesUnderThePointer) {
    browser().open(page());
    const auto from_exr = [](const std::string& name, const Image& image) {
        const auto file = folder_->path / fmt::format("{}.exr", name);
        Frame frame(image.width(), image.height());
        frame.set("total", image);
        write_exr(file, frame);
        return read_exr(file).plane("total");
    };
    const Image truth = from_exr("truth", sample_truth()), one = from_exr("one", sample_image("one"));
    for (const auto& [x, y] : {std::pair(0, 0), std::pair(13, 7), std::pair(31, 17)}) {
        browser().move_to("#pictures canvas", (x + 0.5) / sample_width, (y + 0.5) / sample_height);
        for (int row = 0; row < 2; ++row) {
            std::istringstream words(value_row(row));
            std::string name, value;
            words >> name;
            for (int c = 0; c < 3; ++c) {
                words >> value;
                const float expected = (row == 0 ? truth : one).at(x, y, c);
                if (std::isnan(expected)) {
                    EXPECT_EQ(value, "NaN") << name << " at " << x << ", " << y;
                    continue;
                }
                // 0.1 % of the packed plane, 0.5 % of three digits.
                EXPECT_NEAR(std::stod(value), expected, 0.006 * expected)
                    << name << " at " << x << ", " << y << ", channel " << c;
            }
        }
    }
    // Half of the truth, averaged over channels.
    EXPECT_NEAR(std::stod(value_row(3).substr(std::string("one: error ").size())),
                0.5 * (truth.at(31, 17, 0) + truth.at(31, 17, 1) + truth.at(31, 17, 2)) / 3, 0.01);
    expect_no_error();
}

TEST_F(PageInBrowser, FlipsByNumberKeysInPlace) {
    browser().open(page());
    show_alone("1");
    const std::string truth = colour_at_place("#pictures canvas", 0.3, 0.3);
    show_alone("2");
    const std::string one = colour_at_place("#pictures canvas", 0.3, 0.3);
    EXPECT_NE(truth, one);
    EXPECT_EQ(browser().text("document.querySelector('#picture-buttons button[aria-pressed=\"true\"]').textContent"),
              "2 one");
    show_alone("1");
    EXPECT_EQ(colour_at_place("#pictures canvas", 0.3, 0.3), truth);
    expect_no_error();
}

TEST_F(PageInBrowser, DrawsWhatThePictureFilesShow) {
    browser().open(page());
    const Image truth = sample_truth();
    show_alone("1");
    browser().run("document.querySelector('#picture-pixel input').value = 0");
    const auto expected = [&](int x, int y) {
        const Image picture = picture_of_radiance(truth, 0.5f);
        std::string text;
        for (int c = 0; c < 3; ++c)
            text += (c == 0 ? "" : " ") + std::to_string(std::lround(255 * picture.at(x, y, c)));
        return text;
    };
    for (const auto& [x, y] : {std::pair(3, 2), std::pair(20, 12)}) {
        EXPECT_EQ(colour_at_place("#pictures canvas", (x + 0.5) / sample_width, (y + 0.5) / sample_height),
                  expected(x, y))
            << "at " << x << ", " << y << "; one level of 255 is 0.4 % and more, the packed plane's precision 0.1 %";
    }
    // Method two is 0.01 brighter; of a scale of 0.4 that is 1/40 of the colour map, whatever the packing rounds.
    show_alone("5");
    const auto colour = colour_at(ColourMap::inferno, 0.01f / 0.4f);
    std::istringstream seen(colour_at_place("#pictures canvas", 0.51, 0.51));
    for (const float level : colour) {
        int value = 0;
        seen >> value;
        // 3 of 255: 0.1 % of values up to 1 is 10 % of the difference, whose slope on the map is below 0.4 levels.
        EXPECT_NEAR(value, 255 * level, 3);
    }
    expect_no_error();
}

TEST_F(PageInBrowser, ZoomsAndMovesAllPicturesTogether) {
    browser().open(page());
    browser().click("#pictures canvas", 0.25, 0.25);
    browser().turn_wheel("#pictures canvas", 0.25, 0.25, -480);  // twice twofold
    browser().move_to("#pictures figure:nth-of-type(2) canvas", 0.77, 0.77);
    // The place (0.25, 0.25) stayed; 0.52 of the canvas is 0.13 of the picture now: (0.38 * 32, 0.38 * 18).
    EXPECT_EQ(
        browser().text("[...document.querySelectorAll('#picture-pixel input')].map((box) => box.value).join(' ')"),
        "12 6");
    browser().drag("#pictures canvas", {0.2, 0.5}, {0.7, 0.5});  // an eighth of the picture to the right
    browser().move_to("#pictures figure:nth-of-type(3) canvas", 0.77, 0.77);
    EXPECT_EQ(browser().text("document.querySelector('#picture-pixel input').value"), "8");
    browser().press("0");
    browser().move_to("#pictures canvas", 0.77, 0.77);
    EXPECT_EQ(browser().text("document.querySelector('#picture-pixel input').value"), "24");
    browser().press("ArrowRight", true);
    EXPECT_EQ(browser().text("document.querySelector('#picture-pixel input').value"), "25");
    expect_no_error();
}

TEST_F(PageInBrowser, ExposureAndSliderChangeWhatIsSeen) {
    browser().open(page());
    show_alone("1");
    const std::string before = colour_at_place("#pictures canvas", 0.3, 0.3);
    browser().run("document.querySelector('#picture-looks input').focus()");
    for (int i = 0; i < 4; ++i) browser().press("ArrowLeft");  // each a quarter stop
    EXPECT_EQ(browser().text("document.querySelector('#picture-looks output').textContent"), "\u22121.00 stops");
    EXPECT_NE(colour_at_place("#pictures canvas", 0.3, 0.3), before);
    browser().run(
        "const box = document.querySelector('#picture-looks input'); box.value = 0; box.dispatchEvent(new "
        "Event('input'))");

    browser().choose("#picture-controls label:nth-of-type(4) select", "slider");
    EXPECT_EQ(colour_at_place("#pictures canvas", 0.3, 0.3), before) << "left: the truth";
    browser().drag("#pictures canvas", {0.5, 0.6}, {0.1, 0.6});
    EXPECT_NE(colour_at_place("#pictures canvas", 0.3, 0.3), before) << "now right of the line: method one";
    expect_no_error();
}

TEST_F(PageInBrowser, ScrubsAndPlaysCameraPathsInStep) {
    browser().open(page());
    const std::string truth = "#path-pictures figure:nth-of-type(1) canvas",
                      one = "#path-pictures figure:nth-of-type(2) canvas";
    // ao is shown as it is: 0.2 per frame, 255 levels. 4 levels for JPEG at quality 88, which is not exact.
    const auto level = [&](const std::string& canvas) { return std::stod(colour_at_place(canvas, 0.5, 0.5)); };
    EXPECT_NEAR(level(truth), 0, 4);
    browser().run("document.querySelector('#path-player input').focus()");
    for (int i = 0; i < 3; ++i) browser().press("ArrowRight");
    EXPECT_NEAR(level(truth), 0.6 * 255, 4);
    EXPECT_NEAR(level(one), 0.7 * 255, 4);
    EXPECT_EQ(browser().text("document.querySelector('#path-player output').textContent"), "4 of 5, 0.30 s");
    EXPECT_THAT(browser().text("document.querySelector('#path-pictures figure:nth-of-type(2)').textContent"),
                HasSubstr("flicker 0.300"));
    EXPECT_NEAR(browser().number("Chart.getChart('path-chart').options.plugins.frameLine.time"), 0.3, 1e-9);
    EXPECT_EQ(browser().text("Chart.getChart('path-chart').data.datasets.map((set) => set.label + ' ' + "
                             "set.data[2].y.toFixed(2)).join(', ')"),
              "one 0.20, two 0.04");
    browser().click("#path-chart", 0.5, 0.5);
    // Chart.js answers a click with the next frame of the screen.
    browser().wait_for("document.querySelector('#path-player output').textContent === '3 of 5, 0.20 s'");
    browser().click("#path-player button");
    browser().wait_for("document.querySelector('#path-player input').value === '4'");
    browser().wait_for("document.querySelector('#path-player input').value === '1'");  // and again from the first
    browser().click("#path-player button");
    expect_no_error();
}

TEST_F(PageInBrowser, DrawsTheWaterfall) {
    browser().open(page());
    EXPECT_EQ(browser().text("JSON.stringify(Chart.getChart('waterfall').data.datasets[0].data)"),
              "[[0,0.03],[0.03,0.06],[0.06,0.05]]");
    EXPECT_THAT(browser().text("document.querySelector('#waterfall-table tbody').textContent"),
                HasSubstr("layers+0.0300 [0.0200, 0.0400]"));
    expect_no_error();
}

TEST_F(PageInBrowser, FitsAPhoneAndZoomsWithTwoFingers) {
    Screen phone;
    phone.width = 390, phone.height = 844, phone.touch = true;
    browser().open(page(), phone);
    EXPECT_LE(browser().number("document.documentElement.scrollWidth"), 390) << "the page would scroll sideways";
    const std::string wide = browser().text(
        "[...document.querySelectorAll('main *')].filter((node) => !node.closest('.scroll') && "
        "node.getBoundingClientRect().right > 391).map((node) => node.tagName + '#' + node.id).join(' ')");
    EXPECT_EQ(wide, "") << "elements that reach beyond the screen";
    browser().pinch("#pictures canvas", 0.2, 0.8);  // fourfold
    EXPECT_TRUE(browser().truth("document.getElementById('pictures').classList.contains('zoomed')"));
    EXPECT_DOUBLE_EQ(browser().number("window.visualViewport.scale"), 1.0) << "the page itself must not zoom";
    expect_no_error();
}

TEST_F(PageInBrowser, EveryControlHasANameAndTheFocusIsSeen) {
    browser().open(page());
    EXPECT_EQ(browser().text("[...document.querySelectorAll('button, select, input')].filter((node) => "
                             "!(node.ariaLabel || node.textContent || node.closest('label')?.textContent)).length"),
              "0");
    EXPECT_EQ(browser().text("[...document.querySelectorAll('canvas[tabindex], canvas[role]')].filter((node) => "
                             "!node.ariaLabel).length"),
              "0");
    browser().run("document.querySelector('#chart-controls select').focus()");
    browser().press("Tab");
    EXPECT_NE(browser().text("getComputedStyle(document.activeElement).outlineStyle"), "none");
    expect_no_error();
}

}  // namespace
}  // namespace plumb
