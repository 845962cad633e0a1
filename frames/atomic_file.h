// Files that appear whole or not at all.
#pragma once

#include <filesystem>
#include <functional>
#include <string_view>

namespace plumb {

// Calls `write` with a temporary path beside `path` (same extension), flushes the result to disk and renames it to
// `path`. Whatever `write` throws leaves an existing file at `path` as it was and no temporary file behind. Missing
// parent folders are created. Throws ImageError with the system's reason (full disk, unwritable folder...).
void write_atomically(const std::filesystem::path& path,
                      const std::function<void(const std::filesystem::path& temporary)>& write);

// The same for a text held in memory.
void write_text_atomically(const std::filesystem::path& path, std::string_view text);

}  // namespace plumb
