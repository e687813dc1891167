#pragma once

#include <gmpxx.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

/// The truth of a well-formed certificate, by rational numbers and the definitions as they stand: every instance of
/// every claim is written down and looked through. Slow, and shares nothing with the checker but the page.
namespace maximin::testing {

class NaiveCertificate {
 public:
  /// What is untrue in a certificate of the right form; empty where nothing is.
  static std::string untruth(const nlohmann::json& certificate) {
    NaiveCertificate naive(certificate);
    for (const auto step : {&NaiveCertificate::model, &NaiveCertificate::constants, &NaiveCertificate::pairs,
                            &NaiveCertificate::rounds, &NaiveCertificate::limit, &NaiveCertificate::test_time,
                            &NaiveCertificate::belief_game, &NaiveCertificate::claims}) {
      if (!(naive.*step)()) return naive.what_;
    }
    return {};
  }

 private:
  using Json = nlohmann::json;
  using Q = mpq_class;
  using Values = std::vector<Q>;
  using Table = std::vector<Values>;
  using States = std::set<int>;
  struct Instance {
    Json at;
    Q left, right;
    bool proves;
  };

  explicit NaiveCertificate(const Json& certificate)
      : c_(certificate),
        tie_highest_(certificate["tie"] == "highest"),
        bounds_(certificate["format"] == "maximin-bounds") {}

  static Q number(const Json& text) { return Q(text.get<std::string>()); }
  static Values numbers(const Json& list) {
    Values values;
    for (const Json& x : list) values.push_back(number(x));
    return values;
  }
  static Q magnitude(const Q& x) { return x < 0 ? Q(-x) : x; }

  /// Remembers what is untrue unless it is true.
  bool expect(bool truth, const std::string& what) {
    if (!truth) what_ = what;
    return truth;
  }

  /// The largest k / 2^64 whose square is at most q, by bisection.
  static Q root_below(const Q& q) {
    const Q step(1, mpz_class(1) << 64);
    mpz_class low = 0, high = 1;
    while (Q(high) * high * step * step <= q) high *= 2;
    while (high - low > 1) {
      const mpz_class middle = (low + high) / 2;
      (Q(middle) * middle * step * step <= q ? low : high) = middle;
    }
    return low * step;
  }

  Table back(const Values& v) const {
    Table q(n_, Values(m_));
    for (int s = 0; s < n_; ++s) {
      for (int a = 0; a < m_; ++a) {
        Q sum = 0;
        for (int t = 0; t < n_; ++t) sum += p_[s][a][t] * v[t];
        q[s][a] = r_[s][a] + g_ * sum;
      }
    }
    return q;
  }

  template <class Value>
  int choose(int count, Value value, bool greatest) const {
    std::vector<int> best;
    for (int i = 0; i < count; ++i) {
      const auto x = value(i);
      if (!x) continue;
      if (!best.empty() && (greatest ? *x > *value(best[0]) : *x < *value(best[0]))) best.clear();
      if (best.empty() || *x == *value(best[0])) best.push_back(i);
    }
    return tie_highest_ ? best.back() : best.front();
  }
  int maximin(const Table& q, const States& belief) const {
    return choose(
        m_,
        [&](int a) {
          Q worst = q[*belief.begin()][a];
          for (const int state : belief) worst = std::min(worst, q[state][a]);
          return std::optional<Q>(worst);
        },
        true);
  }
  std::vector<int> maximin(const Table& q) const {
    std::vector<int> policy;
    for (int t = 0; t < n_; ++t) policy.push_back(maximin(q, ball_[t]));
    return policy;
  }
  bool is_robust(const Values& v, const std::vector<int>& policy) const {
    const Table q = back(v);
    for (int s = 0; s < n_; ++s) {
      Values shown;
      for (const int t : ball_[s]) shown.push_back(q[s][policy[t]]);
      if (v[s] != *std::min_element(shown.begin(), shown.end())) return false;
    }
    return true;
  }

