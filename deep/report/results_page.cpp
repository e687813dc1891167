#include <maximin/deep/report/results_page.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <fmt/format.h>

#include <maximin/deep/report/intervals_in_words.hpp>
#include <maximin/deep/report/map_picture.hpp>
#include <maximin/deep/report/results_text.hpp>
#include <maximin/deep/report/returns_picture.hpp>
#include <maximin/deep/report/training_figures.hpp>
#include <maximin/proofs_check/report/html_text.hpp>
#include <maximin/proofs_check/report/page.hpp>

namespace maximin::deep {
namespace {

using report::count;
using report::counted;
using report::escape;

constexpr std::string_view table_style = R"css(
table.results { width: auto; border-spacing: 3px; border-collapse: separate; }
table.results th { text-align: center; padding: 5px 10px; }
table.results tbody th { text-align: left; font-weight: 600; vertical-align: middle; white-space: nowrap; }
table.results thead th { border-bottom: none; }
table.results thead th.attack { border-bottom: 2px solid var(--axis); }
table.results td { text-align: center; min-width: 6.2em; padding: 6px 10px; line-height: 1.25; }
table.results td b { display: block; white-space: nowrap; font-weight: 650; }
table.results td span { display: block; font-size: .8rem; color: var(--soft); }
table.results td span.figure { white-space: nowrap; }
table.facts th.text { text-align: left; }
table.results td span.miss { color: var(--bad); font-weight: 650; }
table.results td.open { border: 1px dashed var(--grid); color: var(--soft); }
.maps { display: grid; grid-template-columns: repeat(3, minmax(0, 1fr)); gap: 22px 24px; margin: 18px 0; }
.maps.film { grid-template-columns: repeat(4, minmax(0, 1fr)); gap: 14px 16px; }
@media (max-width: 900px) { .maps, .maps.film { grid-template-columns: repeat(2, minmax(0, 1fr)); } }
@media print { .maps > * { break-inside: avoid; } }
)css";

/// What the whole table comes to.
struct Tally {
  long cells = 0, done = 0, targets = 0, decided = 0, met = 0, episodes = 0;
  std::size_t fewest_seeds = 0, most_seeds = 0;
  std::vector<std::string> misses;
  double largest = 0;  ///< absolute mean, for the colours
};

Tally tally_of(const ResultTable& table) {
  Tally t;
  for (const ResultBlock& b : table.blocks) {
    for (const ResultCell& c : b.cells) {
      t.cells += b.derived ? 0 : 1;
      t.targets += c.target ? 1 : 0;
      if (c.runs.empty()) continue;
      const Estimate e = estimate(c.runs);
      t.fewest_seeds = t.done == 0 ? c.runs.size() : std::min(t.fewest_seeds, c.runs.size());
      t.most_seeds = std::max(t.most_seeds, c.runs.size());
      t.done += b.derived ? 0 : 1;
      t.episodes += b.derived ? 0 : e.episodes;
      t.largest = std::max(t.largest, std::abs(e.mean));
      const TargetVerdict v = verdict(c);
      if (v == TargetVerdict::none) continue;
      ++t.decided;
      if (v == TargetVerdict::met || v == TargetVerdict::met_on_average) {
        ++t.met;
      } else {
        t.misses.push_back(fmt::format("{} under {} ({})", c.agent, column_title({c.attack, c.eps}), cell_text(c)));
      }
    }
  }
  return t;
}

std::string listed(const std::vector<std::string>& items, std::size_t most) {
  std::string text;
  for (std::size_t i = 0; i < std::min(items.size(), most); ++i) text += (i == 0 ? "" : "; ") + escape(items[i]);
  return items.size() > most ? text + fmt::format("; and {} more", items.size() - most) : text;
}

std::string verdict_part(const ResultTable& table, const Tally& t) {
  std::string first = t.cells == 0 ? "Nothing has been run yet."
                      : t.done < t.cells
                          ? fmt::format("{} of {} are done.", count(t.done), counted(t.cells, "cell", "cells"))
                          : fmt::format("All {} are done.", counted(t.cells, "cell", "cells"));
  if (t.targets > 0) {
    first += fmt::format(" {} of {} met{}.", count(t.met), counted(t.targets, "target", "targets"),
                         t.decided < t.targets ? fmt::format(", {} open", t.targets - t.decided) : "");
  }
  std::vector<std::string> sentences{first};
  if (!t.misses.empty()) sentences.push_back("Missed: " + listed(t.misses, 6) + ".");
  if (t.done > 0 && t.fewest_seeds < 3) {
    sentences.push_back(t.most_seeds == 1 ? "Every number is of one training seed: nothing here says what another "
                                            "training run would come to."
                                          : "Some numbers are of fewer than three training seeds.");
  }
  sentences.push_back(escape(intervals_in_words(table)));
  return report::verdict_box(t.misses.empty() ? (t.done < t.cells || t.cells == 0 ? "warn" : "") : "bad", sentences);
}

std::string tiles_part(const Tally& t) {
  if (t.done == 0) return "";
  const std::string seeds = t.fewest_seeds == t.most_seeds ? fmt::format("{}", t.most_seeds)
                                                           : fmt::format("{} to {}", t.fewest_seeds, t.most_seeds);
  std::vector<report::Tile> tiles{{fmt::format("{} of {}", t.done, t.cells), "cells done"},
                                  {seeds, "training seeds in a cell"},
                                  {count(t.episodes), "episodes played"}};
  if (t.targets > 0) tiles.push_back({fmt::format("{} of {}", t.met, t.targets), "targets met", !t.misses.empty()});
  return report::tiles(tiles);
}

/// Blue for gains, orange for losses, deeper for larger; the number says the same.
std::string shade(double mean, double largest) {
  const double depth = largest > 0 ? 0.5 * std::min(1.0, std::abs(mean) / largest) : 0;
  return fmt::format("background: rgba({}, {:.2f})", mean >= 0 ? "0, 114, 178" : "226, 120, 0", depth);
}

std::string hover_of_cell(const ResultCell& c) {
  std::string text = fmt::format("{} under {}", c.agent, column_title({c.attack, c.eps}));
  if (c.runs.empty()) return text;
  const Estimate e = estimate(c.runs);
  for (std::size_t i = 0; i < c.runs.size(); ++i) {
    text += fmt::format("\ntraining seed {}: {}, {}", c.runs[i].training_seed, return_text(e.seed_means[i]),
                        counted(static_cast<long>(c.runs[i].returns.size()), "episode", "episodes"));
  }
  text += "\n± across seeds: " + interval_text(e.across_seeds) + "\n± these networks: " + interval_text(e.these_agents);
  for (const auto& [name, value] : c.measures) text += fmt::format("\n{}: {:.4g}", name, value);
  return c.note.empty() ? text : text + "\n" + c.note;
}

std::string data_cell(const ResultCell* c, double largest) {
  if (!c) return "<td></td>";
  const bool open = c->runs.empty();
  std::string html =
      open ? "<td class=\"open\"" : fmt::format("<td style=\"{}\"", shade(estimate(c->runs).mean, largest));
  html += fmt::format(" title=\"{}\"><b>{}</b>", escape(hover_of_cell(*c)), escape(cell_text(*c)));
  if (c->paper) html += fmt::format("<span class=\"figure\">paper {}</span>", escape(paper_text(*c->paper)));
  if (c->target) {
    const TargetVerdict v = verdict(*c);
    const std::string word = verdict_word(v);
    const bool miss = v == TargetVerdict::missed || v == TargetVerdict::missed_nearly;
    html += fmt::format("<span class=\"figure{}\">{}{} {}</span>", miss ? " miss" : "",
                        word.empty() ? "target" : word + ":", c->target->sense == Target::Sense::at_least ? " ≥" : " ≤",
                        exact_text(c->target->value));
  }
  if (!c->note.empty()) html += fmt::format("<span>{}</span>", escape(c->note));
  return html + "</td>";
}

/// Attacks in the first line, each over its radii in the second.
std::string table_head(const std::vector<ResultBlock::Column>& columns) {
  std::string attacks = "<tr><th rowspan=\"2\">agent</th>", radii = "<tr>";
  for (std::size_t i = 0; i < columns.size();) {
    std::size_t end = i;
    while (end < columns.size() && columns[end].attack == columns[i].attack) ++end;
    attacks += fmt::format("<th class=\"attack\" colspan=\"{}\">{}</th>", end - i, escape(columns[i].attack));
    for (; i < end; ++i) radii += columns[i].eps == 0 ? "<th></th>" : fmt::format("<th>ε = {:g}</th>", columns[i].eps);
  }
  return "<thead>" + attacks + "</tr>\n" + radii + "</tr></thead>\n";
}

std::string block_table(const ResultBlock& b, double largest) {
  const auto columns = b.columns();
  std::string html = "<div class=\"scroll\"><table class=\"results\">\n" + table_head(columns) + "<tbody>\n";
  for (const std::string& agent : b.agents()) {
    html += fmt::format("<tr><th scope=\"row\">{}</th>", escape(agent));
    for (const auto& [attack, eps] : columns) html += data_cell(b.find(agent, attack, eps), largest);
    html += "</tr>\n";
  }
  return html + "</tbody></table></div>\n";
}

std::string block_part(const ResultBlock& b, double largest) {
  std::string html = fmt::format("<h2>{}</h2>\n", escape(b.name));
  if (!b.note.empty()) html += fmt::format("<p>{}</p>\n", escape(b.note));
  if (b.cells.empty()) return html + "<p>No cells.</p>\n";
  return html + block_table(b, largest) + returns_pictures(b);
}

/// What a defence is worth is what is left of it under the attack that hurts it most.
std::string worst_part(const ResultTable& table) {
  std::vector<std::string> agents;
  std::map<std::string, std::pair<const ResultBlock*, const ResultCell*>> worst;
  std::map<std::string, long> cells;
  for (const ResultBlock& b : table.blocks) {
    for (const ResultCell& c : b.cells) {
      if (c.runs.empty()) continue;
      auto& entry = worst[c.agent];
      if (!entry.second) agents.push_back(c.agent);
      if (!entry.second || estimate(c.runs).mean < estimate(entry.second->runs).mean) entry = {&b, &c};
      ++cells[c.agent];
    }
  }
  if (agents.size() < 2 && (agents.empty() || cells[agents[0]] < 2)) return "";
  std::string html =
      "<h2>The worst attack on each agent</h2>\n<p>What a defence is worth is what is left under the attack that hurts "
      "it most. An agent that fewer attacks were tried on looks better than it is.</p>\n"
      "<div class=\"scroll\"><table class=\"facts\"><thead><tr><th>agent</th><th>return</th><th "
      "class=\"text\">under</th><th>of</th>"
      "</tr></thead><tbody>\n";
  for (const std::string& agent : agents) {
    const auto& [block, cell] = worst[agent];
    html += fmt::format("<tr><td>{}</td><td>{}</td><td class=\"text\">{} ({})</td><td>{}</td></tr>\n", escape(agent),
                        cell_text(*cell), escape(column_title({cell->attack, cell->eps})), escape(block->name),
                        counted(cells[agent], "cell", "cells"));
  }
  return html + "</tbody></table></div>\n";
}

std::string training_part(const std::vector<TrainingCurve>& curves) {
  const std::string figures = training_figures(curves);
  if (figures.empty()) return "";
  return "<h2>Training</h2>\n<p>The line is the mean over the training seeds of an agent, the band goes from the "
         "lowest "
         "to the highest of them.</p>\n" +
         figures;
}

std::string film(const EpisodeTrace& trace) {
  const std::vector<long> steps = moments(trace, 8);
  if (steps.size() < 2) return "";
  std::string html = fmt::format("<h3>{} against {}, moment by moment</h3>\n<div class=\"maps film\">\n",
                                 escape(trace.agent), escape(column_title({trace.attack, trace.eps})));
  for (const long k : steps) html += "<figure>" + moment_picture(trace, k) + "</figure>\n";
  return html + "</div>\n";
}

/// The episodes of one agent side by side, and moment by moment the one that ended worst.
std::string episodes_of(const std::string& agent, const std::vector<EpisodeTrace>& traces) {
  std::string html = fmt::format("<h3>{}</h3>\n<div class=\"maps\">\n", escape(agent));
  const EpisodeTrace* worst = nullptr;
  for (const EpisodeTrace& t : traces) {
    if (t.agent != agent) continue;
    PathPictureOptions options;
    options.belief_at = moments(t, 4);
    html += "<figure>" + path_picture(t, options) + "</figure>\n";
    const bool has_belief = !moments(t, 1).empty();
    if (has_belief && (!worst || t.total_reward() < worst->total_reward())) worst = &t;
  }
  return html + "</div>\n" + (worst ? film(*worst) : "");
}

std::string episodes_part(const std::vector<EpisodeTrace>& traces) {
  if (traces.empty()) return "";
  std::string html = "<h2>Episodes on the map</h2>\n" + map_legend();
  std::set<std::string> done;
  for (const EpisodeTrace& t : traces) {
    if (done.insert(t.agent).second) html += episodes_of(t.agent, traces);
  }
  return html;
}

std::string making_part(const ResultTable& table) {
  const double hours = table.wall_seconds / 3600;
  std::vector<std::pair<std::string, std::string>> rows{
      {"version", table.version},
      {"time", hours >= 1 ? fmt::format("{:.1f} hours of computing", hours)
                          : fmt::format("{:.0f} s of computing", table.wall_seconds)}};
  if (!table.command.empty()) rows.insert(rows.begin(), {"command", table.command});
  return "<h2>How it was made</h2>\n" + report::facts(rows) + report::configuration_section(table.configuration);
}

}  // namespace

std::string results_page(const ResultTable& table, const std::vector<TrainingCurve>& curves,
                         const std::vector<EpisodeTrace>& traces) {
  validate(table);
  for (const EpisodeTrace& t : traces) validate(t, "trace of " + t.agent);
  const Tally t = tally_of(table);
  const std::string title = table.title.empty() ? "Results" : table.title;
  std::string body = fmt::format(
      "<h1>{}</h1>\n<p class=\"sub\">Return of each agent (rows) under each attack (columns)"
      "</p>\n",
      escape(title));
  body += verdict_part(table, t) + tiles_part(t);
  if (t.done > 0) {
    body += fmt::format(
        "<p class=\"sub\">Cells are blue where the mean return is a gain, orange where it is a loss, the "
        "deeper the larger (up to {}). Rest the pointer on a cell for its seeds.</p>\n",
        return_text(t.largest));
  }
  for (const ResultBlock& b : table.blocks) body += block_part(b, t.largest);
  body += worst_part(table) + training_part(curves) + episodes_part(traces) + making_part(table);
  std::string style = std::string(table_style) + std::string(returns_style()) + std::string(training_style());
  if (!traces.empty()) style += map_style();
  return report::page(title, body, style);
}

}  // namespace maximin::deep
