#include <fmt/format.h>
#include <memory>
#include <vector>

#include <maximin/apps/common/json_output.hpp>
#include <maximin/apps/common/program.hpp>
#include <maximin/apps/maximin/counterexample.hpp>
#include <maximin/counterexamples/gallery.hpp>
#include <maximin/theory/error.hpp>

namespace maximin::apps {

namespace {

struct RunOptions {
  std::string name;
  bool all = false;
  bool json = false;
};

/// The counterexamples that were asked for.
std::vector<Counterexample> chosen(const RunOptions& options) {
  if (options.all == !options.name.empty())
    throw InputError(options.all ? "NAME: given beside --all, expected one of the two"
                                 : "no counterexample given, expected NAME or --all");
  if (!options.all) return {find_counterexample(options.name)};
  const auto all = counterexamples();
  return {all.begin(), all.end()};
}

Json quantity_json(const Counterexample::Quantity& quantity) {
  Json json;
  json["what"] = quantity.what;
  json["exact"] = quantity.value.str();
  json["value"] = static_cast<double>(quantity.value);
  return json;
}

Json finding_json(const Counterexample& c, const Counterexample::Finding& finding) {
  Json json;
  json["name"] = c.name;
  json["refuted"] = finding.refuted;
  json["claimed"] = quantity_json(finding.promised);
  json["found"] = quantity_json(finding.found);
  json["evidence"] = finding.evidence;
  return json;
}

int run_checks(const RunOptions& options) {
  Json results = Json::array();
  std::string text;
  bool refuted = true;
  for (const Counterexample& c : chosen(options)) {
    const auto finding = c.check(c.model());
    refuted = refuted && finding.refuted;
    results.push_back(finding_json(c, finding));
    text += (text.empty() ? "" : "\n") + finding_text(c, finding);
  }
  Json json;
  json["command"] = "counterexample run";
  json["version"] = MAXIMIN_VERSION;
  json["refuted"] = refuted;
  json["results"] = std::move(results);
  print(options.json ? json_text(json) : text);
  return refuted ? ExitCode::success : ExitCode::violated;
}

}  // namespace

void add_counterexample_run(CLI::App& app, Task& task) {
  auto options = std::make_shared<RunOptions>();
  auto* sub = app.add_subcommand("run", "the exact check: both numbers, as fractions");
  declare_name(*sub, options->name);
  sub->add_flag("--all", options->all, "run the checks of all");
  sub->add_flag("--json", options->json, "print one JSON object on standard output, and nothing else there");
  sub->footer(
      "Rational arithmetic, no tolerance. Exit code 0 if the claim is refuted as promised, else 1.\n"
      "Examples:\n"
      "  maximin counterexample run one-sided-rewards\n"
      "  maximin counterexample run --all --json");
  sub->callback([options, &task] { task = [options] { return run_checks(*options); }; });
}

}  // namespace maximin::apps
