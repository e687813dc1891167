#include "checker.hpp"

#include <algorithm>
#include <istream>

#include "claims.hpp"

namespace maximin::checker {
namespace {

/// How many phases the limit has, which claims can name; whether it is one is for later.
std::size_t phases_of(const Node& limit) {
  for (const char* name : {"orbit", "boxes"}) {
    if (limit.has(name)) return limit.member(name).items().size();
  }
  return 0;
}

void check_exactly(const Node& root, const Model& model, const Optimal& optimal, bool highest, Claims& claims) {
  const std::vector<Pair> pairs = check_pairs(root.member("pairs"), model);
  const std::size_t n = root.member("rounds").items().size();
  if (pairs.empty()) refuse("$.pairs", "empty, expected that of a round at least");
  claims.of_pairs(pairs);
  const Indices rounds = root.member("rounds").indices(n, pairs.size());
  const LastRound last =
      check_rounds(rounds, model, pairs, highest, [&claims](const Round& round) { claims.of_round(round); });
  const Node limit = root.member("limit");
  if (limit.has("boxes")) {
    check_boxes(limit, model, last, n, highest, [&claims](const Box& box) { claims.of_box(box); });
  } else if (!limit.is_null()) {
    claims.of_limit(check_limit(limit, model, last.q, highest), last.q);
  }
  claims.of_test_time(check_test_time(root.member("test_time"), model, optimal.q.high, highest));
}

void check_by_bounds(const Node& root, const Model& model, const Optimal& optimal, bool highest, Claims& claims) {
  const auto visit = [&claims](const Box& box) { claims.of_box(box); };
  const LastRound last = check_rounds_by_bounds(root, model, highest, visit);
  const Node limit = root.member("limit");
  const std::size_t n = root.member("rounds").items().size();
  if (!limit.is_null()) check_boxes(limit, model, last, n, highest, visit);
  claims.of_test_time(check_test_time_by_bounds(root.member("test_time"), model, optimal.q, highest));
}

Report check_sections(const Node& root) {
  const bool bounds =
      root.has("format") && root.member("format").one_of({"maximin-certificate", "maximin-bounds"}) == 1;
  std::vector<const char*> names{"format", "version", "model", "reading",   "tie",         "constants", "optimal",
                                 "pairs",  "rounds",  "limit", "test_time", "belief_game", "claims"};
  if (bounds) names.push_back("bits");
  root.expect_members(names);
  root.member("version").integer(1, 1);
  const Limits& limits = root.limits();
  const Model model = read_model(root.member("model"), bounds ? limits.states_by_bounds : limits.states);
  const bool paper = root.member("reading").one_of({"corrected", "paper"}) == 1;
  const bool highest = root.member("tie").one_of({"lowest", "highest"}) == 1;
  const Optimal optimal = (bounds ? check_optimal_by_bounds : check_optimal)(root.member("optimal"), model);
  const Constants constants = check_constants(root.member("constants"), model, optimal.q, bounds);
  const std::size_t n = root.member("rounds").items().size(), phases = phases_of(root.member("limit"));
  if (n == 0) refuse("$.rounds", "no round, expected one at least");
  std::vector<ClaimCheck> checks = read_claims(root.member("claims"), model, n + phases, bounds);
  Claims claims(checks, model, constants, paper, optimal, n);
  if (root.member("limit").is_null()) claims.of_no_limit();
  (bounds ? check_by_bounds : check_exactly)(root, model, optimal, highest, claims);
  std::optional<BeliefGame> game;
  const Node belief_game = root.member("belief_game");
  if (!belief_game.is_null()) game = check_belief_game(belief_game, model, optimal.q, highest, bounds);
  claims.of_belief_game(game ? &*game : nullptr);
  claims.verify();

  Report report{model.states, model.actions,           n, phases, bounds, root.member("limit").has("boxes"),
                {},           left_out(checks, bounds)};
  for (const ClaimCheck& check : checks) report.claims.push_back(check.verdict());
  return report;
}

}  // namespace

std::string_view Report::worst() const {
  for (const std::string_view verdict : {"violated", "undetermined"}) {
    if (std::any_of(claims.begin(), claims.end(), [&](const ClaimVerdict& c) { return c.verdict == verdict; })) {
      return verdict;
    }
  }
  return "holds";
}

Report check(std::string_view text, const Limits& limits) {
  const nlohmann::json json = parse_json(text, limits);
  return check_sections(Node(json, "$", limits));
}

Report check(std::istream& in, const Limits& limits) {
  std::string text;
  std::vector<char> block(std::size_t{1} << 16U);
  while (in && text.size() <= limits.bytes) {
    in.read(block.data(), static_cast<std::streamsize>(block.size()));
    text.append(block.data(), static_cast<std::size_t>(in.gcount()));
  }
  return check(text, limits);
}

}  // namespace maximin::checker