  bool model() {
    const Json& model = c_["model"];
    n_ = model["states"];
    m_ = model["actions"];
    g_ = number(model["discount"]);
    eps_ = number(model["eps"]);
    for (const Json& row : model["rewards"]) r_.push_back(numbers(row));
    p_.assign(n_, Table(m_, Values(n_)));
    for (const Json& x : model["transitions"]) {
      Q& p = p_[x[0].get<int>()][x[1].get<int>()][x[2].get<int>()];
      if (!expect(p == 0 && number(x[3]) > 0, "a transition twice, or not above 0")) return false;
      p = number(x[3]);
    }
    for (const Table& of_state : p_) {
      for (const Values& row : of_state) {
        Q sum = 0;
        for (const Q& p : row) sum += p;
        if (!expect(sum == 1, "a row does not sum to 1")) return false;
      }
    }
    l2_ = model.contains("norm") && model["norm"] == "l2";
    ball_.resize(n_);
    for (int s = 0; s < n_; ++s) {
      for (int t = 0; t < n_; ++t) {
        std::optional<Q> d = Q(0);
        if (model.contains("points")) {
          const Values x = numbers(model["points"][s]), y = numbers(model["points"][t]);
          for (std::size_t i = 0; i < x.size(); ++i) {
            const Q difference = magnitude(x[i] - y[i]);
            if (model["norm"] == "linf") d = std::max(*d, difference);
            if (model["norm"] == "l1") *d += difference;
            if (l2_) *d += difference * difference;
          }
        } else if (model.contains("metric")) {
          d = model["metric"] == "hops" ? hops(s, t) : std::optional<Q>(s == t ? 0 : 1);
        } else {
          d = model["distances"][s][t].is_null() ? std::nullopt : std::optional<Q>(number(model["distances"][s][t]));
        }
        if (d && *d <= (l2_ ? Q(eps_ * eps_) : eps_)) ball_[s].insert(t);
        if (d && l2_) {
          const Q low = root_below(*d);
          far_[{s, t}] = low * low == *d ? low : low + Q(1, mpz_class(1) << 64);
          d = low;
        } else if (d) {
          far_[{s, t}] = *d;
        }
        if (d) near_[{s, t}] = *d;
      }
    }
    return expect(g_ >= 0 && g_ < 1 && eps_ >= 0, "discount or eps") && expect(l2_ || is_metric(), "no metric");
  }
  /// Steps from s to t, by spreading out from s n times.
  std::optional<Q> hops(int s, int t) const {
    States met{s};
    for (int steps = 0; steps <= n_; ++steps) {
      if (met.count(t)) return Q(steps);
      for (const int from : States(met)) {
        for (int to = 0; to < n_; ++to) {
          for (int a = 0; a < m_; ++a) {
            if (p_[from][a][to] > 0 || p_[to][a][from] > 0) met.insert(to);
          }
        }
      }
    }
    return std::nullopt;
  }
  bool is_metric() const {
    for (int s = 0; s < n_; ++s) {
      for (int t = 0; t < n_; ++t) {
        if (near_.count({s, t}) != near_.count({t, s}) || !near_.count({s, s}) || near_.at({s, s}) != 0) return false;
        if (near_.count({s, t}) && (near_.at({s, t}) < 0 || near_.at({s, t}) != near_.at({t, s}))) return false;
        for (int u = 0; u < n_; ++u) {
          if (!near_.count({s, u}) || !near_.count({u, t})) continue;
          if (!near_.count({s, t}) || near_.at({s, t}) > near_.at({s, u}) + near_.at({u, t})) return false;
        }
      }
    }
    return true;
  }

  bool constants() {
    v_star_ = numbers(bounds_ ? c_["optimal"]["high"] : c_["optimal"]);
    q_star_ = back(v_star_);
    const Values below = bounds_ ? numbers(c_["optimal"]["low"]) : v_star_;
    q_low_ = back(below);
    for (int s = 0; s < n_; ++s) {
      if (!expect(v_star_[s] >= *std::max_element(q_star_[s].begin(), q_star_[s].end()), "optimal")) return false;
      if (!expect(below[s] <= *std::max_element(q_low_[s].begin(), q_low_[s].end()), "optimal")) return false;
    }
    std::map<std::string, std::vector<std::pair<Json, Q>>> quotients;
    for (const auto& [pair, d] : far_) {
      const auto [s, t] = pair;
      if (bounds_ ? s == t : s >= t) continue;
      for (int a = 0; a < m_; ++a) {
        Q total = 0;
        std::vector<std::tuple<std::string, Json, Q>> found;
        for (int next = 0; next < n_; ++next) {
          const Q difference = magnitude(p_[s][a][next] - p_[t][a][next]);
          total += difference / 2;
          found.push_back({"l_p", {s, t, a, next}, difference});
        }
        found.push_back({"k", {s, t, a}, total});
        found.push_back({"l_r", {s, t, a}, magnitude(r_[s][a] - r_[t][a])});
        const Q apart = q_low_[s][a] - q_star_[t][a];
        found.push_back({"l_star", {s, t, a}, bounds_ ? apart : magnitude(apart)});
        for (const auto& [name, at, x] : found) {
          if (x == 0 || (bounds_ && d == 0)) continue;
          if (!expect(d > 0, "states at distance 0 differ")) return false;
          quotients[name].push_back({at, x / d});
        }
      }
    }
    for (const char* name : {"l_r", "l_p", "k", "l_star"}) {
      Q most = 0;
      for (const auto& entry : quotients[name]) most = std::max(most, entry.second);
      const Json& given = c_["constants"][name];
      bool attained = most == 0 && given["at"].is_null();
      for (const auto& [at, x] : quotients[name]) attained = attained || (x == most && at == given["at"]);
      const Q x = number(given["value"]);
      if (bounds_) {
        bool proved = x == 0 && given["at"].is_null();
        for (const auto& [at, quotient] : quotients[name])
          proved = proved || (0 < x && x <= quotient && at == given["at"]);
        if (!expect(proved, name)) return false;
      } else if (!expect(x == most && attained, name)) {
        return false;
      }
      constant_[name] = x;
    }
    Values all;
    for (const Values& row : r_) all.insert(all.end(), row.begin(), row.end());
    const auto [least, greatest] = std::minmax_element(all.begin(), all.end());
    const Q size = std::max(magnitude(*least), magnitude(*greatest));
    const Q printed = c_["reading"] == "paper" ? std::max(Q(0), *greatest) : size;
    const Q l_r = constant_["l_r"], of_p = n_ * constant_["l_p"], rest = 1 - g_;
    of_print_ = n_ * printed / rest;
    of_rep_ = g_ * n_ * size / rest;
    l_print_ = l_r + of_p * printed / rest;
    l_sound_ = l_r + of_p * size / rest;
    l_rep_ = l_r + g_ * of_p * size / rest;
    l_tv_ = l_r + g_ * constant_["k"] * (*greatest - *least) / rest;
    return expect(number(c_["constants"]["r_min"]) == *least && number(c_["constants"]["r_max"]) == *greatest, "r_min");
  }

