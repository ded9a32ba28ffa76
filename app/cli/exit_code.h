#pragma once

#include "thimble/driver/fault.h"
#include "thimble/driver/servo_loop.h"

namespace thimble::cli {

/// How the program ended, for scripts; `thimble --help` lists them.
enum ExitCode : int {
  kExitDone = 0,          ///< All went well.
  kExitTrouble = 1,       ///< Something unexpected; the message says what.
  kExitBadInput = 2,      ///< Wrong arguments, scene, arm file or mesh.
  kExitNoDevice = 3,      ///< The arm could not be opened.
  kExitFault = 4,         ///< The force went off with a fault while running.
  kExitUnmet = 5,         ///< A figure, a fit or a check misses its goal, or a check did not run.
  kExitInterrupted = 130  ///< Ended early by Ctrl-C or SIGTERM, with zero force.
};

/// Returns how a run ends the program that did all it was asked to. `end`: why its loop ended;
/// `fault`: in which the device was left; `by_viewer`: a viewer asked it to end, which is no
/// interruption.
constexpr ExitCode exit_code_of(driver::ServoEnd end, driver::Fault fault,
                                bool by_viewer) noexcept {
  switch (end) {
    case driver::ServoEnd::kDone:
      // A loop with a real arm outlives its faults.
      return fault == driver::Fault::kNone ? kExitDone : kExitFault;
    case driver::ServoEnd::kStopped:
      return by_viewer ? kExitDone : kExitInterrupted;
    case driver::ServoEnd::kFault:
      return kExitFault;
  }
  return kExitTrouble;
}

}  // namespace thimble::cli
