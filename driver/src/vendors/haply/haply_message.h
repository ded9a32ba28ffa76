#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "thimble/driver/result.h"

namespace thimble::driver::haply {

// The JSON messages of Haply's service, as its published pages [S docs.haply.co/inverseSDK,
// real-time control commands] and open clients have them. Any text is understood or rejected.
// Real-time: never from the servo thread.

/// What the service tells of an arm in each message. Frame B: the service's own, x right, y away
/// from the user, z up.
struct ArmState {
  Eigen::Vector3d p_BT{0, 0, 0};                       ///< Tip, m.
  Eigen::Vector3d v_BT{0, 0, 0};                       ///< Its velocity, m/s.
  bool has_grip = false;                               ///< A grip tells how it is turned.
  Eigen::Matrix3d R_BT = Eigen::Matrix3d::Identity();  ///< Of the grip.
  std::uint16_t buttons = 0;                           ///< Of the grip: bits 0 to 2 are a, b, c.
};

/// An arm in the first message, which tells everything.
struct FoundInverse3 {
  std::string device_id;  ///< What the service calls it ("049D").
  std::string versions;   ///< What it tells of its versions; empty if nothing.
  std::string trouble;    ///< Why it cannot be used now, a sentence; empty: it can.
  ArmState state;         ///< Where it is.
  bool stand_in = false;  ///< Of Thimble's own stand-in for the service, not of Haply's.
};

/// Returns the arms in the first message of a service. Fails if it is not one of Haply's: no JSON,
/// or no list of Inverse3s with what such a one has.
Result<std::vector<FoundInverse3>> read_first(std::string_view text);

/// What became of a message.
enum class StateRead : std::uint8_t {
  kOk,        ///< The arm's state was read.
  kRejected,  ///< It cannot be understood, has a number that cannot be, or the arm is not ready.
  kGone,      ///< It lists the arms, and this one is not among them.
};

/// Reads the state of one arm out of a later message. Unless kOk, `state` is as before.
StateRead read_state(std::string_view text, std::string_view device_id, ArmState& state);

/// Returns the message that asks for a force (N in B), in both spellings: `vector` since 3.5,
/// `values` before. The service applies it once and answers with a state. Precondition: finite.
std::string force_message(std::string_view device_id, const Eigen::Vector3d& f_T_B);

}  // namespace thimble::driver::haply
