#pragma once

#include <cstddef>
#include <string_view>

#include <maximin/models/files/internal/source.hpp>

namespace maximin::internal {

/// A token of Cassandra's format.
struct CassandraToken {
  enum class Kind { integer, decimal, word, star, colon, plus, minus, end };
  Kind kind;
  std::string_view text;
  std::size_t line;

  bool is(std::string_view word) const { return kind == Kind::word && text == word; }
  bool is_number() const { return kind == Kind::integer || kind == Kind::decimal; }
};

/// Whether the word has a meaning of its own in the format and so cannot name anything.
bool is_reserved_in_cassandra(std::string_view word);

/// Gives the tokens of a text one by one, with one token of lookahead. Comments and line ends mean nothing.
class CassandraTokens {
 public:
  /// Throws InputError, as does `take`, at a character outside the grammar.
  CassandraTokens(const Source& source, std::string_view text) : source_(source), rest_(without_mark(text)) { read(); }

  /// The next token; of kind end after the last.
  const CassandraToken& peek() const { return next_; }
  /// Returns the next token and goes on.
  CassandraToken take();
  /// Goes past the next token if it is of that kind.
  bool take_if(CassandraToken::Kind kind);

  const Source& source() const { return source_; }
  /// Throws InputError at the next token: "'TOKEN': unexpected, expected EXPECTED".
  [[noreturn]] void fail_at_next(std::string_view expected) const;

 private:
  void read();
  void give(CassandraToken::Kind kind, std::size_t length);

  const Source& source_;
  std::string_view rest_;
  std::size_t line_ = 1;
  CassandraToken next_{CassandraToken::Kind::end, "", 1};
};

}  // namespace maximin::internal
