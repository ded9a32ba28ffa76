#include "compat/hd/hd_parameters.h"

#include <algorithm>
#include <cmath>
#include <thread>

#include "compat/core/arm_access.h"

namespace thimble::compat::hd {
namespace {

constexpr double kMillimetres = 1e3;  // per m

template <std::size_t N>
void put(const std::array<double, N>& from, Numbers& to, double factor = 1) {
  for (std::size_t i = 0; i < N; ++i) to[i] = factor * from[i];
}

void put_one(double value, Numbers& to) {
  to[0] = value;
}

/// All arms here have three motors, for the force at the tip.
constexpr std::size_t kMotors = 3;

/// Returns the joint torques of a force at the tip, N mm: tau = J^T f.
std::array<double, 3> joint_torques(const ArmReading& state, const std::array<double, 3>& f_W) {
  std::array<double, 3> tau{};
  for (std::size_t joint = 0; joint < 3; ++joint) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      tau[joint] += kMillimetres * state.J_WT[3 * axis + joint] * f_W[axis];
    }
  }
  return tau;
}

/// Finds the force for given joint torques (N m): J^T f = tau, by Cramer's rule. False if the arm
/// is at a singularity or has no joints.
bool force_of_torques(const std::array<double, 9>& J, const std::array<double, 3>& tau,
                      std::array<double, 3>& f) {
  // The rows of J^T are the columns of J.
  const auto at = [&](std::size_t row, std::size_t column) { return J[3 * column + row]; };
  const auto determinant = [](double a, double b, double c, double d, double e, double g, double h,
                              double i, double k) {
    return a * (e * k - g * i) - b * (d * k - g * h) + c * (d * i - e * h);
  };
  const double whole = determinant(at(0, 0), at(0, 1), at(0, 2), at(1, 0), at(1, 1), at(1, 2),
                                   at(2, 0), at(2, 1), at(2, 2));
  constexpr double kMinDeterminant = 1e-7;  // m^3; an arm of 0.1 m reaches 1e-3 [chosen]
  if (!(std::abs(whole) > kMinDeterminant)) return false;
  for (std::size_t k = 0; k < 3; ++k) {
    std::array<double, 9> m;
    for (std::size_t row = 0; row < 3; ++row) {
      for (std::size_t column = 0; column < 3; ++column) {
        m[3 * row + column] = column == k ? tau[row] : at(row, column);
      }
    }
    f[k] = determinant(m[0], m[1], m[2], m[3], m[4], m[5], m[6], m[7], m[8]) / whole;
  }
  return true;
}

std::array<double, 3> first_three(const Numbers& from, double factor = 1) {
  return {factor * from[0], factor * from[1], factor * from[2]};
}

// Readers of the parameters, in the order of the table below.

