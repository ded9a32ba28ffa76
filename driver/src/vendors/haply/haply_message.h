#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "thimble/driver/result.h"

namespace thimble::driver::haply {

// The JSON messages of Haply's service, from its published pages [S docs.haply.co/inverseSDK,
// real-time control commands] and open clients. Total: any text is understood or rejected.
// Real-time: never from the servo thread.

/// State of an arm in each message of the service. Frame B: the service's own, x right, y away from
/// the user, z up.
struct ArmState {
  Eigen::Vector3d p_BT{0, 0, 0};                       ///< Position of the tip, m.
  Eigen::Vector3d v_BT{0, 0, 0};                       ///< Velocity of the tip, m/s.
  bool has_grip = false;                               ///< A grip reports its orientation.
  Eigen::Matrix3d R_BT = Eigen::Matrix3d::Identity();  ///< Orientation of the grip.
  std::uint16_t buttons = 0;  ///< Buttons of the grip: bits 0 to 2 are a, b, c.
};

/// An arm in the first message, which is complete.
struct FoundInverse3 {
  std::string device_id;  ///< Its id in the service ("049D").
  std::string versions;   ///< Its versions; empty if not reported.
  std::string trouble;    ///< Reason why it cannot be used now, a sentence; empty if it can.
  ArmState state;         ///< Its state.
  bool stand_in = false;  ///< The arm belongs to Thimble's own stand-in for the service.
};

/// Returns the arms in the first message of a service. Fails if the service is not Haply's: the
/// message is not JSON, or has no list of Inverse3s with the fields of one.
Result<std::vector<FoundInverse3>> read_first(std::string_view text);

/// Result of reading a message.
enum class StateRead : std::uint8_t {
  kOk,        ///< The arm's state was read.
  kRejected,  ///< The message cannot be understood or holds an impossible number, or the arm is not
              ///< ready.
  kGone,      ///< The message lists the arms, without this one.
};

/// Reads the state of one arm from a later message. `state` changes only with kOk.
StateRead read_state(std::string_view text, std::string_view device_id, ArmState& state);

/// Returns the message that requests a force (N in B), in both spellings: `vector` since 3.5,
/// `values` before. The service applies it once and answers with a state. Precondition: finite.
std::string force_message(std::string_view device_id, const Eigen::Vector3d& f_T_B);

}  // namespace thimble::driver::haply
