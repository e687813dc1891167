#pragma once

#include <boost/multiprecision/eigen.hpp>
#include <boost/multiprecision/gmp.hpp>

#include <maximin/theory/types.hpp>

namespace maximin {

/// An integer of any size (GMP).
using Integer = boost::multiprecision::number<boost::multiprecision::gmp_int, boost::multiprecision::et_off>;

/// The exact scalar: a rational number, always in lowest terms (GMP). Every template of theory/ takes it; whoever uses
/// it links GMP::GMP, as maximin::tabular does.
using Rational = boost::multiprecision::number<boost::multiprecision::gmp_rational, boost::multiprecision::et_off>;

static_assert(is_exact_v<Rational>);

}  // namespace maximin
