#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include <maximin/models/files/internal/source.hpp>

namespace maximin::internal {

/// Whether the bytes begin as a gzip file does.
bool is_gzip(std::string_view bytes);

/// Unpacks a gzip file (RFC 1952, deflate as in RFC 1951), all members one after the other. Throws InputError when it
/// is damaged, cut short, or unpacks to more than `limit` bytes.
std::string gunzip(const Source& source, std::string_view bytes, std::size_t limit);

}  // namespace maximin::internal
