// What the checker accepts is true: of certificates that are true a piece is changed, thousands of times, and every one
// that is still accepted is looked at by definition. MAXIMIN_CERTIFICATE_MUTANTS=100000 tries more than ctest does,
// MAXIMIN_CERTIFICATE_MUTANTS_OUT=FOLDER keeps those that were accepted, e.g. for another checker.
#include <gmpxx.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <iostream>
#include <random>
#include <vector>

#include "naive_certificate.hpp"
#include "sample_certificates.hpp"

namespace maximin::testing {
namespace {

using nlohmann::json;

/// A changed certificate. `text` differs from `tree` where JSON has more than a tree can tell.
struct Mutant {
  std::string original, field, text;
  json tree;
};

class Mutator {
 public:
  explicit Mutator(unsigned seed) : random_(seed) {}

  Mutant draw() {
    const auto& samples = sample_certificates();
    auto sample = samples.begin();
    std::advance(sample, below(samples.size()));
    Mutant mutant{sample->first, "", "", sample->second};
    do {
      duplicate_.clear();
      mutant.tree = sample->second;
      mutant.field = "$";
      if (below(12) == 0) {
        change_claim(mutant);
      } else {
        descend(mutant.tree, mutant.field);
      }
      mutant.text = mutant.tree.dump();
      if (!duplicate_.empty()) mutant.text.replace(mutant.text.find(duplicate_), duplicate_.size(), duplicated_);
    } while (mutant.text == sample->second.dump());
    return mutant;
  }

 private:
  std::size_t below(std::size_t n) { return std::uniform_int_distribution<std::size_t>(0, n - 1)(random_); }

  /// Changes a piece of the value: itself, or one of its parts.
  void descend(json& value, std::string& field) {
    if (value.is_structured() && !value.empty() && below(8) > 0) {
      auto part = value.begin();
      std::advance(part, below(value.size()));
      field += value.is_array() ? "[]" : "." + part.key();
      descend(*part, field);
    } else if (value.is_array()) {
      change_array(value);
      field += " as a whole";
    } else if (value.is_object()) {
      change_object(value);
      field += " as a whole";
    } else {
      change_leaf(value);
    }
  }

  void change_array(json& array) {
    if (array.empty()) return array.push_back("0");
    const std::size_t i = below(array.size()), j = below(array.size());
    switch (below(4)) {
      case 0:
        std::swap(array[i], array[j]);
        break;
      case 1:
        array.erase(i);
        break;
      case 2:
        array.insert(array.begin() + static_cast<std::ptrdiff_t>(i), json(array[j]));
        break;
      default:
        array = below(2) == 0 ? json(nullptr) : json::array();
    }
  }

  void change_object(json& object) {
    if (object.empty()) return;
    auto part = object.begin();
    std::advance(part, below(object.size()));
    const std::string name = part.key();
    const json value = *part;
    switch (below(4)) {
      case 0:
        object.erase(name);
        break;
      case 1:
        object.erase(name);
        object[name + "_"] = value;
        break;
      case 2:  // a name twice, which no tree can hold: put in when the text is written
        object["@@@"] = 0;
        duplicate_ = "\"@@@\":0";
        duplicated_ = "\"" + name + "\":" + value.dump();
        break;
      default:
        object = nullptr;
    }
  }

  void change_leaf(json& leaf) {
    static const std::vector<std::string> words{
        "holds", "violated", "undetermined", "lowest",    "highest", "corrected", "paper", "l1",
        "l2",    "linf",     "lemma-1",      "theorem-1", "hops",    "discrete",  "A",     "F"};
    if (below(20) == 0) {
      leaf = nullptr;
    } else if (leaf.is_boolean()) {
      leaf = !leaf.get<bool>();
    } else if (leaf.is_number()) {
      leaf = below(2) == 0 ? json(static_cast<long>(below(8))) : json(leaf.get<long>() + (below(2) == 0 ? 1 : -1));
    } else if (!leaf.is_string()) {
      leaf = "1";
    } else if (const std::string text = leaf; text.find_first_not_of("-/0123456789") != text.npos) {
      leaf = words[below(words.size())];
    } else {
      leaf = below(3) == 0 ? raw_change(text) : exact_change(text);
    }
  }

  /// One character is changed, added or dropped.
  std::string raw_change(std::string text) {
    static const std::string characters = "0123456789-/";
    const std::size_t i = below(text.size());
    switch (below(3)) {
      case 0:
        text[i] = characters[below(characters.size())];
        break;
      case 1:
        text.insert(i, 1, characters[below(characters.size())]);
        break;
      default:
        text.erase(i, 1);
    }
    return text;
  }

