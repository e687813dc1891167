#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include <maximin/models/files/read_options.hpp>
#include <maximin/models/model.hpp>

namespace maximin {

/// A text and the name of the file it is from.
struct NamedText {
  std::string text;
  std::string file;
};

/// What stands beside a .tra file.
struct PrismCompanions {
  std::optional<NamedText> state_rewards;       ///< .srew
  std::optional<NamedText> transition_rewards;  ///< .trew
  std::optional<NamedText> labels;              ///< .lab: the states labelled "init" are where the model starts
  std::optional<NamedText> states;              ///< .sta: names the states by their variables
};

/// Reads PRISM's explicit format: MDPs, DTMCs, interval MDPs and the MDP part of POMDPs; one transition or one choice
/// per line; with decimals, fractions or intervals; also Storm's dialect, which begins with "mdp" instead of sizes.
/// State rewards add to every action of the state. States with fewer choices, and labels, are treated as for DRN
/// (`read_drn`). The format has no discount. Throws InputError, "FILE:LINE: what is wrong, what is expected".
template <class Scalar>
Model<Scalar> read_prism_explicit(std::string_view text, std::string_view file_name, const ReadOptions& options = {},
                                  const PrismCompanions& companions = {});

/// The same, with the files found beside NAME.tra or NAME.tra.gz: NAME.srew and NAME.trew, or NAME1.srew, NAME2.srew,
/// ... of several reward structures (`options.reward_model` picks one by number or name), NAME.lab and NAME.sta. Each
/// may be packed by gzip and then may end in .gz.
template <class Scalar>
Model<Scalar> load_prism_explicit(const std::filesystem::path& tra, const ReadOptions& options = {});

/// The same, for a .tra file whose unpacked text has been read: `tra` is not read again, so it may be a pipe.
template <class Scalar>
Model<Scalar> read_prism_explicit_at(std::string_view text, const std::filesystem::path& tra,
                                     const ReadOptions& options = {});

}  // namespace maximin
