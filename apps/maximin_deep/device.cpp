#include <maximin/apps/maximin_deep/device.hpp>

#include <fmt/format.h>

#include <maximin/theory/error.hpp>

namespace maximin::apps {

torch::Device device_named(const std::string& name) {
  if (name == "cpu") return torch::kCPU;
  if (name != "cuda" && !name.starts_with("cuda:")) {
    throw InputError(fmt::format("--device: {}, expected cpu, cuda or cuda:N", name));
  }
  if (!torch::cuda::is_available()) {
    throw InputError(fmt::format("--device: {}, expected cpu: this LibTorch has no CUDA device here", name));
  }
  try {
    const torch::Device device(name);
    if (!device.has_index() || device.index() < static_cast<int>(torch::cuda::device_count())) return device;
  } catch (const c10::Error&) {
  }
  throw InputError(fmt::format("--device: {}, expected cuda:0 to cuda:{}", name, torch::cuda::device_count() - 1));
}

}  // namespace maximin::apps
