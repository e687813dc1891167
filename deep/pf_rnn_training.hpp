#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include <maximin/deep/pf_rnn.hpp>
#include <maximin/deep/tensor_file.hpp>
#include <maximin/deep/wandering.hpp>

namespace maximin::deep {

/// Which true state a prediction is compared with: the one that will be acted on, or the one before it, as released.
enum class PfTarget : std::uint8_t { acted_on, previous };

/// How a PF-RNN is trained. `published()` is as the paper and its released code say.
struct PfTrainingOptions {
  Walk walk = Walk::mixed;
  Deception deception = Deception::mixed;
  int actions_drawn = 8;  ///< by random walks; the released code never draws the last one: 7
  long horizon = 100;     ///< steps of a trajectory at most
  /// How many different trajectories there are; 0: always new ones. The paper says 30, the released code takes 10,000.
  long trajectories = 0;
  PfTarget target = PfTarget::acted_on;

  long updates = 5000;
  long batch = 64;     ///< trajectories in step
  long window = 10;    ///< steps that gradients go back; hidden states go on from window to window
  long particles = 8;  ///< of each trajectory; 0: as many as the module has. A cell moves any number of them alike
  /// The published 5e-4 needs several times the updates.
  double learning_rate = 5e-3;
  bool decay = true;  ///< the learning rate falls to 0, linearly over the last half of the updates
  double clip = 3;    ///< norm of the gradient at most
  /// Share of the embedded input and of what is read that is left out; 0.5 is as published. The spread that it brings
  /// in training is missing in use: after 500 updates at eps 0.5 and uniform noise the belief then held the truth in 31
  /// percent of the steps instead of 95, and the error was the same.
  double dropout = 0;

  double mean_weight =
      1;  ///< of the squared distance between the weighted mean and the truth, in eps (in units if kernel 0)
  double elbo_weight = 0.5;  ///< of -log (1/K) sum_i exp(-err_i^2 / 2)
  /// err_i is the distance in units of kernel * eps, so that the particles are a sample that spreads as the truth may;
  /// 0: exp(-err_i^2) in world units, as published, where a ball is so small that this is the mean of err_i^2 and the
  /// particles fall together. A narrower kernel spreads them more: more often is the truth among them, less sharp the
  /// mean.
  double kernel = 0.15;
  double time_weight = 0;  ///< step t of a window counts exp(time_weight * t)

  std::uint64_t seed = 1;

  static PfTrainingOptions published();
  /// Throws InputError where an option is out of range, or does not go with the module's.
  void check(const PfRnnOptions& shape) const;
};

/// Where the training stands.
struct PfTrainingProgress {
  long update = 0;  ///< 1 to options.updates
  double loss = 0;
  double mean_error = 0;   ///< mean distance from the weighted mean to the truth in this window, world units
  double shown_error = 0;  ///< and from what is shown
};

/// Trains a PF-RNN, whose device must be the CPU, one update after another. The same options are the same module, and a
/// training that is saved, killed and resumed is, bit for bit, one that was not (with the same LibTorch on the same
/// kind of processor).
class PfTrainer {
 public:
  /// Puts the module into training mode. Throws InputError when an option is out of range.
  PfTrainer(PfRnnPtr module, const PfTrainingOptions& options);
  ~PfTrainer();

  long updates() const { return updates_; }
  bool done() const { return updates_ >= options_.updates; }
  /// Throws InputError when the loss is no number any more.
  PfTrainingProgress update();

  /// The module, its optimiser, hidden states, random numbers and where each trajectory stands, which partly share
  /// their numbers with the trainer: write them before it goes on. And back, into a trainer of the same options; `load`
  /// throws InputError when the file is of another training.
  void save(TensorFile& file) const;
  void load(const TensorFile& file);

 private:
  class Lanes;

  torch::Tensor window_loss(PfTrainingProgress& progress);

  PfRnnPtr module_;
  PfTrainingOptions options_;
  std::unique_ptr<Lanes> lanes_;
  PfState state_;
  at::Generator generator_;
  torch::optim::RMSprop optimiser_;
  long updates_ = 0;
};

/// Trains the module as a PfTrainer does, and leaves it in evaluation mode. `progress` is called after every update;
/// training ends early when it returns false.
void train_pf_rnn(const PfRnnPtr& module, const PfTrainingOptions& options,
                  const std::function<bool(const PfTrainingProgress&)>& progress = {});

/// The loss of one step per lane, [n], given the true states [n, 2]: what train_pf_rnn makes small.
torch::Tensor pf_loss(const PfStep& step, const torch::Tensor& truth, double eps, const PfTrainingOptions& options);

}  // namespace maximin::deep
