#include <gtest/gtest.h>
#include <unistd.h>

#include <sys/resource.h>
#include <zlib.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include <maximin/deep/tensor_file.hpp>
#include <maximin/deep/trained_agent.hpp>
#include <maximin/theory/random.hpp>

#include "input_errors.hpp"

namespace maximin::deep {
namespace {

namespace fs = std::filesystem;

std::string with_checksum(std::string bytes) {
  const auto crc = static_cast<std::uint32_t>(
      crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<z_size_t>(bytes.size())));
  char last[4];
  std::memcpy(last, &crc, 4);
  return bytes.append(last, 4);
}

std::string file_of(const std::string& heading, const std::string& numbers = "") {
  return with_checksum("maximin-tensors 1\n" + heading + "\n" + numbers);
}

/// A heading with this list of tensors.
std::string listing(const std::string& tensors) {
  return R"({"kind":"agent","about":{},"tensors":)" + tensors + "}";
}

class TensorFiles : public ::testing::Test {
 protected:
  TensorFiles() { fs::create_directories(folder_); }
  ~TensorFiles() override { fs::remove_all(folder_); }

  void put(const std::string& bytes) const {
    std::ofstream out(path_, std::ios::binary);
    out << bytes;
  }
  std::string get() const {
    std::ostringstream all;
    all << std::ifstream(path_, std::ios::binary).rdbuf();
    return all.str();
  }
  /// What reading these bytes comes to.
  std::string reading(const std::string& bytes) const {
    put(bytes);
    return refusal([&] { read_tensor_file(path_, "agent"); });
  }

