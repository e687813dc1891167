#include <maximin/deep/attacks/director.hpp>

#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include <maximin/theory/error.hpp>

namespace maximin::deep {
namespace {

// Place and time left.
long place_features(const DirectorOptions& options) {
  return 2 * (1 + 2 * options.waves) + 1;
}

}  // namespace

Director::Director(const ObservationBall& ball, const DirectorOptions& options, long further_features, long choices)
    : ball_(ball), options_(options), features_(place_features(options) + further_features), choices_(choices) {
  if (options.horizon < 1) throw InputError(fmt::format("director: horizon {}, expected 1 or more", options.horizon));
  if (options.waves < 0 || options.waves > 8) {
    throw InputError(fmt::format("director: {} waves, expected 0 to 8", options.waves));
  }
  Stream rng(options.seed);
  network_ = std::make_shared<ActorCritic>(features_, choices_, options.hidden, rng);
}

float* Director::write_place(Lane lane, Point truth, float* out) const {
  constexpr double half = gridworld::side / 2.0;
  const auto put = [&](double v) { *out++ = static_cast<float>(v); };
  for (const double v : {truth.x, truth.y}) {
    put((v - half) / half);
    double frequency = std::numbers::pi;
    for (long w = 0; w < options_.waves; ++w, frequency *= 2) {
      put(std::sin(frequency * v));
      put(std::cos(frequency * v));
    }
  }
  put(1 - static_cast<double>(steps_[static_cast<std::size_t>(lane)]) / static_cast<double>(options_.horizon));
  return out;
}

torch::Tensor Director::blank_features(std::size_t lanes) const {
  return torch::zeros({static_cast<long>(lanes), features_});
}

std::vector<int> Director::choose(const torch::Tensor& log_policy, std::span<const Lane> lanes,
                                  std::span<Stream> streams) const {
  std::vector<int> chosen;
  const auto row_of = log_policy.accessor<float, 2>();
  for (std::size_t k = 0; k < lanes.size(); ++k) {
    const auto row = row_of[static_cast<long>(k)];
    int best = 0;
    if (play_ == Play::greedy) {
      for (int c = 1; c < choices_; ++c) best = row[c] > row[best] ? c : best;
    } else {
      double left = streams[static_cast<std::size_t>(lanes[k])].uniform();
      while (best + 1 < choices_ && (left -= std::exp(static_cast<double>(row[best]))) >= 0) ++best;
    }
    chosen.push_back(best);
  }
  return chosen;
}

void Director::perturb(std::span<const Lane> lanes, std::span<const Point> truths, const GridAgent& agent,
                       std::span<Stream> streams, std::span<Point> shown) {
  torch::NoGradGuard no_grad;
  decision_.situations = look(lanes, truths, agent);
  const torch::Tensor log_policy = network_->log_policy(decision_.situations);
  const std::vector<int> chosen = choose(log_policy, lanes, streams);
  decision_.choices = torch::tensor(chosen, torch::kLong);
  decision_.log_probability = log_policy.gather(1, decision_.choices.unsqueeze(1)).squeeze(1);
  decision_.value = network_->value(decision_.situations.features);
  realise(lanes, truths, chosen, streams, shown);
  for (const Lane lane : lanes) ++steps_[static_cast<std::size_t>(lane)];
}

nlohmann::ordered_json Director::about() const {
  return {{"eps", ball_.eps()},
          {"hidden", options_.hidden},
          {"waves", options_.waves},
          {"horizon", options_.horizon},
          {"choices", choices_}};
}

TensorFile Director::save() const {
  TensorFile file;
  file.kind = "attacker";
  file.about = about();
  file.about["play"] = play_ == Play::greedy ? "greedy" : "sampled";
  put_module(file, "network", *network_);
  return file;
}

void Director::load(const TensorFile& file) {
  nlohmann::ordered_json expected = about(), found = file.about;
  const std::string play = found.value("play", "");
  found.erase("play");
  for (const auto& [what, value] : expected.items()) {
    const nlohmann::ordered_json there = found.contains(what) ? found[what] : nlohmann::ordered_json();
    if (there != value)
      throw InputError(fmt::format("attacker: {} is {}, expected {}", what, there.dump(), value.dump()));
  }
  if (found.size() > expected.size()) throw InputError("attacker: more than an attacker has, expected one as written");
  if (play != "greedy" && play != "sampled") {
    throw InputError(fmt::format("attacker: play is '{}', expected greedy or sampled", play));
  }
  get_module(file, "network", *network_);
  play_ = play == "greedy" ? Play::greedy : Play::sampled;
}

}  // namespace maximin::deep
