#include <maximin/apps/maximin_deep/table_plan.hpp>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include <fmt/format.h>

#include <maximin/deep/attacks/named_attack.hpp>
#include <maximin/deep/report/estimate.hpp>

namespace maximin::apps {

namespace {

constexpr const char* paper_block = "the paper's attacks";
constexpr const char* further_block = "attacks that the paper did not try";
constexpr const char* strongest_block = "the strongest of these";
constexpr const char* ablation_block = "ablation";
constexpr const char* noisy_block = "noisy environment";
constexpr const char* aggregator_block = "aggregators of BP-DQN";

constexpr double radii[] = {0.1, 0.5};

/// What a simple agent, the mean of an exact belief, came to in a probe before any of this was trained: what the
/// strongest attack must leave of ours, at the smaller and the larger radius.
constexpr double strongest_target = 161, strongest_target_wide = 73;

struct Row {
  const char* kind;
  const char* title;
  const char* belief = "";  ///< this and what follows: how it acts otherwise than it was trained to
  const char* aggregator = "";
  const char* filter_of = "";
  double random_actions = -1;
};

/// The agent that the targets are for.
constexpr Row ours{"bp-dqn", "BP-DQN (exact belief, mean)"};
/// The paper's belief and aggregator.
constexpr Row with_minimum{"bp-dqn-printed", "BP-DQN (PF-LSTM, min)"};

const std::vector<Row>& agents() {
  static const std::vector<Row> rows{{"dqn", "DQN"},
                                     {"sa-dqn", "SA-DQN"},
                                     {"wocar-dqn", "WocaR-DQN"},
                                     {"radial-dqn", "Radial-DQN"},
                                     {"car-dqn", "CAR-DQN"},
                                     ours,
                                     {"bp-dqn-lstm", "BP-DQN (PF-LSTM, mean)"},
                                     with_minimum};
  return rows;
}

constexpr Row sure_agent{"sure", "Sure agent (exact belief, no network)"};

using Figure = std::optional<deep::PaperFigure>;

/// Means and standard deviations that the paper prints (its tables of the continuous Gridworld), by agent and column.
Figure paper_figure(const std::string& block, const std::string& row, const std::string& attack, double eps) {
  using Key = std::pair<std::string, std::string>;
  const bool released = attack == "pgd-released";  // the authors' code for what the paper calls PGD
  const std::string column = attack == "none" ? "none" : fmt::format("{} {:g}", released ? "pgd" : attack, eps);
  static const std::map<Key, deep::PaperFigure> main{{{"DQN", "none"}, {156.5, 90.2}},
                                                     {{"DQN", "pgd 0.1"}, {128, 118}},
                                                     {{"DQN", "pgd 0.5"}, {-53, 86}},
                                                     {{"DQN", "min-best 0.1"}, {98.2, 137}},
                                                     {{"DQN", "min-best 0.5"}, {98.2, 137}},
                                                     {{"DQN", "pa-ad 0.1"}, {-10.7, 136}},
                                                     {{"DQN", "pa-ad 0.5"}, {-35.9, 118}},
                                                     {{"SA-DQN", "none"}, {20.8, 140}},
                                                     {{"SA-DQN", "pgd 0.1"}, {46, 142}},
                                                     {{"SA-DQN", "pgd 0.5"}, {-100, 0}},
                                                     {{"SA-DQN", "min-best 0.1"}, {-5.8, 131}},
                                                     {{"SA-DQN", "min-best 0.5"}, {-100, 0}},
                                                     {{"SA-DQN", "pa-ad 0.1"}, {-97.5, 13.6}},
                                                     {{"SA-DQN", "pa-ad 0.5"}, {-67.8, 78.3}},
                                                     {{"WocaR-DQN", "none"}, {-63, 88}},
                                                     {{"WocaR-DQN", "pgd 0.1"}, {-100, 0}},
                                                     {{"WocaR-DQN", "pgd 0.5"}, {-63.2, 88}},
                                                     {{"WocaR-DQN", "min-best 0.1"}, {-100, 0}},
                                                     {{"WocaR-DQN", "min-best 0.5"}, {-63.2, 88}},
                                                     {{"WocaR-DQN", "pa-ad 0.1"}, {-100, 0}},
                                                     {{"WocaR-DQN", "pa-ad 0.5"}, {-63.2, 88}},
                                                     {{"Radial-DQN", "none"}, {-100, 0}},
                                                     {{"Radial-DQN", "pgd 0.1"}, {-96.1, 12.3}},
                                                     {{"Radial-DQN", "pgd 0.5"}, {-96.1, 12.3}},
                                                     {{"Radial-DQN", "min-best 0.1"}, {-100, 0}},
                                                     {{"Radial-DQN", "min-best 0.5"}, {-100, 0}},
                                                     {{"Radial-DQN", "pa-ad 0.1"}, {-100, 0}},
                                                     {{"Radial-DQN", "pa-ad 0.5"}, {-100, 0}},
                                                     {{"BP-DQN", "none"}, {163, 26}},
                                                     {{"BP-DQN", "pgd 0.1"}, {165, 29}},
                                                     {{"BP-DQN", "pgd 0.5"}, {176, 16}},
                                                     {{"BP-DQN", "min-best 0.1"}, {147, 88}},
                                                     {{"BP-DQN", "min-best 0.5"}, {114, 114}},
                                                     {{"BP-DQN", "pa-ad 0.1"}, {171.9, 17}},
                                                     {{"BP-DQN", "pa-ad 0.5"}, {177.2, 10.6}}};
  static const std::map<Key, deep::PaperFigure> ablation{{{"maximin only", "pgd 0.5"}, {-71, 91}},
                                                         {{"belief only", "pgd 0.5"}, {45.7, 134}},
                                                         {{"BP-DQN", "pgd 0.5"}, {176, 16}}};
  static const std::map<Key, deep::PaperFigure> noisy{
      {{"BP-DQN", "none"}, {102, 110}},          {{"BP-DQN", "pgd 0.1"}, {101.5, 109}},
      {{"BP-DQN", "pgd 0.5"}, {56, 135}},        {{"BP-DQN", "min-best 0.1"}, {79.3, 125}},
      {{"BP-DQN", "min-best 0.5"}, {30.7, 138}}, {{"BP-DQN", "pa-ad 0.1"}, {78.6, 125}},
      {{"BP-DQN", "pa-ad 0.5"}, {13.1, 140}}};
  const auto& figures = block == ablation_block ? ablation : block == noisy_block ? noisy : main;
  const bool is_bp_dqn = block == ablation_block ? row == with_minimum.title : row.starts_with("BP-DQN");
  const std::string agent = is_bp_dqn ? "BP-DQN" : row;
  const auto found = figures.find({agent, column});
  if (block == aggregator_block || found == figures.end() || (released && block != further_block)) return std::nullopt;
  return found->second;
}

PlannedCell planned(const std::string& block, const Row& row, double trained_eps, const std::string& attack,
                    double attack_eps) {
  PlannedCell p;
  p.block = block;
  p.kind = row.kind;
  p.trained_eps = trained_eps;
  p.change.belief = row.belief;
  p.change.aggregator = row.aggregator;
  p.change.random_actions = row.random_actions;
  p.filter_of = row.filter_of;
  p.attack = attack;
  p.attack_eps = attack_eps;
  p.cell.agent = row.title;
  p.cell.attack = deep::attack_named(attack).title;
  p.cell.eps = attack_eps;
  p.cell.paper = paper_figure(block, row.title, attack, attack_eps);
  if (attack == "none" && trained_eps > radii[0]) {
    p.cell.attack += fmt::format(", trained for {:g}", trained_eps);
    p.cell.paper.reset();
  }
  if (block != ablation_block && row.title == std::string(ours.title) && p.cell.paper) {
    p.cell.target = deep::Target{deep::Target::Sense::at_least, p.cell.paper->mean};
  }
  return p;
}

/// At both radii, trained for each, or all trained for `trained_eps`. Without attack the radius is that of the
/// training, of which a vanilla agent has none.
void add_columns(std::vector<PlannedCell>& plan, const char* block, const Row& row,
                 const std::vector<std::string>& attacks, std::optional<double> trained_eps = std::nullopt) {
  const bool one_training = trained_eps || std::string(row.kind) == "dqn";
  for (const std::string& attack : attacks) {
    for (const double eps : radii) {
      if (attack == "none" && one_training && eps > radii[0]) continue;
      plan.push_back(planned(block, row, trained_eps.value_or(eps), attack, attack == "none" ? 0 : eps));
    }
  }
}

std::vector<std::string> attacks_where(bool in_paper) {
  std::vector<std::string> names;
  for (const deep::NamedAttack& a : deep::named_attacks()) {
    if (a.in_paper == in_paper) names.push_back(a.name);
  }
  return names;
}

/// The runs of a cell that are of these seeds.
std::vector<deep::SeedRun> of_seeds(const deep::ResultCell& cell, const std::set<std::uint64_t>& seeds) {
  std::vector<deep::SeedRun> runs = cell.runs;
  std::erase_if(runs, [&](const deep::SeedRun& r) { return !seeds.contains(r.training_seed); });
  return runs;
}

/// All that attacked the agent at this radius, in both blocks, but for what was not run at all.
std::vector<const deep::ResultCell*> attacks_on(const deep::ResultTable& table, const std::string& agent, double eps) {
  std::vector<const deep::ResultCell*> cells;
  for (const char* name : {paper_block, further_block}) {
    const deep::ResultBlock* block = table.find(name);
    if (!block) continue;
    for (const deep::ResultCell& cell : block->cells) {
      if (cell.agent == agent && cell.eps == eps && !cell.runs.empty()) cells.push_back(&cell);
    }
  }
  return cells;
}

/// What is least of all attacks on this cell's agent, compared over common seeds.
deep::ResultCell strongest(const deep::ResultTable& table, const deep::ResultCell& of) {
  deep::ResultCell out;
  out.agent = of.agent;
  out.attack = "strongest";
  out.eps = of.eps;
  const std::vector<const deep::ResultCell*> cells = attacks_on(table, of.agent, of.eps);
  if (cells.empty()) return out;
  std::set<std::uint64_t> common;
  for (const deep::SeedRun& r : cells.front()->runs) common.insert(r.training_seed);
  for (const deep::ResultCell* cell : cells) {
    std::erase_if(common, [&](std::uint64_t seed) { return of_seeds(*cell, {seed}).empty(); });
  }
  if (common.empty()) return out;
  for (const deep::ResultCell* cell : cells) {
    std::vector<deep::SeedRun> runs = of_seeds(*cell, common);
    if (!out.runs.empty() && deep::estimate(out.runs).mean <= deep::estimate(runs).mean) continue;
    out.runs = std::move(runs);
    out.note = "by " + cell->attack;
  }
  if (of.agent == ours.title) {
    out.target = deep::Target{deep::Target::Sense::at_least, of.eps < 0.3 ? strongest_target : strongest_target_wide};
  }
  return out;
}

}  // namespace

deep::AgentSpec spec_of(const PlannedCell& cell, std::uint64_t seed, const deep::Effort& effort) {
  deep::AgentSpec spec = deep::recipe(cell.kind, cell.trained_eps, seed, effort);
  if (!cell.config.empty()) deep::merge_json(spec, nlohmann::ordered_json::parse(cell.config), "plan");
  return spec;
}

std::vector<PlannedCell> gridworld_plan() {
  std::vector<PlannedCell> plan;
  const std::vector<std::string> of_paper = attacks_where(true), further = attacks_where(false);
  for (const Row& row : agents()) add_columns(plan, paper_block, row, of_paper);
  // Three directors take an hour of a particle filter, and the one that it has is enough to ruin it.
  std::vector<std::string> on_particles = further;
  std::erase(on_particles, "directors");
  const auto has_particles = [](const Row& row) {
    return deep::recipe(row.kind, radii[0], 1, {}).has_particle_filter();
  };
  for (const Row& row : agents()) {
    add_columns(plan, further_block, row, has_particles(row) ? on_particles : further);
  }
  // Nothing of it can be differentiated.
  std::vector<std::string> on_sure = further;
  std::erase(on_sure, "through-defence");
  add_columns(plan, paper_block, sure_agent, of_paper);
  add_columns(plan, further_block, sure_agent, on_sure);
  // The paper has PGD alone here.
  const std::vector<std::string> ablated{"pgd", "best-response"};
  add_columns(plan, ablation_block, with_minimum, ablated);
  add_columns(plan, ablation_block, {"bp-dqn-printed", "maximin only", "ball", "min"}, ablated);
  add_columns(plan, ablation_block, {"dqn", "belief only", "pf-lstm-mean", "mean", "bp-dqn-printed"}, ablated);
  // What of BP-DQN is belief, what random actions, what training.
  const std::vector<std::string> of_ours{"pgd", "best-response", "constant-offset", "director"};
  add_columns(plan, ablation_block, {"dqn", "DQN, 2 % random actions", "", "", "", 0.02}, of_ours);
  const Row dqn_on_belief{"dqn", "DQN on the exact belief, mean", "exact", "mean"};
  add_columns(plan, ablation_block, dqn_on_belief, of_ours);
  add_columns(plan, ablation_block,
              {"dqn", "DQN on the exact belief, mean, 2 % random actions", "exact", "mean", "", 0.02}, of_ours);
  add_columns(plan, ablation_block, {"bp-dqn", "BP-DQN (exact belief, mean), no random actions", "", "", "", 0},
              of_ours);
  add_columns(plan, ablation_block, ours, of_ours);
  for (const Row& row : {dqn_on_belief, ours}) add_columns(plan, ablation_block, row, {"directors"});
  const Row noisy{"bp-dqn-noisy", "BP-DQN, learned in noise"};
  for (const auto& attacks : {of_paper, on_particles}) add_columns(plan, noisy_block, noisy, attacks, radii[0]);
  return plan;
}

std::vector<PlannedCell> aggregators_plan() {
  struct Choice {
    const char* aggregator;
    double random_actions;
  };
  std::vector<PlannedCell> plan;
  for (const Choice& choice : {Choice{"min", 0}, Choice{"cvar:0.25", 0}, Choice{"cvar:0.5", 0}, Choice{"soft-min:1", 0},
                               Choice{"mean", 0}, Choice{"mean", 0.02}, Choice{"mean", 0.05}}) {
    const std::size_t first = plan.size();
    std::vector<std::string> all = attacks_where(true);
    for (const std::string& name : attacks_where(false)) all.push_back(name);
    const std::string title = choice.random_actions > 0 ? fmt::format("{}, {:g} % random actions", choice.aggregator,
                                                                      100 * choice.random_actions)
                                                        : choice.aggregator;
    add_columns(plan, aggregator_block, {"bp-dqn", title.c_str()}, all);
    for (std::size_t i = first; i < plan.size(); ++i) {
      plan[i].config = fmt::format(R"({{"kind": "bp-dqn-{0}", "aggregator": "{0}"}})", choice.aggregator);
      plan[i].change.random_actions = choice.random_actions;
    }
  }
  return plan;
}

bool is_in_quick_table(const PlannedCell& cell) {
  if (cell.attack_eps > 0) return cell.attack_eps == radii[1];
  return cell.trained_eps == radii[1] || cell.kind == "dqn";
}

std::string block_note(const std::string& block, const deep::Effort& effort) {
  const auto training = [&](const char* kind) {
    const deep::TrainOptions o = deep::recipe(kind, 0.1, 1, effort).training;
    return fmt::format("{} frames and {} updates", o.frames, o.frames / o.frames_per_update);
  };
  if (block == paper_block) {
    return fmt::format(
        "DQN: a double DQN, {}. All others go on from it: BP-DQN for {}, under a mixture of random, constant, PGD, "
        "MinBest and best-response observations (with PF-LSTM and min under PGD alone), SA, WocaR, Radial and CAR for "
        "{}, without attack, as they are defined; their bounds take most of the time. BP-DQN with the mean has three "
        "things more that no other has, chosen on another seed: that aggregator, 2 % random actions, and the average "
        "of its last weights; see the ablation. Losses see rewards times 0.02: so are lambda of CAR and the margin of "
        "SA to be read. SA, WocaR, Radial and CAR may be under-trained. All networks have waves of the coordinates as "
        "features, "
        "which lead the gradients of PGD and MinBest astray, so that as many random looks find more: the searches "
        "below, for the same objectives, are the attacks on the network to judge by. Attacks see the network, not "
        "beliefs; in the place of the sure agent's, which has none, a vanilla DQN. Truth in belief and belief area "
        "are of the set; of a particle filter they are of the box around its particles, widened by a quarter of the "
        "radius.",
        training("dqn"), training("bp-dqn"), training("sa-dqn"));
  }
  if (block == further_block) {
    return "Random and constant offset look at the truth alone; PGD as released (with the paper's figures for PGD), "
           "PGD from 10 starts and the two searches at the network; the others at the whole defence. Best responses "
           "and the descent are judged by the values of a vanilla DQN of a seed that no training saw; for the director "
           "they are what it begins with. A director is taught once, and another seed may teach a stronger or a weaker "
           "one: the worst of three is the one of three that left least in 200 episodes of their own. Particle filters "
           "met a single one.";
  }
  if (block == ablation_block) {
    return "Maximin only: the same network, acting on the ball. Belief only: DQN on the mean of the particles. The "
           "rest is not in the paper.";
  }
  if (block == noisy_block) {
    return "Trained under PGD at 0.1 from the beginning, learning from what it believes instead of the truth, its "
           "particle filter from 30 trajectories over and over; it acts by the mean, with 2 % random actions, as the "
           "paper's does not. Attacked at both radii.";
  }
  return "";
}

void add_strongest(deep::ResultTable& table) {
  deep::ResultBlock out;
  out.name = strongest_block;
  out.derived = true;
  out.note =
      "For each agent and radius the attack of the two blocks above that left it least on average, over the seeds "
      "that all of them were run on. The least of so many means is a little too low, and another attack may be "
      "stronger. To show the truth is an attack too, under natural above; it is left out here. The targets, set "
      "beforehand, are what a simple agent on the mean of an exact belief came to in a probe.";
  for (const char* name : {paper_block, further_block}) {
    const deep::ResultBlock* block = table.find(name);
    if (!block) continue;
    for (const deep::ResultCell& cell : block->cells) {
      if (cell.eps > 0 && !out.find(cell.agent, "strongest", cell.eps)) out.cells.push_back(strongest(table, cell));
    }
  }
  std::erase_if(out.cells, [](const deep::ResultCell& c) { return c.runs.empty(); });
  if (out.cells.empty()) return;
  std::erase_if(table.blocks, [](const deep::ResultBlock& b) { return b.name == strongest_block; });
  const auto last = std::find_if(table.blocks.rbegin(), table.blocks.rend(), [](const deep::ResultBlock& b) {
    return b.name == further_block || b.name == paper_block;
  });
  table.blocks.insert(last.base(), std::move(out));
}

}  // namespace maximin::apps
