#pragma once

#include <fmt/format.h>

#include <bit>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

/// Archives for tests.
namespace maximin::testing {

/// A POSIX tar archive of plain files.
inline std::string tar(const std::vector<std::pair<std::string, std::string>>& files) {
  std::string archive;
  for (const auto& [path, content] : files) {
    std::string header(512, '\0');
    header.replace(0, path.size(), path);
    const std::string size = fmt::format("{:011o}", content.size());
    header.replace(100, 7, "0000644");
    header.replace(124, size.size(), size);
    header.replace(148, 8, "        ");
    header[156] = '0';
    header.replace(257, 5, "ustar");
    header.replace(263, 2, "00");
    unsigned sum = 0;
    for (const char c : header) sum += static_cast<unsigned char>(c);
    header.replace(148, 8, fmt::format("{:06o}", sum) + std::string("\0 ", 2));
    archive += header + content + std::string((512 - content.size() % 512) % 512, '\0');
  }
  return archive + std::string(1024, '\0');
}

/// Numbers as little-endian bytes, `width` each.
inline std::string little_endian(const std::vector<std::uint64_t>& numbers, int width) {
  std::string bytes;
  for (const std::uint64_t n : numbers) {
    for (int i = 0; i < width; ++i) bytes.push_back(static_cast<char>(n >> (8 * i) & 0xFF));
  }
  return bytes;
}

inline std::string little_endian(const std::vector<double>& numbers) {
  std::vector<std::uint64_t> bits;
  for (const double x : numbers) bits.push_back(std::bit_cast<std::uint64_t>(x));
  return little_endian(bits, 8);
}

}  // namespace maximin::testing
