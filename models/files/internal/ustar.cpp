#include <maximin/models/files/internal/ustar.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <optional>

namespace maximin::internal {

namespace {

constexpr std::size_t block = 512;

/// A text field, up to its first NUL.
std::string_view field(std::string_view header, std::size_t begin, std::size_t length) {
  const std::string_view text = header.substr(begin, length);
  return text.substr(0, std::min(text.find('\0'), text.size()));
}

/// An octal number, perhaps with blanks around it.
std::optional<std::uint64_t> octal(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  if (text.empty() || text.size() > 20) return std::nullopt;
  std::uint64_t value = 0;
  for (const char c : text) {
    if (c < '0' || c > '7') return std::nullopt;
    value = value * 8 + static_cast<std::uint64_t>(c - '0');
  }
  return value;
}

/// The sum of the header's bytes, the checksum's own counted as blanks.
std::uint64_t checksum(std::string_view header) {
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < block; ++i) sum += i >= 148 && i < 156 ? ' ' : static_cast<unsigned char>(header[i]);
  return sum;
}

}  // namespace

std::map<std::string, std::string_view, std::less<>> tar_entries(const Source& source, std::string_view bytes) {
  std::map<std::string, std::string_view, std::less<>> entries;
  while (bytes.size() >= block) {
    const std::string_view header = bytes.substr(0, block);
    if (std::all_of(header.begin(), header.end(), [](char c) { return c == '\0'; })) break;
    if (octal(field(header, 148, 8)) != checksum(header)) {
      source.fail(0, "not a tar archive or damaged (wrong checksum), expected an undamaged file");
    }
    const std::optional<std::uint64_t> size = octal(field(header, 124, 12));
    bytes.remove_prefix(block);
    if (!size || *size > bytes.size()) {
      source.fail(0,
                  fmt::format("entry {} is cut short, expected an undamaged file", in_quotes(field(header, 0, 100))));
    }
    const char type = header[156];
    const std::string_view prefix = field(header, 257, 6) == "ustar" ? field(header, 345, 155) : std::string_view();
    std::string path = prefix.empty() ? std::string() : std::string(prefix) + "/";
    path += field(header, 0, 100);
    if (path.starts_with("./")) path.erase(0, 2);
    if (type == '0' || type == '\0') {
      if (!entries.emplace(path, bytes.substr(0, *size)).second) {
        source.fail(0, fmt::format("entry {} is there twice, expected each once", in_quotes(path)));
      }
    }
    bytes.remove_prefix(std::min<std::uint64_t>(bytes.size(), (*size + block - 1) / block * block));
  }
  return entries;
}

}  // namespace maximin::internal
