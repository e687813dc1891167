#include "report.hpp"

#include <vector>

#include <fmt/format.h>

#include <maximin/apps/common/json_output.hpp>
#include <maximin/apps/common/table.hpp>

#include "discount.hpp"

namespace maximin::apps {
namespace {

using non_contraction::ExactDistances;
using non_contraction::Examination;
using non_contraction::Fraction;
using non_contraction::Side;

double to_double(const Fraction& value) {
  return boost::rational_cast<double>(value);
}

/// Discounts on both sides of the threshold, and the threshold itself.
std::vector<Fraction> sweep(const Fraction& threshold) {
  return {{1, 2},     {4, 5},
          {9, 10},    threshold - Fraction(1, 1'000'000),
          threshold,  threshold + Fraction(1, 1'000'000),
          {19, 20},   {99, 100},
          {999, 1000}};
}

std::string state_name(State s) {
  return fmt::format("s{}", s + 1);
}
std::string action_name(Action a) {
  return fmt::format("a{}", a + 1);
}

std::string tables_text(const Examination& e) {
  Table table;
  table.column("state", Align::left);
  for (const int side : {1, 2}) {
    for (Action a = 0; a < 3; ++a) table.column(fmt::format("Q{}(.,{})", side, action_name(a)));
  }
  for (State s = 0; s < 3; ++s) {
    std::vector<std::string> row{state_name(s)};
    for (const Side* side : {&e.first, &e.second}) {
      for (Action a = 0; a < 3; ++a) row.push_back(number(side->q(s, a)));
    }
    table.row(row);
  }
  table.row({});
  std::vector<std::string> least{"least"};
  for (const Side* side : {&e.first, &e.second}) {
    for (Action a = 0; a < 3; ++a) least.push_back(number(side->q.col(a).minCoeff()));
  }
  return table.row(least).text();
}

std::string policies_text(const Examination& e) {
  Table table;
  table.column("state", Align::left);
  for (const int i : {1, 2}) {
    table.column(fmt::format("pi{}", i))
        .column(fmt::format("omega{}", i))
        .column(fmt::format("Q{}(s,pi{}(omega{}(s)))", i, i, i));
  }
  for (State s = 0; s < 3; ++s) {
    std::vector<std::string> row{state_name(s)};
    for (const Side* side : {&e.first, &e.second}) {
      const auto i = static_cast<std::size_t>(s);
      row.push_back(action_name(side->step.policy[i]));
      row.push_back(state_name(side->step.attack[i]));
      row.push_back(number(side->step.values[s]));
    }
    table.row(row);
  }
  return table.text();
}

std::string backups_text(const Examination& e) {
  Table table;
  table.column("state", Align::left);
  for (const int side : {1, 2}) {
    for (Action a = 0; a < 3; ++a) table.column(fmt::format("TQ{}(.,{})", side, action_name(a)));
  }
  for (State s = 0; s < 3; ++s) {
    std::vector<std::string> row{state_name(s)};
    for (const Side* side : {&e.first, &e.second}) {
      for (Action a = 0; a < 3; ++a) row.push_back(number(side->backup(s, a)));
    }
    table.row(row);
  }
  return table.text();
}

std::string sweep_text(const ExactDistances& exact) {
  Table table;
  table.column("exactly", Align::right)
      .column("gamma", Align::point)
      .column("|TQ1-TQ2|", Align::point)
      .column("than before", Align::left);
  for (const Fraction& gamma : sweep(exact.threshold())) {
    const char* verdict = exact.expands(gamma)         ? "further apart"
                          : gamma == exact.threshold() ? "as far as before"
                                                       : "closer";
    table.row({fraction_text(gamma), fmt::format("{:.7f}", to_double(gamma)),
               fmt::format("{:.7f}", to_double(exact.after(gamma))), verdict});
  }
  return table.text();
}

std::string verdict_text(const ExactDistances& exact, const Fraction& gamma) {
  const Fraction threshold = exact.threshold();
  const char* relation = gamma > threshold ? ">" : gamma == threshold ? "=" : "<";
  const char* conclusion =
      exact.expands(gamma) ? "the backup drives Q1 and Q2 further apart. It is not a contraction."
                           : "the backup does not drive Q1 and Q2 apart. This pair refutes nothing at this discount.";
  return fmt::format("gamma = {} {} {}: {}\n", fraction_text(gamma), relation, fraction_text(threshold), conclusion);
}

Json side_json(const Side& side) {
  return Json{{"q", to_json(side.q)},
              {"policy", Json(side.step.policy)},
              {"attack", Json(side.step.attack)},
              {"composed", Json(side.step.composed)},
              {"values", to_json(side.step.values)},
              {"backup", to_json(side.backup)}};
}

Json distances_json(const ExactDistances& exact, const Fraction& gamma) {
  return Json{{"gamma", to_double(gamma)},
              {"gamma_exact", fraction_text(gamma)},
              {"distance_before", exact.before},
              {"distance_after", to_double(exact.after(gamma))},
              {"distance_after_exact", fraction_text(exact.after(gamma))},
              {"expands", exact.expands(gamma)}};
}

}  // namespace

std::string non_contraction_text(const Fraction& gamma) {
  const Examination e = non_contraction::examine(to_double(gamma));
  const ExactDistances exact = non_contraction::exact_distances();
  std::string text =
      "The pessimistic backup T is not a contraction (appendix C.2, Table 4).\n"
      "S = {s1, s2, s3}, A = {a1, a2, a3}; every action leads to s2; R = 0; every ball is all of S.\n\n";
  text += "Two tables, and the least value of each action over the ball:\n\n" + tables_text(e);
  text += "\nTheir maximin policies, the attacker's best responses, and what the backups read:\n\n" + policies_text(e);
  text += fmt::format("\nThe backups at gamma = {}:\n\n", fraction_text(gamma)) + backups_text(e);
  text += fmt::format("\n|Q1 - Q2|   = {}\n|TQ1 - TQ2| = {} gamma = {}\n\n", exact.before, exact.after_per_gamma,
                      number(to_double(exact.after(gamma))));
  text += verdict_text(exact, gamma);
  return text + "\nAround the threshold:\n\n" + sweep_text(exact);
}

std::string non_contraction_json(const Fraction& gamma) {
  const Examination e = non_contraction::examine(to_double(gamma));
  const ExactDistances exact = non_contraction::exact_distances();
  Json document = distances_json(exact, gamma);
  document["threshold"] = to_double(exact.threshold());
  document["threshold_exact"] = fraction_text(exact.threshold());
  document["distance_after_per_gamma"] = exact.after_per_gamma;
  document["q1"] = side_json(e.first);
  document["q2"] = side_json(e.second);
  document["sweep"] = Json::array();
  for (const Fraction& other : sweep(exact.threshold())) document["sweep"].push_back(distances_json(exact, other));
  return json_text(document);
}

}  // namespace maximin::apps
