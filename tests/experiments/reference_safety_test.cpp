// `plumbline reference` does not lose work: signals, full disks, unwritable folders, vanished files.
#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "frames/exr.h"
#include "tests/experiments/program.h"
#include "tests/file_size_limit.h"
#include "tests/temporary_folder.h"

namespace plumb {
namespace {

using testing::AllOf;
using testing::HasSubstr;

// So many that no machine is done before it is interrupted.
constexpr const char* endless = "16777216";

std::string bytes_of(const std::filesystem::path& file) {
    std::ostringstream bytes;
    bytes << std::ifstream(file, std::ios::binary).rdbuf();
    return bytes.str();
}

class ReferenceSafety : public testing::Test {
protected:
    std::filesystem::path output() const { return folder_.path / "out"; }
    std::filesystem::path frame_file() const { return output() / "cornell.front.reference.exr"; }
    std::vector<std::string> command(const std::string& samples, const std::string& seed = "1") const {
        return {"reference", "cornell", "--size", "64", "36",       "--planes",       "ao",
                "--samples", samples,   "--seed", seed, "--output", output().string()};
    }
    // All files with their contents: what must not change.
    std::map<std::string, std::string> files() const {
        std::map<std::string, std::string> found;
        for (const auto& entry : std::filesystem::directory_iterator(output()))
            found[entry.path().filename().string()] = bytes_of(entry.path());
        return found;
    }
    std::filesystem::path checkpoint() const {
        for (const auto& entry : std::filesystem::directory_iterator(output())) {
            if (entry.path().extension() == ".partial") return entry.path();
        }
        ADD_FAILURE() << "there is no checkpoint";
        return {};
    }
    // With files of at most so many kilobytes: what a full disk does, without the rights to make one.
    static ProgramRun run_with_limit(int kilobytes, const std::vector<std::string>& arguments) {
        return run_shell("ulimit -f " + std::to_string(2 * kilobytes) + " && " + quoted_command(arguments));
    }

