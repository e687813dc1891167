#include <maximin/models/files/internal/cassandra_preamble.hpp>

#include <fmt/format.h>

#include <maximin/models/files/internal/model_assembly.hpp>
#include <maximin/models/files/internal/number.hpp>

namespace maximin::internal {

namespace {

using TokenKind = CassandraToken::Kind;

class PreambleReader {
 public:
  explicit PreambleReader(CassandraTokens& tokens) : tokens_(tokens) {}

  CassandraPreamble read() {
    while (!ended()) {
      const CassandraToken keyword = tokens_.take();
      if (keyword.is("discount")) {
        read_discount(keyword);
      } else if (keyword.is("values")) {
        read_values();
      } else if (keyword.is("states")) {
        preamble_.states.read(tokens_, "state");
      } else if (keyword.is("actions")) {
        preamble_.actions.read(tokens_, "action");
      } else if (keyword.is("observations")) {
        preamble_.observations.read(tokens_, "observation");
      } else if (keyword.is("start")) {
        read_start(keyword);
      } else {
        tokens_.source().fail(keyword.line, fmt::format("{}: unexpected, expected discount, values, states, actions, "
                                                        "observations, start, T, O or R",
                                                        in_quotes(keyword.text)));
      }
    }
    return std::move(preamble_);
  }

  bool values_given() const { return values_given_; }

 private:
  bool ended() const {
    const CassandraToken& next = tokens_.peek();
    return next.kind == TokenKind::end || next.is("T") || next.is("O") || next.is("R");
  }

  void read_discount(const CassandraToken& keyword) {
    if (preamble_.discount) tokens_.source().fail(keyword.line, "discount given twice, expected it once");
    take_colon(tokens_);
    if (!tokens_.peek().is_number()) tokens_.fail_at_next("a number from 0 up to but not including 1");
    preamble_.discount = tokens_.take();
  }

  void read_values() {
    take_colon(tokens_);
    const CassandraToken& next = tokens_.peek();
    const bool costs = next.is("cost") || next.is("costs");
    if (!costs && !next.is("reward") && !next.is("rewards")) tokens_.fail_at_next("reward or cost");
    if (next.is("rewards") || next.is("costs")) {
      preamble_.notes.push_back(fmt::format("values: '{}' taken for '{}'", next.text, costs ? "cost" : "reward"));
    }
    preamble_.costs = costs;
    values_given_ = true;
    tokens_.take();
  }

  void read_start(const CassandraToken& keyword) {
    using Form = CassandraPreamble::StartForm;
    if (preamble_.start_form != Form::none) tokens_.source().fail(keyword.line, "start given twice, expected it once");
    preamble_.start_line = keyword.line;
    preamble_.start_form = tokens_.peek().is("include")   ? Form::include
                           : tokens_.peek().is("exclude") ? Form::exclude
                                                          : Form::vector;
    if (preamble_.start_form != Form::vector) tokens_.take();
    take_colon(tokens_);
    while (is_start_item(tokens_.peek())) preamble_.start.push_back(tokens_.take());
    if (preamble_.start.empty()) tokens_.fail_at_next("probabilities, states or 'uniform'");
  }

  static bool is_start_item(const CassandraToken& token) {
    return token.is_number() || token.is("uniform") ||
           (token.kind == TokenKind::word && !is_reserved_in_cassandra(token.text));
  }

  CassandraTokens& tokens_;
  CassandraPreamble preamble_;
  bool values_given_ = false;
};

}  // namespace

void take_colon(CassandraTokens& tokens) {
  if (!tokens.take_if(TokenKind::colon)) tokens.fail_at_next("':'");
}

void CassandraSet::read(CassandraTokens& tokens, std::string_view kind) {
  const Source& source = tokens.source();
  line_ = tokens.peek().line;
  if (given_) source.fail(line_, fmt::format("{}s given twice, expected them once", kind));
  given_ = true;
  kind_ = kind;
  take_colon(tokens);
  if (tokens.peek().kind == TokenKind::integer) {
    const CassandraToken count = tokens.take();
    size_ = parse_count(count.text).value_or(0);
    if (size_ < 1) source.fail(count.line, fmt::format("0 {}s, expected at least 1", kind));
    return;
  }
  while (tokens.peek().kind == TokenKind::word && !is_reserved_in_cassandra(tokens.peek().text)) {
    const CassandraToken name = tokens.take();
    if (!index_.emplace(name.text, names_.size()).second) {
      source.fail(name.line, fmt::format("{} {} given twice, expected distinct names", kind, in_quotes(name.text)));
    }
    names_.emplace_back(name.text);
  }
  size_ = names_.size();
  if (size_ < 1) tokens.fail_at_next(fmt::format("a number of {}s or their names", kind));
}

std::size_t CassandraSet::index(const Source& source, const CassandraToken& token) const {
  if (token.kind == TokenKind::integer) {
    const std::uint64_t value = parse_count(token.text).value_or(size_);
    if (value < size_) return static_cast<std::size_t>(value);
  } else if (token.kind == TokenKind::word) {
    const auto found = index_.find(token.text);
    if (found != index_.end()) return found->second;
  }
  const std::string numbers = fmt::format("0 to {}", size_ - 1);
  source.fail(token.line, fmt::format("{}: no such {}, expected {}",
                                      token.kind == TokenKind::end ? "end of file" : in_quotes(token.text), kind_,
                                      names_.empty() ? numbers : fmt::format("one of its names or {}", numbers)));
}

CassandraPreamble read_cassandra_preamble(CassandraTokens& tokens, const ReadOptions& options) {
  PreambleReader reader(tokens);
  CassandraPreamble preamble = reader.read();
  const Source& source = tokens.source();
  const std::size_t line = tokens.peek().line;
  if (!preamble.states.given()) source.fail(line, "no 'states:' before this, expected their number or names");
  if (!preamble.actions.given()) source.fail(line, "no 'actions:' before this, expected their number or names");
  if (!reader.values_given()) preamble.notes.emplace_back("values: the file does not say, reward assumed");
  require_size(source, preamble.states.line(), preamble.states.size(), preamble.actions.size(), options.limits);
  if (preamble.observations.given()) {
    require_size(source, preamble.observations.line(), preamble.states.size(), preamble.observations.size(),
                 options.limits);
  }
  return preamble;
}

}  // namespace maximin::internal
