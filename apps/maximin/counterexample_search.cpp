#include <fmt/format.h>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>

#include <maximin/apps/common/interrupt.hpp>
#include <maximin/apps/common/option_checks.hpp>
#include <maximin/apps/common/program.hpp>
#include <maximin/apps/maximin/counterexample.hpp>
#include <maximin/counterexamples/exact_text.hpp>
#include <maximin/counterexamples/gallery.hpp>
#include <maximin/counterexamples/search.hpp>
#include <maximin/counterexamples/tiny_models.hpp>
#include <maximin/theory/error.hpp>

namespace maximin::apps {

namespace {

struct SearchOptions {
  std::string name;
  std::optional<std::uint64_t> seed;
  std::optional<double> seconds;
  bool model = false;
};

StopRequest stop_after(const std::optional<double>& seconds) {
  const auto start = std::chrono::steady_clock::now();
  return [seconds, start, &interrupted = stop_on_interrupt()] {
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start;
    return interrupted || (seconds && spent.count() >= *seconds);
  };
}

/// "All models of 1 x 1 ... were looked at" and in which sense the one found is the smallest.
std::string exhaustive_text(const CounterexampleSearch& search) {
  std::string text =
      "All models whose states look alike, with gamma 1/2, rewards -2 to 2, and one successor or two by a fair coin,\n"
      "by size: sum |R| plus arrows to other states.\n\n";
  for (const auto& shape : search.shapes) {
    const bool last = search.model && &shape == &search.shapes.back();
    text +=
        fmt::format("  {} x {}: {} models, {}\n", shape.states, shape.actions, shape.examined,
                    last ? fmt::format("the last one shows it, of size {}", exact_text(tiny_size(search.model->mdp)))
                         : "none shows it");
  }
  return text + "\nSmallest: no model of a smaller shape, nor a smaller one of its shape, shows it in this family.\n\n";
}

std::string random_text(const CounterexampleSearch& search, std::uint64_t seed) {
  return fmt::format(
      "Number {} of the small random models of seed {} shows it. Shrunk as far as that goes: the smallest found by "
      "this\n"
      "search, not the smallest there is.\n\n",
      search.examined, seed);
}

int search(const SearchOptions& options) {
  const Counterexample& c = find_counterexample(options.name);
  const StopRequest stop = stop_after(options.seconds);
  const CounterexampleSearch result =
      options.seed ? search_randomly(c, *options.seed, stop) : search_exhaustively(c, stop);
  if (!result.model) {
    if (stop_on_interrupt()) return ExitCode::interrupted;
    throw BudgetExhausted(fmt::format("search: none of {} models shows it; allow more --seconds", result.examined));
  }
  if (options.model) {
    print(own_json(*result.model));
    return ExitCode::success;
  }
  print(options.seed ? random_text(result, *options.seed) : exhaustive_text(result));
  print(exact_model_text(*result.model) + "\n" + finding_text(c, c.check(*result.model)));
  return ExitCode::success;
}

}  // namespace

void add_counterexample_search(CLI::App& app, Task& task) {
  auto options = std::make_shared<SearchOptions>();
  auto* sub = app.add_subcommand("search", "the smallest model: stationary-optimum and sharper-belief");
  declare_name(*sub, options->name)->required();
  sub->add_option("--seed", options->seed, "draw random models from this seed and shrink, instead of trying all")
      ->check(seed_number())
      ->type_name("N");
  sub->add_option("--seconds", options->seconds, "give up after so long (exit code 3); random models: stop shrinking")
      ->check(real_number({.low = 0, .above = true}))
      ->type_name("S");
  sub->add_flag("--model", options->model, "print only the model that is found, in the project's own JSON");
  sub->footer(
      "Without --seed all models of a family are tried by size, so that the first that is found is the smallest.\n"
      "Examples:\n"
      "  maximin counterexample search stationary-optimum\n"
      "  maximin counterexample search sharper-belief --seed 1 --seconds 60");
  sub->callback([options, &task] { task = [options] { return search(*options); }; });
}

}  // namespace maximin::apps
