#include <maximin/models/files/internal/source.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace maximin::internal {

namespace {

bool is_control(char c) {
  return static_cast<unsigned char>(c) < 0x20 || c == 0x7F;
}

/// Whether the UTF-8 sequence acts on a terminal or on the text around it instead of being shown.
bool is_active(std::string_view sequence) {
  if (sequence.size() == 1) return is_control(sequence[0]);
  if (sequence.size() == 2) return sequence[0] == '\xC2' && static_cast<unsigned char>(sequence[1]) < 0xA0;
  return (sequence >= "\u202A" && sequence <= "\u202E") || (sequence >= "\u2066" && sequence <= "\u2069");
}

}  // namespace

void Source::fail(std::size_t at, std::string_view message) const {
  throw InputError(fmt::format("{}: {}", place(at), message));
}

std::string TextSource::place(std::size_t at) const {
  return at == 0 ? file() : fmt::format("{}:{}", file(), at);
}

void TextSource::require_text(std::string_view text) const {
  std::size_t line = 1;
  while (!text.empty()) {
    const std::size_t length = utf8_length(text);
    if (length == 0 || (is_control(text.front()) && std::string_view("\t\n\r").find(text.front()) == text.npos)) {
      fail(line, fmt::format("byte 0x{:02x} is not text, expected UTF-8", static_cast<unsigned char>(text.front())));
    }
    if (text.front() == '\n') ++line;
    text.remove_prefix(length);
  }
}

std::string_view without_mark(std::string_view text) {
  constexpr std::string_view mark = "\uFEFF";
  return text.starts_with(mark) ? text.substr(mark.size()) : text;
}

bool is_name(std::string_view text) {
  bool good = !text.empty();
  while (good && !text.empty()) {
    const std::size_t length = utf8_length(text);
    good = length > 0 && !is_active(text.substr(0, length));
    text.remove_prefix(length);
  }
  return good;
}

std::size_t utf8_length(std::string_view text) {
  if (text.empty()) return 0;
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned lead = byte(0);
  if (lead < 0x80) return 1;
  const std::size_t length = lead >= 0xC2 && lead < 0xE0   ? 2
                             : lead >= 0xE0 && lead < 0xF0 ? 3
                             : lead >= 0xF0 && lead < 0xF5 ? 4
                                                           : 0;
  if (length == 0 || text.size() < length) return 0;
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0) != 0x80) return 0;
  }
  // Overlong forms, surrogates and code points beyond U+10FFFF.
  const unsigned second = byte(1);
  if ((lead == 0xE0 && second < 0xA0) || (lead == 0xED && second > 0x9F)) return 0;
  if ((lead == 0xF0 && second < 0x90) || (lead == 0xF4 && second > 0x8F)) return 0;
  return length;
}

std::string in_quotes(std::string_view token) {
  constexpr std::size_t longest = 40;
  std::string out = "'";
  while (!token.empty() && out.size() <= longest) {
    const std::size_t length = utf8_length(token);
    const std::string_view character = token.substr(0, std::max<std::size_t>(length, 1));
    token.remove_prefix(character.size());
    if (length > 0 && !is_active(character)) {
      out += character;
      continue;
    }
    for (const char byte : character) out += fmt::format("\\x{:02x}", static_cast<unsigned char>(byte));
  }
  return out + (token.empty() ? "'" : "...'");
}

}  // namespace maximin::internal
