#pragma once

#include <iosfwd>
#include <string>

#include <maximin/deep/pf_rnn.hpp>

namespace maximin::deep {

/// Writes a trained PF-RNN: a line `maximin-pf-rnn 1`, a line of options, then for each tensor a line with its name and
/// sizes and its numbers as 32-bit floats, little endian, and last a 64-bit FNV-1a checksum of everything before.
/// Throws InputError where the stream cannot be written.
void save_pf_rnn(std::ostream& out, const PfRnn& module);

/// Reads it back, in evaluation mode. Throws InputError, one line that begins with `where` (a file's name), when it is
/// no such file, of another version, cut off or damaged.
PfRnnPtr load_pf_rnn(std::istream& in, const std::string& where);

}  // namespace maximin::deep
