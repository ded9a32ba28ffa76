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

/// The arm of a command, as the user chose it.
struct ArmChoice {
  std::string device = "auto";
  std::string arm_file;
  std::string firmware;
  /// Whether the simulated arm is used if no arm is plugged in. If false, only --device sim selects
  /// it.
  bool falls_back_to_simulation = true;
  bool no_real_time = false;  ///< Apply forces with a real arm without real-time priority.

  /// Adds --device, --arm and --firmware to a command.
  void add_options(CLI::App& command);
  /// Adds --no-real-time to a command that applies forces.
  void add_real_time_option(CLI::App& command);
};

/// The arm that a choice selects.
struct ChosenArm {
  scene::ArmFile file;                       ///< Arm file. For a real arm it includes the
                                             ///< calibration, if wanted.
  std::filesystem::path path;                ///< Path of `file`.
  std::vector<std::string> messages;         ///< Which file a real arm uses, and why.
  std::optional<driver::FoundArm> real_arm;  ///< The real arm; none if simulated.
  std::string name;                          ///< FoundArm::name, or "sim"
};

/// Fails if the file of --arm cannot be read, whichever arm is used. An empty path is valid.
/// Real-time: never from the servo thread.
driver::Result<void> check_arm_file(const std::string& arm_file);

/// Finds the arm that a choice selects and reads its file. A plugged arm comes first, with its
/// calibration unless it is chosen `for_calibration`; otherwise the simulated arm of --arm is used.
/// The error contains the remedy. Real-time: never from the servo thread.
driver::Result<ChosenArm> resolve(const ArmChoice& choice, bool for_calibration);

/// Fails if the arm is real and the loop gets no real-time priority, as `run` does, before an arm
/// is opened. --no-real-time allows it. Real-time: never from the servo thread.
driver::Result<void> check_priority(const ArmChoice& choice, const ChosenArm& chosen);

/// Returns the exit code of a command whose arm could not be resolved: bad input for a simulated
/// arm or an invalid arm file, otherwise no device.
ExitCode exit_code_of(const ArmChoice& refused);

/// Prints on the first and the last line that an arm is simulated, so that results are not mistaken
/// for those of a real arm.
class SimulatedNote {
 public:
  /// Prints the first line if `arm` is simulated. `kept` names what is not saved ("calibration").
  SimulatedNote(const ChosenArm& arm, const char* kept);
  ~SimulatedNote();
  SimulatedNote(const SimulatedNote&) = delete;
  SimulatedNote& operator=(const SimulatedNote&) = delete;

 private:
  void print() const;

  std::string line_;  // empty: the arm is real
};

}  // namespace thimble::cli