  bool pairs() {
    if (bounds_) return true;  // looked at with their rounds
    std::set<std::string> seen;
    for (const Json& pair : c_["pairs"]) {
      const std::vector<int> policy = pair["policy"], attack = pair["attack"];
      const Values fixed = numbers(pair["fixed"]);
      const Table q = back(fixed);
      for (int s = 0; s < n_; ++s) {
        if (!expect(fixed[s] == q[s][policy[attack[s]]], "fixed")) return false;
      }
      if (!expect(is_robust(numbers(pair["robust"]), policy), "robust")) return false;
      if (!expect(seen.insert(Json{policy, attack}.dump()).second, "pair twice")) return false;
    }
    return true;
  }

  bool rounds() {
    if (bounds_) return rounds_by_bounds();
    q_.assign(1, Table(n_, Values(m_)));
    std::vector<int> order;
    for (const int index : c_["rounds"]) {
      if (std::find(order.begin(), order.end(), index) == order.end()) order.push_back(index);
      if (!expect(order[index] == index, "pairs out of order")) return false;
      const Table& q = q_.back();
      const std::vector<int> policy = maximin(q);
      Values next;
      std::vector<int> attack;
      for (int s = 0; s < n_; ++s) {
        attack.push_back(choose(
            n_, [&](int t) { return ball_[s].count(t) ? std::optional<Q>(q[s][policy[t]]) : std::nullopt; }, false));
        next.push_back(q[s][policy[attack[s]]]);
      }
      const Json& pair = c_["pairs"][index];
      if (!expect(pair["policy"] == Json(policy) && pair["attack"] == Json(attack), "policies of a round"))
        return false;
      q_.push_back(back(next));
      x_low_ = x_high_ = next;
    }
    return expect(order.size() == c_["pairs"].size(), "a pair in no round");
  }

  /// What one class of entries has in common in a phase, as text: Q_N, reward, and where it goes.
  std::string nature(int s, int a, const std::vector<std::string>& kind) const {
    std::map<std::string, Q> moves;
    for (int next = 0; next < n_; ++next) moves[kind[next]] += p_[s][a][next];
    std::string text = q_.back()[s][a].get_str() + " " + r_[s][a].get_str();
    for (const auto& [where, p] : moves) {
      if (p > 0) text += " " + where + ":" + p.get_str();
    }
    return text;
  }

