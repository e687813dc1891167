#include <maximin/models/files/internal/gzip.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace maximin::internal {

namespace {

/// Takes bits off a byte string, lowest first.
class BitReader {
 public:
  BitReader(const Source& source, std::string_view bytes) : source_(source), bytes_(bytes) {}

  unsigned bits(unsigned count) {
    while (held_ < count) {
      hold_ |= std::uint32_t{byte()} << held_;
      held_ += 8;
    }
    const unsigned value = hold_ & ((1U << count) - 1U);
    hold_ >>= count;
    held_ -= count;
    return value;
  }

  /// Drops what is left of the current byte. Fewer than eight bits are ever held between calls of bits().
  void align() { hold_ = held_ = 0; }

  std::uint8_t byte() {
    if (next_ == bytes_.size()) source_.fail(0, "the gzip data ends too early, expected an undamaged file");
    return static_cast<std::uint8_t>(bytes_[next_++]);
  }

  std::uint32_t word32() {
    std::uint32_t value = 0;
    for (unsigned i = 0; i < 4; ++i) value |= std::uint32_t{byte()} << (8 * i);
    return value;
  }

  bool at_end() const { return next_ == bytes_.size(); }
  [[noreturn]] void damaged() const { source_.fail(0, "the gzip data is damaged, expected an undamaged file"); }

 private:
  const Source& source_;
  std::string_view bytes_;
  std::size_t next_ = 0;
  std::uint32_t hold_ = 0;
  unsigned held_ = 0;
};

/// A canonical Huffman code (RFC 1951, section 3.2.2): codes of one length are consecutive, in order of their symbols.
class HuffmanCode {
 public:
  static constexpr unsigned longest = 15;

  /// Symbol i has a code of lengths[i] bits, or none when that is 0.
  HuffmanCode(const BitReader& in, std::span<const std::uint8_t> lengths) {
    for (const std::uint8_t length : lengths) ++count_[length];
    count_[0] = 0;
    std::int32_t left = 1;  // codes of this length still free
    for (unsigned length = 1; length <= longest; ++length) {
      left = 2 * left - count_[length];
      if (left < 0) in.damaged();
    }
    std::array<std::int32_t, longest + 2> first{};
    for (unsigned length = 1; length <= longest; ++length) first[length + 1] = first[length] + count_[length];
    symbols_.resize(lengths.size());
    for (std::size_t i = 0; i < lengths.size(); ++i) {
      if (lengths[i] != 0) symbols_[static_cast<std::size_t>(first[lengths[i]]++)] = static_cast<std::uint16_t>(i);
    }
  }

  unsigned read(BitReader& in) const {
    std::int32_t code = 0, first = 0, index = 0;
    for (unsigned length = 1; length <= longest; ++length) {
      code |= static_cast<std::int32_t>(in.bits(1));
      const std::int32_t here = count_[length];
      if (code - first < here) return symbols_[static_cast<std::size_t>(index + code - first)];
      index += here;
      first = 2 * (first + here);
      code *= 2;
    }
    in.damaged();
  }

 private:
  std::array<std::int32_t, longest + 1> count_{};
  std::vector<std::uint16_t> symbols_;
};

class Inflater {
 public:
  Inflater(const Source& source, BitReader& in, std::string& out, std::size_t limit)
      : source_(source), in_(in), out_(out), begin_(out.size()), limit_(limit) {}

  /// Unpacks blocks up to and including the last.
  void run() {
    bool last = false;
    while (!last) {
      last = in_.bits(1) == 1;
      const unsigned type = in_.bits(2);
      if (type == 0) {
        stored_block();
      } else if (type == 1) {
        fixed_block();
      } else if (type == 2) {
        dynamic_block();
      } else {
        in_.damaged();
      }
    }
    in_.align();
  }

 private:
  void put(char c) {
    if (out_.size() >= limit_) {
      source_.fail(0, fmt::format("unpacks to more than {} bytes, expected less", limit_));
    }
    out_.push_back(c);
  }

  void stored_block() {
    in_.align();
    const unsigned length = in_.bits(16);
    if ((length ^ in_.bits(16)) != 0xFFFF) in_.damaged();
    for (unsigned i = 0; i < length; ++i) put(static_cast<char>(in_.byte()));
  }

  void fixed_block() {
    std::array<std::uint8_t, 288> literals{};
    for (std::size_t i = 0; i < literals.size(); ++i) {
      literals[i] = static_cast<std::uint8_t>(i < 144 ? 8 : i < 256 ? 9 : i < 280 ? 7 : 8);
    }
    std::array<std::uint8_t, 30> distances{};
    distances.fill(5);
    codes(HuffmanCode(in_, literals), HuffmanCode(in_, distances));
  }

  void dynamic_block() {
    constexpr std::array<std::uint8_t, 19> order = {16, 17, 18, 0, 8, 7, 9, 6, 10, 5, 11, 4, 12, 3, 13, 2, 14, 1, 15};
    const std::size_t literals = in_.bits(5) + 257U;
    const std::size_t distances = in_.bits(5) + 1U;
    const std::size_t given = in_.bits(4) + 4U;
    if (literals > 286 || distances > 30) in_.damaged();
    std::array<std::uint8_t, 19> of_lengths{};
    for (std::size_t i = 0; i < given; ++i) of_lengths[order[i]] = static_cast<std::uint8_t>(in_.bits(3));
    const std::vector<std::uint8_t> lengths = code_lengths(HuffmanCode(in_, of_lengths), literals + distances);
    const std::span<const std::uint8_t> all(lengths);
    if (all[256] == 0) in_.damaged();
    codes(HuffmanCode(in_, all.first(literals)), HuffmanCode(in_, all.subspan(literals)));
  }

