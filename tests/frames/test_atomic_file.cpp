#include <csignal>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <vector>

#include <gmock/gmock.h>
#include <sys/wait.h>
#include <unistd.h>

#include "frames/atomic_file.h"
#include "frames/exr.h"
#include "frames/image_error.h"
#include "tests/file_size_limit.h"
#include "tests/message_of.h"
#include "tests/temporary_folder.h"

namespace plumb {
namespace {

using testing::HasSubstr;

std::string text_of(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

int file_count(const std::filesystem::path& folder) {
    return static_cast<int>(std::distance(std::filesystem::directory_iterator(folder), {}));
}

TEST(AtomicFile, ReplacesAnExistingFileAndCreatesFolders) {
    const TemporaryFolder folder;
    const auto path = folder / "a" / "b" / "file.txt";
    write_text_atomically(path, "first");
    write_text_atomically(path, "second");
    EXPECT_EQ(text_of(path), "second");
    EXPECT_EQ(file_count(path.parent_path()), 1) << "temporary files must be gone";
}

TEST(AtomicFile, KeepsTheOldFileWhenTheWriterThrowsMidway) {
    const TemporaryFolder folder;
    const auto path = folder / "file.txt";
    write_text_atomically(path, "old");
    EXPECT_THROW(write_atomically(path,
                                  [](const std::filesystem::path& temporary) {
                                      std::ofstream(temporary) << "half of the new";
                                      throw std::runtime_error("midway");
                                  }),
                 std::runtime_error);
    EXPECT_EQ(text_of(path), "old");
    EXPECT_EQ(file_count(folder.path), 1);
}

TEST(AtomicFile, KeepsTheOldFileWhenTheProcessIsKilledMidway) {
    const TemporaryFolder folder;
    const auto path = folder / "file.txt";
    write_text_atomically(path, "old");
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
        write_atomically(path, [](const std::filesystem::path& temporary) {
            std::ofstream(temporary) << "half of the new" << std::flush;
            ::raise(SIGKILL);
        });
        ::_exit(0);
    }
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFSIGNALED(status));
    EXPECT_EQ(text_of(path), "old");
}

TEST(AtomicFile, NamesPathAndReasonWhereItCannotWrite) {
    const TemporaryFolder folder;
    write_text_atomically(folder / "file.txt", "a file, not a folder");
    const auto below_a_file = folder / "file.txt" / "image.exr";
    const auto message = message_of<ImageError>([&] { write_text_atomically(below_a_file, "text"); });
    EXPECT_THAT(message, HasSubstr(below_a_file.string()));
    EXPECT_THAT(message, HasSubstr("Not a directory"));
}

TEST(AtomicFile, NamesPathAndReasonInAFolderWithoutWritePermission) {
    if (::geteuid() == 0) GTEST_SKIP() << "root may write anywhere";
    const TemporaryFolder folder;
    std::filesystem::permissions(folder.path, std::filesystem::perms::owner_read | std::filesystem::perms::owner_exec);
    const auto message = message_of<ImageError>([&] { write_text_atomically(folder / "file.txt", "text"); });
    std::filesystem::permissions(folder.path, std::filesystem::perms::owner_all);
    EXPECT_THAT(message, HasSubstr("file.txt"));
    EXPECT_THAT(message, HasSubstr("Permission denied"));
}

TEST(AtomicFile, KeepsTheOldImageWhenTheDiskIsFull) {
    const TemporaryFolder folder;
    const auto path = folder / "image.exr";
    Frame old(1, 1);
    old.set("ao", Image(1, 1, 1, 0.5f));
    write_exr(path, old);

    Frame frame(64, 64);
    Image& noise = frame.set("direct", Image(64, 64, 3));
    std::uint32_t state = 1;
    for (float& value : noise.values()) value = static_cast<float>(state = state * 1664525u + 1013904223u);
    std::string message;
    {
        const FileSizeLimit limit(4096);
        message = message_of<ImageError>([&] { write_exr(path, frame); });
    }
    EXPECT_THAT(message, HasSubstr(path.string()));
    EXPECT_THAT(message, HasSubstr("File too large"));
    EXPECT_EQ(read_exr(path).plane("ao").at(0, 0), 0.5f);
    EXPECT_EQ(file_count(folder.path), 1);
}

}  // namespace
}  // namespace plumb
