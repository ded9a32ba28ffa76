#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "compat/core/arm_data.h"

namespace thimble::compat::haply {

// The JSON messages of an Inverse3's service, from the service's side, as its published pages [S
// docs.haply.co/inverseSDK: WebSocket protocol, simulation channel] and open clients have them.
// Never from the servo thread.

/// The force that a message asks of one arm.
struct ForceCommand {
  std::string device_id;         ///< Which arm.
  Eigen::Vector3d f_B{0, 0, 0};  ///< N; finite.
};

/// A part of a message that could not be taken, for the report.
struct WrongPart {
  const char* command;  ///< Its name.
  const char* what;     ///< What is wrong with it.
};

/// A message of a program. Any text makes one: what cannot be understood asks for no force.
struct Request {
  std::vector<ForceCommand> forces;  ///< One for each arm that gets one.
  std::vector<WrongPart> wrong;      ///< What was not taken.
  bool full = false;                 ///< The answer shall hold everything.

  /// Returns the force for an arm; nothing if none is asked for.
  std::optional<Eigen::Vector3d> force_of(std::string_view device_id) const;
};

/// Reads a message. Takes both spellings of a force: `vector` since 3.5, `values` before.
Request read_request(std::string_view text);

/// What is told of an arm.
struct ToldArm {
  std::string device_id;  ///< What the service calls it.
  ArmFacts facts;         ///< What it is.
  ArmReading reading;     ///< Its newest tick.
  bool ready = true;      ///< It runs, and no fault keeps its force off.
  bool in_use = false;    ///< A session has asked it for forces.
};

/// Returns the name of an arm, by its number: four digits, as the arms themselves have.
std::string device_id_of(int arm);

/// Returns a message with the state of all arms; `full`: with the session and how the arms are set.
/// An arm's buttons, and how its stylus is turned where it knows, are told as those of a wireless
/// grip.
std::string state_message(std::span<const ToldArm> arms, int session, bool full);

}  // namespace thimble::compat::haply
