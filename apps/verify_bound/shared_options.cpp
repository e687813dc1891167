#include "shared_options.hpp"

#include <algorithm>
#include <thread>
#include <vector>

#include <maximin/apps/common/option_checks.hpp>
#include <maximin/models/model_family.hpp>

namespace maximin::verify_bound {

CLI::Option* add_reading(CLI::App& app, std::string& value) {
  return app
      .add_option("--reading", value,
                  "R_max of the paper's claims: paper, Assumption 2 as printed,\n"
                  "R <= R_max; or corrected, |R| <= R_max (the default)")
      ->check(apps::one_of({"paper", "corrected"}))
      ->type_name("WORD");
}

CLI::Option* add_tie(CLI::App& app, std::string& value) {
  return app.add_option("--tie", value, "which index wins among equals: lowest (the default) or highest")
      ->check(apps::one_of({"lowest", "highest"}))
      ->type_name("WORD");
}

CLI::Option* add_family(CLI::App& app, std::string& value, const std::string& description) {
  std::vector<std::string> names;
  for (const Family f : all_families()) names.emplace_back(family_name(f));
  return app.add_option("--family", value, description)->check(apps::one_of(names))->type_name("WORD");
}

CLI::Option* add_seed(CLI::App& app, std::uint64_t& value, const std::string& description) {
  return app.add_option("--seed", value, description)->check(apps::seed_number())->type_name("N");
}

CLI::Option* add_threads(CLI::App& app, int& value, const std::string& description) {
  return app.add_option("--threads", value, description)->check(apps::whole_number(0, 1024))->type_name("N");
}

Reading reading_named(const std::string& word) {
  return word == "paper" ? Reading::paper : Reading::corrected;
}

TieBreak tie_named(const std::string& word) {
  return word == "highest" ? TieBreak::highest_index : TieBreak::lowest_index;
}

int threads_for(int asked) {
  return asked > 0 ? asked : static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
}

}  // namespace maximin::verify_bound