void get_buttons(const Look& look, Numbers& to) {
  put_one(look.state.buttons, to);
}
void get_counts(const Look& look, Numbers& to) {
  for (std::size_t i = 0; i < 3; ++i) to[i] = look.state.counts[i];
}
void get_pinch(const Look& look, Numbers& to) {
  put_one(kMillimetres * static_cast<double>(look.state.gripper), to);
}
void get_position(const Look& look, Numbers& to) {
  put(to_hd(look.state.p_WT), to, kMillimetres);
}
void get_velocity(const Look& look, Numbers& to) {
  put(to_hd(look.state.v_WT), to, kMillimetres);
}
void get_transform(const Look& look, Numbers& to) {
  put(transform_of(look.state), to);
}
void get_turning(const Look& look, Numbers& to) {
  put(to_hd(look.state.w_WT), to);
}
/// 6 x 6, row by row. The first three rows contain mm per rad of the first three joints. The rest
/// (gimbal axes, rotation) is unknown: zeros.
void get_jacobian(const Look& look, Numbers& to) {
  for (std::size_t joint = 0; joint < 3; ++joint) {
    const std::array<double, 3> column =
        to_hd({look.state.J_WT[joint], look.state.J_WT[3 + joint], look.state.J_WT[6 + joint]});
    for (std::size_t row = 0; row < 3; ++row) to[6 * row + joint] = kMillimetres * column[row];
  }
}
void get_joints(const Look& look, Numbers& to) {
  put(look.state.q, to);
}
void get_gimbal(const Look& look, Numbers& to) {
  for (std::size_t i = 0; i < 3; ++i) to[i] = static_cast<double>(look.state.gimbal[i]);
}
void get_force(const Look& look, Numbers& to) {
  put(to_hd(look.device.frame.command.f_W), to);
}
void get_force_sent(const Look& look, Numbers& to) {
  put(to_hd(look.state.f_sent_W), to);
}
void get_torque(const Look& look, Numbers& to) {
  put(to_hd(look.device.frame.command.torque_W), to, kMillimetres);
}
void get_joint_torque(const Look& look, Numbers& to) {
  put(joint_torques(look.state, look.device.frame.command.f_W), to);
}
void get_joint_torque_sent(const Look& look, Numbers& to) {
  put(joint_torques(look.state, look.state.f_sent_W), to);
}
void get_gimbal_torque(const Look& look, Numbers& to) {
  put(look.device.frame.command.gimbal, to, kMillimetres);
}
void get_nothing(const Look&, Numbers&) {}
void get_true(const Look&, Numbers& to) {
  put_one(1, to);
}
void get_workspace(const Look& look, Numbers& to) {
  put(to_hd(look.facts.workspace_min), to, kMillimetres);
  const std::array<double, 3> max_corner = to_hd(look.facts.workspace_max);
  for (std::size_t i = 0; i < 3; ++i) to[3 + i] = kMillimetres * max_corner[i];
}
/// The height of the origin above the table, as if the workspace were on it.
void get_tabletop(const Look& look, Numbers& to) {
  put_one(kMillimetres * look.facts.workspace_min[2], to);
}
void get_input_dof(const Look& look, Numbers& to) {
  put_one(look.facts.has_orientation ? 6 : 3, to);
}
void get_output_dof(const Look&, Numbers& to) {
  put_one(kMotors, to);
}
void get_calibration_style(const Look&, Numbers& to) {
  put_one(HD_CALIBRATION_AUTO, to);
}
void get_rate(const Look& look, Numbers& to) {
  put_one(look.facts.rate, to);
}
void get_measured_rate(const Look& look, Numbers& to) {
  const Frame& frame = look.device.frame;
  const auto period = static_cast<double>(frame.now.time_ns - frame.last.time_ns);
  put_one(period > 0 ? 1e9 / period : 0, to);
}
void get_stiffness(const Look& look, Numbers& to) {  // N/mm
  put_one(look.facts.stiffness_max / kMillimetres, to);
}
void get_damping(const Look& look, Numbers& to) {  // N s/mm
  put_one(look.facts.damping_max / kMillimetres, to);
}
void get_force_max(const Look& look, Numbers& to) {
  put_one(look.facts.force_max, to);
}
void get_force_continuous(const Look& look, Numbers& to) {
  // If unknown: the maximum force. The heat guard of the arm protects the motors in any case.
  const double known = look.facts.force_continuous;
  put_one(known > 0 ? known : look.facts.force_max, to);
}
void get_heat(const Look& look, Numbers& to) {
  put(look.state.heat, to);
}
void get_velocity_limit(const Look& look, Numbers& to) {
  const double own = look.device.velocity_limit;
  put_one(own > 0 ? own : kMillimetres * look.facts.speed_max, to);
}
void get_impulse_limit(const Look& look, Numbers& to) {
  constexpr double kMilliseconds = 1e3;  // per s
  const double own = look.device.impulse_limit;
  put_one(own > 0 ? own : look.facts.rise_max / kMilliseconds, to);
}
void get_ramping_rate(const Look& look, Numbers& to) {
  put_one(look.device.ramping_rate, to);
}
void get_light(const Look& look, Numbers& to) {
  put(look.device.light, to);
}
void get_joint_references(const Look& look, Numbers& to) {
  put(look.device.joint_references, to);
}

// Writers of the parameters.

/// Returns the command of the open frame of this thread; null without one.
ForceCommand* command_of(Device& device) {
  Frame& frame = device.frame;
  if (!frame.open || frame.owner != std::this_thread::get_id()) return nullptr;
  frame.commanded = true;
  return &frame.command;
}

