#pragma once

#include <string>
#include <utility>
#include <vector>

#include <maximin/theory/error.hpp>
#include <maximin/theory/finite_mdp.hpp>
#include <maximin/theory/perturbation.hpp>

namespace maximin {

/// What the call complains of, or "accepted".
template <class Call>
std::string complaint(Call&& call) {
  try {
    call();
  } catch (const InputError& e) {
    return e.what();
  }
  return "accepted";
}

/// The states on a line at x[0], x[1], ... and the closed balls of radius eps among them.
template <class Scalar>
Perturbation<Scalar> on_line(const std::vector<Scalar>& x, Scalar eps) {
  typename Metric<Scalar>::Points points(static_cast<Eigen::Index>(x.size()), 1);
  for (std::size_t s = 0; s < x.size(); ++s) points(static_cast<Eigen::Index>(s), 0) = x[s];
  return Perturbation<Scalar>(Metric<Scalar>::from_points(std::move(points), Norm::l1), eps);
}

/// One-sided rewards: S = {0, 1, 20} on a line, R(s,a) = -x_s, gamma = 1/2. Action 0 keeps state 0 and sends state 1 to
/// 20, action 1 the other way round; 20 absorbs.
template <class Scalar>
FiniteMdp<Scalar> one_sided() {
  FiniteMdpBuilder<Scalar> b(3, 2, Scalar(1) / Scalar(2));
  for (Action a = 0; a < 2; ++a) b.reward(0, a, Scalar(0)).reward(1, a, Scalar(-1)).reward(2, a, Scalar(-20));
  const Scalar sure(1);
  b.transition(0, 0, 0, sure).transition(0, 1, 2, sure).transition(1, 1, 1, sure).transition(1, 0, 2, sure);
  b.transition(2, 0, 2, sure).transition(2, 1, 2, sure);
  return std::move(b).build();
}

/// The balls of `one_sided`: eps = 1 confuses states 0 and 1.
template <class Scalar>
Perturbation<Scalar> one_sided_balls() {
  return on_line<Scalar>({Scalar(0), Scalar(1), Scalar(20)}, Scalar(1));
}

}  // namespace maximin
