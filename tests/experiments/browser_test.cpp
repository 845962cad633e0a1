// The report page in a real browser: it draws, and says so, without a script error.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "experiments/page.h"
#include "experiments/summary.h"
#include "frames/atomic_file.h"
#include "frames/picture.h"
#include "tests/experiments/program.h"
#include "tests/experiments/sample_results.h"
#include "tests/experiments/temporary_folder.h"

namespace plumb {
namespace {

using testing::HasSubstr;
using testing::Not;

std::string browser() {
    for (const char* name : {"chromium", "chromium-browser", "google-chrome"}) {
        if (run_shell(std::string("command -v ") + name).exit_code == 0) return name;
    }
    return "";
}

// The document as it stands after its script has run.
std::string document_of(const std::filesystem::path& page, const std::filesystem::path& profile) {
    const std::string command =
        browser() + " --headless --no-sandbox --disable-gpu --disable-dev-shm-usage --user-data-dir='" +
        profile.string() + "' --virtual-time-budget=5000 --dump-dom 'file://" + page.string() + "' 2>/dev/null";
    return run_shell("timeout 120 " + command).output;
}

// What the script drew, without the data and the libraries that the file itself contains.
std::string drawn_part(const std::string& document) {
    return document.substr(0, document.find("<script type=\"application/json\""));
}

class PageInBrowser : public testing::Test {
protected:
    void SetUp() override {
        if (browser().empty()) GTEST_SKIP() << "no Chromium here (Debian package chromium)";
    }
    std::string load(const RunResults& results) {
        const auto page = folder_.path / "index.html";
        write_text_atomically(page, print_page(results, folder_.path));
        return document_of(page, folder_.path / "profile");
    }
    TemporaryFolder folder_;
};

TEST_F(PageInBrowser, DrawsTableChartAndPicturesWithoutAnError) {
    write_png(folder_.path / "pictures/a.png", Image(4, 4, 3, 0.5f));
    RunResults results = sample_results();
    PictureSet set;
    set.scene = "cornell", set.view = "front", set.plane = "ao";
    set.images = {{"truth", "truth", "pictures/a.png", "64 samples"}, {"one", "error", "pictures/a.png", ""}};
    results.pictures = {set};
    results.rows[0].measured = false, results.rows[0].refusal = "4096 samples would do";
    ResultRow curve = sample_row("front", "path tracer, 4 spp", 0.2, 50.0);
    curve.path_tracer_samples = 4;
    results.rows.push_back(curve);
    results.failures = {{"cornell / front / <b>", "went wrong"}};
    results.summary = summarise(results);

    const std::string document = load(results), drawn = drawn_part(document);
    EXPECT_THAT(document, HasSubstr("data-ready=\"true\"")) << "the script did not come to its end";
    EXPECT_THAT(drawn, HasSubstr("<pre id=\"script-errors\" class=\"warning\" hidden=\"\"></pre>"))
        << "a script error is shown";
    EXPECT_THAT(drawn, HasSubstr("4096 samples would do"));
    EXPECT_THAT(drawn, HasSubstr("times"));
    EXPECT_THAT(drawn, HasSubstr("cornell / front / &lt;b&gt;: went wrong"));
    EXPECT_THAT(drawn, HasSubstr("[0.0450, 0.0550]")) << "the 95 % interval of method two";
    EXPECT_THAT(drawn, HasSubstr("<img src=\"data:image/png;base64,"));
    EXPECT_THAT(drawn, HasSubstr("<canvas id=\"chart\""));
}

TEST_F(PageInBrowser, DrawsARunInWhichEverythingFailed) {
    RunResults results = sample_results();
    results.rows.clear();
    results.failures = {{"cornell", "no such scene"}};
    const std::string document = load(results);
    EXPECT_THAT(document, HasSubstr("data-ready=\"true\""));
    EXPECT_THAT(drawn_part(document), HasSubstr("class=\"warning\" hidden=\"\"></pre>"));
}

TEST_F(PageInBrowser, AScriptErrorWouldBeSeen) {
    // The page is made to fail, which proves that the tests above can.
    const auto page = folder_.path / "index.html";
    std::string text = print_page(sample_results(), folder_.path);
    const std::string call = "\ndrawTable();";
    text.replace(text.rfind(call), call.size(), "\nnoSuchFunction();");
    write_text_atomically(page, text);
    const std::string document = document_of(page, folder_.path / "profile");
    EXPECT_THAT(document, Not(HasSubstr("data-ready=\"true\"")));
    EXPECT_THAT(drawn_part(document), HasSubstr("noSuchFunction is not defined"));
}

}  // namespace
}  // namespace plumb
