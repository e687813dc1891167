#pragma once

#include <string>

#include <torch/torch.h>

namespace maximin::apps {

/// The device of this name. Throws InputError when there is none, or LibTorch cannot use it here.
torch::Device device_named(const std::string& name);

}  // namespace maximin::apps
