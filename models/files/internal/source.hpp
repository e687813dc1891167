#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include <maximin/theory/error.hpp>

/// What every reader needs to say where an error is.
namespace maximin::internal {

/// A file being read. Knows how to turn a position, a number whose meaning is its own, into words.
class Source {
 public:
  explicit Source(std::string_view file) : file_(file) {}
  virtual ~Source() = default;

  /// "FILE:LINE" or "FILE: $.path"; position 0 is the file as a whole.
  virtual std::string place(std::size_t at) const = 0;

  /// What to add where probabilities do not sum to 1: how the format writes them exactly, if it can.
  virtual std::string_view hint_on_sums() const { return ""; }

  /// Throws InputError("PLACE: MESSAGE").
  [[noreturn]] void fail(std::size_t at, std::string_view message) const;

  const std::string& file() const { return file_; }

 private:
  std::string file_;
};

/// A text file: positions are line numbers from 1.
class TextSource : public Source {
 public:
  using Source::Source;
  std::string place(std::size_t at) const override;

  /// Throws InputError unless the text is UTF-8 without control characters other than tabs and line ends.
  void require_text(std::string_view text) const;
};

/// The token in quotes, cut to a readable length, with stray bytes and the characters that `is_name` refuses escaped.
std::string in_quotes(std::string_view token);

/// The length of the UTF-8 sequence at the front of `text`, or 0 when there is none.
std::size_t utf8_length(std::string_view text);

/// The text without the byte order mark that some editors put before UTF-8.
std::string_view without_mark(std::string_view text);

/// Whether the text may name a state or an action: UTF-8, not empty, without control characters (C0 and C1) and without
/// the characters that turn the direction of the text after them (U+202A to U+202E, U+2066 to U+2069).
bool is_name(std::string_view text);

}  // namespace maximin::internal
