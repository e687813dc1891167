#include "checker.hpp"

#include <algorithm>
#include <istream>

#include "claims.hpp"

namespace maximin::checker {
namespace {

Report check_sections(const Node& root) {
  root.expect_members({"format", "version", "model", "reading", "tie", "constants", "optimal", "pairs", "rounds",
                       "limit", "test_time", "belief_game", "claims"});
  root.member("format").one_of({"maximin-certificate"});
  root.member("version").integer(1, 1);
  const Model model = read_model(root.member("model"));
  const bool paper = root.member("reading").one_of({"corrected", "paper"}) == 1;
  const bool highest = root.member("tie").one_of({"lowest", "highest"}) == 1;

  const Table q_star = check_optimal(root.member("optimal"), model);
  const Constants constants = check_constants(root.member("constants"), model, q_star);

  const std::vector<Pair> pairs = check_pairs(root.member("pairs"), model);
  const std::size_t n = root.member("rounds").items().size();
  if (n == 0 || pairs.empty()) refuse("$.rounds", "no round, or no pair for one, expected a round at least");
  const Indices rounds = root.member("rounds").indices(n, pairs.size());
  const bool decided = !root.member("limit").is_null();
  const std::size_t phases =
      decided && root.member("limit").has("orbit") ? root.member("limit").member("orbit").items().size() : 0;
  std::vector<ClaimCheck> checks = read_claims(root.member("claims"), model, n + phases);
  Claims claims(checks, model, constants, paper, q_star, pairs, n);

  const Table last =
      check_rounds(rounds, model, pairs, highest, [&claims](const Round& round) { claims.of_round(round); });
  std::optional<Limit> limit;
  if (decided) limit = check_limit(root.member("limit"), model, last, highest);
  claims.of_limit(limit ? &*limit : nullptr, last);
  claims.of_test_time(check_test_time(root.member("test_time"), model, q_star, highest));
  std::optional<BeliefGame> game;
  const Node belief_game = root.member("belief_game");
  if (!belief_game.is_null()) game = check_belief_game(belief_game, model, q_star, highest);
  claims.of_belief_game(game ? &*game : nullptr);

  Report report{model.states, model.actions, n, phases, {}, left_out(checks)};
  for (const ClaimCheck& check : checks) {
    if (!check.undetermined()) check.verify();
    report.claims.push_back(check.verdict());
  }
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
