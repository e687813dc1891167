#include <optional>

#include <fmt/format.h>

#include <maximin/counterexamples/exact_text.hpp>
#include <maximin/counterexamples/gallery.hpp>
#include <maximin/models/builtin_models.hpp>
#include <maximin/models/rationalise.hpp>
#include <maximin/proofs_check/certificate/certificate.hpp>

namespace maximin {
namespace {

Model<Rational> model() {
  FiniteMdpBuilder<Rational> b(3, 2, Rational(9, 10));
  b.transition(0, 0, 2, 1).reward(0, 0, -1).transition(0, 1, 0, 1).reward(0, 1, 1);
  b.transition(1, 0, 0, 1).reward(1, 0, 1).transition(1, 1, 1, 1).reward(1, 1, -1);
  b.transition(2, 0, 2, 1).transition(2, 1, 0, 1);
  Model<Rational> model{.mdp = std::move(b).build()};
  model.geometry.kind = Geometry<Rational>::Kind::points;
  model.geometry.norm = Norm::l1;
  model.geometry.eps = Rational(1);
  model.geometry.points.resize(3, 1);
  model.geometry.points << Rational(0), Rational(1), Rational(2);
  model.name = "myopic-attack";
  model.state_names = {"s0", "s1", "s2"};
  model.action_names = {"a0", "a1"};
  return model;
}

/// Where omega_n leaves most above what the optimal attack on pi_n leaves, over the phases of the limit.
struct Widest {
  long phase = -1;
  State state = -1;
  Rational myopic, optimal;
};

std::optional<Widest> widest(const CertifiedLimit& limit) {
  std::optional<Widest> result;
  for (std::size_t j = 0; j < limit.orbit.size(); ++j) {
    if (!limit.fixed[j] || !limit.attained[j]) continue;
    for (State s = 0; s < limit.low[j].size(); ++s) {
      const Rational &myopic = (*limit.fixed[j])[s], &optimal = limit.low[j][s];
      if (result && myopic - optimal <= result->myopic - result->optimal) continue;
      result = Widest{static_cast<long>(j), s, myopic, optimal};
    }
  }
  return result;
}

Counterexample::Finding check(const Model<Rational>& model) {
  const Certificate certificate = certify(model, {}, {.only = {{ClaimId::lemma_3}}});
  Counterexample::Finding finding{{"the best response omega_n leaves", 0}, {"the optimal attack leaves", 0}, false, {}};
  const auto where = certificate.limit ? widest(*certificate.limit) : std::nullopt;
  if (!where) {
    finding.evidence.push_back("no limit with one pair of policies per phase was certified");
    return finding;
  }
  finding.promised.value = where->myopic;
  finding.found.value = where->optimal;
  finding.refuted = where->optimal < where->myopic;
  const CertifiedLimit& limit = *certificate.limit;
  finding.evidence.push_back(fmt::format("from {}, in every round n = {} + {} k", model.state_name(where->state),
                                         certificate.rounds.size() + static_cast<std::size_t>(where->phase),
                                         limit.period));
  for (std::size_t j = 0; j < limit.orbit.size(); ++j) {
    if (!limit.fixed[j]) continue;
    finding.evidence.push_back(fmt::format("phase {}: omega_n leaves {}; the optimal attack {}", j,
                                           exact_text(model, *limit.fixed[j]), exact_text(model, limit.low[j])));
  }
  return finding;
}

}  // namespace

Counterexample myopic_attack() {
  return {
      .name = "myopic-attack",
      .title = "The attack that pessimistic Q-iteration assumes is not the strongest",
      .claim = "However long pessimistic Q-iteration runs, omega_n is in the end the optimal attack on pi_n.",
      .explanation =
          "omega_n is best against pi_n for an attacker who believes Q_n, and Q_n is what earlier pairs made of the "
          "model.\n"
          "Were the pair to settle, Q_n would tend to a fixed point of R + gamma P min_{t in B(.)} Q(., pi(t)), and "
          "omega\n"
          "would be optimal: a counterexample in the limit must cycle. This one has period 3, certified for ever. In "
          "every\n"
          "third round omega_n drives the agent from s1 to s0, where pi_n stays at +1 a step: worth 10. For "
          "Q_n\n"
          "was backed up while the pair before it left s0 at a cost, and the optimal attack keeps it in s1: "
          "-10.\n"
          "So the value of (pi_n, omega_n) is not what pi_n guarantees; strengthening A bounds the latter as well.\n"
          "With fewer than 3 states the attacker has no choice to make, and with 1 action neither.",
      .model = model,
      .check = check,
  };
}

}  // namespace maximin
