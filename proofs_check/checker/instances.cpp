#include "instances.hpp"

#include <algorithm>
#include <array>

namespace maximin::checker {
namespace {

constexpr std::array<const char*, 3> verdicts{"holds", "violated", "undetermined"};

/// A claim's name, and what names its instances.
struct Form {
  const char* name;
  bool n;
  std::size_t states;
  bool action;
};
constexpr std::array<Form, 11> forms{{{"lemma-1", true, 2, true},
                                      {"lemma-1-iterates", true, 2, true},
                                      {"lemma-2", true, 1, true},
                                      {"lemma-3", true, 0, false},
                                      {"theorem-1", true, 1, true},
                                      {"A", true, 1, true},
                                      {"B", true, 1, true},
                                      {"C", true, 1, true},
                                      {"D", true, 1, true},
                                      {"E", false, 1, true},
                                      {"F", false, 1, false}}};

const Form& form(ClaimId id) {
  return forms[static_cast<std::size_t>(id)];
}

bool is_of_pairs(ClaimId id) {
  return form(id).states == 2;
}

}  // namespace

ClaimCheck::ClaimCheck(const Node& node, const Model& model, std::size_t rounds, bool bounds)
    : model_(model), path_(node.path()) {
  if (!node.has("claim") || !node.has("verdict")) refuse(path_, "expected an object with a claim and its verdict");
  static_assert(forms.size() == 11 && verdicts.size() == 3);
  id_ = static_cast<ClaimId>(node.member("claim").one_of({forms[0].name, forms[1].name, forms[2].name, forms[3].name,
                                                          forms[4].name, forms[5].name, forms[6].name, forms[7].name,
                                                          forms[8].name, forms[9].name, forms[10].name}));
  if (bounds && id_ == ClaimId::lemma_3) {
    refuse(path_ + ".claim", "\"lemma-3\", expected no entry of it in a certificate by bounds");
  }
  verdict_ = static_cast<Verdict>(node.member("verdict").one_of({verdicts[0], verdicts[1], verdicts[2]}));
  if (undetermined()) {
    node.expect_members({"claim", "verdict"});
    return;
  }
  node.expect_members({"claim", "verdict", "left", "right", "at"});
  left_ = node.member("left").number();
  right_ = node.member("right").number();
  const bool nothing_to_name = is_of_pairs(id_) && !model.has_pairs;
  if (nothing_to_name) {
    node.member("at").expect_members({});
    see({}, 0, 0);
  } else {
    read_place(node.member("at"), rounds);
  }
  if (verdict_ == violated_ && (bounds || model.metric.l2)) {
    refuse(path_ + ".verdict", "violated, expected it never " + std::string(bounds ? "by bounds" : "under l2"));
  }
}

void ClaimCheck::read_place(const Node& at, std::size_t rounds) {
  const Form& f = form(id_);
  std::vector<const char*> names;
  if (f.n) names.push_back("n");
  if (f.states > 0) names.push_back("states");
  if (f.action) names.push_back("action");
  at.expect_members(names);
  if (f.n) at_.n = at.member("n").index(rounds);
  if (f.action) at_.a = at.member("action").index(model_.actions);
  if (f.states == 0) return;
  const Indices states = at.member("states").indices(f.states, model_.states);
  at_.s = states[0];
  if (f.states == 2) at_.t = states[1];
}

ClaimVerdict ClaimCheck::verdict() const {
  const bool known = !undetermined();
  return {form(id_).name, verdicts[verdict_], known ? left_.get_str() : "", known ? right_.get_str() : ""};
}

void ClaimCheck::see(const Place& place, const Rational& left, const Rational& right, bool proves) {
  if (verdict_ == violated_ && !proves) return;
  const Rational gap = right - left;
  if (!least_ || gap < *least_) least_ = gap;
  if (place == at_ && left == left_ && right == right_) least_named_ = gap;
}

void ClaimCheck::see_each(std::size_t n, const Table& left, const Rational& right, bool proves, const Table* added) {
  const auto proves_at = [&](std::size_t i) { return proves && (added == nullptr || added->top[i] == 0); };
  const auto see_at = [&](std::size_t i) {
    see({n, i / model_.actions, Place::none, i % model_.actions}, left[i], right, proves_at(i));
  };
  std::size_t tightest = left.size();
  for (std::size_t i = 0; i < left.size(); ++i) {
    if (wants_violations() && !proves_at(i)) continue;
    if (tightest == left.size() || left.top[i] > left.top[tightest]) tightest = i;
  }
  if (tightest < left.size()) see_at(tightest);
  if (at_.n == n) see_at(model_.at(at_.s, at_.a));
}

void ClaimCheck::verify() const {
  const bool holds = verdict_ == holds_;
  if (!least_)
    refuse(path_ + ".verdict", std::string(verdicts[verdict_]) + ", expected undetermined: no instance decides it");
  if (holds != (*least_ >= 0)) {
    refuse(path_ + ".verdict", std::string(verdicts[verdict_]) + ", but the least right - left is " + shown(*least_) +
                                   ", expected " + (holds ? "0 or more" : "less than 0"));
  }
  if (right_ - left_ != *least_) {
    refuse(path_ + ".left", shown(left_) + " against right " + shown(right_) +
                                ", expected the instance of least right - left, which is " + shown(*least_));
  }
  if (!least_named_) refuse(path_ + ".at", "no instance with these sides, expected the one that they are the sides of");
}

std::vector<ClaimCheck> read_claims(const Node& node, const Model& model, std::size_t rounds, bool bounds) {
  std::vector<ClaimCheck> claims;
  for (const Node& entry : node.items()) {
    claims.emplace_back(entry, model, rounds, bounds);
    if (claims.size() == 1 || claims[claims.size() - 2].id() < claims.back().id()) continue;
    refuse(entry.path() + ".claim", "not after the one before it, expected the order of the format and none twice");
  }
  if (claims.empty()) refuse(node.path(), "empty, expected a claim at least");
  return claims;
}

std::vector<std::string> left_out(const std::vector<ClaimCheck>& claims, bool bounds) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < forms.size(); ++i) {
    if (bounds && static_cast<ClaimId>(i) == ClaimId::lemma_3) continue;
    const auto is_it = [i](const ClaimCheck& claim) { return static_cast<std::size_t>(claim.id()) == i; };
    if (std::none_of(claims.begin(), claims.end(), is_it)) names.emplace_back(forms[i].name);
  }
  return names;
}

}  // namespace maximin::checker
