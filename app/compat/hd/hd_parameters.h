#pragma once

#include <HD/hd.h>

#include <array>
#include <span>

#include "compat/hd/hd_device.h"

namespace thimble::compat::hd {

/// The maximum number of values of a parameter.
inline constexpr std::size_t kNumbersMax = 36;
using Numbers = std::array<double, kNumbersMax>;
/// Count of a parameter with one value for each motor: HD_OUTPUT_DOF values.
inline constexpr std::size_t kPerMotor = 0;

/// The sources of a parameter's values.
struct Look {
  HHD handle = 0;           ///< The arm's number.
  const Device& device;     ///< State of the device in this process.
  const ArmFacts& facts;    ///< Properties of the arm.
  const ArmReading& state;  ///< State for CURRENT or LAST parameters.
};

/// One numeric parameter of HDAPI, in HDAPI's units and axes.
struct Parameter {
  HDenum number;                                         ///< Its constant.
  std::size_t count;                                     ///< Number of its values, or kPerMotor.
  bool last = false;                                     ///< Uses the previous frame.
  void (*get)(const Look& look, Numbers& to) = nullptr;  ///< Null: it is not readable.
  /// Sets it; returns HD_SUCCESS or the error. Null: it is not writable.
  HDerror (*set)(HHD handle, Device& device, const Numbers& from) = nullptr;
};

/// Returns the parameter of a constant; null if there is none.
const Parameter* find_parameter(HDenum number) noexcept;
/// Returns all numeric parameters.
std::span<const Parameter> parameters() noexcept;
/// Returns the number of values of a parameter for an arm.
std::size_t count_of(const Parameter& parameter, const ArmFacts& facts) noexcept;
/// Returns whether a constant names a text.
bool is_text(HDenum number) noexcept;

/// Converts a vector from W to HDAPI's axes: x right, y up, z to the user.
std::array<double, 3> to_hd(const std::array<double, 3>& v_W) noexcept;
/// Converts a vector from HDAPI's axes to W.
std::array<double, 3> from_hd(const std::array<double, 3>& v_hd) noexcept;
/// Returns the transform of a state: 16 numbers, column by column, mm.
std::array<double, 16> transform_of(const ArmReading& state) noexcept;

}  // namespace thimble::compat::hd
