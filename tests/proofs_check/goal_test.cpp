#include <maximin/proofs_check/falsify/goal.hpp>

#include <gtest/gtest.h>

#include <string>

#include <maximin/models/builtin_models.hpp>

namespace maximin {
namespace {

Verdict proved_on(const char* goal, const char* model, Reading reading = Reading::corrected) {
  ExaminationOptions options;
  options.reading = reading;
  return proved(*find_goal(goal), builtin_model(model), options);
}

TEST(Goal, IsProvedExactlyEitherWay) {
  EXPECT_EQ(proved_on("settling", "cycling"), Verdict::violated);
  EXPECT_EQ(proved_on("settling", "one-sided"), Verdict::holds);
  EXPECT_EQ(proved_on("theorem-1", "one-sided", Reading::paper), Verdict::violated);
  EXPECT_EQ(proved_on("theorem-1", "one-sided"), Verdict::holds);
  EXPECT_EQ(proved_on("sharper-belief", "one-sided"), Verdict::holds) << "violated: by the search, in the CLI test";
}

TEST(Goal, IsProvedUnderTheEuclideanNormToo) {
  Model<double> model = builtin_model("one-sided");
  model.geometry.kind = Geometry<double>::Kind::points;
  model.geometry.points = Metric<double>::Points::Zero(model.mdp.states(), 2);
  for (State s = 0; s < model.mdp.states(); ++s) model.geometry.points(s, 0) = s;
  model.geometry.norm = Norm::l2;
  model.geometry.eps = 1;
  for (const Goal& goal : goals()) {
    EXPECT_NE(proved(goal, model, {}), Verdict::violated) << goal.name;
    EXPECT_NO_THROW(proved(goal, model, {})) << goal.name;
  }
  EXPECT_EQ(proved(*find_goal("sharper-belief"), model, {}), Verdict::holds);
}

TEST(Goal, IsUndeterminedWhereABudgetRunsOut) {
  ExaminationOptions options;
  options.max_iterations = 1;
  options.max_belief_positions = 1;
  for (const char* goal : {"settling", "sharper-belief"}) {
    EXPECT_EQ(proved(*find_goal(goal), builtin_model("cycling"), options), Verdict::undetermined) << goal;
  }
  options.reading = Reading::paper;
  EXPECT_EQ(proved(*find_goal("theorem-1"), builtin_model("one-sided"), options), Verdict::undetermined);
}

}  // namespace
}  // namespace maximin