  bool limit() {
    const Json& limit = c_["limit"];
    if (limit.is_null()) return true;
    if (bounds_ || limit.contains("boxes")) return boxes();
    const int k = limit["period"];
    const Q r = number(limit["radius"]);
    if (!expect(r > 0, "radius")) return false;
    const auto classes = limit["classes"].get<std::vector<std::vector<int>>>();
    int next_class = 0;
    for (const auto& row : classes) {
      for (const int number : row) {
        if (!expect(number <= next_class, "numbers of classes")) return false;
        next_class = std::max(next_class, number + 1);
      }
    }
    for (int j = 0; j < k; ++j) {
      const Values u = numbers(limit["orbit"][j]);
      const Table q = back(numbers(limit["orbit"][(j + k - 1) % k]));
      orbit_.push_back(q);
      if (j == 0) delta_ = distance(q_.back(), q);
      if (!expect(delta_ <= r, "condition 3")) return false;

      std::vector<States> candidates(n_);
      for (int t = 0; t < n_; ++t) {
        Values v;
        std::vector<States> least(m_);
        for (int a = 0; a < m_; ++a) {
          Q worst = q[t][a];
          for (const int state : ball_[t]) worst = std::min(worst, q[state][a]);
          v.push_back(worst);
          for (const int state : ball_[t]) {
            if (q[state][a] <= worst + 2 * r) least[a].insert(classes[state][a]);
          }
        }
        const Q most = *std::max_element(v.begin(), v.end());
        std::vector<int> near;  // in the order of tie
        for (int a = 0; a < m_; ++a) {
          if (v[a] >= most - 2 * r) near.push_back(a);
        }
        if (tie_highest_) std::reverse(near.begin(), near.end());
        for (std::size_t b = 0; b < near.size(); ++b) {
          bool beaten = false;
          for (std::size_t a = 0; a < b; ++a) {
            bool contained = true;
            for (const int number : least[near[a]]) contained = contained && least[near[b]].count(number);
            beaten = beaten || contained;
          }
          if (!beaten) candidates[t].insert(near[b]);
        }
      }
      const auto is_settled = [&](int s) {
        return std::all_of(ball_[s].begin(), ball_[s].end(), [&](int t) { return candidates[t].size() == 1; });
      };

      const Values low = numbers(limit["low"][j]);
      const Table back_of_low = back(low);
      std::vector<States> attaining(n_), attained_classes(n_);
      std::vector<std::string> kind;
      bool all_known = true, all_settled = true;
      std::vector<int> provoked;
      for (int s = 0; s < n_; ++s) {
        Values least, greatest, lows;
        for (const int t : ball_[s]) {
          Values of_t;
          for (const int a : candidates[t]) {
            of_t.push_back(q[s][a]);
            lows.push_back(back_of_low[s][a]);
            if (q[s][a] == u[s]) attaining[s].insert(a), attained_classes[s].insert(classes[s][a]);
            if (!expect(!(u[s] < q[s][a] && q[s][a] <= u[s] + 2 * r), "condition 2")) return false;
          }
          least.push_back(*std::min_element(of_t.begin(), of_t.end()));
          greatest.push_back(*std::max_element(of_t.begin(), of_t.end()));
        }
        const bool same = u[s] == *std::min_element(least.begin(), least.end()) &&
                          u[s] == *std::min_element(greatest.begin(), greatest.end());
        if (!expect(same, "condition 1")) return false;
        if (!expect(low[s] == *std::min_element(lows.begin(), lows.end()), "low")) return false;
        kind.push_back(is_settled(s) ? Json(attained_classes[s]).dump() : "state " + std::to_string(s));
        all_settled = all_settled && is_settled(s);
        if (attaining[s].size() == 1) {
          provoked.push_back(*attaining[s].begin());
        } else if (is_settled(s) && attained_classes[s].size() == 1) {
          std::vector<int> ball(ball_[s].begin(), ball_[s].end());
          if (tie_highest_) std::reverse(ball.begin(), ball.end());
          int first = 0;
          while (!attaining[s].count(*candidates[ball[first]].begin())) ++first;
          provoked.push_back(*candidates[ball[first]].begin());
        } else {
          all_known = false;
        }
      }
      std::map<int, std::string> natures;
      for (int s = 0; s < n_; ++s) {
        for (int a = 0; a < m_; ++a) {
          const std::string own = nature(s, a, kind);
          if (!expect(natures.emplace(classes[s][a], own).first->second == own, "condition 4")) return false;
        }
      }
      low_proves_.push_back(all_settled || k == 1);
      low_.push_back(back_of_low);
      const Json& given = limit["fixed"][j];
      if (!expect(given.is_null() == (!all_known && k > 1), "fixed null")) return false;
      fixed_.emplace_back();
      if (given.is_null()) continue;
      const Values fixed = numbers(given);
      fixed_.back() = back(fixed);
      for (int s = 0; s < n_; ++s) {
        if (!expect(fixed[s] == (all_known ? (*fixed_.back())[s][provoked[s]] : u[s]), "fixed_j")) return false;
      }
    }
    return true;
  }

  // ---- Enclosures ----

