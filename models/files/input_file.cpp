#include <maximin/models/files/input_file.hpp>

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <fstream>

#include <maximin/theory/error.hpp>

namespace maximin {

std::string file_bytes(const std::filesystem::path& path, std::size_t limit, std::string_view expected) {
  const std::string name = path.string();
  std::error_code code;
  if (std::filesystem::is_directory(path, code)) {
    throw InputError(fmt::format("{}: a folder, expected {}", name, expected));
  }
  std::ifstream in(path, std::ios::binary);
  if (!in) throw InputError(fmt::format("{}: {}, expected {}", name, std::strerror(errno), expected));
  // Read in pieces: a device or a pipe has no size to ask for.
  std::string bytes;
  std::string piece(std::size_t{1} << 20, '\0');
  while (in) {
    in.read(piece.data(), static_cast<std::streamsize>(piece.size()));
    bytes.append(piece, 0, static_cast<std::size_t>(in.gcount()));
    if (bytes.size() > limit) throw InputError(fmt::format("{}: larger than {} bytes, expected less", name, limit));
  }
  if (in.bad()) throw InputError(fmt::format("{}: reading failed, expected {}", name, expected));
  return bytes;
}

}  // namespace maximin
