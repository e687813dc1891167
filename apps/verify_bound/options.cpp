#include "options.hpp"

#include <charconv>
#include <string_view>

#include <fmt/format.h>

#include <maximin/apps/common/option_checks.hpp>

#include <maximin/theory/error.hpp>

#include "shared_options.hpp"

namespace maximin::verify_bound {
namespace {

template <class T>
T number(std::string_view text, std::string_view option, std::string_view whole) {
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc{} && end == text.data() + text.size()) return value;
  throw InputError(fmt::format("{}: '{}', expected a number or LOW:HIGH, e.g. 5:40", option, whole));
}

/// "LOW:HIGH" or one number, within [least, most].
template <class T>
std::optional<Range<T>> range(const std::string& text, std::string_view option, T least, T most) {
  if (text.empty()) return std::nullopt;
  const auto colon = text.find(':');
  const std::string_view view(text);
  const T low = number<T>(view.substr(0, colon), option, text);
  const T high = colon == std::string::npos ? low : number<T>(view.substr(colon + 1), option, text);
  if (!(low <= high && low >= least && high <= most)) {
    throw InputError(
        fmt::format("{}: '{}', expected LOW:HIGH with {} <= LOW <= HIGH <= {}", option, text, least, most));
  }
  return Range<T>{low, high};
}

void declare_checks(CLI::App& program, Options& o) {
  const std::string group = "What to check";
  add_reading(program, o.reading)->group(group);
  program
      .add_option("--claims", o.claims,
                  "claims to check, separated by commas (default: all): lemma-1,\n"
                  "lemma-1-iterates, lemma-2, lemma-3, theorem-1, A, B, C, D, E, F")
      ->delimiter(',')
      ->type_name("LIST")
      ->group(group);
  program
      .add_option(
          "--arith", o.arith,
          "double, floating point with certified error (the default), or\n"
          "exact, rational numbers: what holds is proved; random models\n"
          "then have short numbers: rewards and gamma of 3 decimals,\n"
          "probabilities in multiples of 1/4096; or certified, the same\n"
          "with bounds in the place of exact values, for thousands of\n"
          "states: it never says violated, leaves open what holds with\nnothing to spare, and leaves out lemma-3")
      ->check(apps::one_of({"double", "certified", "exact"}))
      ->type_name("WORD")
      ->group(group);
  program
      .add_flag_callback(
          "--exact", [&o] { o.arith = "exact"; }, "short for --arith exact")
      ->group(group);
  program
      .add_flag("--pedantic", o.pedantic,
                "what holds in floating point alone is undetermined: it held\nwithin rounding, and was not certified")
      ->group(group);
  add_tie(program, o.tie)->group(group);
  program
      .add_option("--max-iterations", o.max_iterations,
                  fmt::format("rounds of pessimistic Q-iteration before its fate is\nundetermined (default: {})",
                              o.max_iterations))
      ->check(apps::whole_number(1, 100'000'000))
      ->type_name("N")
      ->group(group);
  program
      .add_option("--max-period", o.max_period,
                  fmt::format("longest cycle of policy pairs that is looked for\n(default: {})", o.max_period))
      ->check(apps::whole_number(1, 10'000))
      ->type_name("N")
      ->group(group);
  program
      .add_option(
          "--max-positions", o.max_positions,
          fmt::format("reachable (state, belief) pairs before claim F is\nundetermined (default: {})", o.max_positions))
      ->check(apps::whole_number(1, 100'000'000))
      ->type_name("N")
      ->group(group);
}

void declare_campaign(CLI::App& program, Options& o) {
  const std::string group = "Random models (without --model or --example)";
  program.add_option("--trials", o.trials, fmt::format("models to draw (default: {})", o.trials))
      ->check(apps::whole_number(1, 1'000'000'000))
      ->type_name("N")
      ->group(group);
  add_seed(program, o.seed, "trial K of a seed is always the same model (default: 1)")->group(group);
  add_threads(program, o.threads, "0 takes one per core (the default); changes no result")->group(group);
  add_family(program, o.family,
             "kind of models: informative (bounds that say something), broad,\n"
             "sparse, cycling (Q_n often cycles), costs (R <= 0), mixed (all of\nthem, the default)")
      ->group(group);
  const auto range_option = [&](const char* name, std::string& value, const char* description) {
    program.add_option(name, value, description)->type_name("LOW:HIGH")->group(group);
  };
  range_option("--states", o.states, "number of states, a range or one number");
  range_option("--actions", o.actions, "number of actions");
  range_option("--gamma", o.gamma, "discount");
  program.add_option("--l-r", o.l_r, "Lipschitz constant of the rewards, met exactly")
      ->check(apps::real_number({.low = 0}))
      ->type_name("X")
      ->group(group);
  program.add_option("--l-p", o.l_p, "Lipschitz constant of the transition probabilities, met exactly")
      ->check(apps::real_number({.low = 0}))
      ->type_name("X")
      ->group(group);
  program.add_option("--dimension", o.dimension, "dimension of the points")
      ->check(apps::whole_number(1, 16))
      ->type_name("N")
      ->group(group);
  program.add_option("--successors", o.successors, "successors of a (state, action) pair; 0 is dense")
      ->check(apps::whole_number(0, 1'000'000))
      ->type_name("N")
      ->group(group);
  program.add_option("--replay", o.replay, "examine only this trial, and show it in full")
      ->check(apps::whole_number(0))
      ->type_name("TRIAL")
      ->group(group);
}

void declare_output(CLI::App& program, Options& o) {
  const std::string group = "Output";
  program.add_flag("--json", o.json, "one JSON object on standard output, nothing else")->group(group);
  program.add_option("--trials-out", o.trials_out, "write one JSON line per trial to this file")
      ->type_name("FILE")
      ->group(group);
  program.add_flag("--resume", o.resume, "complete the file of --trials-out if an earlier run was cut\nshort")
      ->group(group);
  program
      .add_option("--report", o.report, "write a self-contained HTML page with plots, in place of\none of that name")
      ->type_name("FILE")
      ->group(group);
  program.add_option("--save-model", o.save_model, "with --replay: write the model of that trial")
      ->type_name("FILE")
      ->group(group);
  program
      .add_option("--violation-dir", o.violation_dir,
                  "folder where one violating model per claim is written, shrunk\n(default: here)")
      ->check(apps::existing_folder())
      ->type_name("DIR")
      ->group(group);
  program
      .add_option(
          "--certificates", o.certificates,
          "with --arith exact or certified: write the certificate of each trial K to\nDIR/trial-K.json, and say how "
          "long they took. A run "
          "that\nis killed may leave trial-K.json.*.partial, which the next\nrun there removes; with --resume only "
          "trials that are not\nin the file yet are certified")
      ->check(apps::existing_folder())
      ->type_name("DIR")
      ->group(group);
  program.add_flag("--explain", o.explain, "print what each claim states, and its symbols; nothing else")->group(group);
  program.add_flag("--quiet", o.quiet, "no progress bar")->group(group);
}

}  // namespace

void declare(CLI::App& program, Options& o) {
  declare_checks(program, o);
  declare_campaign(program, o);
  apps::declare(program, o.model);
  declare_output(program, o);
}

void check_combination(const CLI::App& program, const Options& o) {
  if (const auto asked = program.get_option("--arith")->results();
      program.count("--exact") > 0 && !asked.empty() && asked.front() != "exact") {
    throw InputError(fmt::format("--exact: given beside --arith {}, expected one of the two", asked.front()));
  }
  if (!o.model.given()) {
    const std::string where = "on random models";
    apps::refuse_given(program, {"--discount"}, where, "--gamma, or --model or --example beside it");
    apps::refuse_given(program, {"--metric", "--reward-model", "--intervals"}, where, "--model or --example beside it");
    if (!o.certificates.empty() && !is_exact(o))
      throw InputError("--certificates: expected --arith exact or certified beside it");
    if (!o.replay) return;
    apps::refuse_given(program,
                       {"--certificates", "--trials", "--threads", "--trials-out", "--resume", "--violation-dir"},
                       "beside --replay", "it without --replay only");
    return;
  }
  const std::string where = o.model.file.empty() ? "beside --example" : "beside --model";
  apps::refuse_given(program, {"--gamma"}, where, "--discount");
  apps::refuse_given(
      program,
      {"--trials", "--seed", "--threads", "--family", "--states", "--actions", "--l-r", "--l-p", "--dimension",
       "--successors", "--replay", "--trials-out", "--resume", "--save-model", "--violation-dir", "--certificates"},
      where, "it with random models only");
}

std::optional<std::set<ClaimId>> claims_named(const std::vector<std::string>& names) {
  if (names.empty()) return std::nullopt;
  std::set<ClaimId> ids;
  for (const std::string& name : names) {
    const auto id = find_claim(name);
    if (!id) {
      throw InputError(
          fmt::format("--claims: '{}' is no claim, expected lemma-1, lemma-1-iterates, lemma-2, lemma-3, theorem-1, A, "
                      "B, C, D, E or F",
                      name));
    }
    ids.insert(*id);
  }
  return ids;
}

ExaminationOptions examination_options(const Options& o) {
  ExaminationOptions e;
  e.reading = reading_named(o.reading);
  e.tie = tie_named(o.tie);
  e.max_iterations = o.max_iterations;
  e.max_belief_positions = o.max_positions;
  e.max_period = o.max_period;
  e.exact = is_exact(o);
  e.by_bounds = o.arith == "certified";
  e.pedantic = o.pedantic;
  e.only = claims_named(o.claims);
  if (e.by_bounds && e.only && e.only->contains(ClaimId::lemma_3)) {
    throw InputError("--claims: lemma-3 is not proved by bounds, expected others or --arith exact");
  }
  return e;
}

std::optional<Range<State>> state_range(const std::string& text) {
  return range<State>(text, "--states", 2, 1000);
}

FamilyOptions family_options(const Options& o) {
  FamilyOptions f;
  f.states = state_range(o.states);
  f.actions = range<Action>(o.actions, "--actions", 1, 1000);
  f.discount = range<double>(o.gamma, "--gamma", 0.0, 0.999999);
  if (!o.model.eps.empty()) f.eps = apps::nearest_number(o.model.eps);
  f.l_r = o.l_r;
  f.l_p = o.l_p;
  f.dimension = o.dimension;
  f.successors = o.successors;
  if (!o.model.norm.empty()) f.norm = apps::norm_named(o.model.norm);
  return f;
}

nlohmann::ordered_json configuration(const Options& o) {
  nlohmann::ordered_json eps = nullptr;  // a fraction as it is written
  if (!o.model.eps.empty()) eps = apps::nearest_number(o.model.eps);
  if (o.model.eps.find('/') != std::string::npos) eps = o.model.eps;
  const auto optional = [](const auto& x) { return x ? nlohmann::ordered_json(*x) : nlohmann::ordered_json(nullptr); };
  return {{"reading", o.reading},
          {"arith", o.arith},
          {"claims", o.claims},
          {"tie", o.tie},
          {"max_iterations", o.max_iterations},
          {"max_period", o.max_period},
          {"max_positions", o.max_positions},
          {"trials", o.trials},
          {"seed", o.seed},
          {"family", o.family},
          {"states", o.states},
          {"actions", o.actions},
          {"gamma", o.gamma},
          {"eps", eps},
          {"l_r", optional(o.l_r)},
          {"l_p", optional(o.l_p)},
          {"norm", o.model.norm},
          {"dimension", optional(o.dimension)},
          {"successors", optional(o.successors)}};
}

nlohmann::ordered_json told_configuration(const Options& o) {
  nlohmann::ordered_json told = configuration(o);
  if (o.pedantic) told["pedantic"] = true;
  return told;
}

std::string replay_options(const Options& o) {
  std::string text = fmt::format("--seed {}", o.seed);
  const auto add = [&](std::string_view option, const auto& value) { text += fmt::format(" {} {}", option, value); };
  if (o.family != "mixed") add("--family", o.family);
  if (!o.states.empty()) add("--states", o.states);
  if (!o.actions.empty()) add("--actions", o.actions);
  if (!o.gamma.empty()) add("--gamma", o.gamma);
  if (!o.model.eps.empty()) add("--eps", o.model.eps);
  if (o.l_r) add("--l-r", *o.l_r);
  if (o.l_p) add("--l-p", *o.l_p);
  if (!o.model.norm.empty()) add("--norm", o.model.norm);
  if (o.dimension) add("--dimension", *o.dimension);
  if (o.successors) add("--successors", *o.successors);
  if (o.reading != "corrected") add("--reading", o.reading);
  if (o.tie != "lowest") add("--tie", o.tie);
  if (is_exact(o)) add("--arith", o.arith);
  const Options unchanged;
  if (o.max_iterations != unchanged.max_iterations) add("--max-iterations", o.max_iterations);
  if (o.max_period != unchanged.max_period) add("--max-period", o.max_period);
  if (o.max_positions != unchanged.max_positions) add("--max-positions", o.max_positions);
  return text;
}

}  // namespace maximin::verify_bound
