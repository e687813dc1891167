#include <maximin/models/files/cassandra.hpp>

#include <algorithm>
#include <utility>
#include <vector>

#include <maximin/models/files/internal/cassandra_preamble.hpp>
#include <maximin/models/files/internal/cassandra_rewards.hpp>
#include <maximin/models/files/internal/model_assembly.hpp>
#include <maximin/models/files/internal/sparse_rows.hpp>
#include <maximin/theory/rational.hpp>

namespace maximin {

namespace {

using namespace internal;
using TokenKind = CassandraToken::Kind;

/// What a reference stands for: one index, or all of them.
struct Range {
  std::size_t begin, end;
  bool all;

  std::int64_t index() const { return all ? -1 : static_cast<std::int64_t>(begin); }
};

template <class Scalar>
class CassandraReader {
 public:
  CassandraReader(std::string_view text, std::string_view file, const ReadOptions& options)
      : source_(file),
        options_(options),
        tokens_((source_.require_text(text), source_), text),
        preamble_(read_cassandra_preamble(tokens_, options)),
        states_(preamble_.states.size()),
        actions_(preamble_.actions.size()),
        observations_(std::max<std::size_t>(preamble_.observations.size(), 1)),
        transitions_(states_ * actions_, states_),
        observed_(preamble_.observations.given() ? states_ * actions_ : 0, observations_),
        rewards_(states_, observations_) {}

  Model<Scalar> read() {
    read_start();
    while (tokens_.peek().kind != TokenKind::end) read_line();
    std::vector<std::string> notes = std::move(preamble_.notes);
    std::optional<Scalar> in_file;
    const std::size_t line = preamble_.discount ? preamble_.discount->line : 0;
    if (preamble_.discount) in_file = read_number<Scalar>(source_, line, "discount", preamble_.discount->text);
    const Scalar discount = choose_discount(source_, options_, in_file, line, notes);
    if (preamble_.costs) notes.emplace_back("values: costs, taken as negative rewards");
    ModelAssembly<Scalar> assembly(source_, options_.limits, static_cast<State>(states_), static_cast<Action>(actions_),
                                   slack());
    for (std::size_t s = 0; s < states_; ++s) {
      for (std::size_t a = 0; a < actions_; ++a) add_row(assembly, s, a);
    }
    Model<Scalar> model{std::move(assembly).build(discount, 0, notes), {}, {}, {}, {}, {}, {}};
    model.state_names = preamble_.states.names();
    model.action_names = preamble_.actions.names();
    if (start_given_) model.start = std::move(start_);
    if (start_scaled_) notes.emplace_back("start: summed to 1 only nearly; scaled to sum to 1");
    model.notes = std::move(notes);
    return model;
  }