  /// Another number in the right form, often near to it.
  std::string exact_change(const std::string& text) {
    mpq_class x(text);
    switch (below(6)) {
      case 0:
        x = -x;
        break;
      case 1:
        x *= 2;
        break;
      case 2:
        x /= 3;
        break;
      case 3:
        x += below(2) == 0 ? 1 : -1;
        break;
      case 4:
        x += mpq_class(below(2) == 0 ? 1 : -1, mpz_class(1) << below(80));
        break;
      default:
        x = x == 0 ? mpq_class(1) : mpq_class(1 / x);
    }
    return x.get_str();
  }

  /// What changes several members of a claim at once.
  void change_claim(Mutant& mutant) {
    json& claims = mutant.tree["claims"];
    json& claim = claims[below(claims.size())];
    mutant.field = "$.claims[] weakened";
    if (claim["verdict"] == "undetermined" || below(3) == 0) {
      claim = {{"claim", claim["claim"]}, {"verdict", "undetermined"}};
      return;
    }
    mutant.field = "$.claims[] with both sides";
    mpq_class left(claim["left"].get<std::string>()), right(claim["right"].get<std::string>());
    if (below(2) == 0) {
      std::swap(left, right);
      claim["verdict"] = left > right ? "violated" : "holds";
    } else {
      const mpq_class step(1, 1 + below(20));
      left += step;
      right += step;
    }
    left.canonicalize();
    right.canonicalize();
    claim["left"] = left.get_str();
    claim["right"] = right.get_str();
  }

  std::mt19937 random_;
  std::string duplicate_, duplicated_;
};

/// Whether a field can have several true values, so that a mutant there may be accepted.
bool may_vary(const Mutant& mutant) {
  const json& original = sample_certificates().at(mutant.original);
  const std::string& field = mutant.field;
  const auto starts = [&](const std::string& start) { return field.compare(0, start.size(), start) == 0; };
  if (starts("$.model") || field == "$.reading" || field == "$.tie") return true;  // another model, as true
  if (starts("$.constants") && field.find(".at") != field.npos) return true;
  if (starts("$.limit.classes")) return true;  // finer ones
  if (field == "$.limit.radius" || starts("$.rounds") || field == "$.claims as a whole") return true;
  if (field == "$.belief_game.exact") return original["belief_game"]["exact"] == true;
  if (field == "$.belief_game as a whole" || field == "$.limit as a whole") return true;  // null
  if (starts("$.belief_game.values") && original["belief_game"].contains("exact"))
    return original["belief_game"]["exact"] == false;
  if (starts("$.limit.boxes")) return true;  // other bounds, or a phase twice
  if (original["format"] == "maximin-bounds") {
    for (const char* bound : {"$.constants", "$.optimal", "$.bits", "$.pairs[].below", "$.pairs[].above", "$.test_time",
                              "$.belief_game.values"}) {
      if (starts(bound)) return true;
    }
  }
  return field == "$.claims[] weakened" || starts("$.claims[].at");
}

std::size_t tries() {
  const char* asked = std::getenv("MAXIMIN_CERTIFICATE_MUTANTS");
  return asked == nullptr ? 2'000 : std::strtoul(asked, nullptr, 10);
}

TEST(CertificateMutants, ThatAreAcceptedAreTrue) {
  const char* out = std::getenv("MAXIMIN_CERTIFICATE_MUTANTS_OUT");
  Mutator mutator(20'240'501);
  std::map<std::string, std::pair<std::size_t, std::size_t>> counts;  // by field: drawn, accepted
  std::size_t accepted = 0;
  for (std::size_t i = 0; i < tries(); ++i) {
    const Mutant mutant = mutator.draw();
    auto& count = counts[mutant.field];
    ++count.first;
    if (!refusal(mutant.text).empty()) continue;
    ++count.second;
    ++accepted;
    EXPECT_EQ(NaiveCertificate::untruth(mutant.tree), "") << mutant.original << ", " << mutant.field << "\n"
                                                          << mutant.text;
    EXPECT_TRUE(may_vary(mutant)) << mutant.original << ", " << mutant.field << "\n" << mutant.text;
    if (out != nullptr) std::ofstream(std::filesystem::path(out) / (std::to_string(i) + ".json")) << mutant.text;
    if (HasFailure()) return;
  }
  std::cout << accepted << " of " << tries() << " accepted\n";
  for (const auto& [field, count] : counts) {
    if (count.second > 0) std::cout << "  " << field << ": " << count.second << " of " << count.first << "\n";
  }
  EXPECT_GT(accepted, 0U);
}

}  // namespace
}  // namespace maximin::testing
