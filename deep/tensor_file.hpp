#pragma once

#include <filesystem>
#include <map>
#include <string>

#include <torch/torch.h>
#include <nlohmann/json.hpp>

namespace maximin::deep {

/// Tensors by name, and what they are, in one file: trained networks, checkpoints.
///
/// The file: a line "maximin-tensors 1"; a line of JSON with "kind", "about" and the name, type and sizes of each
/// tensor; the numbers of each, little endian, in order of their names; and four bytes, the CRC-32 of all before. A
/// file that was cut, damaged, or is something else is told in one line.
struct TensorFile {
  std::string kind;  ///< e.g. "agent", "training"
  nlohmann::ordered_json about = nlohmann::ordered_json::object();
  std::map<std::string, torch::Tensor> tensors;  ///< float, double, int64 or uint8, on any device

  /// The tensor of this name. Throws InputError, naming it, when there is none.
  const torch::Tensor& at(const std::string& name) const;
  /// Copies the tensor of this name into `into`. Throws InputError when there is none or its type or sizes differ.
  void copy_to(const std::string& name, torch::Tensor into) const;
};

/// Writes the file as a whole or not at all. Throws InputError when the system refuses.
void write_tensor_file(const std::filesystem::path& path, const TensorFile& content);

/// Reads a file of this kind. Throws InputError, "PATH: what is wrong, expected ...".
TensorFile read_tensor_file(const std::filesystem::path& path, const std::string& kind);

/// What another library wrote, as a tensor of bytes; and back.
torch::Tensor tensor_of_bytes(const std::string& bytes);
std::string bytes_of_tensor(const torch::Tensor& tensor);

/// A checksum (CRC-32) of all weights and running statistics of a module.
std::uint32_t checksum_of(const torch::nn::Module& module);

/// All parameters and buffers of a module, as PREFIX.NAME; they share their numbers with the module.
void put_module(TensorFile& file, const std::string& prefix, const torch::nn::Module& module);
/// Takes them back. Throws InputError as TensorFile::copy_to, and where a number is not finite.
void get_module(const TensorFile& file, const std::string& prefix, torch::nn::Module& module);

}  // namespace maximin::deep
