#include <maximin/proofs_check/report/html_text.hpp>

#include <cmath>
#include <cstdlib>

#include <fmt/format.h>

namespace maximin::report {
namespace {

/// Bytes of the UTF-8 character at the front of `text`, or 0 when it is broken.
std::size_t utf8_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const std::size_t length = byte(0) < 0x80                       ? 1
                             : byte(0) >= 0xC2 && byte(0) <= 0xDF ? 2
                             : (byte(0) & 0xF0) == 0xE0           ? 3
                             : byte(0) >= 0xF0 && byte(0) <= 0xF4 ? 4
                                                                  : 0;
  if (length == 0 || length > text.size()) return 0;
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0) != 0x80) return 0;
  }
  if (length < 3) return length;
  const bool overlong = (byte(0) == 0xE0 && byte(1) < 0xA0) || (byte(0) == 0xF0 && byte(1) < 0x90);
  const bool surrogate = byte(0) == 0xED && byte(1) >= 0xA0;
  const bool beyond = byte(0) == 0xF4 && byte(1) >= 0x90;
  const bool no_character = byte(0) == 0xEF && byte(1) == 0xBF && byte(2) >= 0xBE;  // U+FFFE, U+FFFF: not in XML
  return overlong || surrogate || beyond || no_character ? 0 : length;
}

}  // namespace

std::string escape(std::string_view text) {
  constexpr std::string_view replacement = "\xEF\xBF\xBD";
  std::string out;
  out.reserve(text.size());
  while (!text.empty()) {
    const std::size_t length = utf8_length(text);
    const char c = text.front();
    if (length == 0 || (length == 1 && static_cast<unsigned char>(c) < 0x20 && c != '\t' && c != '\n')) {
      out += replacement;
    } else if (c == '&') {
      out += "&amp;";
    } else if (c == '<') {
      out += "&lt;";
    } else if (c == '>') {
      out += "&gt;";
    } else if (c == '"') {
      out += "&quot;";
    } else if (c == '\'') {
      out += "&#39;";
    } else {
      out += text.substr(0, length);
    }
    text.remove_prefix(length == 0 ? 1 : length);
  }
  return out;
}

std::string count(long n) {
  const std::string digits = std::to_string(n);
  std::string text;
  for (std::size_t i = 0; i < digits.size(); ++i) {
    const std::size_t left = digits.size() - i;
    if (left % 3 == 0 && !text.empty() && text.back() != '-') text += ',';
    text += digits[i];
  }
  return text;
}

std::string number(double x) {
  if (!std::isfinite(x)) return "not finite";
  if (x == 0) return "0";
  const double magnitude = std::abs(x);
  if (magnitude >= 0.0001 && magnitude < 1000) return fmt::format("{:.3g}", x);
  if (magnitude >= 1000 && magnitude < 1e6) return count(std::lround(x));
  const std::string text = fmt::format("{:.2e}", x);
  const auto e = text.find('e');
  return fmt::format("{}e{}", text.substr(0, e), std::atoi(text.c_str() + e + 1));
}

std::string percent(long part, long whole) {
  if (whole <= 0) return "-";
  if (part == 0) return "0%";
  if (part == whole) return "100%";
  const double share = 100 * static_cast<double>(part) / static_cast<double>(whole);
  if (share < 0.1) return "<0.1%";
  if (share > 99.9) return ">99.9%";
  return share < 9.95 || share > 99 ? fmt::format("{:.1f}%", share) : fmt::format("{:.0f}%", share);
}

std::string counted(long n, std::string_view singular, std::string_view plural) {
  return fmt::format("{} {}", count(n), n == 1 ? singular : plural);
}

}  // namespace maximin::report
