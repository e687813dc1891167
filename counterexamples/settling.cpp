#include <fmt/format.h>

#include <maximin/counterexamples/exact_text.hpp>
#include <maximin/counterexamples/gallery.hpp>
#include <maximin/models/builtin_models.hpp>
#include <maximin/models/rationalise.hpp>
#include <maximin/proofs_check/certificate/certificate.hpp>

namespace maximin {
namespace {

Model<Rational> model() {
  Model<Rational> model = rationalise(builtin_model("cycling"));
  model.name = "settling";
  model.state_names = {"s0", "s1"};
  model.action_names = {"a0", "a1"};
  return model;
}

Counterexample::Finding check(const Model<Rational>& model) {
  const Certificate certificate = certify(model, {}, {.only = {{ClaimId::lemma_3}}});
  Counterexample::Finding finding{{"period of the policy pairs", 1}, {"period of the policy pairs", 0}, false, {}};
  if (!certificate.limit) {
    finding.evidence.push_back("no limit was certified");
    return finding;
  }
  const CertifiedLimit& limit = *certificate.limit;
  finding.found.value = limit.period;
  finding.refuted = limit.period > 1;
  finding.evidence.push_back(fmt::format("certified for all rounds from {} on", certificate.rounds.size()));
  for (std::size_t j = 0; j < limit.orbit.size(); ++j) {
    finding.evidence.push_back(fmt::format("phase {}: values read {}", j, exact_text(model, limit.orbit[j])));
  }
  return finding;
}

}  // namespace

Counterexample settling() {
  return {
      .name = "settling",
      .title = "Pessimistic Q-iteration need not settle",
      .claim = "From some round on, pessimistic Q-iteration (Algorithm 3) uses one and the same pair of policies.",
      .explanation =
          "Two states look alike, so pi_n is one action for both. What is best against the attack of one round is the\n"
          "wrong action for the next, and the pair comes back to itself every third round. That it does so for ever "
          "is\n"
          "proved: the orbit of period 3 is solved exactly, and Q_n lies nearer to it than any comparison that picks "
          "an\n"
          "action on it can tell; gamma brings it nearer still. Theorem 1 bounds the loss along the orbit; it does "
          "not\n"
          "say that there is a limit.",
      .model = model,
      .check = check,
  };
}

}  // namespace maximin
