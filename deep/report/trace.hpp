#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include <maximin/gridworld/box_union.hpp>
#include <maximin/gridworld/gridworld.hpp>
#include <maximin/theory/rollout.hpp>

namespace maximin::deep {

/// What an agent holds possible at one moment, as a picture needs it: an area, or points, or neither.
struct TraceBelief {
  std::vector<Box> boxes;       ///< e.g. BoxUnion::boxes()
  std::vector<Point> points;    ///< particles
  std::vector<double> weights;  ///< of the points, not negative; empty: all equal

  bool empty() const { return boxes.empty() && points.empty(); }
  friend bool operator==(const TraceBelief&, const TraceBelief&) = default;
};

struct TraceStep {
  Point truth;         ///< s_t
  Point shown;         ///< what the attacker made of it
  TraceBelief belief;  ///< after the agent took in `shown`
  Action action = 0;   ///< a_t, an index of gridworld::moves
  double reward = 0;   ///< R_t

  friend bool operator==(const TraceStep&, const TraceStep&) = default;
};

/// An episode of the Gridworld, step by step, for pictures. Step k is time k.
struct EpisodeTrace {
  std::string agent;
  std::string attack;
  double eps = 0;  ///< radius of the attack's ball; 0: none is drawn
  std::uint64_t training_seed = 0, evaluation_seed = 0;
  long episode = 0;  ///< drawn from Stream(evaluation_seed, episode)
  std::vector<TraceStep> steps;
  Point end;              ///< where the last step led
  bool terminal = false;  ///< gold or bomb ended it, not the horizon

  /// One step more, as `rollout` and `rollout_in_step` report it.
  void add(const StepRecord<Point, Point, Action>& record, TraceBelief belief);
  double total_reward() const;
  /// In words: "gold after 13 steps, return 188", "bomb ...", "cut after 100 steps, return -100".
  std::string outcome() const;

  friend bool operator==(const EpisodeTrace&, const EpisodeTrace&) = default;
};

/// Throws InputError, "WHERE: step K: what, expected what", where a number is not finite, an action is none, a place is
/// outside the world, or weights do not fit the points.
void validate(const EpisodeTrace& trace, std::string_view where);

/// Schema "maximin-deep-trace" version 1, described in deep/report/README.md. Numbers are written so that reading gives
/// them back exactly. Throws InputError as `validate`.
nlohmann::ordered_json to_json(const EpisodeTrace& trace);
/// Throws InputError, "WHERE: what is wrong, expected ...".
EpisodeTrace trace_from_json(const nlohmann::ordered_json& json, std::string_view where);

void write_trace(const std::filesystem::path& path, const EpisodeTrace& trace);
EpisodeTrace read_trace(const std::filesystem::path& path);

}  // namespace maximin::deep
