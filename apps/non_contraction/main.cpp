#include <CLI/CLI.hpp>

#include <maximin/apps/common/program.hpp>

#include "discount.hpp"
#include "report.hpp"

namespace {

constexpr const char* examples = R"(Examples:
  non_contraction                  the tables, the policies, the backups, the distances
  non_contraction --gamma 10/11    at the threshold: the distance stays exactly 10
  non_contraction --gamma 0.99 --json

The discount is taken exactly, as a fraction. Exit codes: 0 done, 1 the numbers are not those of the paper,
2 bad usage or input)";

/// What the paper says: 10 before, 11 gamma after.
bool as_in_the_paper() {
  const auto exact = maximin::non_contraction::exact_distances();
  return exact.before == 10 && exact.after_per_gamma == 11;
}

}  // namespace

int main(int argc, char** argv) {
  using namespace maximin;
  CLI::App program("Shows why pessimistic Q-iteration is not a contraction: the paper's counterexample (Table 4).",
                   "non_contraction");
  program.footer(examples);
  std::string gamma = "0.95";
  bool json = false;
  program.add_option("--gamma", gamma, "discount, 0 <= gamma < 1: a decimal or a fraction\n(default: 0.95)")
      ->type_name("GAMMA");
  program.add_flag("--json", json, "one JSON object on standard output, nothing else");
  return apps::run_program(program, argc, argv, [&] {
    const auto discount = apps::parse_discount(gamma);
    apps::print(json ? apps::non_contraction_json(discount) : apps::non_contraction_text(discount));
    return as_in_the_paper() ? apps::ExitCode::success : apps::ExitCode::violated;
  });
}
