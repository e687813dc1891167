#include <cmath>
#include <limits>
#include <regex>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include <nlohmann/json.hpp>

#include <maximin/models/make_perturbation.hpp>
#include <maximin/models/random_lipschitz_mdp.hpp>
#include <maximin/proofs_check/campaign_summary.hpp>
#include <maximin/proofs_check/report/campaign_figures.hpp>
#include <maximin/proofs_check/report/html_report.hpp>
#include <maximin/proofs_check/report/html_text.hpp>
#include <maximin/proofs_check/report/svg_plot.hpp>
#include <maximin/theory/random.hpp>

#include "../wellformed.hpp"

namespace maximin {
namespace {

using namespace report;
using Json = nlohmann::ordered_json;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// A made-up record with plausible numbers: every bound at `right` times the trivial one, the gap at `share` of that.
TrialRecord record(long trial, double right = 0.5, double share = 0.2) {
  TrialRecord r{trial, trial % 2 == 0 ? "broad" : "sparse", {}};
  Examination& e = r.found;
  Stream rng(7, static_cast<std::uint64_t>(trial));
  e.states = 3 + rng.below(20);
  e.actions = 2 + rng.below(3);
  e.discount = rng.uniform(0.1, 0.95);
  e.eps = e.radius = rng.uniform(0.01, 0.5);
  e.constants.l_r.value = rng.uniform(0.1, 2);
  e.constants.span = rng.uniform(0.5, 2);
  e.trivial = e.discount * e.constants.span / (1 - e.discount);
  e.fate = trial % 10 == 3 ? Fate::cycles : Fate::settled;
  e.period = e.fate == Fate::cycles ? 3 : 1;
  e.iterations = 100;
  e.largest_ball = 2;
  for (Check& c : e.checks) {
    const double bound = right * e.trivial * rng.uniform(0.9, 1);
    c.observe(share * bound, bound, 1e-12, 17);
  }
  e.gap = e.check(ClaimId::b_one_sided).left;
  return r;
}

Records many(long n, double right = 0.5, double share = 0.2) {
  Records records;
  for (long k = 0; k < n; ++k) records.push_back(record(k, right, share));
  return records;
}

const Json configuration{{"reading", "corrected"}, {"seed", 7}, {"trials", 5}};

std::string page_of(const Records& records) {
  return html_report(configuration, records, summarise(records));
}

TEST(Wellformed, SeesWhatIsNot) {
  EXPECT_EQ(Wellformed::flaw("<!DOCTYPE html>\n<p class=\"a\">x &lt; y<br/></p>"), "");
  for (const char* bad :
       {"<p>", "<p></b></p>", "</p>", "<p a=b></p>", "a & b", "<p title=\"<\"></p>", "x < y", "\x01"}) {
    EXPECT_NE(Wellformed::flaw(bad), "") << bad;
  }
}

TEST(ReportText, NumbersForPeople) {
  EXPECT_EQ(count(0), "0");
  EXPECT_EQ(count(999), "999");
  EXPECT_EQ(count(1234567), "1,234,567");
  EXPECT_EQ(count(-123456), "-123,456");
  EXPECT_EQ(number(0.123456), "0.123");
  EXPECT_EQ(number(12345), "12,345");
  EXPECT_EQ(number(1.5e-9), "1.50e-9");
  EXPECT_EQ(number(-2e30), "-2.00e30");
  EXPECT_EQ(number(nan), "not finite");
  EXPECT_EQ(percent(0, 3), "0%");
  EXPECT_EQ(percent(3, 3), "100%");
  EXPECT_EQ(percent(1, 1'000'000), "<0.1%");
  EXPECT_EQ(percent(999'999, 1'000'000), ">99.9%");
  EXPECT_EQ(percent(61, 100), "61%");
  EXPECT_EQ(percent(0, 0), "-");
}

TEST(ReportText, EscapesMarkupAndBrokenBytes) {
  EXPECT_EQ(escape("a<b> & \"c\" 'd'"), "a&lt;b&gt; &amp; &quot;c&quot; &#39;d&#39;");
  EXPECT_EQ(escape("\xCE\xB3 stays"), "\xCE\xB3 stays");
  EXPECT_EQ(escape(std::string_view("\0\x1B", 2)), "\xEF\xBF\xBD\xEF\xBF\xBD");
  EXPECT_EQ(escape("\xC0\xAF"), "\xEF\xBF\xBD\xEF\xBF\xBD") << "overlong";
  EXPECT_EQ(escape("x\xE2\x82"), "x\xEF\xBF\xBD\xEF\xBF\xBD") << "cut short";
}

RC_GTEST_PROP(ReportText, AnyBytesBecomeWellformedText, (const std::vector<unsigned char>& bytes)) {
  const std::string text = escape(std::string(bytes.begin(), bytes.end()));
  RC_ASSERT(Wellformed::flaw("<p title=\"" + text + "\">" + text + "</p>") == "");
  RC_ASSERT(escape("\xCE\xB3" + std::string(bytes.begin(), bytes.end())).starts_with("\xCE\xB3"));
}

RC_GTEST_PROP(ReportAxis, RoundTicksCoverWhatWasAsked, ()) {
  const auto ends = [] {
    const double a = *rc::gen::inRange(-1'000'000, 1'000'000), b = *rc::gen::inRange(-1'000'000, 1'000'000);
    return std::pair(std::min(a, b), std::max(a, b));
  };
  const double unit = std::pow(10.0, *rc::gen::inRange(-12, 12));
  const auto [low, high] = ends();
  const auto [least, most] = ends();  // of the logarithm, in units of 1e-5: from 1e-10 to 1e10
  for (const auto& [axis, from, to] :
       {std::tuple(Axis::linear(low * unit, high * unit), low * unit, high * unit),
        std::tuple(Axis::logarithmic(std::pow(10, least * 1e-5), std::pow(10, most * 1e-5)), std::pow(10, least * 1e-5),
                   std::pow(10, most * 1e-5))}) {
    RC_ASSERT(axis.ticks().size() >= 2u);
    RC_ASSERT(axis.ticks().size() <= 12u);
    for (std::size_t i = 1; i < axis.ticks().size(); ++i) {
      RC_ASSERT(axis.ticks()[i - 1].value < axis.ticks()[i].value);
      RC_ASSERT(axis.ticks()[i - 1].label != axis.ticks()[i].label);
      RC_ASSERT(axis.at(axis.ticks()[i - 1].value) < axis.at(axis.ticks()[i].value));
    }
    RC_ASSERT(axis.shows(from));
    RC_ASSERT(axis.shows(to));
  }
}

TEST(ReportAxis, TicksAreRound) {
  const auto labels = [](const Axis& axis) {
    std::string all;
    for (const Tick& t : axis.ticks()) all += t.label + " ";
    return all;
  };
  EXPECT_EQ(labels(Axis::linear(0, 1)), "0.0 0.2 0.4 0.6 0.8 1.0 ");
  EXPECT_EQ(labels(Axis::linear(3, 103, 4)), "0 20 40 60 80 100 120 ");
  EXPECT_EQ(labels(Axis::logarithmic(0.3, 7)), "0.2 0.5 1 2 5 10 ");
  EXPECT_EQ(labels(Axis::logarithmic(1e-5, 1)), "10⁻⁵ 10⁻⁴ 0.001 0.01 0.1 1 ");
  EXPECT_EQ(labels(Axis::logarithmic(0.01, 100, true)), "0 0.01 0.1 1 10 100 ");
}

TEST(ReportAxis, HasEndsWhateverIsAsked) {
  for (const double low : {nan, -1.0, 0.0, 3.0, 1e300}) {
    for (const double high : {nan, -1.0, 0.0, 3.0, std::numeric_limits<double>::infinity()}) {
      for (const Axis& axis : {Axis::linear(low, high), Axis::logarithmic(low, high, true)}) {
        EXPECT_LT(axis.low(), axis.high());
        EXPECT_GE(axis.at(nan), 0);
        EXPECT_LE(axis.at(1e308), 1);
      }
    }
  }
}

TEST(ReportAxis, ZeroHasAPlaceBelowTheLowestTick) {
  const Axis axis = Axis::logarithmic(0.001, 1, true);
  EXPECT_GT(axis.at(0), 0);
  EXPECT_LT(axis.at(0), axis.at(0.001));
  EXPECT_FALSE(axis.shows(0));
  EXPECT_EQ(axis.at(1e-9), axis.at(0));
}

TEST(ReportPlot, ThinsEvenlyAndOnlyWhenItMust) {
  EXPECT_EQ(thinned(3, 10), (std::vector<std::size_t>{0, 1, 2}));
  EXPECT_EQ(thinned(10, 5), (std::vector<std::size_t>{0, 2, 4, 6, 8}));
  EXPECT_TRUE(thinned(0, 5).empty());
  EXPECT_EQ(thinned(100'000, 600).size(), 600u);
}

TEST(ReportFigures, EveryPointIsDrawnInItsGroup) {
  Records records = many(40, 0.5);
  for (const TrialRecord& r : many(30, 3.0)) records.push_back(r);
  for (Check& c : records[5].found.checks) c = {};          // not asked: no point
  for (Check& c : records[6].found.checks) c.left = 1e-15;  // within the slack: a stroke at the foot
  records[7].found.trivial = 0;                             // nothing to lose: no place, but counted
  const GapAgainstBound data = gap_against_bound(records, ClaimId::b_one_sided);
  EXPECT_EQ(data.informative.size(), 38u);
  EXPECT_EQ(data.vacuous.size(), 30u);
  EXPECT_EQ(data.no_span, 1);
  const std::string html = scatter_figure(records);
  const std::string panels = html.substr(0, html.find("<div class=\"reading\""));
  EXPECT_EQ(occurrences(inside(panels, "<g class=\"marks good\"", "</g>"), "<circle "), 7 * 37u);
  EXPECT_EQ(occurrences(panels, "v9\"><title>trial 6:"), 7u);
  EXPECT_EQ(occurrences(inside(panels, "<g class=\"marks plain\"", "</g>"), "<circle "), 7 * 30u);
  EXPECT_EQ(occurrences(html, "1 with constant rewards left out"), 7u);
  EXPECT_NE(html.find("upright stroke", panels.size()), html.npos);
}

TEST(ReportFigures, ManyVacuousPointsShareOnePath) {
  const std::string html = scatter_figure(many(200, 3.0));
  EXPECT_EQ(occurrences(inside(html, "<path class=\"specks plain\" d", "/>"), "h0"), 7 * 200u);
  EXPECT_EQ(html.find("<title>trial "), html.npos);
}

TEST(ReportFigures, TooManyPointsAreThinnedAndThePageStaysSmall) {
  Records records = many(6000, 0.5);
  for (TrialRecord& r : many(6000, 3.0)) records.push_back(std::move(r));
  for (std::size_t k = 0; k < records.size(); ++k) records[k].trial = static_cast<long>(k);
  const std::string html = page_of(records);
  EXPECT_EQ(occurrences(html, "<title>trial "), 7 * most_marks);
  EXPECT_EQ(occurrences(html, "2,100 of them drawn"), 7u);
  EXPECT_LT(html.size(), 1'000'000u);
}

TEST(ReportFigures, ViolationsAreCrosses) {
  Records records = many(10);
  for (const std::size_t k : {2u, 8u}) {
    records[k].found.check(ClaimId::e_test_time) = {};
    records[k].found.check(ClaimId::e_test_time).observe(10, 6, 1e-12);
  }
  const std::string html = scatter_figure(records);
  EXPECT_EQ(occurrences(html, "l10 10m0-10l-10 10"), 2u);
  EXPECT_EQ(occurrences(html, "violated on 2"), 1u);
  EXPECT_EQ(html.find("no point lies above"), html.npos);
}

TEST(ReportFigures, HeatMapCountsEveryModelOnce) {
  const std::string html = informativeness_figure(many(200));
  long total = 0;
  const std::regex cell("<title>([0-9]+) of ([0-9]+) trials</title>");
  for (auto i = std::sregex_iterator(html.begin(), html.end(), cell); i != std::sregex_iterator(); ++i) {
    total += std::stol((*i)[2]);
  }
  EXPECT_EQ(total, 7 * 200);
}

TEST(ReportFigures, NothingToDrawIsNothing) {
  EXPECT_EQ(scatter_figure({}), "");
  EXPECT_EQ(tightness_figure({}), "");
  EXPECT_EQ(informativeness_figure({}), "");
  EXPECT_EQ(fate_and_regime_figure({}), "");
}

TEST(Report, IsWellformedAndStandsAlone) {
  for (const Records& records : {Records{}, many(1), many(50), many(20, 4.0), many(3, 1e-9, 0.0), many(5, 0.0)}) {
    const std::string html = page_of(records);
    EXPECT_EQ(Wellformed::flaw(html), "");
    for (const char* outside : {"http:", "https:", "src=", "<script", "@import", "url(", "<link"}) {
      EXPECT_EQ(html.find(outside), html.npos) << outside;
    }
  }
}

TEST(Report, SameRecordsSameBytes) {
  EXPECT_EQ(page_of(many(100)), page_of(many(100)));
  EXPECT_NE(page_of(many(100)), page_of(many(100, 0.4)));
}

TEST(Report, EscapesWhatComesFromOutside) {
  Records records = many(2);
  records[0].family = "<script>alert(1)</script>";
  records[1].family = "\xFF & \"co\"";
  const Json hostile{{"reading", "corrected"}, {"seed", "</pre><script>"}, {"model", "a\xFF<b>"}};
  const std::string html = html_report(hostile, records, summarise(records), "--seed '<1>'");
  EXPECT_EQ(Wellformed::flaw(html), "");
  EXPECT_EQ(html.find("<script"), html.npos);
  EXPECT_NE(html.find("&lt;script&gt;alert(1)"), html.npos);
  const std::string model = html_report(hostile, records[0]);
  EXPECT_EQ(Wellformed::flaw(model), "");
  EXPECT_EQ(model.find("<script"), model.npos);
}

TEST(Report, CallsAVacuousCampaignWhatItIs) {
  const std::string html = page_of(many(5, 2.0));
  EXPECT_NE(html.find("nothing verified: every bound was vacuous on all 5 models"), html.npos);
  EXPECT_EQ(page_of(many(5)).find("nothing verified"), std::string::npos);
}

TEST(Report, ViolationsComeFirstWithTheirTrialsAndHowToReplayThem) {
  Records records = many(5);
  records[3].found.check(ClaimId::theorem_1).observe(10, 6, 1e-12, 4);
  records[4].found.check(ClaimId::lemma_2).observe(nan, 6, 1e-12, 2);
  const std::string html = html_report(configuration, records, summarise(records), "--seed 7 --family costs");
  EXPECT_EQ(Wellformed::flaw(html), "");
  EXPECT_NE(html.find("Violated: 2 of 5 models break a claim."), html.npos);
  EXPECT_NE(html.find("theorem-1 (1 trial)"), html.npos);
  EXPECT_NE(html.find("<span>--family</span> <span>costs</span> <span>--replay 3</span>"), html.npos);
  EXPECT_NE(html.find("not finite"), html.npos);
  EXPECT_LT(html.find("<h2>Violations"), html.find("<h2>The claims"));
  EXPECT_NE(html.find("class=\"bad-text\">trial 4<"), html.npos);
  EXPECT_EQ(page_of(many(5)).find("<h2>Violations"), std::string::npos);
}

TEST(Report, TellsOfWhatWasNotDecided) {
  Records records = many(5);
  records[1].found.check(ClaimId::f_belief) = {};
  records[1].found.check(ClaimId::f_belief).verdict = Verdict::undetermined;
  records[2].found.failed_assumption = "Assumption 1: states 0 and 1";
  for (Check& c : records[2].found.checks) c = {}, c.verdict = Verdict::assumption_fails;
  Json interrupted = configuration;
  interrupted["trials"] = 2000;
  const std::string html = html_report(interrupted, records, summarise(records));
  EXPECT_NE(html.find("A budget ran out on 1 trial; undetermined there: F (1 trial)."), html.npos);
  EXPECT_NE(html.find("An assumption of the claims fails on 1 trial"), html.npos);
  EXPECT_NE(html.find("5 of 2,000 trials are done"), html.npos);
}

TEST(Report, ReplayFallsBackOnTheSeedOfTheConfiguration) {
  EXPECT_NE(page_of(many(3)).find("<span>--seed</span> <span>7</span> <span>--replay "), std::string::npos);
}

TEST(ModelReport, ShowsBothSidesAndTheRounds) {
  const Examination& e = record(1).found;
  RoundSeries rounds{{1, 0.5, 0.25, 0.25}, {{ClaimId::c_finite_n, {4, 2, 1, 1}}}};
  const std::string html = html_report(configuration, TrialRecord{0, "tiger", e}, rounds);
  EXPECT_EQ(Wellformed::flaw(html), "");
  EXPECT_NE(html.find("All 11 claims hold on this model."), html.npos);
  EXPECT_EQ(occurrences(html, "class=\"interval "), claim_count);
  EXPECT_NE(html.find("<h2>Round by round"), html.npos);
  EXPECT_EQ(occurrences(inside(html, "<path class=\"line s0\" d=\"M", "/>"), "L"), 3u);
  EXPECT_EQ(html_report(configuration, record(1)).find("<h2>Round by round"), std::string::npos) << "none were given";
}

TEST(ModelReport, SaysWhatFailed) {
  TrialRecord bad = record(1);
  bad.found.check(ClaimId::theorem_1).observe(10, 6, 0);
  EXPECT_NE(html_report(configuration, bad).find("Violated on this model: theorem-1."), std::string::npos);
  TrialRecord none = record(1);
  none.found.failed_assumption = "Assumption 1: states 0 & 1";
  for (Check& c : none.found.checks) c = {}, c.verdict = Verdict::assumption_fails;
  const std::string html = html_report(configuration, none);
  EXPECT_EQ(Wellformed::flaw(html), "");
  EXPECT_NE(html.find("An assumption of the claims fails on this model"), html.npos);
  EXPECT_NE(html.find("states 0 &amp; 1"), html.npos);
  TrialRecord open = record(1);
  open.found.check(ClaimId::f_belief) = {};
  open.found.check(ClaimId::f_belief).verdict = Verdict::undetermined;
  EXPECT_NE(html_report(configuration, open).find("Open: F."), std::string::npos);
}

TEST(ModelReport, TakesWhatExamineFinds) {
  Records records;
  for (long k = 0; k < 20; ++k) {
    Stream rng(3, static_cast<std::uint64_t>(k));
    LipschitzMdpOptions options;
    options.states = 5;
    const Model<double> model = random_lipschitz_mdp(options, rng);
    const auto perturbation = make_perturbation(model);
    records.push_back({k, "lipschitz", examine(model.mdp, perturbation)});
    const Examination& found = records.back().found;
    const RoundSeries rounds = round_series(model.mdp, perturbation);
    ASSERT_EQ(static_cast<long>(rounds.gap.size()), found.iterations);
    ASSERT_EQ(rounds.bounds.size(), 2u);
    for (const auto& [id, bound] : rounds.bounds) {
      const auto n = static_cast<std::size_t>(found.check(id).n);
      EXPECT_EQ(rounds.gap[n], found.check(id).left) << "the tightest round is one of the series";
      EXPECT_EQ(bound[n], found.check(id).right);
    }
    EXPECT_EQ(Wellformed::flaw(html_report(configuration, records.back(), rounds)), "");
  }
  EXPECT_EQ(Wellformed::flaw(page_of(records)), "");
  EXPECT_EQ(gap_against_bound(records, ClaimId::theorem_1).size(), 20u);
}

}  // namespace
}  // namespace maximin
