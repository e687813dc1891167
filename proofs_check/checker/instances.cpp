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

bool has_pairs(const Model& m) {
  for (std::size_t s = 0; s < m.states; ++s) {
    for (std::size_t t = s + 1; t < m.states; ++t) {
      if (m.finite[s * m.states + t]) return true;
    }
  }
  return false;
}

}  // namespace

ClaimCheck::ClaimCheck(const Node& node, const Model& model, std::size_t rounds) : model_(model), path_(node.path()) {
  if (!node.has("claim") || !node.has("verdict")) refuse(path_, "expected an object with a claim and its verdict");
  static_assert(forms.size() == 11 && verdicts.size() == 3);
  id_ = static_cast<ClaimId>(node.member("claim").one_of({forms[0].name, forms[1].name, forms[2].name, forms[3].name,
                                                          forms[4].name, forms[5].name, forms[6].name, forms[7].name,
                                                          forms[8].name, forms[9].name, forms[10].name}));
  verdict_ = static_cast<Verdict>(node.member("verdict").one_of({verdicts[0], verdicts[1], verdicts[2]}));
  if (undetermined()) {
    node.expect_members({"claim", "verdict"});
    return;
  }
  node.expect_members({"claim", "verdict", "left", "right", "at"});
  left_ = node.member("left").number();
  right_ = node.member("right").number();
  const bool nothing_to_name = is_of_pairs(id_) && !has_pairs(model);
  if (nothing_to_name) {
    node.member("at").expect_members({});
    see({}, 0, 0);
  } else {
    read_place(node.member("at"), rounds);
  }
  if (verdict_ == violated_ && model.l2) refuse(path_ + ".verdict", "violated, expected it only of l1 and linf");
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

void ClaimCheck::see_each(std::size_t n, const Table& left, const Rational& more, const Rational& right, bool proves) {
  const auto see_at = [&](std::size_t s, std::size_t a) {
    see({n, s, Place::none, a}, left[model_.at(s, a)] + more, right, proves);
  };
  const std::size_t i = largest(left);
  see_at(i / model_.actions, i % model_.actions);
  if (at_.n == n) see_at(at_.s, at_.a);
}

void ClaimCheck::see_pairs(std::size_t n, const Table& x, const Rational& slack, const Table& right) {
  const Model& m = model_;
  // All sides are numerators over x.bottom * of_x, or right.bottom, until the tightest instance is known.
  const Integer of_x = slack == 0 ? Integer(1) : Integer(slack.get_den() * m.whole);
  const Integer of_row = slack.get_num() * x.bottom, bottom = x.bottom * of_x;
  Integer left, added, gap;
  const auto find_left = [&](const Place& place) {
    added = slack == 0 ? Integer(0) : Integer(of_row * sum(row_differences(m, place.s, place.t, place.a)));
    left = x.top[m.at(place.s, place.a)] - x.top[m.at(place.t, place.a)];
    left = abs(left) * of_x + added;
  };
  const auto see_at = [&](const Place& place) {
    find_left(place);
    see(place, Table{{left}, bottom}[0], right[place.s * m.states + place.t], added == 0);
  };
  Place tightest;
  Integer least, widest;
  for (std::size_t s = 0; s < m.states; ++s) {
    for (std::size_t t = s + 1; t < m.states; ++t) {
      if (!m.finite[s * m.states + t]) continue;
      Place of_pair;
      for (std::size_t a = 0; a < m.actions; ++a) {
        const Place place{n, s, t, a};
        find_left(place);
        if ((verdict_ == violated_ && added != 0) || (of_pair.n == n && left <= widest)) continue;
        swap(widest, left);
        of_pair = place;
      }
      if (of_pair.n != n) continue;
      gap = right.top[s * m.states + t] * bottom - widest * right.bottom;
      if (tightest.n == n && gap >= least) continue;
      swap(least, gap);
      tightest = of_pair;
    }
  }
  if (tightest.n != n) return;
  see_at(tightest);
  if (at_.n == n && at_.s < at_.t && m.finite[at_.s * m.states + at_.t]) see_at(at_);
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

std::vector<ClaimCheck> read_claims(const Node& node, const Model& model, std::size_t rounds) {
  std::vector<ClaimCheck> claims;
  for (const Node& entry : node.items()) {
    claims.emplace_back(entry, model, rounds);
    if (claims.size() == 1 || claims[claims.size() - 2].id() < claims.back().id()) continue;
    refuse(entry.path() + ".claim", "not after the one before it, expected the order of the format and none twice");
  }
  if (claims.empty()) refuse(node.path(), "empty, expected a claim at least");
  return claims;
}

std::vector<std::string> left_out(const std::vector<ClaimCheck>& claims) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < forms.size(); ++i) {
    const auto is_it = [i](const ClaimCheck& claim) { return static_cast<std::size_t>(claim.id()) == i; };
    if (std::none_of(claims.begin(), claims.end(), is_it)) names.emplace_back(forms[i].name);
  }
  return names;
}

}  // namespace maximin::checker
