#include <maximin/deep/report/results.hpp>

#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <sstream>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <maximin/deep/report/results_file.hpp>
#include <maximin/deep/report/results_page.hpp>
#include <maximin/deep/report/results_text.hpp>
#include <maximin/theory/error.hpp>

#include "../../wellformed.hpp"
#include "sample.hpp"
#include "scratch.hpp"

namespace maximin::deep {
namespace {

using Json = nlohmann::ordered_json;

ResultCell cell(std::vector<SeedRun> runs, std::optional<Target> target = {}) {
  return {"BP-DQN", "PGD", 0.5, std::move(runs), {}, target, "", {}};
}

ResultTable one_cell(const ResultCell& c) {
  ResultTable t;
  t.blocks = {{"block", "", {c}}};
  return t;
}

std::vector<SeedRun> seeds(std::vector<double> means) {
  std::vector<SeedRun> runs;
  for (const double m : means) runs.push_back({runs.size(), runs.size(), {m - 1, m + 1}, 1});
  return runs;
}

TEST(Results, VerdictOfATarget) {
  const Target least{Target::Sense::at_least, 100}, most{Target::Sense::at_most, 100};
  EXPECT_EQ(verdict(cell(seeds({120, 121, 122}), least)), TargetVerdict::met);
  EXPECT_EQ(verdict(cell(seeds({120, 121, 122}), most)), TargetVerdict::missed);
  EXPECT_EQ(verdict(cell(seeds({90, 110, 130}), least)), TargetVerdict::met_on_average);
  EXPECT_EQ(verdict(cell(seeds({70, 110, 90}), least)), TargetVerdict::missed_nearly);
  EXPECT_EQ(verdict(cell(seeds({50, 51, 52}), least)), TargetVerdict::missed);
  EXPECT_EQ(verdict(cell(seeds({50, 51, 52}), most)), TargetVerdict::met);
  EXPECT_EQ(verdict(cell(seeds({500}), least)), TargetVerdict::met_on_average) << "one seed is never beyond doubt";
  EXPECT_EQ(verdict(cell(seeds({5}), least)), TargetVerdict::missed);
  EXPECT_EQ(verdict(cell({}, least)), TargetVerdict::none);
  EXPECT_EQ(verdict(cell(seeds({500}))), TargetVerdict::none);
}

TEST(Results, JsonGivesBackTheTable) {
  const ResultTable t = sample::table();
  const Json json = to_json(t);
  EXPECT_EQ(results_from_json(Json::parse(json.dump()), "x"), t);
  EXPECT_EQ(json["blocks"][0]["cells"][0]["summary"]["seeds"], 3);
  EXPECT_EQ(results_from_json(to_json(ResultTable{}), "x"), ResultTable{});
}

RC_GTEST_PROP(Results, AnyNumbersAreGivenBackExactly, (std::uint64_t seed, std::vector<double> returns)) {
  ResultCell c = cell({{seed, ~seed, {0.1}, 1e-300}});
  for (const double r : returns) {
    if (std::abs(r) < 1e100) c.runs[0].returns.push_back(r);
  }
  const ResultTable t = one_cell(c);
  RC_ASSERT(results_from_json(Json::parse(to_json(t).dump()), "x") == t);
}

/// What reading a changed document says.
std::string refusal(const std::function<void(Json&)>& change) {
  Json json = to_json(one_cell(cell(seeds({1, 2, 3}), Target{})));
  change(json);
  try {
    results_from_json(json, "t.json");
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

TEST(Results, ForeignAndBrokenDocumentsAreRefusedInOneLine) {
  EXPECT_EQ(refusal([](Json&) {}), "");
  const auto expect = [](const std::string& beginning, const std::function<void(Json&)>& change) {
    const std::string words = refusal(change);
    EXPECT_TRUE(words.starts_with("t.json: " + beginning)) << words;
    EXPECT_NE(words.find("expected"), words.npos) << words;
    EXPECT_EQ(words.find('\n'), words.npos) << words;
  };
  expect("[1,2], expected an object", [](Json& j) { j = Json::array({1, 2}); });
  expect("schema: not there", [](Json& j) { j = Json::object(); });
  expect("schema: \"other\"", [](Json& j) { j["schema"] = "other"; });
  expect("schema_version: 2", [](Json& j) { j["schema_version"] = 2; });
  expect("blocks: 7", [](Json& j) { j["blocks"] = 7; });
  const auto first = [](Json& j) -> Json& { return j["blocks"][0]["cells"][0]; };
  expect("blocks[0].cells[0].eps: null", [&](Json& j) { first(j)["eps"] = nullptr; });
  expect("blocks[0].cells[0].agent: 3", [&](Json& j) { first(j)["agent"] = 3; });
  expect("blocks[0].cells[0].runs[1].returns[0]: \"x\"", [&](Json& j) { first(j)["runs"][1]["returns"][0] = "x"; });
  expect("blocks[0].cells[0].runs[1].returns: empty", [&](Json& j) { first(j)["runs"][1]["returns"] = Json::array(); });
  expect("blocks[0].cells[0].runs[0].training_seed: -1", [&](Json& j) { first(j)["runs"][0]["training_seed"] = -1; });
  expect("blocks[0].cells[0].summary.mean", [&](Json& j) { first(j)["runs"][1]["returns"][0] = 900; });
  expect("blocks[0].cells[0].target.at_most: not there", [&](Json& j) { first(j)["target"] = Json::object(); });
  expect("table: block / BP-DQN / PGD eps 0.5: training seed 0: there twice",
         [&](Json& j) { first(j)["runs"][1]["training_seed"] = 0; });
  expect("table: block / BP-DQN / PGD eps 0.5: there twice", [&](Json& j) {
    const Json copy = first(j);
    j["blocks"][0]["cells"].push_back(copy);
  });
}

TEST(Results, NumbersThatAreNoneAreRefused) {
  for (const double bad : {sample::nan, std::numeric_limits<double>::infinity()}) {
    ResultCell c = cell(seeds({1, 2}));
    c.runs[1].returns[1] = bad;
    try {
      to_json(one_cell(c));
      ADD_FAILURE() << "not refused";
    } catch (const InputError& e) {
      EXPECT_TRUE(std::string(e.what()).starts_with(
          "table: block / BP-DQN / PGD eps 0.5: training seed 1: return of episode 1 is "))
          << e.what();
    }
    ResultCell paper = cell({}), target = cell({}), measure = cell({}), eps = cell({});
    paper.paper = PaperFigure{bad, {}};
    target.target = Target{Target::Sense::at_least, bad};
    measure.measures = {{"x", bad}};
    eps.eps = bad;
    for (const ResultCell& wrong : {paper, target, measure, eps}) {
      EXPECT_THROW(markdown(one_cell(wrong)), InputError);
      EXPECT_THROW(results_page(one_cell(wrong)), InputError);
    }
  }
  // Its mean would be no number.
  EXPECT_THROW(validate(one_cell(cell(seeds({1, 1e308})))), InputError);
}

TEST(ResultFile, GoesOnWhereItStopped) {
  const Scratch scratch;
  const auto path = scratch / "table.json";
  ResultTable plan = one_cell(cell({}));
  plan.configuration = {{"episodes", 2}};
  const auto runs = seeds({1, 2, 3});
  {
    ResultFile file = ResultFile::open(path, plan);
    EXPECT_THROW(ResultFile::open(path, plan), InputError) << "one writer at a time";
    file.put("block", cell({}), runs[0]);
    EXPECT_EQ(read_results(path), file.table()) << "on disk at once";
    EXPECT_THROW(file.put("block", cell({}), runs[0]), InputError) << "the same seed twice";
    SeedRun broken = runs[1];
    broken.returns[0] = sample::nan;
    EXPECT_THROW(file.put("block", cell({}), broken), InputError);
    EXPECT_EQ(read_results(path), file.table()) << "a refused run leaves no trace";
  }
  ResultFile file = ResultFile::open(path, plan);
  EXPECT_TRUE(file.has("block", cell({}), 0));
  EXPECT_FALSE(file.has("block", cell({}), 1));
  EXPECT_FALSE(file.has("other", cell({}), 0));
  file.put("block", cell({}), runs[1]);
  file.put("new block", cell({}), runs[2]);
  EXPECT_EQ(file.table().blocks.size(), 2u);
  EXPECT_EQ(file.table().wall_seconds, 3);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(scratch.path()), {}), 2) << "table and lock, no parts";
}

TEST(ResultFile, RefusesOtherFilesAndLeavesThemAlone) {
  const Scratch scratch;
  const auto path = scratch / "table.json";
  ResultTable plan = one_cell(cell({}));
  for (const std::string& text : {std::string("not json"), std::string("{\"a\": 1}"), std::string(200, '[')}) {
    std::ofstream(path) << text;
    try {
      ResultFile::open(path, plan);
      ADD_FAILURE() << text;
    } catch (const InputError& e) {
      EXPECT_TRUE(std::string(e.what()).starts_with(path.string() + ": ")) << e.what();
    }
    std::stringstream left;
    left << std::ifstream(path).rdbuf();
    EXPECT_EQ(left.str(), text);
  }
  std::filesystem::remove(path);
  { ResultFile::open(path, plan); }
  plan.configuration = {{"episodes", 9}};
  try {
    ResultFile::open(path, plan);
    ADD_FAILURE() << "another configuration";
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("another table (it has no episodes)"), std::string::npos) << e.what();
  }
  EXPECT_THROW(write_results(scratch / "no" / "folder.json", plan), InputError);
  EXPECT_THROW(read_results(scratch / "none.json"), InputError);
  EXPECT_THROW(read_results(scratch.path()), InputError);
}

TEST(ResultFile, TablesOfSeveralMachinesBecomeOne) {
  ResultTable a = one_cell(cell(seeds({1, 2}))), b = one_cell(cell(seeds({1, 2, 3})));
  merge(a, b, "b.json");
  EXPECT_EQ(a.blocks, b.blocks);
  EXPECT_EQ(a.wall_seconds, 1);
  // Measures are means over runs, in whatever order they come together.
  const auto measured = [](std::vector<SeedRun> runs, double measure) {
    ResultTable t = one_cell(cell(std::move(runs)));
    t.blocks[0].cells[0].measures = {{"truth in belief", measure}};
    return t;
  };
  const std::vector<SeedRun> three = seeds({1, 2, 3});
  ResultTable later = measured({three[1], three[2]}, 0.5);
  merge(later, measured({three[0]}, 0.8), "c.json");
  EXPECT_EQ(later.blocks[0].cells[0].runs, three);
  EXPECT_NEAR(later.blocks[0].cells[0].measures[0].second, 0.6, 1e-12);
  ResultTable overlapping = measured({three[0], three[1]}, 0.5);
  merge(overlapping, measured({three[1], three[2]}, 0.8), "d.json");
  EXPECT_EQ(overlapping.blocks[0].cells[0].runs, three);
  EXPECT_TRUE(overlapping.blocks[0].cells[0].measures.empty());
  merge(later, measured({three[0]}, 0.1), "e.json");
  EXPECT_NEAR(later.blocks[0].cells[0].measures[0].second, 0.6, 1e-12) << "nothing new";
  b.blocks[0].cells[0].runs[0].returns[0] += 1;
  EXPECT_THROW(merge(a, b, "b.json"), InputError) << "the same seed, other returns";
}

TEST(Markdown, SaysAllThatTheTableHolds) {
  const std::string text = markdown(sample::table());
  for (const char* words : {"# Gridworld", "## The paper's attacks", "| agent | no attack | PGD, ε = 0.1 |", "not run",
                            "(one seed)", "paper 163 (sd 26)", "**MISS", "met (target ≥ 150)", "cannot be estimated",
                            "not estimable", "truth in belief 1", "maximin_deep table", "\"frames\": 1000000"}) {
    EXPECT_NE(text.find(words), text.npos) << words;
  }
  EXPECT_NE(markdown(ResultTable{}).find("Nothing has been run yet."), std::string::npos);
  EXPECT_EQ(cell_text(cell(seeds({163, 163, 163}))), "163.0 ± 0.0");
  EXPECT_TRUE(cell_text(cell(seeds({-0.01}))).starts_with("0 ± ")) << "no minus before zero";
}

/// The number of cells of each line of the tables: escaped bars do not count.
std::vector<std::size_t> bars(const std::string& text) {
  std::vector<std::size_t> all;
  std::stringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("|")) continue;
    std::size_t n = 0;
    for (std::size_t i = 0; i < line.size(); ++i) n += line[i] == '|' && (i == 0 || line[i - 1] != '\\') ? 1 : 0;
    all.push_back(n);
  }
  return all;
}

