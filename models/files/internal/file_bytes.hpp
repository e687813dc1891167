#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace maximin::internal {

/// The content of a file. Throws InputError when it cannot be read, is not a plain file, or is larger than `limit`.
std::string file_bytes(const std::filesystem::path& path, std::size_t limit);

}  // namespace maximin::internal