  std::vector<int> candidates(const Table& low, const Table& high, const States& belief) const {
    const auto least = [&](const Table& q, int a) {
      Q worst = q[*belief.begin()][a];
      for (const int state : belief) worst = std::min(worst, q[state][a]);
      return worst;
    };
    std::vector<int> found;
    for (int b = 0; b < m_; ++b) {
      bool beaten = false;
      for (int a = 0; a < m_; ++a) {
        const Q v_low = least(low, a), v_high = least(high, b);
        const bool first = tie_highest_ ? a > b : a < b;
        beaten = beaten || (a != b && (v_low > v_high || (v_low == v_high && first)));
      }
      if (!beaten) found.push_back(b);
    }
    return found;
  }
  struct Choices {
    std::vector<std::vector<int>> candidates;
    std::vector<States> possible;
    Values low, high;
  };
  Choices choices(const Table& low, const Table& high) const {
    Choices all;
    for (int t = 0; t < n_; ++t) all.candidates.push_back(candidates(low, high, ball_[t]));
    for (int s = 0; s < n_; ++s) {
      States possible;
      std::optional<Q> least, most;
      for (const int t : ball_[s]) {
        std::optional<Q> most_of_t;
        for (const int a : all.candidates[t]) {
          possible.insert(a);
          if (!least || low[s][a] < *least) least = low[s][a];
          if (!most_of_t || high[s][a] > *most_of_t) most_of_t = high[s][a];
        }
        if (!most || *most_of_t < *most) most = most_of_t;
      }
      all.possible.push_back(possible);
      all.low.push_back(*least);
      all.high.push_back(*most);
    }
    return all;
  }
  bool between(const Values& below, const Values& above, const std::vector<States>& possible,
               const std::vector<States>& provoked) {
    const Table low = back(below), high = back(above);
    for (int s = 0; s < n_; ++s) {
      for (const int a : possible[s]) {
        if (!expect(below[s] <= low[s][a], "below")) return false;
      }
      for (const int a : provoked[s]) {
        if (!expect(above[s] >= high[s][a], "above")) return false;
      }
    }
    return true;
  }
  std::vector<States> provoked(const Table& low, const Choices& all, const Values& most) const {
    std::vector<States> found(n_);
    for (int s = 0; s < n_; ++s) {
      for (const int a : all.possible[s]) {
        if (low[s][a] <= most[s]) found[s].insert(a);
      }
    }
    return found;
  }
  Q rounded(const Q& x, bool up) const {
    const Q scaled = x * Q(mpz_class(1) << c_["bits"].get<unsigned>());
    mpz_class whole = scaled.get_num() / scaled.get_den();  // towards 0
    if (up ? whole < scaled : whole > scaled) whole += up ? 1 : -1;
    Q result(whole, mpz_class(1) << c_["bits"].get<unsigned>());
    result.canonicalize();
    return result;
  }

  /// A round by bounds or a phase of boxes, for the claims.
  struct Enclosed {
    int n;
    bool first;
    Values before_low, before_high;  // of Lo and Hi
    Values low, below, above;
  };

  bool rounds_by_bounds() {
    std::vector<Json> order;
    for (std::size_t n = 0; n < c_["rounds"].size(); ++n) {
      Table low(n_, Values(m_)), high = low;
      if (n > 0) {
        low = back(x_low_);
        high = back(x_high_);
      }
      const Values before_low = x_low_, before_high = x_high_;
      const Choices all = choices(low, high);
      x_low_ = x_high_ = {};
      for (int s = 0; s < n_; ++s) {
        x_low_.push_back(rounded(all.low[s], false));
        x_high_.push_back(rounded(all.high[s], true));
      }
      const std::vector<States> found = provoked(low, all, x_high_);
      const std::size_t index = c_["rounds"][n];
      const Json& pair = c_["pairs"][index];
      if (!expect(pair["choices"] == Json(all.candidates) && pair["provoked"] == Json(found), "actions of a round"))
        return false;
      const Json key{all.candidates, found};
      const bool first = std::find(order.begin(), order.end(), key) == order.end();
      if (first) order.push_back(key);
      if (!expect(order[index] == key, "pairs out of order")) return false;
      const Values below = numbers(pair["below"]), above = numbers(pair["above"]);
      if (!between(below, above, all.possible, found)) return false;
      enclosed_.push_back({static_cast<int>(n), first, before_low, before_high, x_low_, below, above});
    }
    return expect(order.size() == c_["pairs"].size(), "a pair in no round");
  }

  bool boxes() {
    const Json& list = c_["limit"]["boxes"];
    const int rounds = static_cast<int>(c_["rounds"].size()), k = static_cast<int>(list.size());
    for (int j = 0; j < k; ++j) {
      const Values before_low = numbers(list[(j + k - 1) % k]["low"]),
                   before_high = numbers(list[(j + k - 1) % k]["high"]);
      const Table lo = back(before_low), hi = back(before_high);
      const Values low = numbers(list[j]["low"]), high = numbers(list[j]["high"]);
      const Values below = numbers(list[j]["below"]), above = numbers(list[j]["above"]);
      for (int s = 0; s < n_ && j == 0; ++s) {
        if (!expect(before_low[s] <= x_low_[s] && x_high_[s] <= before_high[s], "boxes, condition 1")) return false;
      }
      const Choices all = choices(lo, hi);
      for (int s = 0; s < n_; ++s) {
        if (!expect(low[s] <= all.low[s] && high[s] >= all.high[s], "boxes, condition 2")) return false;
      }
      if (!between(below, above, all.possible, provoked(lo, all, high))) return false;
      enclosed_.push_back({rounds + j, true, before_low, before_high, low, below, above});
    }
    return expect(k > 0, "no boxes");
  }

