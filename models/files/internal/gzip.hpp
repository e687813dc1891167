#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include <maximin/models/files/internal/source.hpp>

namespace maximin::internal {

/// Whether the bytes begin as a gzip file does.
bool is_gzip(std::string_view bytes);

/// Unpacks a gzip file (RFC 1952, deflate as in RFC 1951), all members one after the other. Throws InputError when it
/// is damaged, cut short, or unpacks to more than `limit` bytes.
std::string gunzip(const Source& source, std::string_view bytes, std::size_t limit);

/// The content of a model file, unpacked if it is packed by gzip. Throws InputError where it cannot be read, is no
/// plain file, or is larger than `limit`, packed or unpacked.
std::string unpacked_file_bytes(const std::filesystem::path& path, std::size_t limit);

}  // namespace maximin::internal
