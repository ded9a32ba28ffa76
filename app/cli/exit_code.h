#pragma once

namespace thimble::app {

/// Tells a script how the program ended; `thimble --help` lists them.
enum ExitCode : int {
  kExitDone = 0,          ///< All went well.
  kExitTrouble = 1,       ///< Something unexpected; the message says what.
  kExitBadInput = 2,      ///< Wrong arguments, scene, arm file or mesh.
  kExitNoDevice = 3,      ///< The arm could not be opened.
  kExitFault = 4,         ///< The force went off with a fault while running.
  kExitInterrupted = 130  ///< Ended early by Ctrl-C or SIGTERM, with zero force.
};

}  // namespace thimble::app
