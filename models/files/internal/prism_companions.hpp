#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <maximin/models/files/internal/gzip.hpp>
#include <maximin/models/files/internal/number.hpp>
#include <maximin/models/files/internal/text_lines.hpp>
#include <maximin/models/files/prism_explicit.hpp>

/// The small files beside a .tra file.
namespace maximin::internal {

/// Finds and reads the files beside `tra`; the notes say which reward structure was taken where there are several.
/// Throws InputError when the one asked for is not there.
PrismCompanions find_prism_companions(const std::filesystem::path& tra, const ReadOptions& options,
                                      std::vector<std::string>& notes);

/// The states labelled "init" of a .lab file, in PRISM's or Storm's dialect; ascending.
std::vector<State> initial_states(const NamedText& lab, std::uint64_t states);

/// Uniform over the initial states; empty when there are none.
template <class Scalar>
std::vector<Scalar> read_initial_states(const NamedText& lab, std::uint64_t states) {
  const std::vector<State> initial = initial_states(lab, states);
  if (initial.empty()) return {};
  std::vector<Scalar> start(states, Scalar(0));
  for (const State s : initial) {
    start[static_cast<std::size_t>(s)] = Scalar(Scalar(1) / Scalar(static_cast<long>(initial.size())));
  }
  return start;
}

/// The valuations of a .sta file, e.g. "(0,1)", one per state.
std::vector<std::string> read_state_names(const NamedText& sta, std::uint64_t states);

/// The rewards of a .srew file, one per state; what is not listed is 0. A state listed twice is an error.
template <class Scalar>
std::vector<Scalar> read_state_rewards(const NamedText& srew, std::uint64_t states) {
  const TextSource source(srew.file);
  source.require_text(srew.text);
  TextLines lines(source, srew.text);
  std::vector<Scalar> rewards;
  std::vector<bool> given;
  while (lines.next_filled()) {
    const std::vector<std::string_view>& words = lines.words();
    if (words.front().front() == '#') continue;
    if (words.size() != 2) lines.fail(fmt::format("{} words, expected 'state reward'", words.size()));
    if (rewards.empty()) {
      if (read_count(source, lines.number(), "number of states", words[0]) != states) {
        lines.fail(fmt::format("{} states, expected {} as in the .tra file", words[0], states));
      }
      rewards.assign(states, Scalar(0));
      given.assign(states, false);
      continue;
    }
    const std::size_t s = read_index(source, lines.number(), "state", words[0], states);
    if (given[s]) lines.fail(fmt::format("the reward of state {} is given twice, expected each state once", s));
    given[s] = true;
    rewards[s] = read_number<Scalar>(source, lines.number(), "reward", words[1]);
  }
  if (rewards.empty()) lines.fail("no sizes, expected a line 'states entries'");
  return rewards;
}

}  // namespace maximin::internal
