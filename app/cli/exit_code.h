#pragma once

#include "thimble/driver/fault.h"
#include "thimble/driver/servo_loop.h"

namespace thimble::cli {

/// Exit codes of the program, for scripts; `thimble --help` lists them.
enum ExitCode : int {
  kExitDone = 0,          ///< Success.
  kExitTrouble = 1,       ///< Unexpected error; the message describes it.
  kExitBadInput = 2,      ///< Wrong arguments, scene, arm file or mesh.
  kExitNoDevice = 3,      ///< The arm could not be opened.
  kExitFault = 4,         ///< A fault switched the force off during the run.
  kExitUnmet = 5,         ///< A figure, a fit or a check misses its goal, or a check did not run.
  kExitInterrupted = 130  ///< Ended early by Ctrl-C or SIGTERM, with zero force.
};

/// Returns the exit code of a run. `end`: why its loop ended; `fault`: the last fault of the
/// device; `by_viewer`: a viewer ended the run, which is no interruption.
constexpr ExitCode exit_code_of(driver::ServoEnd end, driver::Fault fault,
                                bool by_viewer) noexcept {
  switch (end) {
    case driver::ServoEnd::kDone:
      // A loop with a real arm continues after a fault.
      return fault == driver::Fault::kNone ? kExitDone : kExitFault;
    case driver::ServoEnd::kStopped:
      return by_viewer ? kExitDone : kExitInterrupted;
    case driver::ServoEnd::kFault:
      return kExitFault;
  }
  return kExitTrouble;
}

/// Returns the exit code of a run of two arms that ended with these codes of `exit_code_of`. A
/// fault counts before an interruption, because the fault of one arm also stops the loops of the
/// others.
constexpr ExitCode more_serious(ExitCode one, ExitCode other) noexcept {
  for (const ExitCode code : {kExitFault, kExitTrouble, kExitInterrupted}) {
    if (one == code || other == code) return code;
  }
  return kExitDone;
}

}  // namespace thimble::cli