  std::vector<std::uint8_t> code_lengths(const HuffmanCode& code, std::size_t count) {
    std::vector<std::uint8_t> lengths;
    while (lengths.size() < count) {
      const unsigned symbol = code.read(in_);
      if (symbol < 16) {
        lengths.push_back(static_cast<std::uint8_t>(symbol));
        continue;
      }
      if (symbol == 16 && lengths.empty()) in_.damaged();
      const std::uint8_t value = symbol == 16 ? lengths.back() : std::uint8_t{0};
      const std::size_t repeat = symbol == 16 ? 3 + in_.bits(2) : symbol == 17 ? 3 + in_.bits(3) : 11 + in_.bits(7);
      if (lengths.size() + repeat > count) in_.damaged();
      lengths.insert(lengths.end(), repeat, value);
    }
    return lengths;
  }

  void codes(const HuffmanCode& literals, const HuffmanCode& distances) {
    for (unsigned symbol = literals.read(in_); symbol != 256; symbol = literals.read(in_)) {
      if (symbol < 256) {
        put(static_cast<char>(symbol));
      } else {
        copy(symbol - 257, distances);
      }
    }
  }

  void copy(unsigned symbol, const HuffmanCode& distances) {
    constexpr std::array<std::uint16_t, 29> length_base = {3,  4,  5,  6,   7,   8,   9,   10,  11, 13,
                                                           15, 17, 19, 23,  27,  31,  35,  43,  51, 59,
                                                           67, 83, 99, 115, 131, 163, 195, 227, 258};
    constexpr std::array<std::uint8_t, 29> length_bits = {0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2,
                                                          2, 3, 3, 3, 3, 4, 4, 4, 4, 5, 5, 5, 5, 0};
    if (symbol >= length_base.size()) in_.damaged();
    const std::size_t length = length_base[symbol] + in_.bits(length_bits[symbol]);
    const unsigned code = distances.read(in_);
    if (code >= 30) in_.damaged();
    // Distances double every second code: 1, 2, 3, 4, 5-6, 7-8, 9-12, ...
    const unsigned extra = code < 4 ? 0 : code / 2 - 1;
    const std::size_t base = code < 4 ? code + 1U : ((2U + (code & 1U)) << extra) + 1U;
    const std::size_t distance = base + in_.bits(extra);
    if (distance > out_.size() - begin_) in_.damaged();
    for (std::size_t i = 0; i < length; ++i) put(out_[out_.size() - distance]);
  }

  const Source& source_;
  BitReader& in_;
  std::string& out_;
  std::size_t begin_;
  std::size_t limit_;
};

std::uint32_t crc32(std::string_view bytes) {
  static const std::array<std::uint32_t, 256> table = [] {
    std::array<std::uint32_t, 256> t{};
    for (std::uint32_t i = 0; i < 256; ++i) {
      std::uint32_t r = i;
      for (int bit = 0; bit < 8; ++bit) r = (r >> 1) ^ ((r & 1U) != 0 ? 0xEDB88320U : 0U);
      t[i] = r;
    }
    return t;
  }();
  std::uint32_t crc = ~std::uint32_t{0};
  for (const char c : bytes) crc = (crc >> 8) ^ table[(crc ^ static_cast<std::uint8_t>(c)) & 0xFFU];
  return ~crc;
}

void skip_header(BitReader& in) {
  if (in.byte() != 0x1F || in.byte() != 0x8B || in.byte() != 8) in.damaged();
  const unsigned flags = in.byte();
  if ((flags & 0xE0U) != 0) in.damaged();
  for (int i = 0; i < 6; ++i) in.byte();  // time, flags of the compressor, operating system
  if ((flags & 4U) != 0) {
    const unsigned low = in.byte();
    const unsigned length = low | (unsigned{in.byte()} << 8);
    for (unsigned i = 0; i < length; ++i) in.byte();
  }
  for (const unsigned text : {8U, 16U}) {  // file name, comment
    if ((flags & text) == 0) continue;
    while (in.byte() != 0) continue;
  }
  if ((flags & 2U) != 0) in.byte(), in.byte();
}

}  // namespace

bool is_gzip(std::string_view bytes) {
  return bytes.starts_with("\x1f\x8b");
}

std::string gunzip(const Source& source, std::string_view bytes, std::size_t limit) {
  BitReader in(source, bytes);
  std::string out;
  do {
    skip_header(in);
    const std::size_t begin = out.size();
    Inflater(source, in, out, limit).run();
    const std::string_view member = std::string_view(out).substr(begin);
    if (in.word32() != crc32(member)) in.damaged();
    if (in.word32() != static_cast<std::uint32_t>(member.size())) in.damaged();
  } while (!in.at_end());
  return out;
}

}  // namespace maximin::internal
