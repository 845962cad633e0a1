#include "experiments/page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "experiments/page_data.h"
#include "frames/image_error.h"
#include "tests/experiments/page_sample.h"
#include "tests/temporary_folder.h"

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

TEST(Page, ContainsEachPlaneOnce) {
    const TemporaryFolder folder;
    RunResults results = sample_results();
    PictureSet other = sample_pictures(folder.path);
    other.truth = "within 1 m";  // another truth for the same methods
    results.pictures = {sample_pictures(folder.path), other};
    const std::string page = print_page(results, folder.path);
    EXPECT_THAT(page,
                AllOf(HasSubstr("id=\"values-0\""), HasSubstr("id=\"values-2\""), Not(HasSubstr("id=\"values-3\""))));
}

TEST(Page, LeavesOffPicturesThatWouldMakeItTooLargeAndSaysSo) {
    const TemporaryFolder folder;
    RunResults results = sample_results();
    results.pictures = {sample_pictures(folder.path, "front"), sample_pictures(folder.path, "left")};
    std::filesystem::resize_file(folder.path / "pictures/front.one.plane",
                                 most_picture_bytes);  // a hole: no disk is used
    const PageData data = page_data(results, folder.path);
    EXPECT_THAT(data.json, HasSubstr("1 of 2 sets of pictures are left off"));
    EXPECT_THAT(data.planes, testing::ElementsAre("pictures/left.truth.plane", "pictures/left.one.plane",
                                                  "pictures/left.two.plane"));
}

TEST(Page, NamesThePictureThatIsMissing) {
    const TemporaryFolder folder;
    RunResults results = sample_results();
    results.pictures = {sample_pictures(folder.path)};
    std::filesystem::remove(folder.path / "pictures/front.one.plane");
    EXPECT_THAT([&] { print_page(results, folder.path); },
                testing::ThrowsMessage<ImageError>(HasSubstr("front.one.plane")));
    results.pictures[0].images[0].values = "";
    EXPECT_THAT([&] { print_page(results, folder.path); },
                testing::ThrowsMessage<ImageError>(HasSubstr("'pictures/front.truth.png' has no packed plane")));
}

}  // namespace
}  // namespace plumb
