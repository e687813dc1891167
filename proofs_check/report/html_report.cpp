#include <maximin/proofs_check/report/html_report.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <maximin/proofs_check/report/campaign_figures.hpp>
#include <maximin/proofs_check/report/html_text.hpp>
#include <maximin/proofs_check/report/page.hpp>
#include <maximin/proofs_check/verdict_text.hpp>

namespace maximin {
namespace {

using namespace report;
using Json = nlohmann::ordered_json;

const ClaimSummary& of(const CampaignSummary& s, ClaimId id) {
  return s.claims[static_cast<std::size_t>(id)];
}

/// How many trials were asked for, or as many as there are.
long asked_trials(const Json& configuration, const CampaignSummary& s) {
  if (!configuration.is_object()) return s.trials;
  const auto trials = configuration.find("trials");
  return trials != configuration.end() && trials->is_number_integer() ? std::max(s.trials, trials->get<long>())
                                                                      : s.trials;
}

/// A command line that shows trial k alone.
class Replay {
 public:
  Replay(const Json& configuration, std::string_view options) : options_(options) {
    if (options_.empty() && configuration.is_object()) {
      const auto seed = configuration.find("seed");
      if (seed != configuration.end() && seed->is_number()) options_ = "--seed " + seed->dump();
    }
  }

  std::string of(long trial) const {
    if (trial < 0) return "";
    // Words in spans of their own: a line may break between options and never inside one.
    std::string words = "<span>verify_bound</span> ";
    const std::string_view all = options_;
    for (std::size_t from = all.find_first_not_of(' '); from != all.npos;) {
      const std::size_t to = std::min(all.find(' ', from), all.size());
      words += "<span>" + escape(all.substr(from, to - from)) + "</span> ";
      from = all.find_first_not_of(' ', to);
    }
    return fmt::format("<code class=\"command\">{}<span>--replay {}</span></code>", words, trial);
  }

