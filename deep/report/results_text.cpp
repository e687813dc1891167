#include <maximin/deep/report/results_text.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <maximin/deep/report/intervals_in_words.hpp>

namespace maximin::deep {
namespace {

/// Text in a cell of a Markdown table: no markup, no cell or line of its own.
std::string plain(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '<') {
      out += "&lt;";
    } else if (c == '>') {
      out += "&gt;";
    } else if (c == '&') {
      out += "&amp;";
    } else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) {
      out += ' ';
    } else {
      if (std::string_view("\\`*_[]|#~!$").find(c) != std::string_view::npos) out += '\\';
      out += c;
    }
  }
  return out;
}

std::string target_text(const ResultCell& c) {
  if (!c.target) return "";
  const std::string word = verdict_word(verdict(c));
  const std::string bound = (c.target->sense == Target::Sense::at_least ? "≥ " : "≤ ") + exact_text(c.target->value);
  if (word.empty()) return "; target " + bound;
  return fmt::format("; {}{}{} (target {})", word.starts_with("MISS") ? "**" : "", word,
                     word.starts_with("MISS") ? "**" : "", bound);
}

std::string table_cell(const ResultCell* c) {
  if (!c) return "";
  std::string text = cell_text(*c);
  if (c->paper) text += "; paper " + paper_text(*c->paper);
  return text + target_text(*c);
}

std::string main_table(const ResultBlock& b) {
  std::string text = "| agent |", rule = "\n|---|";
  for (const auto& column : b.columns()) {
    text += fmt::format(" {} |", plain(column_title(column)));
    rule += "---|";
  }
  text += rule + "\n";
  for (const std::string& agent : b.agents()) {
    text += fmt::format("| {} |", plain(agent));
    for (const auto& [attack, eps] : b.columns()) text += fmt::format(" {} |", table_cell(b.find(agent, attack, eps)));
    text += '\n';
  }
  return text;
}

std::string seeds_table(const ResultBlock& b) {
  std::string rows;
  for (const ResultCell& c : b.cells) {
    if (c.runs.empty()) continue;
    const Estimate e = estimate(c.runs);
    std::string seeds;
    for (std::size_t i = 0; i < c.runs.size(); ++i) {
      seeds += fmt::format("{}{}: {}", i == 0 ? "" : ", ", c.runs[i].training_seed, return_text(e.seed_means[i]));
    }
    std::string further;
    for (const auto& [name, value] : c.measures) further += fmt::format("{} {:.4g}; ", plain(name), value);
    rows += fmt::format("| {} | {} | {} | {} | {} | {} | {}{} |\n", plain(c.agent),
                        plain(column_title({c.attack, c.eps})), seeds, e.episodes, interval_text(e.across_seeds),
                        interval_text(e.these_agents), further, plain(c.note));
  }
  if (rows.empty()) return "";
  return "\n| agent | attack | mean of each training seed | episodes | ± across seeds | ± these networks | notes "
         "|\n|---|---|---|---|---|---|---|\n" +
         rows;
}

/// As many decimals as the half-width has to say: "163 ± 12", "4.2 ± 1.3".
std::string mean_and_half_width(double mean, double half_width) {
  const int decimals = half_width >= 9.95 ? 0 : half_width >= 0.995 || half_width == 0 ? 1 : 2;
  if (std::max(std::abs(mean), half_width) >= 1e6) return fmt::format("{:.4g} ± {:.2g}", mean, half_width);
  std::string text = fmt::format("{:.{}f}", mean, decimals);
  if (text.front() == '-') text.replace(0, 1, text.find_first_not_of("-0.") == text.npos ? "" : "−");
  return fmt::format("{} ± {:.{}f}", text, half_width, decimals);
}

/// A fence longer than any row of backticks in the text.
std::string fenced(const std::string& text) {
  std::size_t longest = 2, row = 0;
  for (const char c : text) {
    row = c == '`' ? row + 1 : 0;
    longest = std::max(longest, row);
  }
  const std::string fence(longest + 1, '`');
  return fence + "\n" + text + "\n" + fence + "\n";
}

}  // namespace

