#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <optional>
#include <string>

#include "arm_file.h"
#include "thimble/driver/discovery.h"

namespace thimble::app {

/// Is which arm a command is about, as the user said it.
struct ArmChoice {
  std::string device = "sim";
  std::string arm_file;
  std::string firmware;

  /// Adds --device, --arm and --firmware to a command.
  void add_options(CLI::App& command);
};

/// Is the arm that a choice means.
struct ChosenArm {
  ArmFile file;
  std::optional<driver::FoundArm> real_arm;  ///< empty: the simulated one
  std::string name;                          ///< FoundArm::name, or "sim"
};

/// Finds the arm that a choice means and reads its file, without its calibration. The error says
/// what to do. Real-time: never from the servo thread.
driver::Result<ChosenArm> resolve(const ArmChoice& choice);

}  // namespace thimble::app
