#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "compat/core/arm_data.h"

namespace thimble::compat::haply {

// The JSON messages of an Inverse3's service, from the service's side, as in its published pages [S
// docs.haply.co/inverseSDK: WebSocket protocol, simulation channel] and in open-source clients.
// Never from the servo thread.

/// The requested force for one arm.
struct ForceCommand {
  std::string device_id;         ///< Id of the arm.
  Eigen::Vector3d f_B{0, 0, 0};  ///< N; finite.
};

/// An invalid part of a message, for the report.
struct WrongPart {
  const char* command;  ///< Its name.
  const char* what;     ///< The problem.
};

/// A message of a program. Any text is accepted; invalid parts request no force.
struct Request {
  std::vector<ForceCommand> forces;  ///< One for each arm with a force.
  std::vector<WrongPart> wrong;      ///< The invalid parts.
  bool full = false;                 ///< The answer must contain the full state.

  /// Returns the force for an arm; nothing if none is requested.
  std::optional<Eigen::Vector3d> force_of(std::string_view device_id) const;
};

/// Parses a message. Accepts both keys of a force: `vector` since 3.5, `values` before.
Request read_request(std::string_view text);

/// The state of an arm in a message.
struct ReportedArm {
  std::string device_id;  ///< Id in the service.
  ArmFacts facts;         ///< Its properties.
  ArmReading reading;     ///< Its newest tick.
  bool ready = true;      ///< It runs, and no fault keeps its force off.
  bool in_use = false;    ///< A session has requested forces from it.
};

/// Returns the id of an arm by its number: four digits, as real arms have.
std::string device_id_of(int arm);

/// Returns a message with the state of all arms; `full`: with the session and the settings of the
/// arms. An arm's buttons, and its stylus orientation if known, are reported as those of a wireless
/// grip.
std::string state_message(std::span<const ReportedArm> arms, int session, bool full);

}  // namespace thimble::compat::haply
