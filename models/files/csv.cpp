#include <maximin/models/files/csv.hpp>

#include <algorithm>
#include <array>
#include <tuple>
#include <utility>
#include <vector>

#include <maximin/models/files/internal/choice_table.hpp>
#include <maximin/models/files/internal/text_lines.hpp>
#include <maximin/theory/rational.hpp>

namespace maximin {

namespace {

using namespace internal;

constexpr std::array<std::string_view, 5> columns = {"idstatefrom", "idaction", "idstateto", "probability", "reward"};

/// Splits a line at its commas; fails unless there are five fields.
std::array<std::string_view, 5> split(const TextLines& lines) {
  std::array<std::string_view, 5> fields;
  std::string_view rest = lines.line();
  std::size_t count = 0;
  for (bool more = true; more; ++count) {
    const std::size_t comma = rest.find(',');
    more = comma != std::string_view::npos;
    if (count < fields.size()) fields[count] = trimmed(rest.substr(0, comma));
    if (more) rest.remove_prefix(comma + 1);
  }
  if (count != fields.size()) {
    lines.fail(fmt::format("{} fields, expected 5: {}", count, fmt::join(columns, ",")));
  }
  return fields;
}

template <class Scalar>
struct CsvRow {
  std::uint64_t from, action, to;
  Scalar probability, reward;
  std::size_t at;
};

template <class Scalar>
class CsvReader {
 public:
  CsvReader(std::string_view text, std::string_view file, const ReadOptions& options)
      : source_(file), lines_(source_, text), options_(options) {
    source_.require_text(text);
  }

  Model<Scalar> read() {
    read_rows();
    std::stable_sort(rows_.begin(), rows_.end(), [](const auto& x, const auto& y) {
      return std::tie(x.from, x.action) < std::tie(y.from, y.action);
    });
    ChoiceTable<Scalar> table(source_, options_);
    std::size_t next = 0;
    for (std::uint64_t s = 0; s < states_; ++s) {
      table.begin_state();
      if (next == rows_.size() || rows_[next].from != s) {
        source_.fail(0, fmt::format("state {}: no transitions, expected at least one action", s));
      }
      for (std::uint64_t a = 0; next < rows_.size() && rows_[next].from == s; ++a) read_choice(table, s, a, next);
    }
    std::vector<std::string> notes;
    const Scalar discount = choose_discount<Scalar>(source_, options_, std::nullopt, 0, notes);
    return table.flatten({}, discount, std::move(notes));
  }

 private:
  void read_rows() {
    std::array<std::size_t, 5> place = {0, 1, 2, 3, 4};
    bool first = true;
    while (lines_.next_filled()) {
      const std::array<std::string_view, 5> fields = split(lines_);
      if (std::exchange(first, false) && !parse_count(fields[0]) && !split_number(fields[0])) {
        place = read_header(fields);
        continue;
      }
      if (rows_.size() >= options_.limits.transitions) {
        lines_.fail(fmt::format("more than {} transitions, expected fewer", options_.limits.transitions));
      }
      const auto count = [&](std::size_t i) {
        return read_count(source_, lines_.number(), columns[i], fields[place[i]]);
      };
      const auto number = [&](std::size_t i) {
        return read_number<Scalar>(source_, lines_.number(), columns[i], fields[place[i]]);
      };
      rows_.push_back({count(0), count(1), count(2), number(3), number(4), lines_.number()});
      check_states(rows_.back());
    }
    if (rows_.empty())
      source_.fail(0, "no transitions, expected lines of " + fmt::format("{}", fmt::join(columns, ",")));
    // Every state needs a line of its own, so a larger id cannot be right and is refused before it is believed.
    for (const auto& row : rows_) {
      const std::uint64_t largest = std::max(row.from, row.to);
      if (largest >= rows_.size()) {
        source_.fail(row.at, fmt::format("state {} in a file of {} transitions, expected every state to have one",
                                         largest, rows_.size()));
      }
      states_ = std::max(states_, largest + 1);
    }
  }

  void check_states(const CsvRow<Scalar>& row) const {
    if (row.from > options_.limits.pairs || row.to > options_.limits.pairs) {
      lines_.fail(
          fmt::format("state {}: too large, expected at most {}", std::max(row.from, row.to), options_.limits.pairs));
    }
  }

  std::array<std::size_t, 5> read_header(const std::array<std::string_view, 5>& fields) const {
    std::array<std::size_t, 5> place{};
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const auto found = std::find(fields.begin(), fields.end(), columns[i]);
      if (found == fields.end()) {
        lines_.fail(fmt::format("header without '{}', expected {}", columns[i], fmt::join(columns, ",")));
      }
      place[i] = static_cast<std::size_t>(found - fields.begin());
    }
    return place;
  }

  void read_choice(ChoiceTable<Scalar>& table, std::uint64_t s, std::uint64_t a, std::size_t& next) const {
    if (rows_[next].action != a) {
      source_.fail(rows_[next].at, fmt::format("state {} has action {} but not action {}, expected actions from 0 "
                                               "without a gap",
                                               s, rows_[next].action, a));
    }
    table.begin_choice({}, rows_[next].at);
    WeightedMean<Scalar> reward;
    for (; next < rows_.size() && rows_[next].from == s && rows_[next].action == a; ++next) {
      const auto& row = rows_[next];
      table.branch(static_cast<State>(row.to), {row.probability, row.probability}, row.at);
      reward.add(row.probability, row.reward);
    }
    table.choice(table.choices() - 1).reward = reward.value();
  }

  TextSource source_;
  TextLines lines_;
  const ReadOptions& options_;
  std::vector<CsvRow<Scalar>> rows_;
  std::uint64_t states_ = 0;
};

}  // namespace

template <class Scalar>
Model<Scalar> read_csv(std::string_view text, std::string_view file_name, const ReadOptions& options) {
  return CsvReader<Scalar>(text, file_name, options).read();
}

template <class Scalar>
void write_csv(const Model<Scalar>& model, std::ostream& out) {
  const FiniteMdp<Scalar>& mdp = model.mdp;
  out << fmt::format("{}\n", fmt::join(columns, ","));
  for (State s = 0; s < mdp.states(); ++s) {
    for (Action a = 0; a < mdp.actions(); ++a) {
      for (const auto& next : mdp.successors(s, a)) {
        out << s << ',' << a << ',' << next.target << ',' << number_text(next.probability) << ','
            << number_text(mdp.reward(s, a)) << '\n';
      }
    }
  }
}

template Model<double> read_csv(std::string_view, std::string_view, const ReadOptions&);
template Model<Rational> read_csv(std::string_view, std::string_view, const ReadOptions&);
template void write_csv(const Model<double>&, std::ostream&);

}  // namespace maximin
