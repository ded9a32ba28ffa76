#pragma once

#include <stddef.h>
#include <stdint.h>

#include "core/arm_config.h"

namespace thimble {
namespace firmware {

// The arm that boards for three motors drive. Edit this file for your arm; the numbers are those of
// app/arms/woodenhaptics_teensy.yaml with smaller currents.

/// Product string, by which the host recognises the board. 40 characters at most.
constexpr char kProduct[] = "Thimble arm: reference";

/// Range of the current amplifiers at full reference, A, and the duty cycles at its ends.
/// [chosen: maxon ESCON as WoodenHaptics has them, DEVICES 1; set the amplifiers to the same]
constexpr float kAmplifierRange = 6.0f, kReferenceLow = 0.1f, kReferenceHigh = 0.9f;

/// Divider of the supply's voltage in front of the converter: 100 kohm over 10 kohm. [chosen: 36 V
/// at 3.3 V]
constexpr float kSupplyDivider = 11.0f;

/// Returns the data of the arm. `board` has at most 6 characters.
inline ArmConfig own_arm(const char* board) noexcept {
  ArmConfig arm;
  arm.motors = 3;
  arm.geometry = Geometry::kSerial;
  arm.current_max_mA = 2000;
  arm.supply_min_mV = 9000;  // [chosen: the lowest supply of an ESCON is 10 V]
  constexpr float kRatio[kMotorsMax] = {16, 12, 12};
  for (size_t i = 0; i < kMotorsMax; ++i) {
    arm.counts_per_turn[i] = 2000;
    arm.ratio[i] = kRatio[i];
  }
  for (size_t i = 0; i < sizeof arm.board && board[i] != 0; ++i) arm.board[i] = board[i];
  return arm;
}

/// Returns the supply, mV, from a conversion of 12 bits over 3.3 V. Zero counts as not measured, so
/// that a board without the divider works.
inline uint16_t supply_mV(uint32_t conversion) noexcept {
  return static_cast<uint16_t>(static_cast<float>(conversion) * (3300.0f / 4095.0f) *
                               kSupplyDivider);
}

/// Returns the temperature, 0.1 degrees C, of an NTC of 10 kohm with B = 3950 K to ground, under 10
/// kohm to 3.3 V, from a conversion of 12 bits. The highest and lowest conversions mean that no
/// sensor is connected. Straight lines between computed points; the error is below 1 degree from 0
/// to 125 [C].
inline int16_t ntc_temperature(uint32_t conversion) noexcept {
  // 4095 R / (R + 10 kohm) with R = 10 kohm exp(3950 (1 / T - 1 / 298.15)).
  static constexpr int16_t kAt[] = {3156, 2625, 2048, 1514, 1081, 759, 532, 375, 267, 193, 142};
  static constexpr int16_t kFirst_dC = 0, kStep_dC = 125;
  if (conversion < 40 || conversion > 4055) return INT16_MIN;
  const int16_t value = static_cast<int16_t>(conversion);
  if (value >= kAt[0]) return kFirst_dC;
  for (int16_t i = 1; i < 11; ++i) {
    if (value < kAt[i]) continue;
    const int32_t part = static_cast<int32_t>(kAt[i - 1] - value) * kStep_dC;
    return static_cast<int16_t>(kFirst_dC + (i - 1) * kStep_dC + part / (kAt[i - 1] - kAt[i]));
  }
  return kFirst_dC + 10 * kStep_dC;
}

}  // namespace firmware
}  // namespace thimble
