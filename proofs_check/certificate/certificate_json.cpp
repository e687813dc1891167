#include <algorithm>

#include <nlohmann/json.hpp>

#include <maximin/proofs_check/certificate/bounds_certificate.hpp>
#include <maximin/proofs_check/certificate/certificate.hpp>
#include <maximin/proofs_check/trial_record.hpp>

namespace maximin {
namespace {

using Json = nlohmann::ordered_json;

Json text(const Rational& x) {
  return x.str();
}

Json list(const Values<Rational>& v) {
  Json out = Json::array();
  for (const Rational& x : v) out.push_back(text(x));
  return out;
}

template <class Table, class Entry>
Json rows(const Table& table, Entry entry) {
  Json out = Json::array();
  for (Eigen::Index i = 0; i < table.rows(); ++i) {
    Json row = Json::array();
    for (Eigen::Index j = 0; j < table.cols(); ++j) row.push_back(entry(table(i, j)));
    out.push_back(std::move(row));
  }
  return out;
}

Json model_json(const Model<Rational>& model) {
  using Kind = Geometry<Rational>::Kind;
  const FiniteMdp<Rational>& mdp = model.mdp;
  Json json{{"format", "maximin-mdp"},          {"version", 1},
            {"states", mdp.states()},           {"actions", mdp.actions()},
            {"discount", text(mdp.discount())}, {"eps", text(*model.geometry.eps)}};
  if (model.geometry.kind == Kind::points) {
    json["points"] = rows(model.geometry.points, text);
    json["norm"] = norm_name(model.geometry.norm);
  } else if (model.geometry.kind == Kind::hops || model.geometry.kind == Kind::discrete) {
    json["metric"] = model.geometry.kind == Kind::hops ? "hops" : "discrete";
  } else {
    json["distances"] =
        rows(model.geometry.distances, [](const Rational& d) { return d < 0 ? Json(nullptr) : text(d); });
  }
  json["rewards"] = rows(mdp.rewards(), text);
  Json& transitions = json["transitions"] = Json::array();
  for (State s = 0; s < mdp.states(); ++s) {
    for (Action a = 0; a < mdp.actions(); ++a) {
      for (const auto& next : mdp.successors(s, a)) transitions.push_back({s, a, next.target, text(next.probability)});
    }
  }
  return json;
}

Json constant_json(const LipschitzConstant<Rational>& c) {
  Json at = nullptr;
  if (c.value != 0) {
    at = {c.s1, c.s2, c.action};
    if (c.target >= 0) at.push_back(c.target);
  }
  return {{"value", text(c.value)}, {"at", std::move(at)}};
}

Json list(const ScaledValues& v) {
  Json out = Json::array();
  for (State s = 0; s < static_cast<State>(v.numerators.size()); ++s) out.push_back(text(v[s]));
  return out;
}

Json boxes_json(const std::optional<BoxLimit>& limit) {
  if (!limit) return nullptr;
  Json json{{"boxes", Json::array()}};
  for (std::size_t j = 0; j < limit->phases.size(); ++j) {
    const ValueBox& passed = limit->phases[j].passed;
    json["boxes"].push_back({{"low", list(passed.low)},
                             {"high", list(passed.high)},
                             {"below", list(limit->pairs[j].below)},
                             {"above", list(limit->pairs[j].above)}});
  }
  return json;
}

Json limit_json(const std::optional<CertifiedLimit>& limit) {
  if (!limit) return nullptr;
  Json json{{"period", limit->period}, {"radius", text(limit->radius)}};
  json["classes"] = rows(limit->classes, [](int number) { return Json(number); });
  for (const auto& u : limit->orbit) json["orbit"].push_back(list(u));
  for (const auto& v : limit->low) json["low"].push_back(list(v));
  for (const auto& v : limit->fixed) json["fixed"].push_back(v ? list(*v) : Json(nullptr));
  return json;
}

Json belief_json(const std::optional<CertifiedBeliefGame>& game) {
  if (!game) return nullptr;
  Json positions = Json::array();
  for (const auto& [truth, belief] : game->positions) positions.push_back({truth, belief});
  return {{"positions", std::move(positions)},
          {"values", list(game->values)},
          {"reach", text(game->reach)},
          {"exact", game->exact}};
}

Json claim_json(const CertifiedClaim& c) {
  Json json{{"claim", claim(c.id).name}};
  if (c.verdict == Verdict::undetermined) {
    json["verdict"] = "undetermined";
    return json;
  }
  json["verdict"] = c.verdict == Verdict::holds ? "holds" : "violated";
  json["left"] = text(c.left);
  json["right"] = text(c.right);
  Json at = Json::object();
  if (c.n >= 0) at["n"] = c.n;
  if (!c.states.empty()) at["states"] = c.states;
  if (c.action >= 0) at["action"] = c.action;
  json["at"] = std::move(at);
  return json;
}

Json constants_json(const ModelConstants<Rational>& c, const LipschitzConstant<Rational>& l_star) {
  return {{"l_r", constant_json(c.l_r)},     {"l_p", constant_json(c.l_p)}, {"k", constant_json(c.k_tv)},
          {"l_star", constant_json(l_star)}, {"r_min", text(c.r_min)},      {"r_max", text(c.r_max_signed)}};
}

/// What certificates of both formats begin with.
template <class Any>
Json head_json(const char* format, const Any& c) {
  Json json{{"format", format},
            {"version", 1},
            {"model", model_json(c.model)},
            {"reading", to_string(c.reading)},
            {"tie", c.tie == TieBreak::highest_index ? "highest" : "lowest"}};
  json["constants"] = constants_json(c.constants, c.l_star);
  return json;
}

Json claims_json(const std::vector<CertifiedClaim>& claims) {
  Json json = Json::array();
  for (const CertifiedClaim& claim : claims) json.push_back(claim_json(claim));
  return json;
}

}  // namespace

bool CertifiedLimit::all_attained() const {
  return std::all_of(attained.begin(), attained.end(), [](bool x) { return x; });
}

bool Certificate::any(Verdict verdict) const {
  return std::any_of(claims.begin(), claims.end(), [&](const CertifiedClaim& c) { return c.verdict == verdict; });
}

std::string certificate_json(const Certificate& c) {
  Json json = head_json("maximin-certificate", c);
  json["optimal"] = list(c.optimal);
  json["pairs"] = Json::array();
  for (const CertifiedPair& p : c.pairs) {
    json["pairs"].push_back({{"policy", p.policies.policy},
                             {"attack", p.policies.attack},
                             {"fixed", list(p.fixed)},
                             {"robust", list(p.robust)}});
  }
  json["rounds"] = c.rounds;
  json["limit"] = c.limit ? limit_json(c.limit) : boxes_json(c.boxes);
  json["test_time"] = {{"policy", c.test_time_policy}, {"robust", list(c.test_time_robust)}};
  json["belief_game"] = belief_json(c.belief_game);
  json["claims"] = claims_json(c.claims);
  return json.dump() + "\n";
}

std::string certificate_json(const BoundsCertificate& c) {
  Json json = head_json("maximin-bounds", c);
  json["optimal"] = {{"low", list(c.optimal.low)}, {"high", list(c.optimal.high)}};
  json["bits"] = c.bits;
  json["pairs"] = Json::array();
  for (const BoundedPair& p : c.pairs) {
    json["pairs"].push_back({{"choices", p.choices},
                             {"provoked", p.provoked},
                             {"below", list(p.values.below)},
                             {"above", list(p.values.above)}});
  }
  json["rounds"] = c.rounds;
  json["limit"] = boxes_json(c.limit);
  json["test_time"] = {{"below", list(c.test_time)}};
  Json game = belief_json(c.belief_game);
  if (c.belief_game) game.erase("exact");
  json["belief_game"] = std::move(game);
  json["claims"] = claims_json(c.claims);
  return json.dump() + "\n";
}

}  // namespace maximin
