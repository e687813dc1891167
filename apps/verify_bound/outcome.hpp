#pragma once

#include <utility>

#include <maximin/proofs_check/trial_record.hpp>
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

/// The record as it is told to programs: what holds is undetermined where it is doubted.
inline TrialRecord told(TrialRecord record, const ExaminationOptions& options) {
  if (!options.doubts_what_holds()) return record;
  for (Check& check : record.found.checks) {
    if (check.verdict == Verdict::holds) check.verdict = Verdict::undetermined;
  }
  return record;
}

}  // namespace maximin::verify_bound