 private:
  std::string options_;
};

std::string upper_limit_sentence(const CampaignSummary& s, bool exact) {
  const double limit = 100 * s.violation_upper_limit();
  return fmt::format("With 95 percent confidence at most {} percent of models drawn like these violate a claim. {}",
                     number(limit),
                     exact ? "Each verdict is proved, in exact arithmetic; of other models nothing is."
                           : "The inequalities were checked in floating point with certified numerical error; that is "
                             "evidence and not a "
                             "proof.");
}

std::string informative_sentence(const CampaignSummary& s) {
  return fmt::format("At least one bound says something, being below the trivial γ span(R)/(1-γ), on {} of them ({}).",
                     count(s.any_informative), percent(s.any_informative, s.trials));
}

/// Names of the claims that came to something on a trial, with the number of trials.
std::string names_with(const CampaignSummary& s, long ClaimSummary::*what) {
  std::string names;
  for (const Claim& c : claims()) {
    const long n = of(s, c.id).*what;
    if (n > 0)
      names += fmt::format("{}{} ({})", names.empty() ? "" : ", ", escape(c.name), counted(n, "trial", "trials"));
  }
  return names;
}

std::string caveats(const CampaignSummary& s, long asked) {
  std::string text;
  const auto add = [&](const std::string& sentence) { text += (text.empty() ? "" : " ") + sentence; };
  if (s.trials < asked) {
    add(fmt::format("The run ended early: {} of {} trials are done.", count(s.trials), count(asked)));
  }
  if (s.undetermined > 0) {
    add(fmt::format("A budget ran out on {}; undetermined there: {}.", counted(s.undetermined, "trial", "trials"),
                    names_with(s, &ClaimSummary::undetermined)));
  }
  if (s.assumption_failures > 0) {
    add(fmt::format("An assumption of the claims fails on {}, of which they therefore say nothing.",
                    counted(s.assumption_failures, "trial", "trials")));
  }
  return text;
}

std::string verdict(const CampaignSummary& s, long asked, const Replay& replay, bool exact, const std::string& doubt) {
  const std::string rest = caveats(s, asked);
  if (s.trials == 0) return verdict_box("warn", {"Nothing was checked: there is no trial.", rest});
  if (s.violations > 0) {
    return verdict_box("bad", {fmt::format("Violated: {} of {} break a claim.", count(s.violations),
                                           counted(s.trials, "model", "models")),
                               "Violated are " + names_with(s, &ClaimSummary::violated) + ". The first is shown by " +
                                   replay.of(s.first_violation),
                               rest});
  }
  if (s.vacuous()) {
    return verdict_box(
        "warn",
        {fmt::format("No violation, and nothing verified: every bound was vacuous on {}.",
                     s.trials == 1 ? "the only model" : "all " + count(s.trials) + " models"),
         "A bound at or above the trivial γ span(R)/(1-γ) holds whatever is done. Ask for a smaller eps, γ or l_p.",
         rest});
  }
  const bool clean = outcome(s, s.trials >= asked) == Outcome::holds;
  return verdict_box(clean && doubt.empty() ? "" : "warn",
                     {doubt, fmt::format("No violation on {}.", counted(s.trials, "random model", "random models")),
                      informative_sentence(s) + " " + upper_limit_sentence(s, exact), rest});
}

std::string campaign_tiles(const CampaignSummary& s) {
  return tiles({{count(s.trials), s.trials == 1 ? "model examined" : "models examined", false},
                {count(s.violations), "with a claim violated", s.violations > 0},
                {percent(s.any_informative, s.trials), "with an informative bound", false},
                {count(s.cycles), "whose policies cycle", false}});
}

std::string violation_row(const TrialRecord& record, const Claim& c, const Check& check, const Replay& replay) {
  return fmt::format(
      "<tbody class=\"claim\"><tr><td class=\"bad-text\">trial {}</td><td class=\"text\">{}</td><td>{}</td><td>{}</td>"
      "<td>{}</td><td>{}</td></tr>\n<tr class=\"detail\"><td colspan=\"6\">{}</td></tr></tbody>\n",
      record.trial, escape(c.name), number(check.left), number(check.right), number(check.left - check.right),
      check.n < 0 ? "-" : std::to_string(check.n), replay.of(record.trial));
}

/// Every violation with its numbers, the first of them at most.
std::string violations_section(const Records& records, const CampaignSummary& s, const Replay& replay) {
  constexpr long most_rows = 40;
  if (s.violations == 0) return "";
  std::string rows;
  long all = 0;
  for (const TrialRecord& r : records) {
    for (const Claim& c : claims()) {
      const Check& check = r.found.check(c.id);
      if (check.verdict == Verdict::violated && ++all <= most_rows) rows += violation_row(r, c, check, replay);
    }
  }
  const std::string note = all > most_rows ? fmt::format(" The first {} of {} are listed.", most_rows, count(all)) : "";
  return fmt::format(
      "<h2>Violations</h2>\n<p>The left side exceeds the right side by more than the certified numerical error, or one "
      "of "
      "them is not finite.{}</p>\n<div class=\"scroll\"><table><thead><tr><th>trial</th><th style=\"text-align:left\">"
      "claim</th><th>left side</th><th>right side</th><th>excess</th><th>at round "
      "n</th></tr></thead>\n{}</table></div>\n",
      note, rows);
}

std::string ratio(double x, bool known) {
  return known ? number(x) : "-";
}

std::string claim_rows(const Claim& c, const ClaimSummary& s, const Replay& replay) {
  const bool known = s.max_trial >= 0;
  std::string undetermined;
  if (s.undetermined > 0)
    undetermined = fmt::format("<br/>Undetermined on {}.", counted(s.undetermined, "trial", "trials"));
  if (s.assumption_fails > 0) undetermined += fmt::format("<br/>An assumption fails on {}.", count(s.assumption_fails));
  return fmt::format(
      "<tbody class=\"claim\"><tr><td><b>{}</b></td><td>{}</td><td{}>{}</td><td>{}</td><td>{}</td><td>{}</td>"
      "<td>{}</td></tr>\n<tr class=\"detail\"><td colspan=\"7\"><i>{}</i> "
      "({})<br/><code>{}</code>{}{}{}</td></tr></tbody>\n",
      escape(c.name), count(s.checked()), s.violated > 0 ? " class=\"bad-text\"" : "", count(s.violated),
      c.is_bound ? percent(s.informative, s.checked()) : "", ratio(s.median, known), ratio(s.p99, known),
      ratio(s.max, known), escape(c.title), escape(c.reference), escape(c.statement), undetermined,
      known ? "<br/>Largest ratio: " : "", replay.of(s.max_trial));
}

std::string claims_section(const CampaignSummary& s, const Replay& replay) {
  std::string rows;
  for (const Claim& c : claims()) {
    const ClaimSummary& cs = of(s, c.id);
    if (cs.checked() + cs.undetermined + cs.assumption_fails > 0) rows += claim_rows(c, cs, replay);
  }
  if (rows.empty()) return "";
  return "<h2>The claims</h2>\n<p>A claim is an inequality, left side ≤ right side, checked on each model at every "
         "round, pair of states and action. Tightness is the largest left / right among them, less the certified "
         "numerical error: at 1 the inequality is attained, above 1 it fails. A bound is informative on a model where "
         "it "
         "lies below γ span(R)/(1-γ).</p>\n"
         "<div class=\"scroll\"><table class=\"claims\"><thead><tr><th>claim</th><th>models "
         "checked</th><th>violated</th>"
         "<th>informative</th><th>tightness, median</th><th>99th "
         "percentile</th><th>largest</th></tr></thead>\n" +
         rows + "</table></div>\n" + notation();
}

/// "3 / 10 / 40": least, median and greatest of a quantity over the records.
template <class Quantity>
std::string spread(const Records& records, Quantity quantity) {
  std::vector<double> values;
  for (const TrialRecord& r : records) {
    const double v = static_cast<double>(quantity(r.found));
    if (std::isfinite(v)) values.push_back(v);
  }
  if (values.empty()) return "-";
  std::sort(values.begin(), values.end());
  return fmt::format("{} / {} / {}", number(values.front()), number(values[(values.size() - 1) / 2]),
                     number(values.back()));
}

std::string models_section(const Records& records) {
  return "<h2>The models</h2>\n<p>Least, median and greatest over the models drawn; what the pictures show is true of "
         "these and of nothing else.</p>\n" +
         facts({{"states", spread(records, [](const Examination& e) { return e.states; })},
                {"actions", spread(records, [](const Examination& e) { return e.actions; })},
                {"discount γ", spread(records, [](const Examination& e) { return e.discount; })},
                {"eps, as the bounds use it", spread(records, [](const Examination& e) { return e.radius; })},
                {"eps · l_r / span(R)",
                 spread(records,
                        [](const Examination& e) { return e.radius * e.constants.l_r.value / e.constants.span; })},
                {"states in the largest ball", spread(records, [](const Examination& e) { return e.largest_ball; })},
                {"span(R)", spread(records, [](const Examination& e) { return e.constants.span; })},
                {"rounds of Q-iteration", spread(records, [](const Examination& e) { return e.iterations; })},
                {"policy pairs met", spread(records, [](const Examination& e) { return e.pairs; })}});
}

std::string section(std::string_view heading, const std::string& content) {
  return content.empty() ? "" : fmt::format("<h2>{}</h2>\n{}", heading, content);
}

}  // namespace

std::string html_report(const Json& configuration, const Records& records, const CampaignSummary& summary,
                        std::string_view replay_options) {
  const Replay replay(configuration, replay_options);
  const std::string title =
      "What pessimism costs: the bounds on " + (summary.trials == 0   ? "no random model"
                                                : summary.trials == 1 ? "one random model"
                                                                      : count(summary.trials) + " random models");
  std::string body = fmt::format("<h1>{}</h1>\n<p class=\"sub\">A campaign of verify_bound; {}.</p>\n", escape(title),
                                 reading_of(configuration));
  body +=
      verdict(summary, asked_trials(configuration, summary), replay, is_exact(configuration), doubt_of(configuration));
  body += campaign_tiles(summary);
  body += violations_section(records, summary, replay);
  body += claims_section(summary, replay);
  body += section("Gap against bound", scatter_figure(records));
  body += section("How tight the bounds are", tightness_figure(records));
  body += section("Where the bounds say something", informativeness_figure(records));
  body += section("Fates and regimes", fate_and_regime_figure(summary));
  if (!records.empty()) body += models_section(records);
  return page(title, body + configuration_section(configuration));
}

}  // namespace maximin
