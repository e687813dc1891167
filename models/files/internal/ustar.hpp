#pragma once

#include <map>
#include <string>
#include <string_view>

#include <maximin/models/files/internal/source.hpp>

namespace maximin::internal {

/// The plain files of a POSIX tar archive, by path; the contents are views of `bytes`. Throws InputError when the
/// archive is damaged, cut short, or holds a path twice.
std::map<std::string, std::string_view, std::less<>> tar_entries(const Source& source, std::string_view bytes);

}  // namespace maximin::internal