std::string return_text(double value) {
  const double magnitude = std::abs(value);
  std::string text = magnitude >= 1e6     ? fmt::format("{:.3g}", value)
                     : magnitude >= 99.95 ? fmt::format("{:.0f}", value)
                     : magnitude >= 0.095 ? fmt::format("{:.1f}", value)
                                          : fmt::format("{:.2g}", value);
  if (text.front() == '-') text.replace(0, 1, "−");
  return text;
}

std::string interval_text(const std::optional<ConfidenceInterval>& interval) {
  return interval ? return_text(interval->half_width) : "not estimable";
}

std::string exact_text(double value) {
  std::string text = fmt::format("{:g}", value);
  if (text.front() == '-') text.replace(0, 1, "−");
  return text;
}

std::string paper_text(const PaperFigure& paper) {
  return exact_text(paper.mean) + (paper.deviation ? " (sd " + exact_text(*paper.deviation) + ")" : "");
}

std::string verdict_word(TargetVerdict v) {
  switch (v) {
    case TargetVerdict::met:
      return "met";
    case TargetVerdict::met_on_average:
      return "met on average";
    case TargetVerdict::missed_nearly:
      return "MISS, within ±";
    case TargetVerdict::missed:
      return "MISS";
    case TargetVerdict::none:
      break;
  }
  return "";
}

std::string cell_text(const ResultCell& cell) {
  if (cell.runs.empty()) return "not run";
  const Estimate e = estimate(cell.runs);
  const std::string mean = return_text(e.mean);
  if (e.across_seeds) return mean_and_half_width(e.mean, e.across_seeds->half_width);
  const std::string why = cell.runs.size() == 1 ? "one seed" : "one episode";
  if (!e.these_agents) return fmt::format("{} ({})", mean, why);
  return fmt::format("{} ({})", mean_and_half_width(e.mean, e.these_agents->half_width), why);
}

std::string intervals_in_words(const ResultTable& table) {
  bool crossed = false, mixed = false, single = false;
  for (const ResultBlock& b : table.blocks) {
    for (const ResultCell& c : b.cells) {
      if (c.runs.empty()) continue;
      const EpisodeDesign design = estimate(c.runs).design;
      single = single || c.runs.size() == 1;
      crossed = crossed || design == EpisodeDesign::crossed;
      mixed = mixed || design == EpisodeDesign::mixed;
    }
  }
  std::string text =
      "A number is the mean over training seeds of the mean return over a seed's episodes. ± is half of a 95 percent "
      "interval for another training run on other episodes: Student's t over the seeds";
  if (crossed) text += ", and, as all seeds play the same episodes, the luck of the episodes on top (two-way analysis)";
  if (mixed) text += "; where some seeds share episodes, with a bound on what they share";
  text += ". “These networks” asks less: the same networks on other episodes; it says nothing of training.";
  if (single) {
    text +=
        " “One seed” marks what one training seed alone came to: its ± is of these networks, and what another training "
        "run would come to cannot be estimated.";
  }
  return text + " The paper's figures are of one training seed and ten episodes; sd is their standard deviation.";
}

std::string markdown(const ResultTable& table) {
  validate(table);
  std::string text = fmt::format("# {}\n\n", plain(table.title.empty() ? "Results" : table.title));
  text += intervals_in_words(table) + "\n";
  if (table.blocks.empty()) text += "\nNothing has been run yet.\n";
  for (const ResultBlock& b : table.blocks) {
    text += fmt::format("\n## {}\n\n", plain(b.name));
    if (!b.note.empty()) text += plain(b.note) + "\n\n";
    text += b.cells.empty() ? "No cells.\n" : main_table(b) + seeds_table(b);
  }
  text += fmt::format("\n## How it was made\n\nVersion {}, {:.0f} s of computing.\n\n", plain(table.version),
                      table.wall_seconds);
  if (!table.command.empty()) text += fenced(table.command) + "\n";
  using Json = nlohmann::ordered_json;
  return text + "<details><summary>Configuration</summary>\n\n" +
         fenced(table.configuration.dump(2, ' ', false, Json::error_handler_t::replace)) + "\n</details>\n";
}

}  // namespace maximin::deep
