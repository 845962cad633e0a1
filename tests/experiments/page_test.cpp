#include "experiments/page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "frames/picture.h"
#include "tests/experiments/sample_results.h"
#include "tests/experiments/temporary_folder.h"

namespace plumb {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

TEST(Page, TextIsEscaped) {
    EXPECT_EQ(escape_html("<a & \"b\" 'c'>"), "&lt;a &amp; &quot;b&quot; &#39;c&#39;&gt;");
    EXPECT_EQ(escape_for_script("[\"</script><!--\"]"), "[\"\\u003c/script>\\u003c!--\"]");
}

TEST(Page, ContainsTheResultsAndNothingFromOutside) {
    const TemporaryFolder folder;
    RunResults results = sample_results();
    results.summary = {"a sentence with </script> in it"};
    const std::string page = print_page(results, folder.path);
    EXPECT_THAT(page, AllOf(HasSubstr("<title>A &lt;sample&gt; &amp; more"),
                            HasSubstr("a sentence with \\u003c/script>"), HasSubstr("Chart.js v")));
    EXPECT_THAT(page, AllOf(Not(HasSubstr("{{")), Not(HasSubstr("src=\"http")), Not(HasSubstr("href=\"http"))))
        << "left-over or network";
}

TEST(Page, ContainsEachPictureOnce) {
    const TemporaryFolder folder;
    write_png(folder.path / "pictures/a.png", Image(2, 2, 3, 0.5f));
    RunResults results = sample_results();
    PictureSet set;
    set.scene = "cornell", set.view = "front", set.plane = "ao";
    set.images = {{"truth", "truth", "pictures/a.png", ""}, {"one", "method", "pictures/a.png", ""}};
    results.pictures = {set};
    const std::string page = print_page(results, folder.path);
    const auto first = page.find("data:image/png;base64,iVBORw0KGgo");
    ASSERT_NE(first, std::string::npos);
    EXPECT_EQ(page.find("data:image/png;base64,iVBORw0KGgo", first + 1), std::string::npos);
}

}  // namespace
}  // namespace plumb
