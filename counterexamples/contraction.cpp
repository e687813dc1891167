#include <vector>

#include <fmt/format.h>

#include <maximin/counterexamples/exact_text.hpp>
#include <maximin/counterexamples/gallery.hpp>
#include <maximin/counterexamples/non_contraction.hpp>
#include <maximin/models/make_perturbation.hpp>
#include <maximin/theory/bellman.hpp>
#include <maximin/theory/error.hpp>

namespace maximin {
namespace {

Model<Rational> model() {
  Model<Rational> model{.mdp = non_contraction::model(Rational(19, 20))};
  model.geometry.kind = Geometry<Rational>::Kind::discrete;
  model.geometry.eps = Rational(1);
  model.name = "contraction";
  model.state_names = {"s1", "s2", "s3"};
  model.action_names = {"a1", "a2", "a3"};
  return model;
}

QTable<Rational> pessimistic_backup(const Model<Rational>& model, const QTable<Rational>& q) {
  PessimisticStep<Rational> step;
  QTable<Rational> out;
  pessimistic_update(model.mdp, make_perturbation(model), q, step, out);
  return out;
}

/// max |x - y|
Rational distance(const QTable<Rational>& x, const QTable<Rational>& y) {
  return (x - y).cwiseAbs().maxCoeff();
}

Counterexample::Finding check(const Model<Rational>& model) {
  if (model.mdp.states() != 3 || model.mdp.actions() != 3)
    throw InputError("contraction: the tables are of 3 states and 3 actions, expected a model of that size");
  const QTable<Rational> q1 = non_contraction::q1<Rational>(), q2 = non_contraction::q2<Rational>();
  const Rational before = distance(q1, q2);
  const Rational after = distance(pessimistic_backup(model, q1), pessimistic_backup(model, q2));
  Counterexample::Finding finding{{"|Q1 - Q2|, at most", before}, {"|T Q1 - T Q2|", after}, after > before, {}};
  if (model.mdp.discount() > 0) {
    const Rational factor = after / (before * model.mdp.discount());
    finding.evidence.push_back(fmt::format("the backup stretches this distance by {} gamma, gamma = {}",
                                           exact_text(factor), exact_text(model.mdp.discount())));
    finding.evidence.push_back(fmt::format("above gamma = {} it drives Q1 and Q2 apart", exact_text(1 / factor)));
  }
  return finding;
}

}  // namespace

Counterexample contraction() {
  return {
      .name = "contraction",
      .title = "The pessimistic backup is no contraction (Table 4 of the paper)",
      .claim = "The operator Q -> T^{pi_Q o omega_Q} Q brings any two tables nearer to each other.",
      .explanation =
          "Every action leads to s2 and all states look alike, so a table plays the action whose least entry is "
          "largest.\n"
          "Q1 plays a1 everywhere and reads Q1(s2,a1) = 11; Q2 plays a2 and reads Q2(s2,a2) = 0. The tables are 10 "
          "apart,\n"
          "their backups 11 gamma: the policies changed with the table, and with them what is read. For a fixed pair "
          "of\n"
          "policies the operator does contract (Lemma 3). Q1 and Q2 are in Table 4; the program non_contraction "
          "prints\n"
          "them.",
      .model = model,
      .check = check,
  };
}

}  // namespace maximin
