#include <maximin/counterexamples/non_contraction.hpp>
#include <maximin/models/files/maximin_json.hpp>
#include <maximin/proofs_check/claims.hpp>

// One thing of each upper floor: reads a model, names a claim, computes the numbers of a counterexample.
bool upper_floors_work() {
  const auto model = maximin::read_maximin_json<double>(
      R"({"format":"maximin-mdp","version":1,"states":1,"actions":1,"discount":0.5,
          "rewards":[[1]],"transitions":[[0,0,0,1]]})",
      "model.json");
  const auto distances = maximin::non_contraction::exact_distances();
  return model.mdp.states() == 1 && maximin::find_claim("theorem-1") && distances.before == 10 &&
         distances.after_per_gamma == 11;
}