    TemporaryFolder folder_;
};

TEST_F(ReferenceSafety, ARunThatWasInterruptedEndsWithTheBitsOfOneThatWasNot) {
    // More samples than the first pass has, after which the signal is looked at.
    const std::string samples = "256";
    const std::vector<std::string> planes = {"--planes", "ao,direct,indirect,indirect.2,total,depth", "--bounces", "2"};
    std::vector<std::string> arguments = command(samples);
    arguments.insert(arguments.end(), planes.begin(), planes.end());
    arguments.erase(arguments.begin() + 5, arguments.begin() + 7);  // --planes ao
    ASSERT_EQ(run_plumbline(arguments).exit_code, 0);
    const Frame whole = read_exr(frame_file());
    std::filesystem::remove(frame_file());

    const ProgramRun stopped = signal_plumbline(arguments, SIGTERM);
    ASSERT_EQ(stopped.exit_code, 130) << stopped.output;
    EXPECT_FALSE(std::filesystem::exists(frame_file()));
    const std::filesystem::path partial = checkpoint();
    const ProgramRun resumed = run_plumbline(arguments);
    ASSERT_EQ(resumed.exit_code, 0) << resumed.output;
    EXPECT_THAT(resumed.output, HasSubstr("256 samples per pixel"));
    EXPECT_FALSE(std::filesystem::exists(partial)) << "the checkpoint of a run that has ended";

    const Frame frame = read_exr(frame_file());
    ASSERT_EQ(frame.plane_names(), whole.plane_names());
    for (const std::string& plane : whole.plane_names()) {
        const auto a = std::as_bytes(whole.plane(plane).values()), b = std::as_bytes(frame.plane(plane).values());
        EXPECT_TRUE(std::ranges::equal(a, b)) << plane;
    }
    EXPECT_EQ(frame.facts.at("rays"), whole.facts.at("rays"));
}

TEST_F(ReferenceSafety, ADamagedCheckpointIsRefusedAndStays) {
    const std::string samples = "256";
    ASSERT_EQ(signal_plumbline(command(samples), SIGTERM).exit_code, 130);
    const std::filesystem::path partial = checkpoint();
    const std::string good = bytes_of(partial);
    std::string damaged = good;
    damaged[good.size() / 2] ^= 0x10;
    const std::string cut = good.substr(0, good.size() - 9), foreign = "no checkpoint at all";
    for (const auto& [bytes, reason] : {std::pair{damaged, "is damaged"}, std::pair{cut, "is cut off"},
                                        std::pair{foreign, "is not a checkpoint of a reference"}}) {
        std::ofstream(partial, std::ios::binary) << bytes;
        const auto before = files();
        const ProgramRun refused = run_plumbline(command(samples));
        EXPECT_EQ(refused.exit_code, 2) << refused.output;
        EXPECT_THAT(refused.output, AllOf(HasSubstr(partial.string()), HasSubstr(reason), HasSubstr("remove it")));
        EXPECT_TRUE(files() == before) << "files changed, vanished or were left behind";
    }
    std::filesystem::remove(partial);
    EXPECT_EQ(run_plumbline(command(samples)).exit_code, 0);
}

class Signals : public ReferenceSafety, public testing::WithParamInterface<int> {};

TEST_P(Signals, LeaveACheckpointThatTheSameCommandResumes) {
    const auto samples = [](const std::string& text) { return std::stol(text.substr(text.find("after ") + 6)); };
    const ProgramRun first = signal_plumbline(command(endless), GetParam());
    EXPECT_EQ(first.exit_code, 130) << first.output;
    ASSERT_THAT(first.output, AllOf(HasSubstr("the same command resumes"), HasSubstr(checkpoint().string())));
    const ProgramRun second = signal_plumbline(command(endless), GetParam());
    EXPECT_EQ(second.exit_code, 130) << second.output;
    ASSERT_THAT(second.output, HasSubstr("the same command resumes"));
    EXPECT_GT(samples(second.output), samples(first.output));
}

TEST_P(Signals, LeaveACheckpointOfAShardToo) {
    const ProgramRun stopped = signal_plumbline(command(std::string("8..") + endless), GetParam());
    EXPECT_EQ(stopped.exit_code, 130) << stopped.output;
    EXPECT_THAT(stopped.output, HasSubstr(checkpoint().string()));
    EXPECT_FALSE(std::filesystem::exists(output() / (std::string("cornell_front.8-") + endless + ".shard")));
}

INSTANTIATE_TEST_SUITE_P(Of, Signals, testing::Values(SIGINT, SIGTERM));

TEST_F(ReferenceSafety, AFileThatCannotGrowLeavesTheLastGoodFrameAndNoRest) {
    ASSERT_EQ(run_plumbline(command("4")).exit_code, 0);
    const auto good = files();
    const ProgramRun full = run_with_limit(4, command("4", "2"));
    EXPECT_EQ(full.exit_code, 2) << full.output;
    EXPECT_THAT(full.output, AllOf(HasSubstr(frame_file().string()), HasSubstr("cannot write")));
    EXPECT_TRUE(files() == good) << "files changed, vanished or were left behind";
}

TEST_F(ReferenceSafety, AShardThatCannotGrowLeavesTheOneBefore) {
    ASSERT_EQ(run_plumbline(command("0..4")).exit_code, 0);
    const auto good = files();
    const ProgramRun full = run_with_limit(4, command("0..4", "2"));
    EXPECT_EQ(full.exit_code, 2) << full.output;
    EXPECT_THAT(full.output, AllOf(HasSubstr("cornell_front.0-4.shard"), HasSubstr("File too large")));
    EXPECT_TRUE(files() == good) << "files changed, vanished or were left behind";
}

TEST_F(ReferenceSafety, ACheckpointThatCannotGrowLeavesTheOneBefore) {
    ASSERT_EQ(signal_plumbline(command(endless), SIGINT).exit_code, 130);
    const auto good = files();
    ProgramRun full;
    {
        const FileSizeLimit limit(4096);
        full = signal_plumbline(command(endless), SIGINT);
    }
    EXPECT_EQ(full.exit_code, 2) << full.output;
    EXPECT_THAT(full.output,
                AllOf(HasSubstr(checkpoint().string()), HasSubstr("File too large"), HasSubstr("choose another path")));
    EXPECT_TRUE(files() == good) << "files changed, vanished or were left behind";
    const ProgramRun resumed = signal_plumbline(command(endless), SIGINT);
    EXPECT_THAT(resumed.output, HasSubstr("the same command resumes"));
}

TEST_F(ReferenceSafety, AFullDiskLeavesTheLastGoodFrame) {
    // A disk of its own, in a namespace of its own, filled to the last block.
    const std::string disk = (folder_.path / "disk").string();
    std::filesystem::create_directory(disk);
    const std::string mount = "mount -t tmpfs -o size=1m none '" + disk + "'";
    if (run_shell("unshare --user --map-root-user --mount sh -c \"" + mount + "\"").exit_code != 0)
        GTEST_SKIP() << "no rights to mount a small disk here";
    std::vector<std::string> arguments = command("4");
    arguments.back() = disk + "/out";
    std::ofstream(folder_.path / "good.sh") << quoted_command(arguments);
    arguments[10] = "2";  // another seed
    std::ofstream(folder_.path / "full.sh") << quoted_command(arguments);
    std::ofstream(folder_.path / "script.sh")
        << "set -e\n"
        << mount << "\ncd '" << disk << "'\nsh ../good.sh >/dev/null\n"
        << "cp -r out ../before\ncat /dev/zero > rest 2>/dev/null || true\n"
        << "code=0; sh ../full.sh || code=$?\necho exit code $code\ndiff -r out ../before && echo unchanged\n";
    const ProgramRun run =
        run_shell("unshare --user --map-root-user --mount sh '" + (folder_.path / "script.sh").string() + "'");
    EXPECT_THAT(run.output,
                AllOf(HasSubstr("No space left on device"), HasSubstr("exit code 2"), HasSubstr("unchanged")));
}

TEST_F(ReferenceSafety, AFolderThatCannotBeWrittenIsRefusedBeforeAnyWork) {
    std::ofstream(folder_.path / "file") << "no folder";
    for (const std::string& folder : {std::string("/proc/plumbline"), (folder_.path / "file").string()}) {
        std::vector<std::string> arguments = command(endless);
        arguments.back() = folder;
        const ProgramRun run = run_plumbline(arguments);
        EXPECT_EQ(run.exit_code, 2) << run.output;
        EXPECT_THAT(run.output, AllOf(HasSubstr(folder), HasSubstr("choose another with --output")));
    }
}

TEST_F(ReferenceSafety, ASceneFileThatVanishedLeavesTheLastGoodFrame) {
    const auto scene = folder_.path / "room.toml";
    std::ofstream(scene) << "builtin = \"cornell\"\n";
    std::vector<std::string> arguments = command("4");
    arguments[1] = scene.string();
    const ProgramRun first = run_plumbline(arguments);
    ASSERT_EQ(first.exit_code, 0) << first.output;
    const auto good = files();
    std::filesystem::remove(scene);
    const ProgramRun second = run_plumbline(arguments);
    EXPECT_EQ(second.exit_code, 2) << second.output;
    EXPECT_THAT(second.output, HasSubstr(scene.string()));
    EXPECT_TRUE(files() == good);
}

}  // namespace
}  // namespace plumb