TEST(Markdown, HostileNamesBreakNoTable) {
  const ResultTable plain = one_cell(cell(seeds({1, 2})));
  ResultTable hostile = plain;
  ResultCell& c = hostile.blocks[0].cells[0];
  c.agent = "a|b\n| c | d\n<script>`**x**";
  c.note = "```\n# no";
  hostile.command = "```` ```";
  const std::string text = markdown(hostile);
  EXPECT_EQ(bars(text), bars(markdown(plain)));
  EXPECT_EQ(text.find("<script"), text.npos);
  EXPECT_NE(text.find("`````\n```` ```\n`````"), text.npos);
  EXPECT_EQ(bars("| a | b\\| |"), (std::vector<std::size_t>{3}));
}

TEST(ResultsPage, IsWellformedAndStandsAlone) {
  ResultTable empty_block;
  empty_block.blocks = {{"nothing", "", {}}};
  const EpisodeTrace no_steps;
  for (const std::string& html :
       {results_page(ResultTable{}), results_page(empty_block), results_page(sample::table()),
        results_page(one_cell(cell(seeds({3})))), results_page(one_cell(cell({}))),
        results_page(sample::table(), {sample::curve("DQN", 1, 100), {"empty", 2, {{"frames"}, {}}}},
                     {sample::episode(sample::Kind::box_belief, 0.5, 2, 3), no_steps})}) {
    EXPECT_EQ(Wellformed::flaw(html), "");
    for (const char* outside : {"http:", "https:", "src=", "<script", "@import", "url(", "<link"}) {
      EXPECT_EQ(html.find(outside), html.npos) << outside;
    }
  }
}

