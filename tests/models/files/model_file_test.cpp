#include <maximin/models/files/model_file.hpp>

#include <gtest/gtest.h>

#include <sys/stat.h>
#include <zlib.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>

#include <maximin/models/files/prism_explicit.hpp>
#include <maximin/models/make_perturbation.hpp>

#include "model_file_testing.hpp"

namespace maximin {
namespace {

/// A folder of its own, gone with the test.
class ModelFile : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::temp_directory_path() / (std::string("maximin_model_file_") + test->name());
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path write(const std::string& name, const std::string& content) const {
    std::ofstream(folder_ / name, std::ios::binary) << content;
    return folder_ / name;
  }
  std::string error(const std::filesystem::path& path) const {
    std::string message = testing::error_of([&] { load_model<double>(path); });
    const auto at = message.find(folder_.string() + "/");
    return at == std::string::npos ? message : message.erase(at, folder_.string().size() + 1);
  }

  std::filesystem::path folder_;
};

const std::string json =
    R"({"format":"maximin-mdp","version":1,"states":1,"actions":1,"discount":0.5,"rewards":[[3]],
        "transitions":[[0,0,0,1]]})";
const std::string gymnasium = R"({"nS":1,"nA":1,"P":[[[[1,0,3,false]]]]})";
const std::string cassandra = "discount: 0.5\nvalues: reward\nstates: 1\nactions: 1\nT: 0 identity\nR: 0 : 0 : 0 3\n";
const std::string tra = "1 1 1\n0 0 0 1\n";
const std::string drn = "@type: MDP\n@parameters\n\n@reward_models\nr\n@nr_states\n1\n@model\nstate 0 [3]\n\t0 : 1\n";
const std::string csv = "0,0,0,1,3\n";

/// The text in a gzip file, not compressed.
std::string stored_gzip(const std::string& text) {
  const auto little_endian = [](std::size_t value, int bytes) {
    std::string out;
    for (int i = 0; i < bytes; ++i) out.push_back(static_cast<char>(value >> (8 * i) & 0xFF));
    return out;
  };
  const auto length = text.size();
  const auto checksum = crc32(0, reinterpret_cast<const Bytef*>(text.data()), static_cast<uInt>(length));
  return std::string("\x1f\x8b\x08\0\0\0\0\0\0\x03\x01", 11) + little_endian(length, 2) +
         little_endian(~length & 0xFFFF, 2) + text + little_endian(checksum, 4) + little_endian(length, 4);
}

TEST_F(ModelFile, FormatIsToldByExtension) {
  for (const auto& [name, content] : std::vector<std::pair<std::string, std::string>>{{"a.json", json},
                                                                                      {"b.json", gymnasium},
                                                                                      {"c.POMDP", cassandra},
                                                                                      {"c.mdp", cassandra},
                                                                                      {"d.drn", drn},
                                                                                      {"e.csv", csv}}) {
    EXPECT_EQ(load_model<double>(write(name, content)).mdp.reward(0, 0), 3) << name;
  }
}

TEST_F(ModelFile, FormatIsToldByContent) {
  for (const std::string& content : {json, gymnasium, "# a comment\n" + cassandra, drn, csv}) {
    EXPECT_EQ(load_model<double>(write("model", content)).mdp.reward(0, 0), 3) << content;
  }
  EXPECT_EQ(load_model<double>(write("model", tra)).mdp.states(), 1);
  EXPECT_EQ(error(write("model", "Dear reader,\n")),
            "model: not a known model format, expected .json, .pomdp, .mdp, .tra, .drn, .csv or .umb");
  EXPECT_EQ(error(write("model", "")),
            "model: not a known model format, expected .json, .pomdp, .mdp, .tra, .drn, .csv or .umb");
}

TEST_F(ModelFile, PrismFilesAreFoundTogether) {
  write("m.srew", "1 1\n0 3\n");
  const auto path = write("m.tra", tra);
  EXPECT_EQ(load_model<double>(path).mdp.reward(0, 0), 3);
}

TEST_F(ModelFile, PrismRewardStructuresGoByNumberOrName) {
  write("m.prism1.srew", "# Reward structure \"time\"\n1 1\n0 1\n");
  write("m.prism1.trew", "# Reward structure \"time\"\n1 1 1\n0 0 0 10\n");
  write("m.prism2.srew", "# Reward structure \"energy\"\n1 1\n0 2\n");
  const auto path = write("m.prism.tra", tra);
  const Model<double> first = load_model<double>(path);
  EXPECT_EQ(first.mdp.reward(0, 0), 11);
  EXPECT_EQ(first.notes[0], "rewards: 2 reward structures, the first taken; choose one with --reward-model");
  ReadOptions options;
  for (const char* name : {"2", "energy"}) {
    options.reward_model = name;
    EXPECT_EQ(load_model<double>(path, options).mdp.reward(0, 0), 2);
  }
  options = {};
  options.state_rewards = write("other.srew", "1 1\n0 7\n");
  EXPECT_EQ(load_model<double>(path, options).mdp.reward(0, 0), 7);
}

