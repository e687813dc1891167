// Writing a model and reading it back gives an equal model, to the last bit.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <sstream>

#include <maximin/models/files/cassandra.hpp>
#include <maximin/models/files/csv.hpp>
#include <maximin/models/files/drn.hpp>
#include <maximin/models/files/maximin_json.hpp>

#include "model_file_testing.hpp"

namespace maximin {
namespace {

using testing::random_model;
using testing::same_model;

/// Formats without a discount are told the one they lost.
ReadOptions with_discount_of(const Model<double>& model) {
  ReadOptions options;
  options.discount = model.mdp.discount();
  return options;
}

RC_GTEST_PROP(RoundTrip, MaximinJsonKeepsEverything, (std::uint64_t seed)) {
  Stream rng(seed);
  const Model<double> model = random_model(rng);
  std::ostringstream out;
  write_maximin_json(model, out);
  RC_ASSERT(same_model(read_maximin_json<double>(out.str(), "model.json"), model));
}

RC_GTEST_PROP(RoundTrip, CsvKeepsTheMdp, (std::uint64_t seed)) {
  Stream rng(seed);
  const Model<double> model = random_model(rng);
  std::ostringstream out;
  write_csv(model, out);
  RC_ASSERT(read_csv<double>(out.str(), "model.csv", with_discount_of(model)).mdp == model.mdp);
}

RC_GTEST_PROP(RoundTrip, DrnKeepsTheMdpAndNamesOfActions, (std::uint64_t seed)) {
  Stream rng(seed);
  const Model<double> model = random_model(rng, {.names = true, .plain = true, .start = false, .geometry = true});
  std::ostringstream out;
  write_drn(model, out);
  const Model<double> back = read_drn<double>(out.str(), "model.drn", with_discount_of(model));
  RC_ASSERT(back.mdp == model.mdp);
  RC_ASSERT(back.action_names == model.action_names);
}

RC_GTEST_PROP(RoundTrip, DrnKeepsTheMdpWhateverTheNames, (std::uint64_t seed)) {
  Stream rng(seed);
  const Model<double> model = random_model(rng);
  std::ostringstream out;
  write_drn(model, out);
  const Model<double> back = read_drn<double>(out.str(), "model.drn", with_discount_of(model));
  RC_ASSERT(back.mdp == model.mdp);
  for (std::size_t s = 0; s < model.start.size(); ++s) RC_ASSERT((model.start[s] > 0) == (back.start[s] > 0));
}

RC_GTEST_PROP(RoundTrip, CassandraKeepsTheMdpNamesAndStart, (std::uint64_t seed)) {
  Stream rng(seed);
  const Model<double> model = random_model(rng, {.names = true, .plain = true, .start = true, .geometry = true});
  std::ostringstream out;
  write_cassandra(model, out);
  const Model<double> back = read_cassandra<double>(out.str(), "model.mdp");
  RC_ASSERT(back.mdp == model.mdp);
  RC_ASSERT(back.state_names == model.state_names);
  RC_ASSERT(back.action_names == model.action_names);
  RC_ASSERT(back.start == model.start);
  RC_ASSERT(back.notes.empty());
}

RC_GTEST_PROP(RoundTrip, CassandraKeepsTheMdpWhateverTheNames, (std::uint64_t seed)) {
  Stream rng(seed);
  const Model<double> model = random_model(rng);
  std::ostringstream out;
  write_cassandra(model, out);
  RC_ASSERT(read_cassandra<double>(out.str(), "model.mdp").mdp == model.mdp);
}

// All readers agree: one model written in every format is read as the same MDP.
RC_GTEST_PROP(RoundTrip, ReadersAgree, (std::uint64_t seed)) {
  Stream rng(seed);
  const Model<double> model = random_model(rng);
  const ReadOptions options = with_discount_of(model);
  std::ostringstream json, csv, drn, cassandra;
  write_maximin_json(model, json);
  write_csv(model, csv);
  write_drn(model, drn);
  write_cassandra(model, cassandra);
  const FiniteMdp<double> mdp = read_maximin_json<double>(json.str(), "m.json", options).mdp;
  RC_ASSERT(read_csv<double>(csv.str(), "m.csv", options).mdp == mdp);
  RC_ASSERT(read_drn<double>(drn.str(), "m.drn", options).mdp == mdp);
  RC_ASSERT(read_cassandra<double>(cassandra.str(), "m.mdp", options).mdp == mdp);
}

// The comparison that these properties rest on can fail.
TEST(SameModel, SeesEveryDifference) {
  Stream rng(7);
  Model<double> model = random_model(rng);
  while (model.mdp.states() < 2 || model.geometry.kind != Geometry<double>::Kind::points) model = random_model(rng);
  EXPECT_TRUE(same_model(model, model));
  const auto differs = [&](auto change) {
    Model<double> other = model;
    change(other);
    return !same_model(model, other) && !same_model(other, model);
  };
  EXPECT_TRUE(differs([](auto& m) { m.name += "x"; }));
  EXPECT_TRUE(differs([](auto& m) { m.notes.push_back("x"); }));
  EXPECT_TRUE(differs([](auto& m) { m.state_names.push_back("x"); }));
  EXPECT_TRUE(differs([](auto& m) { m.action_names.push_back("x"); }));
  EXPECT_TRUE(differs([](auto& m) { m.start.push_back(1); }));
  EXPECT_TRUE(differs([](auto& m) { m.geometry.points(0, 0) += 1e300; }));
  EXPECT_TRUE(differs([](auto& m) { m.geometry.eps = m.geometry.eps.value_or(0) + 1; }));
  EXPECT_TRUE(differs([&](auto& m) {
    do m.mdp = random_model(rng).mdp;
    while (m.mdp.discount() == model.mdp.discount());
  }));
}

}  // namespace
}  // namespace maximin