  void spread(const std::string& claim, int n, const Values& v, const Values& w, const Q& factor) {
    Values middle;
    Q half = 0;
    for (int s = 0; s < n_; ++s) {
      middle.push_back((v[s] + w[s]) / 2);
      half = std::max(half, Q((w[s] - v[s]) / 2));
    }
    const std::size_t before = instances_[claim].size();
    lipschitz(claim, n, back(middle), 2 * g_ * half, factor);
    for (std::size_t i = before; i < instances_[claim].size(); ++i) instances_[claim][i].proves = false;
  }

  void claims_of(const Enclosed& x, int rounds) {
    const Q e2 = 2 * eps_ * g_, rest = 1 - g_;
    const Json at{{"n", x.n}};
    if (x.first) spread("lemma-1", x.n, x.below, x.above, of_print_);
    if (x.n > 0) spread("lemma-1-iterates", x.n, x.before_low, x.before_high, of_rep_);
    const Table hi = x.n == 0 ? Table(n_, Values(m_)) : back(x.before_high);
    Values off(n_);
    for (int s = 0; s < n_; ++s) {
      if (ball_[s].size() > 1) off[s] = *std::max_element(hi[s].begin(), hi[s].end()) - x.low[s];
    }
    Table loss = back(off);
    for (int s = 0; s < n_; ++s) {
      for (int a = 0; a < m_; ++a) loss[s][a] -= r_[s][a];
    }
    const Table none(n_, Values(m_)), below = back(x.below);
    each("lemma-2", at, loss, none, false, e2 * l_print_, false);
    const bool phase = x.n >= rounds;
    for (const auto& [claim, delta] : {std::pair<std::string, Q>("C", e2 * l_rep_), {"D", e2 * l_tv_}}) {
      const Q now = finite_n(x.n, delta), at_last = (g_ * delta / rest + delta) / rest;
      each(claim, at, q_star_, below, false, phase ? std::min(now, at_last) : now, false);
    }
    if (!phase) return;
    each("theorem-1", at, q_star_, below, false, (1 + g_) / (rest * rest) * e2 * l_print_, false);
    each("A", at, q_star_, below, false, (1 + g_) / (rest * rest) * e2 * l_sound_, false);
    each("B", at, q_star_, below, false, e2 * l_sound_ / (rest * rest), false);
  }

  bool test_time() {
    if (bounds_) {
      const Values below = numbers(c_["test_time"]["below"]);
      return between(below, v_star_, choices(q_low_, q_star_).possible, std::vector<States>(n_));
    }
    const std::vector<int> policy = maximin(q_star_);
    return expect(c_["test_time"]["policy"] == Json(policy), "test_time policy") &&
           expect(is_robust(numbers(c_["test_time"]["robust"]), policy), "test_time robust");
  }

  bool belief_game() {
    const Json& game = c_["belief_game"];
    if (game.is_null()) return true;
    using Position = std::pair<int, States>;
    std::map<Position, Q> listed;
    for (std::size_t i = 0; i < game["positions"].size(); ++i) {
      const Json& entry = game["positions"][i];
      listed[{entry[0].get<int>(), entry[1].get<States>()}] = number(game["values"][i]);
    }
    if (!expect(listed.size() == game["positions"].size(), "positions twice")) return false;
    const bool exact = !bounds_ && game["exact"] == true;
    std::set<Position> reached;
    std::vector<Position> open;
    const auto reach = [&](const Position& position) {
      if (!exact && !listed.count(position)) return true;
      if (reached.insert(position).second) open.push_back(position);
      return expect(listed.count(position) == 1, "a position is missing");
    };
    for (int s = 0; s < n_; ++s) {
      for (const int t : ball_[s]) {
        if (!expect(listed.count({s, ball_[t]}) == 1, "a start is missing") || !reach({s, ball_[t]})) return false;
      }
    }
    Q rho = 0;
    while (!open.empty()) {
      const auto [s, belief] = open.back();
      open.pop_back();
      const Q given = listed[{s, belief}];
      for (const int a : candidates(q_low_, q_star_, belief)) {
        Q value = r_[s][a];
        for (int next = 0; next < n_; ++next) {
          if (p_[s][a][next] == 0) continue;
          std::optional<Q> worst;
          for (const int t : ball_[next]) {
            Position position{next, {}};
            for (const int state : ball_[t]) {
              for (const int member : belief) {
                if (p_[member][a][state] > 0) position.second.insert(state);
              }
            }
            if (!reach(position)) return false;
            const Q next_value =
                listed.count(position) ? listed[position] : number(c_["constants"]["r_min"]) / (1 - g_);
            if (!worst || next_value < *worst) worst = next_value;
          }
          value += g_ * p_[s][a][next] * *worst;
        }
        if (!expect(exact ? given == value : given <= value, "belief value")) return false;
      }
      for (const int member : belief) rho = std::max(rho, near_.at({s, member}));
    }
    for (int s = 0; s < n_; ++s) {
      Q worst = listed[{s, ball_[s]}];
      for (const int t : ball_[s]) worst = std::min(worst, listed[{s, ball_[t]}]);
      belief_worst_.push_back(worst);
    }
    return expect(reached.size() == listed.size(), "an unreached position") &&
           expect(number(game["reach"]) == rho, "reach");
  }

