#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/exit_code.h"
#include "thimble/driver/discovery.h"
#include "thimble/scene/arm_file.h"

namespace thimble::cli {

/// Which arm a command is about, as the user said it.
struct ArmChoice {
  std::string device = "auto";
  std::string arm_file;
  std::string firmware;
  /// Whether the simulated arm is taken where no arm is plugged in; if not, only by --device sim.
  bool simulates_unasked = true;
  bool no_real_time = false;  ///< Push a real arm although the loop gets no real-time priority.

  /// Adds --device, --arm and --firmware to a command.
  void add_options(CLI::App& command);
  /// Adds --no-real-time to a command that pushes.
  void add_real_time_option(CLI::App& command);
};

/// The arm that a choice means.
struct ChosenArm {
  scene::ArmFile file;                       ///< Of a real arm with its calibration, if wanted.
  std::filesystem::path path;                ///< Where `file` was read.
  std::vector<std::string> told;             ///< Which file a real arm has and why.
  std::optional<driver::FoundArm> real_arm;  ///< empty: the simulated one
  std::string name;                          ///< FoundArm::name, or "sim"
};

/// Finds the arm that a choice means and reads its file: a plugged one if there is one, with its
/// calibration unless it is chosen `for_calibration`; else the simulated one of --arm. The error
/// says what to do. Real-time: never from the servo thread.
driver::Result<ChosenArm> resolve(const ArmChoice& choice, bool for_calibration);

/// Fails, before an arm is opened, if it is real and the loop gets no real-time priority, as `run`
/// does; --no-real-time allows it. Real-time: never from the servo thread.
driver::Result<void> check_priority(const ArmChoice& choice, const ChosenArm& chosen);

/// Returns the exit code of a command whose arm could not be resolved: wrong arguments or a wrong
/// file if the arm is simulated, else no device.
ExitCode exit_code_of(const ArmChoice& refused);

/// Says on the first and the last line that an arm is simulated, so that nobody takes what was
/// found for the arm on the desk.
class SimulatedNote {
 public:
  /// Prints the first line if `arm` is simulated. `kept` names what is not kept ("calibration").
  SimulatedNote(const ChosenArm& arm, const char* kept);
  ~SimulatedNote();
  SimulatedNote(const SimulatedNote&) = delete;
  SimulatedNote& operator=(const SimulatedNote&) = delete;

 private:
  void print() const;

  std::string line_;  // empty: the arm is real
};

}  // namespace thimble::cli
