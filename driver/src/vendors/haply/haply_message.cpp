#include "vendors/haply/haply_message.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>

namespace thimble::driver::haply {
namespace {

using nlohmann::json;

// Far beyond any position or velocity of the arm, so that for example a message in mm is rejected.
constexpr double kFarthest = 2;   // m
constexpr double kFastest = 100;  // m/s

/// Formats a number with six decimals, independent of the locale.
std::string number(double value) {
  char text[400];  // the largest double has 309 digits before the point
  const auto end = std::to_chars(text, std::end(text), value, std::chars_format::fixed, 6);
  return {text, end.ptr};
}

json parsed(std::string_view text) {
  return json::parse(text, nullptr, /*allow_exceptions=*/false);
}

/// Returns a member, or null if there is none.
const json& member(const json& object, const char* key) {
  static const json kNothing;
  if (!object.is_object()) return kNothing;
  const auto found = object.find(key);
  return found == object.end() ? kNothing : *found;
}

bool read_number(const json& from, double& number) {
  if (!from.is_number()) return false;
  number = from.get<double>();
  return std::isfinite(number);
}

bool read_vector(const json& from, double most, Eigen::Vector3d& vector) {
  return read_number(member(from, "x"), vector.x()) && read_number(member(from, "y"), vector.y()) &&
         read_number(member(from, "z"), vector.z()) && vector.cwiseAbs().maxCoeff() <= most;
}

bool read_rotation(const json& from, Eigen::Matrix3d& rotation) {
  Eigen::Quaterniond q;
  if (!read_number(member(from, "x"), q.x()) || !read_number(member(from, "y"), q.y()) ||
      !read_number(member(from, "z"), q.z()) || !read_number(member(from, "w"), q.w())) {
    return false;
  }
  // Written so that NaN is refused.
  if (!(std::abs(q.norm() - 1) < 0.1)) return false;
  rotation = q.normalized().toRotationMatrix();
  return true;
}

std::uint16_t read_buttons(const json& state) {
  if (const json& one = member(state, "button"); one.is_boolean()) return one.get<bool>() ? 1 : 0;
  const json& several = member(state, "buttons");
  unsigned buttons = 0, bit = 1;
  for (const char* key : {"a", "b", "c"}) {
    const json& button = member(several, key);
    if (button.is_boolean() && button.get<bool>()) buttons |= bit;
    bit <<= 1;
  }
  return static_cast<std::uint16_t>(buttons);
}

/// Reads the first grip; false if its values are impossible. A message without a grip is valid.
bool read_grip(const json& message, ArmState& state) {
  for (const char* kind : {"verse_grip", "wireless_verse_grip"}) {
    const json& grips = member(message, kind);
    if (!grips.is_array() || grips.empty()) continue;
    const json& grip = member(grips.front(), "state");
    if (!member(grip, "orientation").is_object()) continue;
    if (!read_rotation(member(grip, "orientation"), state.R_BT)) return false;
    state.has_grip = true;
    state.buttons = read_buttons(grip);
    return true;
  }
  return true;
}

/// Reads an arm and its grip.
bool read_arm(const json& message, const json& arm, ArmState& state) {
  const json& reported = member(arm, "state");
  ArmState read = state;
  if (!read_vector(member(reported, "cursor_position"), kFarthest, read.p_BT) ||
      !read_vector(member(reported, "cursor_velocity"), kFastest, read.v_BT) ||
      !read_grip(message, read)) {
    return false;
  }
  state = read;
  return true;
}

bool is_false(const json& status, const char* key) {
  const json& reported = member(status, key);
  return reported.is_boolean() && !reported.get<bool>();
}

/// Returns the reason why the positions of an arm are unreliable; empty if there is none.
std::string trouble_of(const json& arm) {
  const json& status = member(arm, "status");
  if (is_false(status, "power_supply")) return "The arm has no power. Plug in its power supply.";
  if (is_false(status, "calibrated")) {
    return "The arm is not calibrated. Calibrate it with its vendor's software.";
  }
  if (is_false(status, "ready"))
    return "Haply's service reports that the arm is not ready. Wait, or check the arm in the "
           "vendor's software.";
  return {};
}

std::string id_of(const json& arm) {
  const json& id = member(arm, "device_id");
  return id.is_string() ? id.get<std::string>() : std::string();
}

/// Returns a text that a terminal can show.
std::string shown(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char sign) { return sign < ' ' || sign > '~'; }, '?');
  return text;
}

}  // namespace

Result<std::vector<FoundInverse3>> read_first(std::string_view text) {
  const json message = parsed(text);
  const json& arms = member(message, "inverse3");
  if (!arms.is_array()) {
    return Error{"The server on that port is not Haply's service."};
  }
  std::vector<FoundInverse3> found;
  for (const json& arm : arms) {
    FoundInverse3 one;
    one.device_id = id_of(arm);
    if (one.device_id.empty() || one.device_id != shown(one.device_id) ||
        one.device_id.size() > 64) {
      return Error{"Haply's service lists an arm without a usable device id."};
    }
    one.trouble = trouble_of(arm);
    const json& in_use = member(member(arm, "status"), "in_use");
    if (one.trouble.empty() && in_use.is_boolean() && in_use.get<bool>()) {
      // The service adds up the forces of all programs [S], beyond any limit of ours.
      one.trouble =
          "Another program uses the arm. End that program, because the service adds the forces of "
          "both.";
    }
    if (!read_arm(message, arm, one.state) && one.trouble.empty()) {
      return Error{"Haply's service reports a state of the arm " + one.device_id +
                   " that this version of Thimble does not support."};
    }
    const json& versions = member(member(arm, "config"), "device_info");
    if (!versions.is_null()) {
      one.versions = shown(versions.dump(-1, ' ', true, json::error_handler_t::replace));
    }
    found.push_back(std::move(one));
  }
  return found;
}

StateRead read_state(std::string_view text, std::string_view device_id, ArmState& state) {
  const json message = parsed(text);
  const json& arms = member(message, "inverse3");
  if (!arms.is_array()) return StateRead::kRejected;
  for (const json& arm : arms) {
    if (id_of(arm) != device_id) continue;
    if (!trouble_of(arm).empty()) return StateRead::kRejected;
    return read_arm(message, arm, state) ? StateRead::kOk : StateRead::kRejected;
  }
  return StateRead::kGone;
}

std::string force_message(std::string_view device_id, const Eigen::Vector3d& f_T_B) {
  const std::string force = R"({"x":)" + number(f_T_B.x()) + R"(,"y":)" + number(f_T_B.y()) +
                            R"(,"z":)" + number(f_T_B.z()) + "}";
  return R"({"inverse3":[{"device_id":)" + json(device_id).dump() +
         R"(,"commands":{"set_cursor_force":{"vector":)" + force + R"(,"values":)" + force +
         "}}}]}";
}

}  // namespace thimble::driver::haply