  fs::path folder_ = fs::path(::testing::TempDir()) / ("maximin_tensor_file_test" + std::to_string(::getpid()));
  fs::path path_ = folder_ / "file";
};

TensorFile example() {
  TensorFile file{"agent", {{"seed", 3}}, {}};
  file.tensors["a"] = torch::arange(6, torch::kFloat).view({2, 3});
  file.tensors["b"] = torch::tensor({1.5, std::nan("")}, torch::kDouble);
  file.tensors["counts"] = torch::tensor({-1L, 1L << 60});
  file.tensors["empty"] = torch::zeros({0, 2});
  file.tensors["last"] = torch::tensor(7.0F);  // no sizes at all: one number
  file.tensors["odd"] = torch::tensor({1, 2, 255}, torch::kByte);
  return file;
}

TEST_F(TensorFiles, AreReadAsTheyWereWrittenAndDamageIsTold) {
  write_tensor_file(path_, example());
  const std::string good = get();
  const TensorFile read = read_tensor_file(path_, "agent");
  EXPECT_EQ(read.about, example().about);
  ASSERT_EQ(read.tensors.size(), 6U);
  for (const auto& [name, tensor] : example().tensors) {
    EXPECT_EQ(read.at(name).scalar_type(), tensor.scalar_type());
    EXPECT_TRUE(torch::allclose(read.at(name).to(torch::kDouble), tensor.to(torch::kDouble), 0, 0, true)) << name;
  }
  EXPECT_TRUE(read.at("counts").equal(example().at("counts")));
  write_tensor_file(path_, read);
  EXPECT_EQ(get(), good);
  // A transposed tensor is written in its own order, not that of its memory.
  TensorFile turned{"agent", {}, {}};
  turned.tensors["t"] = torch::arange(6, torch::kFloat).view({2, 3}).t();
  write_tensor_file(path_, turned);
  EXPECT_TRUE(read_tensor_file(path_, "agent").at("t").equal(turned.at("t")));

  EXPECT_EQ(reading(good), "[nothing thrown]");
  for (std::size_t length = 0; length < good.size(); ++length) {
    ASSERT_TRUE(is_refusal(reading(good.substr(0, length)))) << length;
  }
  Stream rng(1);
  for (int flip = 0; flip < 2000; ++flip) {
    std::string bytes = good;
    const int at = rng.below(static_cast<int>(bytes.size()));
    bytes[static_cast<std::size_t>(at)] = static_cast<char>(bytes[static_cast<std::size_t>(at)] ^ (1 << rng.below(8)));
    ASSERT_TRUE(is_refusal(reading(bytes))) << at;
  }
  EXPECT_TRUE(is_refusal(reading(good + "x")));

  put(good);
  EXPECT_NE(refusal([&] { read_tensor_file(path_, "training"); }).find("kind 'agent', expected 'training'"),
            std::string::npos);
  EXPECT_NE(reading("maximin-tensors 2\n{}\n").find("another version"), std::string::npos);
  EXPECT_NE(reading("PK\x03\x04").find("no file of this program"), std::string::npos);
  EXPECT_NE(refusal([&] { read_tensor_file(folder_, "agent"); }).find("a folder"), std::string::npos);
  EXPECT_NE(refusal([&] { read_tensor_file(folder_ / "none", "agent"); }).find("No such file"), std::string::npos);
  EXPECT_TRUE(is_refusal(refusal([&] { write_tensor_file(folder_ / "none" / "file", example()); })));
}

TEST_F(TensorFiles, HostileHeadingsWithAGoodChecksumAreRefused) {
  const std::string one = R"({"name":"a","type":"uint8","sizes":[1]})";
  EXPECT_EQ(reading(file_of(listing("[" + one + "]"), "x")), "[nothing thrown]");
  EXPECT_EQ(reading(file_of(listing(R"([{"name":"a","type":"float32","sizes":[]}])"), "1234")), "[nothing thrown]");
  const auto sized = [](const std::string& sizes, const char* type = "float32") {
    return file_of(listing(std::string(R"([{"name":"a","type":")") + type + R"(","sizes":)" + sizes + "}]"));
  };
  rlimit before{};
  getrlimit(RLIMIT_AS, &before);
#ifndef __SANITIZE_ADDRESS__                        // whose shadow memory alone is larger
  const rlimit tight{4UL << 30U, before.rlim_max};  // a heading is no reason to take memory
  setrlimit(RLIMIT_AS, &tight);
#endif
  for (const char* sizes : {"[1e12]",
                            "[1000000000000]",
                            "[9223372036854775807]",
                            "[18446744073709551615]",
                            "[4611686018427387904,4]",
                            "[]",
                            "[0,9223372036854775807,9223372036854775807]",
                            "[4294967296,4294967296]",
                            "[1]",
                            "[-1]",
                            "[1.5]",
                            "[true]",
                            "[[1]]",
                            "[null]",
                            "{}",
                            "7",
                            "\"1\"",
                            "null",
                            "[0,0,0,0,0,0,0,0,0]",
                            "[1e400]",
                            "[NaN]"}) {
    EXPECT_TRUE(is_refusal(reading(sized(sizes)))) << sizes << reading(sized(sizes));
    EXPECT_TRUE(is_refusal(reading(sized(sizes, "int64")))) << sizes;
  }
  setrlimit(RLIMIT_AS, &before);
  EXPECT_TRUE(is_refusal(reading(sized("[0]", "float16"))));
  EXPECT_EQ(reading(sized("[0,5]")), "[nothing thrown]");
  for (const char* sizes : {"[]", "[1]", "[2,3]"}) {
    EXPECT_NE(reading(sized(sizes)).find("cut off"), std::string::npos) << sizes;
  }
  for (const std::string& tensors :
       {"[" + one + "," + one + "]", std::string("null"), std::string("7"), std::string("[7]"), std::string("[{}]"),
        std::string(R"([{"name":7,"type":"uint8","sizes":[1]}])"),
        std::string(R"([{"name":"a","type":7,"sizes":[1]}])")}) {
    EXPECT_TRUE(is_refusal(reading(file_of(listing(tensors), "xx")))) << tensors;
  }
  EXPECT_NE(reading(file_of(listing("[" + one + "," + one + "]"), "xx")).find("tensor a twice"), std::string::npos);
  const std::string deep(100'000, '[');
  for (
      const std::string& heading :
      {std::string(), std::string("{}"), std::string("[]"), std::string("null"), std::string("{"),
       std::string("\xff\xfe"), std::string(R"({"kind":"agent","tensors":[]})"),
       std::string(R"({"kind":7,"about":{},"tensors":[]})"),
       std::string(R"({"kind":"a\nb\u0000","about":{},"tensors":[]})"),
       R"({"kind":")" + std::string(100'000, 'k') + R"(","about":{},"tensors":[]})",
       R"({"kind":"agent","tensors":[],"about":)" + deep + std::string(100'000, ']') + "}", deep,
       std::string(
           R"({"kind":"agent","about":{},"tensors":[{"name":"\n","type":"uint8","sizes":[1]},{"name":"\n","type":"uint8","sizes":[1]}]})")}) {
    EXPECT_TRUE(is_refusal(reading(file_of(heading, "xx")))) << heading.substr(0, 60);
  }
  EXPECT_TRUE(is_refusal(reading(with_checksum("maximin-tensors 1\n"))));
  EXPECT_TRUE(is_refusal(reading(with_checksum("maximin-tensors 1\nno line"))));

  const TensorFile file = example();
  torch::Tensor into = torch::zeros({2, 3});
  file.copy_to("a", into);
  EXPECT_TRUE(into.equal(file.at("a")));
  EXPECT_TRUE(is_refusal(refusal([&] { file.copy_to("a", torch::zeros({3, 2})); })));
  EXPECT_TRUE(is_refusal(refusal([&] { file.copy_to("a", torch::zeros({2, 3}, torch::kDouble)); })));
  EXPECT_TRUE(is_refusal(refusal([&] { file.copy_to("z", into); })));
  torch::nn::Linear layer(2, 2), other(2, 2);
  TensorFile module{"agent", {}, {}};
  put_module(module, "m", *layer);
  get_module(module, "m", *other);
  EXPECT_TRUE(other->weight.equal(layer->weight));
  EXPECT_TRUE(is_refusal(refusal([&] { get_module(module, "n", *other); })));
  module.tensors["m.bias"] = torch::full({2}, std::nan(""));
  EXPECT_TRUE(is_refusal(refusal([&] { get_module(module, "m", *other); })));
}

/// A mutant of the bytes: some overwritten, cut out, doubled, or replaced by what numbers and headings are made of.
std::string mutant(std::string bytes, Stream& rng) {
  static const char* pieces[] = {"[",    "]",       "{",    "}",    ",",  ":",     "\"",      "-1",
                                 "1e99", "0",       "null", "true", "\n", "65537", "\\u0000", "99999999999999999999",
                                 "nan",  "float64", "\xff"};
  for (int n = 1 + rng.below(3); n > 0 && !bytes.empty(); --n) {
    const auto at = static_cast<std::size_t>(rng.below(static_cast<int>(bytes.size())));
    const auto length = static_cast<std::size_t>(rng.below(9));
    switch (rng.below(4)) {
      case 0:
        bytes[at] = static_cast<char>(rng.below(256));
        break;
      case 1:
        bytes.erase(at, length);
        break;
      case 2:
        bytes.insert(at, bytes.substr(static_cast<std::size_t>(rng.below(static_cast<int>(bytes.size()))), length));
        break;
      default:
        bytes.replace(at, length, pieces[rng.below(static_cast<int>(std::size(pieces)))]);
    }
  }
  return bytes;
}

TEST_F(TensorFiles, MutantsOfAnAgentAreReadOrRefusedInOneLine) {
  AgentSpec spec = recipe("sa-dqn", 0.3, 1, true);
  spec.network.hidden = {4};
  spec.network.waves = 0;
  write_agent(path_, untrained(spec));
  const std::string whole = get(), good = whole.substr(0, whole.size() - 4);
  EXPECT_EQ(refusal([&] { read_agent(path_); }), "[nothing thrown]");
  Stream rng(6);
  long read = 0, refused = 0;
  const std::size_t heading = good.find('\n', good.find('\n') + 1);
  for (int i = 0; i < 2500; ++i) {
    const std::string bytes = mutant(good.substr(0, heading), rng) + good.substr(heading);
    put(with_checksum(bytes));
    const std::string text = refusal([&] { read_agent(path_); });
    ASSERT_TRUE(is_refusal(text) || text == "[nothing thrown]") << text;
    ++(is_refusal(text) ? refused : read);
  }
  EXPECT_GT(read, 25);  // a changed number is another agent, not a broken one
  EXPECT_GT(refused, 1200);
  // The program takes no file for an agent that is none of its own.
  TensorFile nan = (put(whole), read_tensor_file(path_, "agent")), list = nan;
  nan.tensors["q.layer0.bias"][1] = std::nan("");
  write_tensor_file(path_, nan);
  EXPECT_NE(refusal([&] { read_agent(path_); }).find("q.layer0.bias holds what is no number"), std::string::npos);
  list.about = nlohmann::ordered_json::array();
  write_tensor_file(path_, list);
  EXPECT_TRUE(is_refusal(refusal([&] { read_agent(path_); })));
}

}  // namespace
}  // namespace maximin::deep
