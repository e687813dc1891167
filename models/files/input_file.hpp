#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace maximin {

/// The content of a file, a device or a pipe. Throws InputError, "FILE: what is wrong, expected EXPECTED", when it
/// cannot be read, is a folder, or is larger than `limit` bytes.
std::string file_bytes(const std::filesystem::path& path, std::size_t limit, std::string_view expected);

}  // namespace maximin