TEST_F(ModelFile, AnyFileMayBePackedByGzip) {
  // 'tra' and a .srew file, "1 1\n0 3\n", stored in gzip without compression
  const std::string reward = "1 1\n0 3\n";
  const auto path = write("m.tra.gz", stored_gzip(tra));
  EXPECT_EQ(load_model<double>(path).mdp.reward(0, 0), 0);
  write("m.srew.gz", stored_gzip(reward));
  EXPECT_EQ(load_model<double>(path).mdp.reward(0, 0), 3);
  write("m.tra.srew", "1 1\n0 5\n");  // not a companion of m.tra.gz
  EXPECT_EQ(load_model<double>(path).mdp.reward(0, 0), 3);
  write("m.srew", "1 1\n0 4\n");
  EXPECT_EQ(load_model<double>(path).mdp.reward(0, 0), 4);
  EXPECT_EQ(load_prism_explicit<double>(path).mdp.reward(0, 0), 4);
  ReadOptions options;
  options.state_rewards = folder_ / "m.srew.gz";
  EXPECT_EQ(load_model<double>(path, options).mdp.reward(0, 0), 3);
  EXPECT_EQ(load_model<double>(write("m.json.gz", stored_gzip(json))).mdp.reward(0, 0), 3);
}

// A pipe can be read once only: a second reading would wait for ever.
TEST_F(ModelFile, PipesAreReadOnce) {
  for (const char* name : {"pipe", "pipe.tra"}) {
    const std::filesystem::path path = folder_ / name;
    ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);
    std::thread writer([&] { std::ofstream(path) << tra; });
    EXPECT_EQ(load_model<double>(path).mdp.states(), 1);
    writer.join();
  }
}

TEST_F(ModelFile, ByteOrderMarksAreSkipped) {
  const std::string mark = "\uFEFF";
  write("m.srew", mark + "1 1\n0 3\n");
  for (const auto& [name, content] : std::vector<std::pair<std::string, std::string>>{{"m.json", json},
                                                                                      {"g.json", gymnasium},
                                                                                      {"m.mdp", cassandra},
                                                                                      {"m.tra", tra},
                                                                                      {"m.drn", drn},
                                                                                      {"m.csv", csv},
                                                                                      {"c", cassandra},
                                                                                      {"d", drn},
                                                                                      {"e", csv}}) {
    EXPECT_EQ(load_model<double>(write(name, mark + content)).mdp.reward(0, 0), 3) << name;
  }
}

TEST_F(ModelFile, TellsWhatCannotBeRead) {
  EXPECT_EQ(error(folder_ / "absent.json"), "absent.json: No such file or directory, expected a readable model file");
  std::filesystem::create_directory(folder_ / "dir.json");
  EXPECT_EQ(error(folder_ / "dir.json"), "dir.json: a folder, expected a readable model file");
  EXPECT_EQ(error(write("m.json", "{}")),
            "m.json: $: neither 'format' nor 'P', expected \"format\": \"maximin-mdp\" or a gymnasium table with 'P'");
  EXPECT_EQ(error(write("m.drn", std::string("\xfd") + "7zXZ")),
            "m.drn: packed by xz, expected it unpacked or packed by gzip");
  ReadOptions options;
  options.limits.bytes = 10;
  EXPECT_EQ(testing::error_of([&] { load_model<double>(write("m.csv", std::string(11, '0')), options); }),
            (folder_ / "m.csv").string() + ": larger than 10 bytes, expected less");
}

// From the file to the balls.
TEST_F(ModelFile, BallsComeFromTheFilesGeometryOrFromHops) {
  const auto model = load_model<double>(write("m.csv", "0,0,1,1,0\n1,0,2,1,0\n2,0,2,1,0\n"));
  const Perturbation<double> hops = make_perturbation(model);
  EXPECT_EQ(hops.eps(), 1);
  EXPECT_TRUE(hops.contains(0, 1));
  EXPECT_FALSE(hops.contains(0, 2));
  const auto placed = load_model<double>(write("m.json", R"({"format":"maximin-mdp","version":1,"states":2,"actions":1,
      "discount":0.5,"norm":"l1","eps":2,"points":[[0],[3]],"rewards":[[0],[0]],
      "transitions":[[0,0,0,1],[1,0,1,1]]})"));
  EXPECT_FALSE(make_perturbation(placed).contains(0, 1));
  GeometryOverrides<double> wider;
  wider.eps = 3;
  EXPECT_TRUE(make_perturbation(placed, wider).contains(0, 1));
}

}  // namespace
}  // namespace maximin