HDerror set_force(HHD, Device& device, const Numbers& from) {
  ForceCommand* command = command_of(device);
  if (command == nullptr) return HD_FRAME_ERROR;
  command->f_W = from_hd(first_three(from));
  return HD_SUCCESS;
}
HDerror set_torque(HHD, Device& device, const Numbers& from) {
  ForceCommand* command = command_of(device);
  if (command == nullptr) return HD_FRAME_ERROR;
  command->torque_W = from_hd(first_three(from, 1 / kMillimetres));
  return HD_SUCCESS;
}
HDerror set_joint_torque(HHD, Device& device, const Numbers& from) {
  ForceCommand* command = command_of(device);
  if (command == nullptr) return HD_FRAME_ERROR;
  std::array<double, 3> f{};
  const auto tau = first_three(from, 1 / kMillimetres);
  const bool solved = force_of_torques(device.frame.now.J_WT, tau, f);
  command->f_W = f;  // none if there is no force for these torques
  return solved ? HD_SUCCESS : HD_FORCE_ERROR;
}
/// Our arms have no gimbal motors: stored as a torque, which is reported and ignored.
HDerror set_gimbal_torque(HHD, Device& device, const Numbers& from) {
  ForceCommand* command = command_of(device);
  if (command == nullptr) return HD_FRAME_ERROR;
  command->gimbal = first_three(from, 1 / kMillimetres);
  return HD_SUCCESS;
}
/// Motors are only controlled through the gate.
HDerror set_motors(HHD, Device&, const Numbers&) {
  return HD_INVALID_OPERATION;
}
HDerror set_velocity_limit(HHD handle, Device& device, const Numbers& from) {
  if (!(from[0] > 0)) return HD_INVALID_VALUE;
  device.velocity_limit = from[0];
  apply_velocity_limit(handle);
  return HD_SUCCESS;
}
HDerror set_impulse_limit(HHD, Device& device, const Numbers& from) {
  if (!(from[0] > 0)) return HD_INVALID_VALUE;
  device.impulse_limit = from[0];
  return HD_SUCCESS;
}
HDerror set_ramping_rate(HHD, Device& device, const Numbers& from) {
  if (!(from[0] > 0)) return HD_INVALID_VALUE;
  device.ramping_rate = from[0];
  return HD_SUCCESS;
}
HDerror set_light(HHD, Device& device, const Numbers& from) {
  device.light[0] = from[0];
  return HD_SUCCESS;
}
HDerror set_joint_references(HHD, Device& device, const Numbers& from) {
  device.joint_references = first_three(from);
  return HD_SUCCESS;
}

constexpr bool kLast = true;

// clang-format off
constexpr Parameter kParameters[] = {
    {HD_CURRENT_BUTTONS, 1, false, get_buttons},
    {HD_CURRENT_SAFETY_SWITCH, 1, false, get_true},
    {HD_CURRENT_INKWELL_SWITCH, 1, false, get_nothing},
    {HD_CURRENT_ENCODER_VALUES, 6, false, get_counts},
    {HD_CURRENT_PINCH_VALUE, 1, false, get_pinch},
    {HD_LAST_PINCH_VALUE, 1, kLast, get_pinch},
    {HD_CURRENT_POSITION, 3, false, get_position},
    {HD_CURRENT_VELOCITY, 3, false, get_velocity},
    {HD_CURRENT_TRANSFORM, 16, false, get_transform},
    {HD_CURRENT_ANGULAR_VELOCITY, 3, false, get_turning},
    {HD_CURRENT_JACOBIAN, 36, false, get_jacobian},
    {HD_CURRENT_JOINT_ANGLES, 3, false, get_joints},
    {HD_CURRENT_GIMBAL_ANGLES, 3, false, get_gimbal},
    {HD_LAST_BUTTONS, 1, kLast, get_buttons},
    {HD_LAST_SAFETY_SWITCH, 1, kLast, get_true},
    {HD_LAST_INKWELL_SWITCH, 1, kLast, get_nothing},
    {HD_LAST_ENCODER_VALUES, 6, kLast, get_counts},
    {HD_LAST_POSITION, 3, kLast, get_position},
    {HD_LAST_VELOCITY, 3, kLast, get_velocity},
    {HD_LAST_TRANSFORM, 16, kLast, get_transform},
    {HD_LAST_ANGULAR_VELOCITY, 3, kLast, get_turning},
    {HD_LAST_JACOBIAN, 36, kLast, get_jacobian},
    {HD_LAST_JOINT_ANGLES, 3, kLast, get_joints},
    {HD_LAST_GIMBAL_ANGLES, 3, kLast, get_gimbal},
    {HD_DEVICE_FIRMWARE_VERSION, 1, false, get_nothing},
    {HD_MAX_WORKSPACE_DIMENSIONS, 6, false, get_workspace},
    {HD_USABLE_WORKSPACE_DIMENSIONS, 6, false, get_workspace},
    {HD_TABLETOP_OFFSET, 1, false, get_tabletop},
    {HD_INPUT_DOF, 1, false, get_input_dof},
    {HD_OUTPUT_DOF, 1, false, get_output_dof},
    {HD_CALIBRATION_STYLE, 1, false, get_calibration_style},
    {HD_UPDATE_RATE, 1, false, get_rate},
    {HD_INSTANTANEOUS_UPDATE_RATE, 1, false, get_measured_rate},
    {HD_NOMINAL_MAX_STIFFNESS, 1, false, get_stiffness},
    {HD_NOMINAL_MAX_DAMPING, 1, false, get_damping},
    {HD_NOMINAL_MAX_FORCE, 1, false, get_force_max},
    {HD_NOMINAL_MAX_CONTINUOUS_FORCE, 1, false, get_force_continuous},
    {HD_MOTOR_TEMPERATURE, kPerMotor, false, get_heat},
    {HD_SOFTWARE_VELOCITY_LIMIT, 1, false, get_velocity_limit, set_velocity_limit},
    {HD_SOFTWARE_FORCE_IMPULSE_LIMIT, 1, false, get_impulse_limit, set_impulse_limit},
    {HD_FORCE_RAMPING_RATE, 1, false, get_ramping_rate, set_ramping_rate},
    {HD_NOMINAL_MAX_TORQUE_STIFFNESS, 1, false, get_nothing},
    {HD_NOMINAL_MAX_TORQUE_DAMPING, 1, false, get_nothing},
    {HD_NOMINAL_MAX_TORQUE_FORCE, 1, false, get_nothing},
    {HD_NOMINAL_MAX_TORQUE_CONTINUOUS_FORCE, 1, false, get_nothing},
    {HD_CURRENT_FORCE, 3, false, get_force, set_force},
    {HD_CURRENT_TORQUE, 3, false, get_torque, set_torque},
    {HD_JOINT_ANGLE_REFERENCES, 3, false, get_joint_references, set_joint_references},
    {HD_CURRENT_JOINT_TORQUE, 3, false, get_joint_torque, set_joint_torque},
    {HD_CURRENT_GIMBAL_TORQUE, 3, false, get_gimbal_torque, set_gimbal_torque},
    {HD_CURRENT_MOTOR_DAC_VALUES, kPerMotor, false, get_nothing, set_motors},
    {HD_LAST_FORCE, 3, kLast, get_force_sent},
    {HD_LAST_TORQUE, 3, kLast, get_nothing},
    {HD_LAST_JOINT_TORQUE, 3, kLast, get_joint_torque_sent},
    {HD_LAST_GIMBAL_TORQUE, 3, kLast, get_nothing},
    {HD_LAST_MOTOR_DAC_VALUES, kPerMotor, kLast, get_nothing},
    {HD_USER_STATUS_LIGHT, 1, false, get_light, set_light},
};
// clang-format on

}  // namespace

