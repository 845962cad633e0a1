#include "experiments/progress_line.h"

#include <memory>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumb {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

// A line whose clock goes as the test wants it, written to a file of its own.
class Progress : public testing::Test {
protected:
    std::unique_ptr<ProgressLine> line(bool terminal) {
        return std::make_unique<ProgressLine>(ProgressOutput{file_.get(), terminal, [this] { return now_; }});
    }
    void wait(milliseconds time) { now_ += time; }
    // What was written since the last call.
    std::string written() {
        std::string text;
        std::fseek(file_.get(), read_, SEEK_SET);
        for (int letter = std::fgetc(file_.get()); letter != EOF; letter = std::fgetc(file_.get()))
            text.push_back(static_cast<char>(letter));
        read_ = std::ftell(file_.get());
        return text;
    }

private:
    struct Close {
        void operator()(std::FILE* file) const { std::fclose(file); }
    };
    std::unique_ptr<std::FILE, Close> file_{std::tmpfile()};
    long read_ = 0;
    std::chrono::steady_clock::time_point now_{};
};

TEST_F(Progress, OnATerminalOneLineRewritesItselfAndGoesAway) {
    const auto progress = line(true);
    progress->show(0.25, "first");
    EXPECT_EQ(written(), "\r\x1b[K[######                  ]  25 %  first") << "without the end of a line";
    wait(milliseconds(50));
    progress->show(0.3, "too soon to be read");
    EXPECT_EQ(written(), "");
    wait(milliseconds(50));
    progress->show(0.5, "second");
    EXPECT_THAT(written(), AllOf(testing::StartsWith("\r\x1b[K[############  "), HasSubstr("50 %  second")));
    progress->log("a word that stays");
    EXPECT_EQ(written(), "\r\x1b[Ka word that stays\n");
    progress->clear();
    EXPECT_EQ(written(), "") << "there is no line to take away";
}

TEST_F(Progress, ElsewhereItIsAPlainLineEveryFiveSeconds) {
    const auto progress = line(false);
    progress->show(0.0, "a short job says nothing");
    wait(milliseconds(4900));
    progress->show(0.1, "not yet");
    EXPECT_EQ(written(), "");
    wait(milliseconds(100));
    progress->show(0.2, "now");
    EXPECT_THAT(written(), AllOf(testing::StartsWith(" 20 %  "), testing::EndsWith("now\n"), Not(HasSubstr("\r")),
                                 Not(HasSubstr("\x1b"))));
    wait(seconds(1));
    progress->show(0.3, "too soon");
    progress->clear();
    EXPECT_EQ(written(), "");
}

TEST_F(Progress, TellsTheTimeThatIsLeftByWhatIsDone) {
    const auto progress = line(true);
    wait(seconds(2));
    progress->show(0.5, "half");
    EXPECT_THAT(written(), Not(HasSubstr("left"))) << "so early an estimate would jump about";
    wait(seconds(8));
    progress->show(0.2, "a fifth in 10 s");
    EXPECT_THAT(written(), HasSubstr("40 s left"));
    wait(seconds(590));
    progress->show(0.5, "half in 600 s");
    EXPECT_THAT(written(), HasSubstr("10 min left"));
    wait(seconds(2400));
    progress->show(0.25, "a quarter in 3000 s");
    EXPECT_THAT(written(), HasSubstr("2.5 h left"));
    wait(seconds(1));
    progress->show(0.005, "hardly anything");
    EXPECT_THAT(written(), Not(HasSubstr("left")));
}

}  // namespace
}  // namespace plumb
