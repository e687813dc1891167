#include <fmt/format.h>

#include <maximin/counterexamples/exact_text.hpp>
#include <maximin/counterexamples/gallery.hpp>
#include <maximin/models/builtin_models.hpp>
#include <maximin/models/rationalise.hpp>
#include <maximin/proofs_check/certificate/certificate.hpp>

namespace maximin {
namespace {

Model<Rational> model() {
  Model<Rational> model = rationalise(builtin_model("one-sided"));
  model.name = "one-sided-rewards";
  model.action_names = {"a0", "a1"};
  return model;
}

CertifiedClaim theorem_1(const Model<Rational>& model, Reading reading) {
  return certify(model, {}, {.reading = reading, .only = {{ClaimId::theorem_1}}}).claims.front();
}

Counterexample::Finding check(const Model<Rational>& model) {
  const CertifiedClaim printed = theorem_1(model, Reading::paper);
  const CertifiedClaim repaired = theorem_1(model, Reading::corrected);
  return {{"Theorem 1 as printed: the loss is at most", printed.right},
          {"the loss in the limit", printed.left},
          printed.verdict == Verdict::violated,
          {fmt::format("with |R| <= R_max the bound is {}, and holds: {}", exact_text(repaired.right),
                       repaired.verdict == Verdict::holds ? "yes" : "no")}};
}

}  // namespace

Counterexample one_sided_rewards() {
  return {
      .name = "one-sided-rewards",
      .title = "Assumption 2 as printed is too weak for Theorem 1",
      .claim = "Theorem 1 holds when rewards are bounded from above only, R <= R_max (Assumption 2).",
      .explanation =
          "R = -x <= 0, so R_max may be 0, and with it the term of Delta that counts how transitions differ vanishes: "
          "the\n"
          "printed bound is 6. But x0 and x1 look alike and need opposite actions; the wrong one leads to x20 and "
          "costs 20\n"
          "a step for ever. The loss is 10. The proof uses |R| <= R_max, and so read (R_max = 20) the theorem holds "
          "here.",
      .model = model,
      .check = check,
  };
}

}  // namespace maximin