  // ---- Claims: every instance ----

  /// |x(s,a) - x(t,a)| + slack TV(s,t,a) <= r(s,t) + factor p(s,t).
  void lipschitz(const std::string& claim, int n, const Table& x, const Q& slack, const Q& factor) {
    for (const auto& [pair, d] : near_) {
      const auto [s, t] = pair;
      if (s >= t) continue;
      Q reward = constant_["l_r"] * d, move = constant_["l_p"] * d;
      Values total_variation;
      for (int a = 0; a < m_; ++a) {
        reward = std::max(reward, magnitude(r_[s][a] - r_[t][a]));
        total_variation.push_back(0);
        for (int next = 0; next < n_; ++next) {
          const Q difference = magnitude(p_[s][a][next] - p_[t][a][next]);
          move = std::max(move, difference);
          total_variation[a] += difference / 2;
        }
      }
      for (int a = 0; a < m_; ++a) {
        const Q added = slack * total_variation[a];
        const Q left = magnitude(x[s][a] - x[t][a]) + added, right = reward + factor * move;
        instances_[claim].push_back({{{"n", n}, {"states", {s, t}}, {"action", a}}, left, right, added == 0});
      }
    }
  }
  void each(const std::string& claim, const Json& at, const Table& x, const Table& y, bool absolute, const Q& right,
            bool proves) {
    for (int s = 0; s < n_; ++s) {
      for (int a = 0; a < m_; ++a) {
        Json place = at;
        place["states"] = {s};
        place["action"] = a;
        const Q difference = x[s][a] - y[s][a];
        instances_[claim].push_back({place, absolute ? magnitude(difference) : difference, right, proves});
      }
    }
  }
  Table greedy_backup(const Table& q) const {
    Values v;
    for (const Values& row : q) v.push_back(*std::max_element(row.begin(), row.end()));
    return back(v);
  }
  static Q distance(const Table& x, const Table& y) {
    Q most = 0;
    for (std::size_t s = 0; s < x.size(); ++s) {
      for (std::size_t a = 0; a < x[s].size(); ++a) most = std::max(most, magnitude(x[s][a] - y[s][a]));
    }
    return most;
  }
  Q finite_n(int n, const Q& delta) const {
    Q most = q_low_[0][0], least = q_star_[0][0], decay = 1;
    for (int s = 0; s < n_; ++s) {
      for (const Q& x : q_low_[s]) most = std::max(most, x);
      for (const Q& x : q_star_[s]) least = std::min(least, x);
    }
    for (int i = 0; i < n; ++i) decay *= g_;
    const Q start = std::max(Q(0), most) + std::max(Q(0), Q(-least));
    return (g_ * (decay * start + delta * (1 - decay) / (1 - g_)) + delta) / (1 - g_);
  }

