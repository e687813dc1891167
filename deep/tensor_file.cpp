#include <maximin/deep/tensor_file.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <zlib.h>

#include <maximin/models/files/input_file.hpp>
#include <maximin/models/files/json_text.hpp>
#include <maximin/models/files/output_file.hpp>
#include <maximin/theory/error.hpp>

namespace maximin::deep {
namespace {

static_assert(std::endian::native == std::endian::little, "numbers are written as they lie in memory");

constexpr std::string_view magic = "maximin-tensors 1\n";
constexpr std::string_view any_version = "maximin-tensors ";
constexpr std::size_t checksum_bytes = 4;
/// A replay memory of a million beliefs is a tenth of it.
constexpr std::size_t most_bytes = std::size_t{1} << 34U;

constexpr std::array<std::pair<const char*, torch::ScalarType>, 4> types{
    {{"float32", torch::kFloat}, {"float64", torch::kDouble}, {"int64", torch::kLong}, {"uint8", torch::kByte}}};

const char* type_name_of(torch::ScalarType type) {
  for (const auto& [name, t] : types) {
    if (t == type) return name;
  }
  throw std::logic_error("tensor file: a type of tensor that it does not know");
}

std::optional<torch::ScalarType> type_named(const std::string& text) {
  for (const auto& [name, t] : types) {
    if (text == name) return t;
  }
  return std::nullopt;
}

std::uint32_t crc_of(std::string_view bytes) {
  uLong crc = crc32_z(0, nullptr, 0);
  return static_cast<std::uint32_t>(crc32_z(crc, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

/// At most 8 whole numbers whose product, zeros left out, is one that LibTorch can count with.
std::vector<std::int64_t> read_sizes(const nlohmann::ordered_json& list) {
  std::vector<std::int64_t> sizes;
  std::int64_t room = std::int64_t{1} << 48U;
  for (const auto& size : list) {
    if (!size.is_number_unsigned() || sizes.size() == 8 ||
        size.get<std::uint64_t>() > static_cast<std::uint64_t>(room)) {
      throw InputError("a tensor of impossible sizes, expected at most 8 whole numbers");
    }
    sizes.push_back(size.get<std::int64_t>());
    room /= std::max<std::int64_t>(sizes.back(), 1);
  }
  return sizes;
}

/// The tensors of the list in the heading, out of the bytes behind it.
void read_tensors(const nlohmann::ordered_json& list, std::string_view bytes, TensorFile& file) {
  if (!list.is_array()) throw InputError("a heading whose tensors are no list, expected one");
  for (const auto& entry : list) {
    const auto type = type_named(entry.at("type").get<std::string>());
    if (!type) throw InputError("a tensor of unknown type, expected float32, float64, int64 or uint8");
    const std::vector<std::int64_t> sizes = read_sizes(entry.at("sizes"));
    std::size_t length = torch::elementSize(*type);
    for (const std::int64_t size : sizes) length *= static_cast<std::size_t>(size);
    if (length > bytes.size()) throw InputError("tensors are cut off, expected all that its heading lists");
    torch::Tensor tensor = torch::empty(sizes, *type);
    if (length > 0) std::memcpy(tensor.data_ptr(), bytes.data(), length);
    bytes.remove_prefix(length);
    const auto name = entry.at("name").get<std::string>();
    if (!file.tensors.emplace(name, tensor).second) {
      throw InputError(fmt::format("tensor {} twice, expected every name once", name));
    }
  }
  if (!bytes.empty()) throw InputError("more than its heading lists, expected the end of the file");
}

}  // namespace

const torch::Tensor& TensorFile::at(const std::string& name) const {
  const auto found = tensors.find(name);
  if (found == tensors.end())
    throw InputError(fmt::format("tensor {} is missing, expected it in a file of kind {}", name, kind));
  return found->second;
}

void TensorFile::copy_to(const std::string& name, torch::Tensor into) const {
  const torch::Tensor& from = at(name);
  if (from.sizes() != into.sizes() || from.scalar_type() != into.scalar_type()) {
    throw InputError(fmt::format("tensor {} is {} {}, expected {} {}", name, type_name_of(from.scalar_type()),
                                 from.sizes().vec(), type_name_of(into.scalar_type()), into.sizes().vec()));
  }
  torch::NoGradGuard no_grad;
  into.copy_(from);
}

void write_tensor_file(const std::filesystem::path& path, const TensorFile& content) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const auto& [name, tensor] : content.tensors) {
    list.push_back({{"name", name}, {"type", type_name_of(tensor.scalar_type())}, {"sizes", tensor.sizes().vec()}});
  }
  std::string bytes(magic);
  bytes += nlohmann::ordered_json{{"kind", content.kind}, {"about", content.about}, {"tensors", list}}.dump() + '\n';
  for (const auto& [name, tensor] : content.tensors) {
    bytes += bytes_of_tensor(tensor);
  }
  const std::uint32_t crc = crc_of(bytes);
  bytes.append(reinterpret_cast<const char*>(&crc), checksum_bytes);
  write_file(path, bytes, Overwrite::replace);
}

TensorFile read_tensor_file(const std::filesystem::path& path, const std::string& kind) {
  const auto refuse = [&](std::string why) {
    // Names in the file may hold anything, line breaks too.
    std::replace_if(
        why.begin(), why.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; }, '?');
    return InputError(fmt::format("{}: {:.200}", path.string(), why));
  };
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (std::filesystem::is_other(status)) throw refuse("is a device or a pipe, expected a file");
  const std::string bytes = file_bytes(path, most_bytes, fmt::format("a file of kind '{}'", kind));
  if (!bytes.starts_with(any_version)) {
    throw refuse(fmt::format("no file of this program, expected one that begins with '{}'", any_version));
  }
  if (!bytes.starts_with(magic)) throw refuse("written by another version, expected version 1");
  std::uint32_t crc = 0;
  const std::string_view all(bytes);
  if (bytes.size() >= magic.size() + checksum_bytes) {
    std::memcpy(&crc, bytes.data() + bytes.size() - checksum_bytes, checksum_bytes);
  }
  if (bytes.size() < magic.size() + checksum_bytes || crc != crc_of(all.substr(0, all.size() - checksum_bytes))) {
    throw refuse("cut off or damaged, its checksum is wrong, expected the file as it was written");
  }
  std::string_view rest = all.substr(magic.size(), all.size() - magic.size() - checksum_bytes);
  const std::size_t line = rest.find('\n');
  if (line == std::string_view::npos) throw refuse("no heading, expected a line of JSON");
  TensorFile file;
  try {
    const auto heading = parse_json(rest.substr(0, line), 32, "heading", "kind, about and tensors");
    file.kind = heading.at("kind").get<std::string>();
    if (file.kind != kind) {
      throw InputError(fmt::format("a file of kind '{}', expected '{}'", file.kind, kind));
    }
    file.about = heading.at("about");
    read_tensors(heading.at("tensors"), rest.substr(line + 1), file);
  } catch (const InputError& e) {
    throw refuse(e.what());
  } catch (const nlohmann::json::exception&) {
    throw refuse("a heading that is none, expected JSON with kind, about and tensors");
  }
  return file;
}

torch::Tensor tensor_of_bytes(const std::string& bytes) {
  torch::Tensor copy = torch::empty({static_cast<long>(bytes.size())}, torch::kByte);
  std::memcpy(copy.data_ptr(), bytes.data(), bytes.size());
  return copy;
}

std::string bytes_of_tensor(const torch::Tensor& tensor) {
  const torch::Tensor dense = tensor.detach().to(torch::kCPU).contiguous();
  return {static_cast<const char*>(dense.data_ptr()), dense.nbytes()};
}

std::uint32_t checksum_of(const torch::nn::Module& module) {
  std::string bytes;
  for (const torch::Tensor& tensor : module.parameters()) bytes += bytes_of_tensor(tensor);
  for (const torch::Tensor& tensor : module.buffers()) bytes += bytes_of_tensor(tensor);
  return crc_of(bytes);
}

void put_module(TensorFile& file, const std::string& prefix, const torch::nn::Module& module) {
  for (const auto& item : module.named_parameters()) file.tensors[prefix + '.' + item.key()] = item.value();
  for (const auto& item : module.named_buffers()) file.tensors[prefix + '.' + item.key()] = item.value();
}

void get_module(const TensorFile& file, const std::string& prefix, torch::nn::Module& module) {
  const auto take = [&](const std::string& key, const torch::Tensor& into) {
    const std::string name = prefix + '.' + key;
    file.copy_to(name, into);
    if (into.is_floating_point() && !into.isfinite().all().item<bool>()) {
      throw InputError(fmt::format("tensor {} holds what is no number, expected finite numbers", name));
    }
  };
  for (const auto& item : module.named_parameters()) take(item.key(), item.value());
  for (const auto& item : module.named_buffers()) take(item.key(), item.value());
}

}  // namespace maximin::deep
