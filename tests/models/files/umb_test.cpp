#include <maximin/models/files/umb.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "model_file_testing.hpp"
#include "tar_writing.hpp"

namespace maximin {
namespace {

using testing::little_endian;

/// Two states; state 0 chooses between a and b, state 1 has a alone.
std::map<std::string, std::string> small_model() {
  return {
      {"index.json",
       R"({"format-version":1,"format-revision":0,
           "transition-system":{"time":"discrete","#players":1,"#states":2,"#initial-states":1,"#choices":3,
             "#choice-actions":2,"#branches":4,"#branch-actions":0,"#observations":0,
             "branch-probability-type":{"type":"double","size":64}},
           "annotations":{"rewards":{"r":{"alias":"gain","applies-to":["states","choices","branches"],
             "type":{"type":"double","size":64}}}}})"},
      {"state-to-choices.bin", little_endian({0, 2, 3}, 8)},
      {"choice-to-branches.bin", little_endian({0, 2, 3, 4}, 8)},
      {"branch-to-target.bin", little_endian({0, 1, 1, 0}, 8)},
      {"branch-to-probability.bin", little_endian({0.25, 0.75, 1.0, 1.0})},
      {"state-is-initial.bin", little_endian({2}, 8)},
      {"actions/choices/values.bin", little_endian({0, 1, 0}, 4)},
      {"actions/choices/string-mapping.bin", little_endian({0, 1, 2}, 8)},
      {"actions/choices/strings.bin", "ab"},
      {"annotations/rewards/r/states/values.bin", little_endian({100.0, 200.0})},
      {"annotations/rewards/r/choices/values.bin", little_endian({10.0, 20.0, 30.0})},
      {"annotations/rewards/r/branches/values.bin", little_endian({4.0, 8.0, 0.0, 1.0})},
  };
}

std::string archive(const std::map<std::string, std::string>& entries) {
  return testing::tar({entries.begin(), entries.end()});
}

Model<double> read(const std::map<std::string, std::string>& entries, const ReadOptions& options = {}) {
  return read_umb<double>(archive(entries), "m.umb", options);
}

std::string error(const std::map<std::string, std::string>& entries) {
  return testing::error_of([&] { read(entries); });
}

TEST(Umb, ReadsASmallModel) {
  const Model<double> model = read(small_model());
  EXPECT_EQ(model.action_names, (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(model.mdp.successors(0, 0)[1], (Successor<double>{1, 0.75}));
  EXPECT_EQ(model.mdp.reward(0, 0), 100 + 10 + 0.25 * 4 + 0.75 * 8);
  EXPECT_EQ(model.mdp.reward(0, 1), 120);
  EXPECT_EQ(model.mdp.reward(1, 0), 231);
  EXPECT_EQ(model.mdp.reward(1, 1), 231);  // state 1 lacks b
  EXPECT_EQ(model.start, (std::vector<double>{0, 1}));
}

TEST(Umb, RewardModelsGoByAliasOrIdentifier) {
  ReadOptions options;
  for (const char* name : {"r", "gain"}) {
    options.reward_model = name;
    EXPECT_EQ(read(small_model(), options).mdp.reward(0, 1), 120);
  }
  options.reward_model = "loss";
  EXPECT_EQ(testing::error_of([&] { read(small_model(), options); }),
            "m.umb: no reward model 'loss', expected one of the 1 in the file");
}

TEST(Umb, MissingRowOffsetsAreTheIdentity) {
  auto entries = small_model();
  entries["index.json"] =
      R"({"format-version":1,"transition-system":{"time":"discrete","#players":0,"#states":2,"#choices":2,"#branches":2,
          "branch-probability-type":{"type":"double","size":64}}})";
  entries.erase("state-to-choices.bin");
  entries.erase("choice-to-branches.bin");
  entries["branch-to-target.bin"] = little_endian({1, 1}, 8);
  entries["branch-to-probability.bin"] = little_endian({1.0, 1.0});
  const Model<double> model = read(entries);
  EXPECT_EQ(model.mdp.actions(), 1);
  EXPECT_EQ(model.mdp.successors(0, 0)[0].target, 1);
}

TEST(Umb, NamesTheEntryAtFault) {
  auto entries = small_model();
  entries["branch-to-target.bin"] = little_endian({0, 1, 1, 2}, 8);
  EXPECT_EQ(error(entries), "m.umb: branch-to-target.bin: branch 3 leads to state 2, expected 0 to 1");
  entries = small_model();
  entries["branch-to-probability.bin"] = little_endian({0.25, 0.75, 1.0});
  EXPECT_EQ(error(entries), "m.umb: branch-to-probability.bin: 24 bytes, expected 4 numbers of 8 bytes");
  entries = small_model();
  entries["branch-to-probability.bin"] = little_endian({0.25, 0.75, 1.0, std::nan("")});
  EXPECT_EQ(error(entries), "m.umb: branch-to-probability.bin: number 3 is not finite, expected finite numbers");
  entries = small_model();
  entries["branch-to-probability.bin"] = little_endian({0.25, 0.5, 1.0, 1.0});
  EXPECT_EQ(error(entries), "m.umb: state 0, action 0: probabilities sum to 0.75, expected 1");
  entries = small_model();
  entries["state-to-choices.bin"] = little_endian({0, 4, 3}, 8);
  EXPECT_EQ(error(entries), "m.umb: state-to-choices.bin: not ascending from 0, expected row offsets");
  entries = small_model();
  entries.erase("branch-to-target.bin");
  EXPECT_EQ(error(entries), "m.umb: no entry 'branch-to-target.bin', expected one in the archive");
  entries = small_model();
  auto& index = entries["index.json"];
  index.replace(index.find("\"#states\":2"), 11, "\"#states\":1000000000000000000");
  EXPECT_EQ(error(entries),
            "m.umb: 1000000000000000000 states and 1 actions are too many, expected at most 5000000 (state, action) "
            "pairs");
  entries = small_model();
  auto& actions = entries["index.json"];
  actions.replace(actions.find("\"#choice-actions\":2"), 19, "\"#choice-actions\":18446744073709551615");
  entries["actions/choices/string-mapping.bin"].clear();
  entries["actions/choices/strings.bin"].clear();
  EXPECT_EQ(error(entries),
            "m.umb: index.json: $['transition-system']['#choice-actions']: 18446744073709551615 actions are too many, "
            "expected at most 5000000");
}

}  // namespace
}  // namespace maximin
