#include <maximin/models/files/internal/file_bytes.hpp>

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <fstream>

#include <maximin/models/files/internal/gzip.hpp>
#include <maximin/theory/error.hpp>

namespace maximin::internal {

std::string file_bytes(const std::filesystem::path& path, std::size_t limit) {
  const std::string name = path.string();
  std::error_code code;
  if (std::filesystem::is_directory(path, code)) throw InputError(name + ": a folder, expected a model file");
  std::ifstream in(path, std::ios::binary);
  if (!in) throw InputError(fmt::format("{}: {}, expected a readable model file", name, std::strerror(errno)));
  // Read in pieces: a device or a pipe has no size to ask for.
  std::string bytes;
  std::string piece(std::size_t{1} << 20, '\0');
  while (in) {
    in.read(piece.data(), static_cast<std::streamsize>(piece.size()));
    bytes.append(piece, 0, static_cast<std::size_t>(in.gcount()));
    if (bytes.size() > limit) throw InputError(fmt::format("{}: larger than {} bytes, expected less", name, limit));
  }
  if (in.bad()) throw InputError(name + ": reading failed, expected a readable model file");
  return bytes;
}

std::string unpacked_file_bytes(const std::filesystem::path& path, std::size_t limit) {
  std::string bytes = file_bytes(path, limit);
  return is_gzip(bytes) ? gunzip(TextSource(path.string()), bytes, limit) : bytes;
}

}  // namespace maximin::internal
