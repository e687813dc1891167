#include <maximin/models/files/internal/cassandra_tokens.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace maximin::internal {

namespace {

using TokenKind = CassandraToken::Kind;

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}
bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\n';
}
bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}
bool in_word(char c) {
  return is_letter(c) || is_digit(c) || c == '_' || c == '-';
}

/// Length of `digits [. digits] [e [+-] digits]` at the front of the text, which begins with a digit.
std::size_t number_length(std::string_view text, TokenKind& kind) {
  const auto skip_digits = [&](std::size_t i) {
    while (i < text.size() && is_digit(text[i])) ++i;
    return i;
  };
  kind = TokenKind::integer;
  std::size_t end = skip_digits(0);
  if (end < text.size() && text[end] == '.') {
    kind = TokenKind::decimal;
    end = skip_digits(end + 1);
  }
  if (end < text.size() && (text[end] == 'e' || text[end] == 'E')) {
    std::size_t digits = end + 1;
    if (digits < text.size() && (text[digits] == '+' || text[digits] == '-')) ++digits;
    if (digits < text.size() && is_digit(text[digits])) {
      kind = TokenKind::decimal;
      end = skip_digits(digits);
    }
  }
  return end;
}

}  // namespace

bool is_reserved_in_cassandra(std::string_view word) {
  constexpr std::array<std::string_view, 16> reserved = {
      "discount", "values",   "states", "actions", "observations", "T",       "O",       "R",
      "uniform",  "identity", "reward", "cost",    "start",        "include", "exclude", "reset"};
  return std::find(reserved.begin(), reserved.end(), word) != reserved.end();
}

CassandraToken CassandraTokens::take() {
  const CassandraToken token = next_;
  read();
  return token;
}

bool CassandraTokens::take_if(TokenKind kind) {
  if (next_.kind != kind) return false;
  read();
  return true;
}

void CassandraTokens::fail_at_next(std::string_view expected) const {
  source_.fail(next_.line, next_.kind == TokenKind::end
                               ? fmt::format("the file ends, expected {}", expected)
                               : fmt::format("{}: unexpected, expected {}", in_quotes(next_.text), expected));
}

void CassandraTokens::give(TokenKind kind, std::size_t length) {
  next_ = {kind, rest_.substr(0, length), line_};
  rest_.remove_prefix(length);
}

void CassandraTokens::read() {
  while (!rest_.empty() && (rest_.front() == '#' || is_blank(rest_.front()))) {
    if (rest_.front() == '\n') ++line_;
    rest_.remove_prefix(rest_.front() == '#' ? std::min(rest_.find('\n'), rest_.size()) : 1);
  }
  if (rest_.empty()) return give(TokenKind::end, 0);
  const char c = rest_.front();
  if (is_digit(c)) {
    TokenKind kind{};
    const std::size_t length = number_length(rest_, kind);
    return give(kind, length);
  }
  if (is_letter(c)) {
    const auto end = std::find_if_not(rest_.begin(), rest_.end(), in_word);
    return give(TokenKind::word, static_cast<std::size_t>(end - rest_.begin()));
  }
  if (c == '*') return give(TokenKind::star, 1);
  if (c == ':') return give(TokenKind::colon, 1);
  if (c == '+') return give(TokenKind::plus, 1);
  if (c == '-') return give(TokenKind::minus, 1);
  source_.fail(line_, fmt::format("{}: not part of the format, expected names, numbers, '*', ':' or a '#' comment",
                                  in_quotes(rest_.substr(0, std::max<std::size_t>(1, utf8_length(rest_))))));
}

}  // namespace maximin::internal
