#include <maximin/models/files/internal/text_lines.hpp>

#include <fmt/format.h>

#include <algorithm>

#include <maximin/models/files/internal/number.hpp>

namespace maximin::internal {

bool TextLines::next() {
  if (ended_ || rest_.empty()) {
    ended_ = true;
    line_ = {};
    return false;
  }
  const std::size_t end = std::min(rest_.find('\n'), rest_.size());
  line_ = rest_.substr(0, end);
  rest_.remove_prefix(std::min(end + 1, rest_.size()));
  if (!line_.empty() && line_.back() == '\r') line_.remove_suffix(1);
  ++number_;
  return true;
}

bool TextLines::next_filled() {
  while (next()) {
    if (!trimmed(line_).empty()) return true;
  }
  return false;
}

const std::vector<std::string_view>& TextLines::words() {
  constexpr std::string_view blanks = " \t\r";
  words_.clear();
  for (std::size_t begin = line_.find_first_not_of(blanks); begin < line_.size();) {
    const std::size_t end = std::min(line_.find_first_of(blanks, begin), line_.size());
    words_.push_back(line_.substr(begin, end - begin));
    begin = line_.find_first_not_of(blanks, end);
  }
  return words_;
}

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blanks = " \t\r";
  const std::size_t begin = text.find_first_not_of(blanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(blanks) - begin + 1);
}

std::uint32_t read_index(const Source& source, std::size_t at, std::string_view name, std::string_view token,
                         std::uint64_t count) {
  const std::optional<std::uint64_t> value = parse_count(token);
  if (!value || *value >= count) {
    source.fail(at, fmt::format("{} {}: no such {}, expected an integer from 0 to {}", name, in_quotes(token), name,
                                count - 1));
  }
  return static_cast<std::uint32_t>(*value);
}

std::uint64_t read_count(const Source& source, std::size_t at, std::string_view name, std::string_view token) {
  const std::optional<std::uint64_t> value = parse_count(token);
  if (!value) source.fail(at, fmt::format("{} {}: expected a non-negative integer", name, in_quotes(token)));
  return *value;
}

}  // namespace maximin::internal