TEST(ResultsPage, ShowsTheNumbersAndCallsAMissAMiss) {
  const std::string html = results_page(sample::table());
  EXPECT_NE(html.find("22 of 25 cells are done. 1 of 4 targets met."), html.npos);
  EXPECT_NE(html.find("Missed: BP-DQN under PGD"), html.npos);
  EXPECT_NE(html.find("<div class=\"verdict bad\">"), html.npos);
  EXPECT_EQ(occurrences(html, "class=\"figure miss\""), 3u);
  EXPECT_EQ(occurrences(html, "<td class=\"open\""), 3u);
  for (const ResultBlock& b : sample::table().blocks) {
    for (const ResultCell& c : b.cells) EXPECT_NE(html.find("<b>" + cell_text(c) + "</b>"), html.npos) << cell_text(c);
  }
  EXPECT_EQ(occurrences(html, "<circle class=\"seed\" cx=\"22\""), 2u) << "a legend for each block that has run";
  EXPECT_EQ(occurrences(html, "<circle class=\"seed\"") - 2, 16 * 3 + 4 * 3 + 2 * 1u);
  ResultTable good = one_cell(cell(seeds({150, 151, 152}), Target{Target::Sense::at_least, 100}));
  EXPECT_EQ(results_page(good).find("figure miss"), std::string::npos);
  EXPECT_NE(results_page(good).find("<div class=\"verdict\">"), std::string::npos);
}

