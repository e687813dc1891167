#include <filesystem>
#include <iostream>

#include <maximin/deep/report/animation.hpp>
#include <maximin/deep/report/map_picture.hpp>
#include <maximin/deep/report/results_file.hpp>
#include <maximin/deep/report/results_page.hpp>
#include <maximin/deep/report/results_text.hpp>
#include <maximin/models/files/output_file.hpp>

#include "sample.hpp"

/// deep_report_example FOLDER: writes what the deep layer shows, with real episodes and made-up numbers, to look at.
int main(int argc, char** argv) {
  using namespace maximin::deep;
  using maximin::Overwrite, maximin::write_file;
  if (argc != 2) {
    std::cerr << "usage: deep_report_example FOLDER\n";
    return 2;
  }
  const std::filesystem::path folder(argv[1]);
  std::filesystem::create_directories(folder);
  const ResultTable table = sample::table();
  std::vector<TrainingCurve> curves;
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    curves.push_back(sample::curve("DQN", seed, 150));
    curves.push_back(sample::curve("SA-DQN", seed + 10, 140));
    curves.push_back(sample::curve("BP-DQN", seed + 20, 175));
  }
  std::vector<EpisodeTrace> traces;
  for (const auto kind : {sample::Kind::box_belief, sample::Kind::particles, sample::Kind::no_belief}) {
    traces.push_back(sample::episode(kind, 0.5, 0, 19));
    traces.push_back(sample::episode(kind, 0.5, 2, 19));
    traces.push_back(sample::episode(kind, 1.0, 24, 19));
  }
  write_results(folder / "table.json", table);
  write_file(folder / "table.md", markdown(table), Overwrite::replace);
  write_file(folder / "table.html", results_page(table, curves, traces), Overwrite::replace);
  write_trace(folder / "episode.json", traces[2]);
  write_file(folder / "episode.svg", animated_svg(traces[2]), Overwrite::replace);
  write_file(folder / "particles.svg", animated_svg(traces[5]), Overwrite::replace);
  write_file(folder / "path.svg", standalone_svg(path_picture(traces[2], {moments(traces[2], 4), true, ""})),
             Overwrite::replace);
}
