#include "compat/haply/service_message.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <array>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <numbers>
#include <utility>

#include "compat/haply/haply_frame.h"
#include "thimble/version.h"

namespace thimble::compat::haply {
namespace {

using nlohmann::json;

constexpr double kDegrees = 180 / std::numbers::pi;  // degrees per rad
constexpr unsigned kGripNumber = 0x8000;             // number before that of the first arm's grip

/// Returns a member, or null if there is none.
const json& member(const json& object, const char* key) {
  static const json kNothing;
  if (!object.is_object()) return kNothing;
  const auto found = object.find(key);
  return found == object.end() ? kNothing : *found;
}

bool read_vector(const json& from, Eigen::Vector3d& vector) {
  Eigen::Index axis = 0;
  for (const char* key : {"x", "y", "z"}) {
    const json& number = member(from, key);
    if (!number.is_number()) return false;
    vector[axis++] = number.get<double>();
  }
  return vector.allFinite();
}

/// Reads the force of a command. Both keys may be present if they agree.
bool read_force(const json& command, Eigen::Vector3d& f_B) {
  for (const char* spelling : {"vector", "values"}) {
    const json& value = member(command, spelling);
    if (!value.is_null()) return read_vector(value, f_B);
  }
  return false;
}

/// Commands of an Inverse3 that are not implemented.
constexpr const char* kUnsupportedCommands[] = {"set_cursor_position", "set_angular_torques",
                                                "set_angular_position", "set_transform"};

void read_arm(const json& arm, Request& request) {
  const json& id = member(arm, "device_id");
  if (!id.is_string()) {
    request.wrong.push_back({"inverse3", "an entry lacks device_id"});
    return;
  }
  const json& commands = member(arm, "commands");
  for (const char* name : kUnsupportedCommands) {
    if (member(commands, name).is_null()) continue;
    request.wrong.push_back({name, "not supported; only set_cursor_force is"});
  }
  const json& force = member(commands, "set_cursor_force");
  if (force.is_null()) return;
  ForceCommand command;
  command.device_id = id.get<std::string>();
  if (read_force(force, command.f_B)) {
    request.forces.push_back(std::move(command));
  } else {
    request.wrong.push_back(
        {"set_cursor_force", "expected three numbers x, y, z (vector or values)"});
  }
}

json to_json(const Eigen::Vector3d& v) {
  return {{"x", v.x()}, {"y", v.y()}, {"z", v.z()}};
}

json to_json(const Eigen::Quaterniond& q) {
  return {{"w", q.w()}, {"x", q.x()}, {"y", q.y()}, {"z", q.z()}};
}

json angles_to_json(const Eigen::Vector3d& angles) {
  const Eigen::Vector3d degrees = angles * kDegrees;
  return {{"a0", degrees.x()}, {"a1", degrees.y()}, {"a2", degrees.z()}};
}

Eigen::Matrix3d matrix_of(const std::array<double, 9>& rows) {
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(rows.data());
}

/// Returns the joint velocities, rad/s; zeros if the arm is at a singularity or has no joints.
Eigen::Vector3d joint_speeds(const ArmReading& reading) {
  const Eigen::Matrix3d J_WT = matrix_of(reading.J_WT);
  constexpr double kMinDeterminant = 1e-7;  // m^3; an arm of 0.1 m reaches 1e-3 [chosen]
  if (!(std::abs(J_WT.determinant()) > kMinDeterminant)) return {0, 0, 0};
  return J_WT.inverse() * vector_of(reading.v_WT);
}

/// Returns the orientation of the stylus in B: the columns are its own axes.
Eigen::Quaterniond turned_B(const ArmReading& reading) {
  const Eigen::Matrix3d R_WT = matrix_of(reading.R_WT);
  Eigen::Matrix3d R_BT;
  for (int axis = 0; axis < 3; ++axis) R_BT.col(axis) = direction_B(R_WT.col(axis));
  return Eigen::Quaterniond(R_BT);
}

std::string four_digits(unsigned number) {
  std::array<char, 16> text{};
  std::snprintf(text.data(), text.size(), "%04X", number);
  return text.data();
}

json arm_of(const ReportedArm& arm, bool full) {
  const ArmReading& now = arm.reading;
  const Eigen::Vector3d zero(0, 0, 0);
  json entry = {{"device_id", arm.device_id},
                {"state",
                 {{"cursor_position", to_json(point_B(vector_of(now.p_WT)))},
                  {"cursor_velocity", to_json(direction_B(vector_of(now.v_WT)))},
                  {"angular_position", angles_to_json(vector_of(now.q))},
                  {"angular_velocity", angles_to_json(joint_speeds(now))},
                  {"body_orientation", to_json(Eigen::Quaterniond::Identity())},
                  {"current_cursor_force", to_json(direction_B(vector_of(now.f_sent_W)))},
                  {"current_cursor_position", to_json(zero)},
                  {"current_angular_torques", angles_to_json(zero)},
                  {"current_angular_position", angles_to_json(zero)},
                  {"control_domain", "cartesian"},
                  {"control_mode", arm.in_use ? "force" : "idle"}}},
                {"status",
                 {{"calibrated", true},
                  {"ready", arm.ready},
                  {"started", true},
                  {"power_supply", true},
                  {"in_use", arm.in_use}}}};
  if (full) {
    entry["config"] = {{"type", "inverse3"},
                       {"device_info", {{"id", arm.device_id}}},
                       {"extended_firmware_version", "Thimble " THIMBLE_VERSION},
                       {"gravity_compensation", {{"enabled", true}, {"scaling_factor", 1.0}}},
                       {"handedness", "right"},
                       {"preset", "defaults"},
                       {"basis", {{"permutation", "XYZ"}}}};
  }
  return entry;
}

json grip_of(const ReportedArm& arm, std::size_t number) {
  const unsigned buttons = arm.reading.buttons;
  json state = {
      {"buttons",
       {{"a", (buttons & 1U) != 0}, {"b", (buttons & 2U) != 0}, {"c", (buttons & 4U) != 0}}}};
  if (arm.facts.has_orientation) state["orientation"] = to_json(turned_B(arm.reading));
  constexpr double kFull = 1;  // our arms have no battery
  state["battery_level"] = kFull;
  return {{"device_id", four_digits(kGripNumber + static_cast<unsigned>(number) + 1)},
          {"state", std::move(state)},
          {"status", {{"awake", true}, {"connected", arm.ready}, {"ready", arm.ready}}}};
}

}  // namespace

std::optional<Eigen::Vector3d> Request::force_of(std::string_view device_id) const {
  for (const ForceCommand& command : forces) {
    if (command.device_id == device_id) return command.f_B;
  }
  return std::nullopt;
}

Request read_request(std::string_view text) {
  Request request;
  const json message = json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (!message.is_object()) {
    request.wrong.push_back({"message", "not a JSON object (JSON has no NaN or infinity)"});
    return request;
  }
  request.full = !member(member(message, "session"), "force_render_full_state").is_null();
  const json& arms = member(message, "inverse3");
  if (arms.is_array()) {
    for (const json& arm : arms) read_arm(arm, request);
  } else if (!arms.is_null()) {
    request.wrong.push_back({"inverse3", "expected a list of arms"});
  }
  return request;
}

std::string device_id_of(int arm) {
  return four_digits(static_cast<unsigned>(arm) + 1);
}

std::string state_message(std::span<const ReportedArm> arms, int session, bool full) {
  json message = {{"inverse3", json::array()}, {"wireless_verse_grip", json::array()}};
  if (full) message["session_id"] = session;
  for (const ReportedArm& arm : arms) {
    message["inverse3"].push_back(arm_of(arm, full));
    message["wireless_verse_grip"].push_back(grip_of(arm, message["wireless_verse_grip"].size()));
  }
  return message.dump();
}

}  // namespace thimble::compat::haply
