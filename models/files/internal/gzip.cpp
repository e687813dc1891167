#include <maximin/models/files/internal/gzip.hpp>

#include <algorithm>
#include <array>
#include <limits>

#include <fmt/format.h>
#include <zlib.h>

#include <maximin/models/files/input_file.hpp>

namespace maximin::internal {
namespace {

/// zlib's inflating stream, for one gzip member at a time.
class Inflater {
 public:
  Inflater() {
    constexpr int gzip_only = 16;
    if (inflateInit2(&stream_, gzip_only + MAX_WBITS) != Z_OK) throw std::bad_alloc();
  }
  ~Inflater() { inflateEnd(&stream_); }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;

  /// Unpacks one member from the front of `bytes` onto `out`; returns how many bytes it took.
  std::size_t member(const Source& source, std::string_view bytes, std::size_t limit, std::string& out) {
    constexpr std::size_t most = std::numeric_limits<uInt>::max();
    inflateReset(&stream_);
    stream_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));  // zlib never writes there
    stream_.avail_in = static_cast<uInt>(std::min(bytes.size(), most));
    int status = Z_OK;
    while (status != Z_STREAM_END) {
      stream_.next_out = reinterpret_cast<Bytef*>(block_.data());
      stream_.avail_out = static_cast<uInt>(block_.size());
      status = inflate(&stream_, Z_NO_FLUSH);
      if (status == Z_BUF_ERROR) source.fail(0, "the gzip data ends too early, expected an undamaged file");
      if (status != Z_OK && status != Z_STREAM_END) {
        source.fail(0, "the gzip data is damaged, expected an undamaged file");
      }
      const std::size_t unpacked = block_.size() - stream_.avail_out;
      if (unpacked > limit - out.size()) {
        source.fail(0, fmt::format("unpacks to more than {} bytes, expected less", limit));
      }
      out.append(block_.data(), unpacked);
    }
    return std::min(bytes.size(), most) - stream_.avail_in;
  }

 private:
  z_stream stream_{};
  std::array<char, 1 << 16> block_{};
};

}  // namespace

bool is_gzip(std::string_view bytes) {
  return bytes.starts_with("\x1f\x8b");
}

std::string gunzip(const Source& source, std::string_view bytes, std::size_t limit) {
  Inflater inflater;
  std::string out;
  do {
    bytes.remove_prefix(inflater.member(source, bytes, limit, out));
  } while (!bytes.empty());
  return out;
}

std::string unpacked_file_bytes(const std::filesystem::path& path, std::size_t limit) {
  std::string bytes = file_bytes(path, limit, "a readable model file");
  return is_gzip(bytes) ? gunzip(TextSource(path.string()), bytes, limit) : bytes;
}

}  // namespace maximin::internal