const Parameter* find_parameter(HDenum number) noexcept {
  const auto found = std::find_if(std::begin(kParameters), std::end(kParameters),
                                  [&](const Parameter& p) { return p.number == number; });
  return found == std::end(kParameters) ? nullptr : found;
}

std::size_t count_of(const Parameter& parameter, const ArmFacts&) noexcept {
  return parameter.count == kPerMotor ? kMotors : parameter.count;
}

std::span<const Parameter> parameters() noexcept {
  return kParameters;
}

bool is_text(HDenum number) noexcept {
  return number == HD_VERSION || number == HD_DEVICE_MODEL_TYPE ||
         number == HD_DEVICE_DRIVER_VERSION || number == HD_DEVICE_VENDOR ||
         number == HD_DEVICE_SERIAL_NUMBER || number == HD_DEVICE_FIRMWARE_VERSION;
}

std::array<double, 3> to_hd(const std::array<double, 3>& v_W) noexcept {
  return {v_W[1], v_W[2], v_W[0]};
}

std::array<double, 3> from_hd(const std::array<double, 3>& v_hd) noexcept {
  return {v_hd[2], v_hd[0], v_hd[1]};
}

std::array<double, 16> transform_of(const ArmReading& state) noexcept {
  // Rows and columns of the rotation are both converted: the stylus has HDAPI's axes, too.
  constexpr std::size_t kWorld[3] = {1, 2, 0};  // our axis of each of HDAPI's
  std::array<double, 16> transform{};
  for (std::size_t column = 0; column < 3; ++column) {
    for (std::size_t row = 0; row < 3; ++row) {
      transform[4 * column + row] = state.R_WT[3 * kWorld[row] + kWorld[column]];
    }
  }
  const std::array<double, 3> p = to_hd(state.p_WT);
  for (std::size_t i = 0; i < 3; ++i) transform[12 + i] = kMillimetres * p[i];
  transform[15] = 1;
  return transform;
}

}  // namespace thimble::compat::hd
