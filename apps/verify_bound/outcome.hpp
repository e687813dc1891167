#pragma once

#include <maximin/proofs_check/verdict_text.hpp>

#include <maximin/apps/common/program.hpp>

namespace maximin::verify_bound {

/// What an outcome means to a shell.
inline int exit_code(Outcome outcome) {
  switch (outcome) {
    case Outcome::violated:
      return apps::ExitCode::violated;
    case Outcome::undetermined:
      return apps::ExitCode::undetermined;
    case Outcome::assumption_fails:
      return apps::ExitCode::assumption_fails;
    case Outcome::holds:
      break;
  }
  return apps::ExitCode::success;
}

}  // namespace maximin::verify_bound
