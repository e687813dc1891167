#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include <torch/torch.h>

#include <maximin/gridworld/gridworld.hpp>
#include <maximin/theory/random.hpp>
#include <maximin/theory/types.hpp>

namespace maximin::deep {

/// Which gates move a particle.
enum class PfCell : std::uint8_t { lstm, gru };

/// What the sampled candidate of a particle is normalised over. `batch` is as published: one channel for each particle
/// number, statistics over the batch and the hidden units, running ones outside training. But resampling shuffles the
/// numbers, and running statistics are of states that a changed policy no longer visits. `layer` normalises each
/// particle over its own hidden units: the same in training and in use, for any number of particles.
enum class PfNormalisation : std::uint8_t { layer, batch, none };

/// What a particle's place is measured from: from what is shown, in units of eps, or from the middle of the world.
enum class PfReadOut : std::uint8_t { residual, absolute };

/// How ancestors are drawn: K draws that are independent, as published, or one draw and K equidistant steps, which
/// are as unbiased and vary less.
enum class PfResampling : std::uint8_t { systematic, multinomial };

/// What is added to a particle's log weight. Published: linear([embedded input; h']), of which normalising takes the
/// input's part out again, since all particles of a lane have it in common: it is linear(h'). `bilinear`: the scalar
/// product of h' with linear(embedded input), so that the same particle can be likely after one observation and not
/// after another.
enum class PfWeighing : std::uint8_t { bilinear, linear };

/// The shape of a PF-RNN. `published()` is that of the paper and its released code.
struct PfRnnOptions {
  PfCell cell = PfCell::lstm;
  long particles = 30;  ///< K
  long hidden = 64;     ///< numbers that a particle carries
  long embedding = 64;  ///< width of the embedded input
  double eps = 0.1;     ///< radius of the ball that observations come from
  double alpha = 0.5;   ///< share of the weights in what ancestors are drawn from; 1 is plain resampling
  PfNormalisation normalisation = PfNormalisation::layer;
  PfReadOut read_out = PfReadOut::residual;
  PfResampling resampling = PfResampling::systematic;
  PfWeighing weighing = PfWeighing::bilinear;
  /// Particles are read before they are resampled: K different ones.
  bool read_before_resampling = true;
  /// The input tells the cell of the observation and the place in that cell too. What a wall does is decided by them.
  bool cells = true;
  /// The input tells by how much, in eps, the observation differs from where the last one would have gone, had it been
  /// true: if the move was made, and if it was cancelled. Raw coordinates hide such differences behind those of places.
  bool innovation = true;
  /// False: the action is one number, as released.
  bool one_hot_actions = true;

  static PfRnnOptions published(double eps);
  /// Throws InputError where an option is out of range.
  void check() const;
  friend bool operator==(const PfRnnOptions&, const PfRnnOptions&) = default;
};

/// What a lane sees at one step.
struct PfSight {
  Point shown;
  Point last;          ///< what was shown one step before; not looked at when action < 0
  Action action = -1;  ///< taken since then; -1 at the first observation of an episode
};

/// The belief over hidden states of n lanes.
struct PfState {
  torch::Tensor h;            ///< [n, K, H]
  torch::Tensor c;            ///< [n, K, H] for PF-LSTM; not defined for PF-GRU
  torch::Tensor log_weights;  ///< [n, K], exp of a row sums to 1
};

/// What chance decides in one step. Given this, a step is a differentiable function.
struct PfNoise {
  torch::Tensor normal;          ///< [n, K, H], standard normal: of the candidates
  torch::Tensor uniform;         ///< [n, K] in [0, 1]: of the ancestors. Systematic resampling takes the first column
  torch::Tensor embedding_mask;  ///< dropout's factors of the embedded input [n, E]; not defined where there is none
  torch::Tensor hidden_mask;     ///< dropout's factors of what is read [n, K, H]; not defined where there is none
};

/// What one step gives.
struct PfStep {
  PfState state;          ///< after resampling
  torch::Tensor places;   ///< [n, K, 2], of each particle
  torch::Tensor weights;  ///< [n, K], of the places, rows sum to 1
  torch::Tensor mean;     ///< [n, 2], the weighted mean of the places
};

/// A sampled candidate is normalised, then LeakyReLU: g of PF-LSTM, n of PF-GRU.
class PfCandidate : public torch::nn::Module {
 public:
  explicit PfCandidate(const PfRnnOptions& options);
  /// mean + softplus(spread) * normal, normalised. All [n, K, H].
  torch::Tensor forward(const torch::Tensor& mean, const torch::Tensor& spread, const torch::Tensor& normal);

 private:
  PfNormalisation kind_;
  torch::Tensor gain_, shift_;
  torch::nn::BatchNorm1d batch_{nullptr};
};

/// The particle-filter recurrent network (Ma, Karkus, Hsu and Lee, "Particle Filter Recurrent Neural Networks", 2020):
/// K hidden states with weights, moved by a recurrent cell with sampled candidates, weighted by what is shown,
/// resampled softly. Predicts the true state that will be acted on: s_t after o_1, a_1, ..., a_{t-1}, o_t.
class PfRnn : public torch::nn::Module {
 public:
  /// Weights are drawn from the stream: the same seed is the same network with every version of LibTorch. Throws
  /// InputError where an option is out of range.
  PfRnn(const PfRnnOptions& options, Stream& rng);

  const PfRnnOptions& options() const { return options_; }
  long feature_count() const;

  /// What n lanes see, as the network's input [n, feature_count()], on the CPU.
  torch::Tensor encode(std::span<const PfSight> sights) const;

  /// Before the first observation: hidden states zero, weights equal. `particles` 0 is options().particles; any other
  /// number works too, unless normalisation is over the batch.
  PfState initial(long lanes, long particles = 0) const;

  /// One step: `features` of encode, `shown` [n, 2] in world units.
  PfStep step(const PfState& before, const torch::Tensor& features, const torch::Tensor& shown, const PfNoise& noise);

 private:
  PfState move(const PfState& before, const torch::Tensor& input, const torch::Tensor& normal);

  PfRnnOptions options_;
  torch::nn::Linear embed_{nullptr}, embed_more_{nullptr};
  torch::nn::Linear from_hidden_{nullptr}, from_input_{nullptr};
  torch::nn::Linear candidate_from_hidden_{nullptr};
  torch::nn::Linear weigh_{nullptr}, read_{nullptr};
  std::shared_ptr<PfCandidate> candidate_;
};

using PfRnnPtr = std::shared_ptr<PfRnn>;

/// Soft resampling: ancestors drawn from q = alpha w + (1 - alpha)/K, new weights proportional to w/q. Through them,
/// and not through the choice, gradients reach w. Takes exp(log_weights) [n, K] that sum to 1 and `uniform` as in
/// PfNoise.
struct Ancestors {
  torch::Tensor rows;         ///< [n * K], int64, rows of the particles as [n * K, ...]
  torch::Tensor log_weights;  ///< [n, K], normalised
};
Ancestors soft_resample(const torch::Tensor& log_weights, double alpha, PfResampling resampling,
                        const torch::Tensor& uniform);

}  // namespace maximin::deep
