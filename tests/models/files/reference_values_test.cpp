// Q* of real files agrees with reference_values.json, which was computed another way (reference_values.py).
#include <gtest/gtest.h>

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include <maximin/models/files/model_file.hpp>
#include <maximin/tabular/policy_iteration.hpp>
#include <maximin/tabular/value_iteration.hpp>

namespace maximin {
namespace {

constexpr double tolerance = 1e-9;

nlohmann::json reference() {
  std::ifstream in(MAXIMIN_REFERENCE_VALUES);
  return nlohmann::json::parse(in);
}

/// Compares the states that the file has; a reader may have added a terminal one.
void expect_agreement(const CertifiedSolution<double>& solution, const nlohmann::json& expected) {
  const std::string file = expected["file"];
  ASSERT_LE(expected["V"].size(), static_cast<std::size_t>(solution.v.size())) << file;
  ASSERT_EQ(expected["Q"][0].size(), static_cast<std::size_t>(solution.q.cols())) << file;
  for (std::size_t s = 0; s < expected["V"].size(); ++s) {
    const auto row = static_cast<Eigen::Index>(s);
    EXPECT_NEAR(solution.v[row], expected["V"][s].get<double>(), tolerance) << file << ", state " << s;
    for (std::size_t a = 0; a < expected["Q"][s].size(); ++a) {
      EXPECT_NEAR(solution.q(row, static_cast<Eigen::Index>(a)), expected["Q"][s][a].get<double>(), tolerance)
          << file << ", state " << s << ", action " << a;
    }
  }
}

TEST(ReferenceValues, OptimalValuesAgree) {
  const nlohmann::json models = reference()["models"];
  ASSERT_EQ(models.size(), 12U);
  for (const auto& expected : models) {
    ReadOptions options;
    options.discount = expected["discount"].get<double>();
    const auto path = std::filesystem::path(MAXIMIN_SHARED_MODELS) / expected["file"].get<std::string>();
    const Model<double> model = load_model<double>(path, options);
    expect_agreement(value_iteration(model.mdp), expected);
    expect_agreement(policy_iteration(model.mdp), expected);
  }
}

}  // namespace
}  // namespace maximin
