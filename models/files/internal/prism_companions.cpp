#include <maximin/models/files/internal/prism_companions.hpp>

#include <algorithm>
#include <set>
#include <utility>

namespace maximin::internal {

namespace {

namespace fs = std::filesystem;

std::optional<NamedText> read_if_there(const fs::path& path, const ReadOptions& options) {
  std::error_code code;
  for (const fs::path& there : {path, fs::path(path.string() + ".gz")}) {
    if (fs::exists(there, code)) return NamedText{unpacked_file_bytes(there, options.limits.bytes), there.string()};
  }
  return std::nullopt;
}

/// NAME of NAME.tra and of NAME.tra.gz.
fs::path stem_of(fs::path tra) {
  if (tra.extension() == ".gz") tra.replace_extension();
  return tra.replace_extension();
}

/// The name in a comment such as: # Reward structure "time"
std::string structure_name(const std::optional<NamedText>& file) {
  if (!file) return {};
  constexpr std::string_view intro = "# Reward structure \"";
  const std::string_view text = without_mark(file->text);
  if (!text.starts_with(intro)) return {};
  const std::string_view rest = text.substr(intro.size());
  return std::string(rest.substr(0, std::min(rest.find_first_of("\"\n"), rest.size())));
}

struct RewardStructure {
  std::string number;  // "" for NAME.srew, "1" for NAME1.srew
  std::string name;
  std::optional<NamedText> state_rewards, transition_rewards;
};

std::vector<RewardStructure> reward_structures(const fs::path& tra, const ReadOptions& options) {
  constexpr int most = 99;
  const fs::path stem = stem_of(tra);
  std::vector<RewardStructure> found;
  for (int i = 0; i <= most; ++i) {
    const std::string number = i == 0 ? "" : std::to_string(i);
    RewardStructure structure{number, {}, {}, {}};
    structure.state_rewards = read_if_there(stem.string() + number + ".srew", options);
    structure.transition_rewards = read_if_there(stem.string() + number + ".trew", options);
    if (!structure.state_rewards && !structure.transition_rewards) {
      if (i > 0) break;
      continue;
    }
    structure.name = structure_name(structure.state_rewards);
    if (structure.name.empty()) structure.name = structure_name(structure.transition_rewards);
    found.push_back(std::move(structure));
  }
  return found;
}

const RewardStructure* choose(const std::vector<RewardStructure>& found, const fs::path& tra,
                              const ReadOptions& options, std::vector<std::string>& notes) {
  if (!options.reward_model.empty()) {
    for (const auto& structure : found) {
      if (options.reward_model == structure.name || options.reward_model == structure.number) return &structure;
    }
    throw InputError(fmt::format("{}: no reward structure {} beside it, expected one of the {} found", tra.string(),
                                 in_quotes(options.reward_model), found.size()));
  }
  if (found.size() > 1) {
    notes.push_back(
        fmt::format("rewards: {} reward structures, the first taken; choose one with --reward-model", found.size()));
  }
  return found.empty() ? nullptr : &found.front();
}

}  // namespace

PrismCompanions find_prism_companions(const fs::path& tra, const ReadOptions& options,
                                      std::vector<std::string>& notes) {
  PrismCompanions companions;
  if (options.state_rewards.empty() && options.transition_rewards.empty()) {
    const std::vector<RewardStructure> found = reward_structures(tra, options);
    if (const RewardStructure* chosen = choose(found, tra, options, notes)) {
      companions.state_rewards = chosen->state_rewards;
      companions.transition_rewards = chosen->transition_rewards;
    }
  }
  const auto named = [&](const fs::path& path) {
    return NamedText{unpacked_file_bytes(path, options.limits.bytes), path.string()};
  };
  if (!options.state_rewards.empty()) companions.state_rewards = named(options.state_rewards);
  if (!options.transition_rewards.empty()) companions.transition_rewards = named(options.transition_rewards);
  const std::string stem = stem_of(tra).string();
  companions.labels = read_if_there(stem + ".lab", options);
  companions.states = read_if_there(stem + ".sta", options);
  return companions;
}

namespace {

/// PRISM: 0="init" 1="deadlock" ..., then "state: number number".
void prism_labels(TextLines& lines, std::uint64_t states, std::set<State>& initial) {
  std::string_view init;
  for (const std::string_view word : lines.words()) {
    const std::size_t equals = word.find('=');
    if (equals == std::string_view::npos) lines.fail(fmt::format("label {}: expected 0=\"init\" ...", in_quotes(word)));
    if (word.substr(equals + 1) == "\"init\"") init = word.substr(0, equals);
  }
  while (lines.next_filled()) {
    const std::size_t colon = lines.line().find(':');
    if (colon == std::string_view::npos) lines.fail("no colon, expected 'state: label label ...'");
    const std::string_view first = trimmed(lines.line().substr(0, colon));
    const std::uint32_t s = read_index(lines.source(), lines.number(), "state", first, states);
    for (const std::string_view word : lines.words()) {
      if (word == init && word.data() > lines.line().data() + colon) initial.insert(static_cast<State>(s));
    }
  }
}

/// Storm: #DECLARATION, names, #END, then "state name name".
void storm_labels(TextLines& lines, std::uint64_t states, std::set<State>& initial) {
  while (trimmed(lines.line()) != "#END") {
    if (!lines.next()) lines.fail("the file ends inside the declaration, expected #END");
  }
  while (lines.next_filled()) {
    const std::vector<std::string_view>& words = lines.words();
    const std::uint32_t s = read_index(lines.source(), lines.number(), "state", words[0], states);
    if (std::find(words.begin() + 1, words.end(), "init") != words.end()) initial.insert(static_cast<State>(s));
  }
}

}  // namespace

std::vector<State> initial_states(const NamedText& lab, std::uint64_t states) {
  const TextSource source(lab.file);
  source.require_text(lab.text);
  TextLines lines(source, lab.text);
  std::set<State> initial;
  while (lines.next_filled()) {
    const std::string_view line = trimmed(lines.line());
    if (line.starts_with("#DECLARATION")) {
      storm_labels(lines, states, initial);
    } else if (line.front() != '#') {
      prism_labels(lines, states, initial);
    }
  }
  return {initial.begin(), initial.end()};
}

std::vector<std::string> read_state_names(const NamedText& sta, std::uint64_t states) {
  const TextSource source(sta.file);
  source.require_text(sta.text);
  TextLines lines(source, sta.text);
  std::vector<std::string> names;
  std::set<std::string_view> seen;
  bool variables = false;
  while (lines.next_filled()) {
    const std::string_view line = trimmed(lines.line());
    if (line.front() == '#') continue;
    if (!std::exchange(variables, true) && line.front() == '(') continue;
    const std::size_t colon = line.find(':');
    if (colon == std::string_view::npos) lines.fail("no colon, expected 'state:(value,...)'");
    const std::string_view value = trimmed(line.substr(colon + 1));
    const std::uint32_t s = read_index(source, lines.number(), "state", trimmed(line.substr(0, colon)), states);
    if (s != names.size()) lines.fail(fmt::format("state {}: out of order, expected {}", s, names.size()));
    if (!is_name(value) || !seen.insert(value).second) {
      lines.fail(fmt::format("{}: not a name or given twice, expected distinct values", in_quotes(value)));
    }
    names.emplace_back(value);
  }
  if (names.size() != states) {
    lines.fail(fmt::format("{} states, expected {} as in the .tra file", names.size(), states));
  }
  return names;
}

}  // namespace maximin::internal
