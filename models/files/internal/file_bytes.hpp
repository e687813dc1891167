#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace maximin::internal {

/// The content of a file. Throws InputError when it cannot be read, is not a plain file, or is larger than `limit`.
std::string file_bytes(const std::filesystem::path& path, std::size_t limit);

/// The same, unpacked if it is packed by gzip; then `limit` holds for the unpacked size too.
std::string unpacked_file_bytes(const std::filesystem::path& path, std::size_t limit);

}  // namespace maximin::internal