 private:
  /// EPSILON of pomdp-solve.
  static Scalar slack() { return Scalar(Scalar(1) / Scalar(100'000)); }

  void read_start() {
    using Form = CassandraPreamble::StartForm;
    const auto& items = preamble_.start;
    start_.assign(states_, Scalar(Scalar(1) / Scalar(static_cast<long>(states_))));
    if (preamble_.start_form == Form::none) return;
    if (preamble_.start_form != Form::vector) return read_start_set(preamble_.start_form == Form::include);
    if (items.size() == 1 && items[0].is("uniform")) return;
    start_given_ = true;
    if (items.size() == 1 && (states_ > 1 || items[0].kind == TokenKind::word || items[0].text == "0")) {
      const std::size_t s = preamble_.states.index(source_, items[0]);
      start_.assign(states_, Scalar(0));
      start_[s] = Scalar(1);
      return;
    }
    if (items.size() != states_) {
      source_.fail(preamble_.start_line, fmt::format("start: {} entries, expected one probability for each of {} "
                                                     "states, one state, or uniform",
                                                     items.size(), states_));
    }
    Scalar sum(0);
    for (std::size_t s = 0; s < states_; ++s) {
      start_[s] = read_number<Scalar>(source_, items[s].line, "probability", items[s].text);
      sum += start_[s];
    }
    const auto defect = defect_of(sum);
    if (!defect) return;
    if (!(*defect <= slack())) source_.fail(preamble_.start_line, "start: " + wrong_sum(source_, sum));
    for (Scalar& p : start_) p = Scalar(p / sum);
    start_scaled_ = true;
  }

  void read_start_set(bool include) {
    std::vector<bool> listed(states_, false);
    for (const CassandraToken& item : preamble_.start) listed[preamble_.states.index(source_, item)] = true;
    const auto count = std::count(listed.begin(), listed.end(), include);
    if (count == 0) source_.fail(preamble_.start_line, "start: no state left, expected at least one");
    for (std::size_t s = 0; s < states_; ++s) {
      start_[s] = listed[s] == include ? Scalar(Scalar(1) / Scalar(static_cast<long>(count))) : Scalar(0);
    }
    start_given_ = true;
  }

  void read_line() {
    const CassandraToken keyword = tokens_.take();
    if (keyword.is("T")) return read_transitions();
    if (keyword.is("R")) return read_rewards(keyword.line);
    if (!keyword.is("O")) {
      source_.fail(keyword.line, fmt::format("{}: unexpected, expected T, O or R", in_quotes(keyword.text)));
    }
    if (!preamble_.observations.given()) {
      source_.fail(keyword.line, "O without 'observations:', expected them in the preamble");
    }
    read_observations();
  }

  /// A colon and a reference to a member of the set.
  Range read_reference(const CassandraSet& set) {
    take_colon(tokens_);
    if (tokens_.take_if(TokenKind::star)) return {0, static_cast<std::size_t>(set.size()), true};
    const std::size_t i = set.index(source_, tokens_.take());
    return {i, i + 1, false};
  }

  Scalar read_probability() {
    const CassandraToken& next = tokens_.peek();
    if (next.kind == TokenKind::minus) source_.fail(next.line, "negative probability, expected 0 to 1");
    if (!next.is_number()) tokens_.fail_at_next("a probability");
    const CassandraToken token = tokens_.take();
    const auto p = read_number<Scalar>(source_, token.line, "probability", token.text);
    if (!(p <= Scalar(1) + slack())) {
      source_.fail(token.line, fmt::format("probability {}: outside the range, expected 0 to 1", token.text));
    }
    return p;
  }

  /// Counts entries that wildcards and matrices write, so that a short line cannot cost hours.
  void charge(std::size_t line, std::size_t entries) {
    expansions_ += entries;
    if (expansions_ > options_.limits.expansions || transitions_.stored() + observed_.stored() > stored_limit()) {
      source_.fail(line, fmt::format("wildcards and matrices write more than {} entries, expected fewer",
                                     std::min(options_.limits.expansions, stored_limit())));
    }
  }

  std::size_t stored_limit() const { return 2 * options_.limits.transitions; }

  /// One row for every row of the ranges.
  template <class Fill>
  void write_rows(SparseRows<Scalar>& rows, Range a, Range s, std::size_t line, std::size_t cost, Fill fill) {
    for (std::size_t i = a.begin; i < a.end; ++i) {
      for (std::size_t j = s.begin; j < s.end; ++j) {
        charge(line, cost);
        const std::size_t row = j * actions_ + i;
        rows.clear(row);
        rows.written_at(row, line);
        fill(row, j);
      }
    }
  }

  void write_uniform(SparseRows<Scalar>& rows, Range a, Range s, std::size_t line) {
    const Scalar p = Scalar(Scalar(1) / Scalar(static_cast<long>(rows.width())));
    write_rows(rows, a, s, line, rows.width(), [&](std::size_t row, std::size_t) {
      for (std::size_t t = 0; t < rows.width(); ++t) rows.set(row, t, p);
    });
  }

  /// As many probabilities as the rows are wide, written to every row of the ranges.
  void read_row(SparseRows<Scalar>& rows, Range a, Range s) {
    const std::size_t line = tokens_.peek().line;
    std::vector<std::pair<std::size_t, Scalar>> entries;
    for (std::size_t t = 0; t < rows.width(); ++t) {
      Scalar p = read_probability();
      if (p != Scalar(0)) entries.emplace_back(t, std::move(p));
    }
    write_rows(rows, a, s, line, entries.size() + 1, [&](std::size_t row, std::size_t) {
      for (const auto& [t, p] : entries) rows.set(row, t, p);
    });
  }

  void write_entry(SparseRows<Scalar>& rows, Range a, Range s, Range t) {
    const std::size_t line = tokens_.peek().line;
    const Scalar p = read_probability();
    for (std::size_t i = a.begin; i < a.end; ++i) {
      for (std::size_t j = s.begin; j < s.end; ++j) {
        charge(line, t.end - t.begin);
        const std::size_t row = j * actions_ + i;
        rows.written_at(row, line);
        for (std::size_t k = t.begin; k < t.end; ++k) rows.set(row, k, p);
      }
    }
  }

  bool take_word(std::string_view word) {
    if (!tokens_.peek().is(word)) return false;
    tokens_.take();
    return true;
  }

  void read_transitions() {
    const std::size_t line = tokens_.peek().line;
    const Range a = read_reference(preamble_.actions);
    const Range every{0, states_, true};
    if (tokens_.peek().kind != TokenKind::colon) {
      if (take_word("uniform")) return write_uniform(transitions_, a, every, line);
      if (take_word("identity")) {
        return write_rows(transitions_, a, every, line, 1,
                          [&](std::size_t row, std::size_t s) { transitions_.set(row, s, Scalar(1)); });
      }
      for (std::size_t s = 0; s < states_; ++s) read_row(transitions_, a, {s, s + 1, false});
      return;
    }
    const Range s = read_reference(preamble_.states);
    if (tokens_.peek().kind == TokenKind::colon)
      return write_entry(transitions_, a, s, read_reference(preamble_.states));
    if (take_word("uniform")) return write_uniform(transitions_, a, s, line);
    if (take_word("reset")) {
      return write_rows(transitions_, a, s, line, states_, [&](std::size_t row, std::size_t) {
        for (std::size_t t = 0; t < states_; ++t) {
          if (start_[t] != Scalar(0)) transitions_.set(row, t, start_[t]);
        }
      });
    }
    read_row(transitions_, a, s);
  }

  void read_observations() {
    const std::size_t line = tokens_.peek().line;
    const Range a = read_reference(preamble_.actions);
    const Range every{0, states_, true};
    if (tokens_.peek().kind != TokenKind::colon) {
      if (take_word("uniform")) return write_uniform(observed_, a, every, line);
      for (std::size_t s = 0; s < states_; ++s) read_row(observed_, a, {s, s + 1, false});
      return;
    }
    const Range s = read_reference(preamble_.states);
    if (tokens_.peek().kind == TokenKind::colon)
      return write_entry(observed_, a, s, read_reference(preamble_.observations));
    if (take_word("uniform")) return write_uniform(observed_, a, s, line);
    read_row(observed_, a, s);
  }

  void read_reward_values(std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
      const bool negative = tokens_.take_if(TokenKind::minus);
      if (!negative) tokens_.take_if(TokenKind::plus);
      if (!tokens_.peek().is_number()) tokens_.fail_at_next("a reward");
      const CassandraToken token = tokens_.take();
      const auto value = read_number<Scalar>(source_, token.line, "reward", token.text);
      rewards_.add_value(negative != preamble_.costs ? Scalar(-value) : value);
    }
  }

  void read_rewards(std::size_t line) {
    using Shape = typename CassandraRewards<Scalar>::Shape;
    constexpr std::int64_t all = CassandraRewards<Scalar>::all;
    const bool partial = preamble_.observations.given();
    const auto more = [&] { return tokens_.peek().kind == TokenKind::colon; };
    typename CassandraRewards<Scalar>::Rule rule{all, all, all, all, Shape::one, rewards_.next_value(), line};
    std::size_t count = 1;
    rule.action = read_reference(preamble_.actions).index();
    if (!more()) {
      if (partial) tokens_.fail_at_next("':' and a state");
      rule.shape = Shape::by_state_and_target;
      count = states_ * states_;
    } else {
      rule.state = read_reference(preamble_.states).index();
      if (!more()) {
        rule.shape = partial ? Shape::by_target_and_observation : Shape::by_target;
        count = states_ * (partial ? observations_ : 1);
      } else {
        rule.target = read_reference(preamble_.states).index();
        if (more() && partial) {
          rule.observation = read_reference(preamble_.observations).index();
        } else if (more()) {
          take_colon(tokens_);
          if (!tokens_.take_if(TokenKind::star)) tokens_.fail_at_next("'*': an MDP has no observations");
        } else if (partial) {
          rule.shape = Shape::by_observation;
          count = observations_;
        }
      }
    }
    read_reward_values(count);
    rewards_.add_rule(rule);
  }

  static Scalar sum_of(const std::vector<typename SparseRows<Scalar>::Entry>& row) {
    Scalar sum(0);
    for (const auto& entry : row) sum += entry.second;
    return sum;
  }

  /// P(.|s,a), and R(s,a) = sum over s' and o of T O R, both made to sum to 1.
  void add_row(ModelAssembly<Scalar>& assembly, std::size_t s, std::size_t a) {
    const auto& row = transitions_.row(s * actions_ + a);
    const std::size_t line = transitions_.line(s * actions_ + a);
    const Scalar sum = sum_of(row);
    const bool off = defect_of(sum).has_value();
    WeightedMean<Scalar> reward;
    for (const auto& [target, p] : row) {
      assembly.transition(static_cast<State>(s), static_cast<Action>(a), target, p, line);
      add_reward(reward, off ? Scalar(p / sum) : p, s, a, static_cast<std::size_t>(target));
    }
    assembly.reward(static_cast<State>(s), static_cast<Action>(a), reward.value());
  }

  void add_reward(WeightedMean<Scalar>& reward, const Scalar& weight, std::size_t s, std::size_t a,
                  std::size_t target) {
    const auto match = rewards_.match(a, s, target);
    if (!match.depends_on_observation()) return reward.add(weight, match.value(0));
    const auto& row = observed_.row(target * actions_ + a);
    observed_rewards_ += row.size();
    if (observed_rewards_ > options_.limits.expansions) {
      source_.fail(match.line(), fmt::format("rewards that depend on observations need more than {} terms, expected "
                                             "fewer",
                                             options_.limits.expansions));
    }
    const Scalar sum = sum_of(row);
    const auto defect = defect_of(sum);
    if (defect && !(*defect <= slack())) {
      source_.fail(match.line(), fmt::format("this reward needs O for action {} and state {}, whose {}", a, target,
                                             wrong_sum(source_, sum)));
    }
    for (const auto& [o, q] : row) {
      reward.add(Scalar(weight * (defect ? Scalar(q / sum) : q)), match.value(static_cast<std::size_t>(o)));
    }
  }

  TextSource source_;
  const ReadOptions& options_;
  CassandraTokens tokens_;
  CassandraPreamble preamble_;
  std::size_t states_, actions_, observations_;
  SparseRows<Scalar> transitions_;  // row s * |A| + a
  SparseRows<Scalar> observed_;     // row s' * |A| + a
  CassandraRewards<Scalar> rewards_;
  std::vector<Scalar> start_;
  bool start_given_ = false;
  bool start_scaled_ = false;
  std::size_t expansions_ = 0;
  std::size_t observed_rewards_ = 0;  // terms summed over observations
};

}  // namespace

template <class Scalar>
Model<Scalar> read_cassandra(std::string_view text, std::string_view file_name, const ReadOptions& options) {
  return CassandraReader<Scalar>(text, file_name, options).read();
}

template Model<double> read_cassandra(std::string_view, std::string_view, const ReadOptions&);
template Model<Rational> read_cassandra(std::string_view, std::string_view, const ReadOptions&);

}  // namespace maximin
