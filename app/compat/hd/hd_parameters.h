#pragma once

#include <HD/hd.h>

#include <array>
#include <span>

#include "compat/hd/hd_device.h"

namespace thimble::compat::hd {

/// The most numbers that one parameter has.
inline constexpr std::size_t kNumbersMost = 36;
using Numbers = std::array<double, kNumbersMost>;

/// What the values of a parameter are made of.
struct Look {
  HHD handle = 0;           ///< The arm's number.
  const Device& device;     ///< What this process knows of it.
  const ArmFacts& facts;    ///< What it is.
  const ArmReading& state;  ///< What a CURRENT or LAST parameter is of.
};

/// One parameter of HDAPI that has numbers. In HDAPI's units and axes.
struct Parameter {
  HDenum number;                                         ///< Its constant.
  std::size_t count;                                     ///< How many numbers it has.
  bool last = false;                                     ///< Of the frame before.
  void (*get)(const Look& look, Numbers& to) = nullptr;  ///< Null: it cannot be read.
  /// Sets it; returns HD_SUCCESS or the error. Null: it cannot be set.
  HDerror (*set)(HHD handle, Device& device, const Numbers& from) = nullptr;
};

/// Returns the parameter of a constant; null if none has it.
const Parameter* find_parameter(HDenum number) noexcept;
/// Returns all parameters that have numbers.
std::span<const Parameter> parameters() noexcept;
/// Returns whether a constant is of a text.
bool is_text(HDenum number) noexcept;

/// Returns a vector of our world in HDAPI's axes: x right, y up, z to the user.
std::array<double, 3> to_hd(const std::array<double, 3>& v_W) noexcept;
/// Returns a vector in HDAPI's axes in our world's.
std::array<double, 3> from_hd(const std::array<double, 3>& v_hd) noexcept;
/// Returns a reading's transform: 16 numbers, column by column, mm.
std::array<double, 16> transform_of(const ArmReading& state) noexcept;

}  // namespace thimble::compat::hd
