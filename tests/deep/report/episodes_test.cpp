#include <cmath>
#include <fstream>
#include <functional>
#include <limits>
#include <regex>
#include <set>
#include <sstream>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <maximin/deep/report/animation.hpp>
#include <maximin/deep/report/map_picture.hpp>
#include <maximin/deep/report/svg_canvas.hpp>
#include <maximin/deep/report/trace.hpp>
#include <maximin/deep/report/training_figures.hpp>
#include <maximin/deep/report/training_log.hpp>
#include <maximin/theory/error.hpp>

#include "../../wellformed.hpp"
#include "sample.hpp"
#include "scratch.hpp"

namespace maximin::deep {
namespace {

using Json = nlohmann::ordered_json;
using Row = std::vector<std::optional<double>>;

std::string refusal(const std::function<void()>& what) {
  try {
    what();
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

std::string text_of(const std::filesystem::path& path) {
  std::stringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

TEST(TrainingLog, IsReadAsWritten) {
  const Scratch scratch;
  const auto path = scratch / "train.csv";
  {
    TrainingLogWriter log(path, {"frames", "return", "loss"});
    log.append({100, -100.25, std::nullopt});
    log.append({200, 0.1, 1e-17});
    EXPECT_NE(refusal([&] { log.append({200, 1, 1}); }).find("frames 200, expected more than 200"), std::string::npos);
    EXPECT_NE(refusal([&] { log.append({300, 1}); }).find("2 values, expected 3"), std::string::npos);
    EXPECT_NE(refusal([&] { log.append({300, sample::nan, 1}); }).find("return is nan"), std::string::npos);
    EXPECT_NE(refusal([&] { log.append({std::nullopt, 1, 1}); }), "");
    EXPECT_NE(refusal([&] {
                TrainingLogWriter(path, {"frames", "return", "loss"});
              }).find("another run"),
              std::string::npos);
  }
  EXPECT_EQ(text_of(path), "frames,return,loss\n100,-100.25,\n200,0.1,1e-17\n");
  const TrainingLog log = read_training_log(path);
  EXPECT_EQ(log.rows, (std::vector<Row>{{100, -100.25, std::nullopt}, {200, 0.1, 1e-17}}));
  EXPECT_EQ(log.column("loss"), 2u);
  EXPECT_FALSE(log.column("exploration"));
}

TEST(TrainingLog, GoesOnFromTheLastCheckpoint) {
  const Scratch scratch;
  const auto path = scratch / "train.csv";
  const std::vector<std::string> columns{"frames", "return"};
  std::ofstream(path) << "frames,return\n100,1\n200,2\n300,3\n40";  // killed in the middle of a row
  EXPECT_EQ(read_training_log(path).rows.size(), 3u);
  {
    TrainingLogWriter log(path, columns, 250);
    log.append({300, 4});
  }
  EXPECT_EQ(text_of(path), "frames,return\n100,1\n200,2\n300,4\n");
  EXPECT_NE(refusal([&] {
              TrainingLogWriter(path, {"frames", "loss"}, 300);
            }).find("columns frames,return, expected"),
            std::string::npos);
  EXPECT_EQ(text_of(path), "frames,return\n100,1\n200,2\n300,4\n") << "refused and left alone";
  { TrainingLogWriter log(path, columns); }
  EXPECT_EQ(text_of(path), "frames,return\n") << "from the start";
  std::ofstream(path) << "fram";  // killed in the middle of the first line
  { TrainingLogWriter log(path, columns, 100); }
  EXPECT_EQ(text_of(path), "frames,return\n");
}

TEST(TrainingLog, RefusesForeignFiles) {
  const Scratch scratch;
  const auto path = scratch / "train.csv";
  const auto says = [&](const std::string& text) {
    std::ofstream(path, std::ios::trunc) << text;
    const std::string words = refusal([&] { read_training_log(path); });
    EXPECT_EQ(words.find('\n'), words.npos);
    return words.substr(std::min(words.size(), path.string().size()));
  };
  EXPECT_EQ(says("frames,x\n1,2\n"), "");
  EXPECT_EQ(says(""), ": empty, expected a training log");
  EXPECT_EQ(says("{}\n").substr(0, 4), ":1: ");
  EXPECT_EQ(says("frames,x,x\n"), ":1: column x twice, expected the columns of a training log");
  EXPECT_EQ(says("frames,x\n1\n"), ":2: 1 fields, expected 2");
  EXPECT_EQ(says("frames,x\n1,nan\n"), ":2: x is 'nan', expected a finite number or nothing");
  EXPECT_EQ(says("frames,x\n1,2z\n"), ":2: x is '2z', expected a finite number or nothing");
  EXPECT_EQ(says("frames,x\n2,1\n1,1\n"), ":3: frames do not rise, expected more than in the row before");
  EXPECT_NE(refusal([&] { read_training_log(scratch / "none"); }), "");
  EXPECT_NE(refusal([&] { TrainingLogWriter(scratch / "t", {"loss"}); }), "");
  EXPECT_NE(refusal([&] { TrainingLogWriter(scratch / "t", {"frames", "a,b"}); }), "");
  EXPECT_NE(refusal([&] { TrainingLogWriter(scratch / "no" / "t", {"frames"}); }), "");
}

TEST(TrainingFigures, DrawWhatIsThere) {
  TrainingCurve a{"A", 1, {{"frames", "return"}, {{0, 0}, {10, 10}, {20, std::nullopt}, {30, 30}}}};
  EXPECT_EQ(value_at(a.log, 1, 5), 5.0);
  EXPECT_EQ(value_at(a.log, 1, 20), 20.0) << "across the row without a value";
  EXPECT_EQ(value_at(a.log, 1, 30), 30.0);
  EXPECT_FALSE(value_at(a.log, 1, 31));
  EXPECT_FALSE(value_at(a.log, 1, -1));
  TrainingCurve b = a;
  b.training_seed = 2;
  EXPECT_EQ(occurrences(training_figures({a}), "class=\"band"), 0u);
  EXPECT_EQ(occurrences(training_figures({a, b}), "class=\"band"), 1u);
  EXPECT_EQ(occurrences(training_figures({a, b}), "<figure>"), 1u) << "no loss, no exploration";
  EXPECT_EQ(training_figures({}), "");
  EXPECT_EQ(training_figures({{"A", 1, {{"frames"}, {{1}}}}}), "");
  std::vector<TrainingCurve> many;
  for (int k = 0; k < 9; ++k) many.push_back(sample::curve("agent " + std::to_string(k), 1, 100));
  EXPECT_EQ(occurrences(training_figures(many), "<figure>"), 6u) << "no more lines than colours in a picture";
}

TEST(Trace, JsonGivesBackTheEpisode) {
  const Scratch scratch;
  for (const auto kind : {sample::Kind::box_belief, sample::Kind::particles, sample::Kind::no_belief}) {
    const EpisodeTrace trace = sample::episode(kind, 0.5, 3, 8);
    ASSERT_GT(trace.steps.size(), 5u);
    write_trace(scratch / "t.json", trace);
    EXPECT_EQ(read_trace(scratch / "t.json"), trace);
  }
  const EpisodeTrace trace = sample::episode(sample::Kind::box_belief, 0.5, 0, 8);
  EXPECT_EQ(trace.outcome(), "gold after " + std::to_string(trace.steps.size()) + " steps, return " +
                                 std::to_string(201 - static_cast<long>(trace.steps.size())));
}

TEST(Trace, RefusesWhatIsNone) {
  const auto says = [](const std::function<void(EpisodeTrace&)>& change) {
    EpisodeTrace trace = sample::episode(sample::Kind::particles, 0.5, 3, 8);
    change(trace);
    return refusal([&] { to_json(trace); });
  };
  EXPECT_EQ(says([](EpisodeTrace&) {}), "");
  EXPECT_TRUE(says([](EpisodeTrace& t) { t.steps[2].truth.x = sample::nan; }).starts_with("trace: step 2: truth (nan"));
  EXPECT_NE(says([](EpisodeTrace& t) { t.steps[2].shown.y = 1e9; }), "");
  EXPECT_NE(says([](EpisodeTrace& t) { t.steps[2].action = 8; }), "");
  EXPECT_NE(says([](EpisodeTrace& t) { t.steps[2].reward = sample::nan; }), "");
  EXPECT_NE(says([](EpisodeTrace& t) { t.steps[2].belief.points[0].x = sample::nan; }), "");
  EXPECT_NE(says([](EpisodeTrace& t) { t.steps[2].belief.weights.pop_back(); }), "");
  EXPECT_NE(says([](EpisodeTrace& t) { t.steps[2].belief.weights[0] = sample::nan; }), "");
  EXPECT_NE(says([](EpisodeTrace& t) { t.steps[2].belief.boxes = {{2, 1, 0, 1}}; }), "");
  EXPECT_NE(says([](EpisodeTrace& t) { t.eps = -1; }), "");
  EXPECT_NE(says([](EpisodeTrace& t) { t.end.x = 11; }), "");
  const Json good = to_json(sample::episode(sample::Kind::particles, 0.5, 3, 8));
  const auto reading = [&](const std::function<void(Json&)>& change) {
    Json json = good;
    change(json);
    return refusal([&] { trace_from_json(json, "t"); });
  };
  EXPECT_EQ(reading([](Json&) {}), "");
  EXPECT_EQ(reading([](Json& j) { j["steps"][1]["action"] = 9; }), "t: steps[1].action: 9, expected 0 to 7");
  EXPECT_EQ(reading([](Json& j) { j["steps"][1]["truth"] = {1}; }), "t: steps[1].truth: 1 numbers, expected 2");
  EXPECT_EQ(reading([](Json& j) { j["steps"][1]["particles"][0] = {1}; }),
            "t: steps[1].particles[0]: [1], expected 2 numbers");
  EXPECT_NE(reading([](Json& j) { j["schema"] = "maximin-deep-results"; }), "");
  EXPECT_NE(reading([](Json& j) { j.erase("end"); }), "");
}

TEST(MapPicture, ShowsEveryStepOnce) {
  const EpisodeTrace trace = sample::episode(sample::Kind::box_belief, 0.5, 3, 8);
  const std::vector<long> at = moments(trace, 4);
  EXPECT_EQ(at.size(), 4u);
  EXPECT_EQ(at.front(), 0);
  EXPECT_EQ(at.back(), static_cast<long>(trace.steps.size()) - 1);
  EXPECT_TRUE(moments(sample::episode(sample::Kind::no_belief, 0.5, 3, 8), 4).empty());
  const std::string svg = path_picture(trace, {at, true, ""});
  EXPECT_EQ(Wellformed::flaw(svg), "");
  EXPECT_EQ(occurrences(svg, "<circle class=\"shown\""), trace.steps.size());
  EXPECT_EQ(occurrences(inside(svg, "<path class=\"path\"", "/>"), "L"), trace.steps.size());
  EXPECT_EQ(occurrences(svg, "class=\"area\""), 4u);
  EXPECT_EQ(occurrences(svg, "class=\"star\""), 1u);
  EXPECT_EQ(occurrences(inside(svg, "<path class=\"wall\"", "/>"), "h40v-40h-40z"), 32u) << "68 cells are free";
  EXPECT_NE(svg.find(trace.outcome()), svg.npos);
  for (std::size_t k = 0; k < trace.steps.size(); ++k) {
    const std::string moment = moment_picture(trace, static_cast<long>(k));
    EXPECT_EQ(Wellformed::flaw(moment), "");
    EXPECT_NE(moment.find("t = " + std::to_string(k) + "<"), moment.npos);
  }
  EXPECT_THROW(moment_picture(trace, 1000), std::out_of_range);
}

TEST(MapPicture, TheOutlineLeavesOutWhatIsInside) {
  const auto length = [](const std::string& svg) {
    const std::string d = inside(svg, "<path class=\"area-edge\"", "/>");
    const std::regex part("M([-0-9.]+) ([-0-9.]+)([VH])([-0-9.]+)");
    double sum = 0;
    for (auto i = std::sregex_iterator(d.begin(), d.end(), part); i != std::sregex_iterator(); ++i) {
      sum += std::abs(std::stod((*i)[4]) - std::stod((*i)[(*i)[3] == "V" ? 2 : 1]));
    }
    return sum / MapFrame::unit;
  };
  const MapFrame f;
  EXPECT_NEAR(length(svg_area(f, {{1, 2, 1, 2}})), 4, 1e-9);
  EXPECT_NEAR(length(svg_area(f, {{1, 2, 1, 2}, {2, 3, 1, 2}})), 6, 1e-9) << "side by side";
  EXPECT_NEAR(length(svg_area(f, {{1, 2, 1, 2}, {1, 2, 1, 2}})), 4, 1e-9) << "the same twice";
  EXPECT_NEAR(length(svg_area(f, {{1, 3, 1, 2}, {1, 2, 2, 3}})), 8, 1e-9) << "an L";
  EXPECT_NEAR(length(svg_area(f, {{1, 2, 1, 2}, {2, 3, 2, 3}})), 8, 1e-9) << "corner to corner";
  EXPECT_NEAR(length(svg_area(f, {{9, 12, 9, 12}})), 4, 1e-9) << "cut to the world";
  EXPECT_EQ(svg_area(f, {}), "");
}

TEST(Animation, MovesAllThroughTheEpisode) {
  for (const auto kind : {sample::Kind::box_belief, sample::Kind::particles, sample::Kind::no_belief}) {
    const EpisodeTrace trace = sample::episode(kind, 0.5, 3, 8);
    const std::string svg = animated_svg(trace);
    EXPECT_EQ(Wellformed::flaw(svg), "");
    EXPECT_TRUE(svg.starts_with("<svg xmlns=\"http://www.w3.org/2000/svg\""));
    EXPECT_EQ(svg.find("<script"), svg.npos);
    EXPECT_EQ(occurrences(svg, "attributeName=\"visibility\""), trace.steps.size() + 1);
    EXPECT_EQ(occurrences(svg, "<g visibility=\"visible\""), 1u) << "the first moment, where nothing can move";
    for (std::size_t k = 0; k <= trace.steps.size(); ++k) {
      EXPECT_EQ(occurrences(svg, ">t = " + std::to_string(k) + "<"), 1u);
    }
    const bool gold = gridworld::cell(trace.end) == gridworld::Cell::gold;
    EXPECT_EQ(svg.find("reached the gold") != svg.npos, trace.terminal && gold);
    EXPECT_EQ(svg.find("held possible") == svg.npos, kind == sample::Kind::no_belief);
  }
}

/// What SMIL asks of an animation: as many times as values, from 0 to 1, never falling.
std::string flaw_of_times(const std::string& svg) {
  const std::string between = "\" keyTimes=\"";  // std::regex recurses on long texts
  for (auto at = svg.find(between); at != svg.npos; at = svg.find(between, at + 1)) {
    const auto begin = svg.rfind('"', at - 1) + 1, later = at + between.size();
    const std::string all_values = svg.substr(begin, at - begin),
                      all_times = svg.substr(later, svg.find('"', later) - later);
    std::stringstream values(all_values), times(all_times);
    std::vector<double> t;
    std::size_t n = 0;
    for (std::string v; std::getline(values, v, ';');) ++n;
    for (std::string v; std::getline(times, v, ';');) t.push_back(std::stod(v));
    if (t.size() != n) return "as many times as values: " + all_times;
    if (t.front() != 0) return "begins at 0";
    if (!std::is_sorted(t.begin(), t.end()) || t.back() > 1) return "rises to 1: " + all_times;
    const bool discrete = all_values.find("visible") != std::string::npos;
    if (!discrete && t.back() != 1) return "ends at 1: " + all_times;
  }
  return "";
}

TEST(Animation, TimesAreInOrder) {
  EXPECT_NE(flaw_of_times("values=\"1;2\" keyTimes=\"0;1;1\""), "");
  EXPECT_NE(flaw_of_times("values=\"1;2\" keyTimes=\"0;0.9\""), "");
  EXPECT_NE(flaw_of_times("values=\"1;2;3\" keyTimes=\"0;0.9;0.8\""), "");
  EXPECT_EQ(flaw_of_times("values=\"1;2;3\" keyTimes=\"0;0.9;1\""), "");
  EpisodeTrace trace = sample::episode(sample::Kind::box_belief, 0.5, 3, 8);
  EXPECT_EQ(flaw_of_times(animated_svg(trace)), "");
  while (trace.steps.size() < 500) trace.steps.push_back(trace.steps[trace.steps.size() / 2]);
  trace.terminal = false;
  trace.end = trace.steps.back().truth;
  const std::string svg = animated_svg(trace, {0.01, 0.01, true});
  EXPECT_EQ(flaw_of_times(svg), "");
  EXPECT_NE(svg.find("time is up"), svg.npos);
  EXPECT_LT(svg.size(), 1'500'000u);
}

TEST(Animation, RefusesAndEscapes) {
  EpisodeTrace trace = sample::episode(sample::Kind::box_belief, 0.5, 3, 8);
  for (const AnimationOptions& bad : {AnimationOptions{0, 1, true}, AnimationOptions{sample::nan, 1, true},
                                      AnimationOptions{1, -1, true}, AnimationOptions{1e9, 1, true}}) {
    EXPECT_NE(refusal([&] { animated_svg(trace, bad); }), "");
  }
  EXPECT_EQ(refusal([] { animated_svg({}); }), "trace: no steps, expected at least one to show");
  trace.agent = trace.attack = "<script>&\"'\xFF" + std::string(80, 'x');
  const std::string svg = animated_svg(trace);
  EXPECT_EQ(Wellformed::flaw(svg), "");
  EXPECT_EQ(svg.find("<script"), svg.npos);
  EXPECT_NE(svg.find("class=\"title\" style=\"font-size:"), svg.npos) << "a long title is smaller";
  trace.steps[1].shown.x = sample::nan;
  EXPECT_NE(refusal([&] { animated_svg(trace); }), "");
}

}  // namespace
}  // namespace maximin::deep
