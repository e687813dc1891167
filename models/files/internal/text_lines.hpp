#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include <maximin/models/files/internal/source.hpp>

namespace maximin::internal {

/// Walks over the lines of a text. "\n", "\r\n" and a missing end of the last line are all the same; a byte
/// order mark before the first is skipped.
class TextLines {
 public:
  TextLines(const Source& source, std::string_view text) : source_(source), rest_(without_mark(text)) {}

  /// Goes to the next line; false at the end of the text.
  bool next();
  /// Goes to the next line that has something on it; false at the end of the text.
  bool next_filled();

  std::string_view line() const { return line_; }
  /// From 1; after the end, the number of the last line.
  std::size_t number() const { return number_; }
  /// The line's words, separated by blanks.
  const std::vector<std::string_view>& words();

  const Source& source() const { return source_; }
  /// Throws InputError("FILE:LINE: MESSAGE").
  [[noreturn]] void fail(std::string_view message) const { source_.fail(number_, message); }

 private:
  const Source& source_;
  std::string_view rest_;
  std::string_view line_;
  std::size_t number_ = 0;
  bool ended_ = false;
  std::vector<std::string_view> words_;
};

/// Without blanks at both ends.
std::string_view trimmed(std::string_view text);

/// An integer in [0, count) or a failure: "NAME 'TOKEN': no such NAME, expected an integer from 0 to COUNT-1".
std::uint32_t read_index(const Source& source, std::size_t at, std::string_view name, std::string_view token,
                         std::uint64_t count);

/// A non-negative integer or a failure; beyond 2^64 - 1 it is held there.
std::uint64_t read_count(const Source& source, std::size_t at, std::string_view name, std::string_view token);

}  // namespace maximin::internal
