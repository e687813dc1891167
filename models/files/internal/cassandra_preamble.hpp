#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <maximin/models/files/internal/cassandra_tokens.hpp>
#include <maximin/models/files/read_options.hpp>

namespace maximin::internal {

/// States, actions or observations of a Cassandra file: a number of them, perhaps with names.
class CassandraSet {
 public:
  /// Reads `: N` or `: name name ...`. `kind` is "state", "action" or "observation".
  void read(CassandraTokens& tokens, std::string_view kind);

  bool given() const { return given_; }
  std::uint64_t size() const { return size_; }
  const std::vector<std::string>& names() const { return names_; }
  std::size_t line() const { return line_; }

  /// The index that a token stands for: an integer below size() or a name. Fails otherwise.
  std::size_t index(const Source& source, const CassandraToken& token) const;

 private:
  bool given_ = false;
  std::string kind_;
  std::uint64_t size_ = 0;
  std::size_t line_ = 0;
  std::vector<std::string> names_;
  std::map<std::string, std::size_t, std::less<>> index_;
};

/// What stands before the first T, O or R.
struct CassandraPreamble {
  enum class StartForm { none, vector, include, exclude };

  std::optional<CassandraToken> discount;
  bool costs = false;
  CassandraSet states, actions, observations;
  StartForm start_form = StartForm::none;
  std::vector<CassandraToken> start;  ///< what follows `start`
  std::size_t start_line = 0;
  std::vector<std::string> notes;
};

/// Reads the preamble and checks that it is complete and within the limits.
CassandraPreamble read_cassandra_preamble(CassandraTokens& tokens, const ReadOptions& options);

/// Fails unless the next token is a colon; goes past it.
void take_colon(CassandraTokens& tokens);

}  // namespace maximin::internal
