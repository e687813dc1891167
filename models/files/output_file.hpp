#pragma once

#include <filesystem>
#include <string_view>

namespace maximin {

/// What to do when the file exists.
enum class Overwrite { refuse, replace };

/// How the name of a file ends that is being written, or was when the program was killed.
inline constexpr const char* partial_suffix = ".partial";

/// Writes a whole file or none: to a file NAME.XXXXXX.partial beside it, which then takes its name. Throws InputError
/// when it cannot be written, or exists and may not be replaced.
void write_file(const std::filesystem::path& path, std::string_view content, Overwrite overwrite);

/// Makes the folder, and those that it is in, unless it is there. Throws InputError when the system refuses.
void make_folder(const std::filesystem::path& path);

}  // namespace maximin