TEST(ResultsPage, SaysThatOneSeedIsOne) {
  const std::string html = results_page(one_cell(cell(seeds({150}))));
  EXPECT_NE(html.find("nothing here says what another training run would come to"), html.npos);
  EXPECT_NE(html.find("(one seed)"), html.npos);
  EXPECT_NE(html.find("± across seeds: not estimable"), html.npos);
  EXPECT_EQ(results_page(one_cell(cell(seeds({1, 2, 3})))).find("one seed"), std::string::npos);
}

TEST(ResultsPage, EscapesWhatComesFromOutside) {
  const std::string evil = "</title><script>alert(1)</script>\" ' & \xFF";
  ResultTable t = one_cell(cell(seeds({1, 2}), Target{}));
  t.title = t.version = t.command = t.blocks[0].name = t.blocks[0].note = evil;
  t.configuration = {{evil, evil}};
  ResultCell& c = t.blocks[0].cells[0];
  c.agent = c.attack = c.note = evil;
  c.measures = {{evil, 1}};
  c.paper = PaperFigure{1, {}};
  EpisodeTrace trace = sample::episode(sample::Kind::particles, 0.5, 2, 3);
  trace.agent = trace.attack = evil;
  TrainingCurve curve = sample::curve(evil, 1, 100);
  const std::string html = results_page(t, {curve}, {trace});
  EXPECT_EQ(Wellformed::flaw(html), "");
  EXPECT_EQ(html.find("<script"), html.npos);
  EXPECT_GE(occurrences(html, "&lt;script&gt;alert(1)"), 12u);
}

TEST(ResultsPage, SameTableSameBytes) {
  EXPECT_EQ(results_page(sample::table()), results_page(sample::table()));
}

}  // namespace
}  // namespace maximin::deep