  bool claims() {
    const Q e2 = 2 * eps_ * g_, rest = 1 - g_;
    const int rounds = static_cast<int>(c_["rounds"].size());
    for (const Enclosed& x : enclosed_) claims_of(x, rounds);
    std::set<int> met;
    for (int n = 0; n < rounds && !bounds_; ++n) {
      const Json& pair = c_["pairs"][c_["rounds"][n].get<int>()];
      const Table robust = back(numbers(pair["robust"]));
      if (met.insert(c_["rounds"][n].get<int>()).second) {
        lipschitz("lemma-1", n, back(numbers(pair["fixed"])), 0, of_print_);
        lipschitz("lemma-1", n, robust, 0, of_print_);
      }
      lipschitz("lemma-1-iterates", n, q_[n], 0, of_rep_);
      each("lemma-2", {{"n", n}}, greedy_backup(q_[n]), q_[n + 1], true, e2 * l_print_, true);
      Values image;
      for (int s = 0; s < n_; ++s) image.push_back(q_star_[s][pair["policy"][pair["attack"][s].get<int>()].get<int>()]);
      instances_["lemma-3"].push_back(
          {{{"n", n}}, distance(q_[n + 1], back(image)), g_ * distance(q_[n], q_star_), true});
      each("C", {{"n", n}}, q_star_, robust, false, finite_n(n, e2 * l_rep_), true);
      each("D", {{"n", n}}, q_star_, robust, false, finite_n(n, e2 * l_tv_), true);
    }
    const int k = static_cast<int>(orbit_.size());
    std::set<std::string> unknown;
    for (int j = 0; j < k; ++j) {
      const Json at{{"n", rounds + j}};
      if (!fixed_[j] || !low_proves_[j]) unknown.insert("lemma-1");
      lipschitz("lemma-1", rounds + j, low_[j], 0, of_print_);
      if (fixed_[j]) lipschitz("lemma-1", rounds + j, *fixed_[j], 0, of_print_);
      lipschitz("lemma-1-iterates", rounds + j, orbit_[j], 2 * g_ * delta_, of_rep_);
      if (j == 0) lipschitz("lemma-1-iterates", rounds, q_.back(), 0, of_rep_);
      const Table greedy = greedy_backup(orbit_[j]), &next = orbit_[(j + 1) % k];
      for (int s = 0; s < n_; ++s) {
        for (int a = 0; a < m_; ++a) {
          Q misled = 0;
          for (int t = 0; t < n_; ++t) misled += ball_[t].size() > 1 ? p_[s][a][t] : Q(0);
          const Q added = 2 * g_ * delta_ * misled;
          instances_["lemma-2"].push_back({{{"n", rounds + j}, {"states", {s}}, {"action", a}},
                                           magnitude(greedy[s][a] - next[s][a]) + added,
                                           e2 * l_print_,
                                           added == 0});
        }
      }
      each("theorem-1", at, q_star_, fixed_[j] ? *fixed_[j] : low_[j], false, (1 + g_) / (rest * rest) * e2 * l_print_,
           fixed_[j].has_value());
      each("A", at, q_star_, low_[j], false, (1 + g_) / (rest * rest) * e2 * l_sound_, low_proves_[j]);
      each("B", at, q_star_, low_[j], false, e2 * l_sound_ / (rest * rest), low_proves_[j]);
      for (const auto& [claim, delta] : {std::pair<std::string, Q>("C", e2 * l_rep_), {"D", e2 * l_tv_}}) {
        const Q at_last = (g_ * delta / rest + delta) / rest;
        each(claim, at, q_star_, low_[j], false, std::min(finite_n(rounds + j, delta), at_last), low_proves_[j]);
      }
    }
    each("E", Json::object(), q_star_, back(numbers(c_["test_time"][bounds_ ? "below" : "robust"])), false,
         e2 * constant_["l_star"] / rest, true);
    for (int s = 0; s < n_ && !c_["belief_game"].is_null(); ++s) {
      instances_["F"].push_back({{{"states", {s}}},
                                 v_star_[s] - belief_worst_[s],
                                 number(c_["belief_game"]["reach"]) * constant_["l_star"] / rest,
                                 !bounds_ && c_["belief_game"]["exact"] == true});
    }
    for (const char* claim : {"lemma-1", "lemma-1-iterates"}) {
      if (instances_[claim].empty()) instances_[claim].push_back({Json::object(), 0, 0, true});
    }
    if (c_["limit"].is_null()) unknown = {"lemma-1", "lemma-1-iterates", "lemma-2", "theorem-1", "A", "B", "C", "D"};
    if (c_["belief_game"].is_null()) unknown.insert("F");
    if (!expect(!c_["claims"].empty(), "no claims")) return false;
    for (const Json& entry : c_["claims"]) {
      if (!expect(!bounds_ || (entry["claim"] != "lemma-3" && entry["verdict"] != "violated"), "by bounds"))
        return false;
      if (entry["verdict"] == "undetermined") continue;
      const std::string name = entry["claim"];
      if (!expect(!unknown.count(name), name + " is not undetermined") || !entry_is_true(entry, instances_[name]))
        return false;
    }
    return true;
  }
  bool entry_is_true(const Json& entry, const std::vector<Instance>& all) {
    const std::string name = entry["claim"];
    const bool violated = entry["verdict"] == "violated";
    const Q left = number(entry["left"]), right = number(entry["right"]);
    bool named = false, least = true;
    for (const Instance& x : all) {
      if (violated && !x.proves) continue;
      named = named || (x.at == entry["at"] && x.left == left && x.right == right);
      least = least && right - left <= x.right - x.left;
    }
    return expect(named, name + ": no such instance") && expect(least, name + ": not the tightest") &&
           expect(violated == (left > right), name + ": the other verdict") &&
           expect(!violated || !l2_, name + ": violated under l2");
  }

  const Json& c_;
  bool tie_highest_, bounds_, l2_ = false;
  std::string what_;
  int n_ = 0, m_ = 0;
  Q g_, eps_;
  Table r_;
  std::vector<Table> p_;
  std::map<std::pair<int, int>, Q> near_, far_;  // of states at a finite distance
  std::vector<States> ball_;
  Values v_star_, belief_worst_;  // V*, or above it
  Table q_star_, q_low_;          // back of it, and of what is below it
  Values x_low_, x_high_;         // of x_n, at last of x_{N-1}
  std::vector<Enclosed> enclosed_;
  std::map<std::string, Q> constant_;
  Q of_print_, of_rep_, l_print_, l_sound_, l_rep_, l_tv_, delta_;
  std::vector<Table> q_, orbit_, low_;
  std::vector<std::optional<Table>> fixed_;
  std::vector<bool> low_proves_;
  std::map<std::string, std::vector<Instance>> instances_;
};

}  // namespace maximin::testing
