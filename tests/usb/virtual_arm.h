#pragma once

#include <algorithm>
#include <memory>
#include <string>
#include <string_view>

#include "thimble/driver/arm.h"
#include "thimble/driver/clock.h"
#include "thimble/driver/device.h"
#include "thimble/driver/discovery.h"
#include "thimble/driver/force_law.h"

namespace thimble::usb_test {

/// A wall normal to an axis of the base, a spring of 300 N/m. The simulated hand moves to and fro
/// along this axis once a second. The wall is at a stated distance below the highest position of
/// the tip, so it does not depend on the position of the hand at the start of the check. It rises
/// slowly, so that a corrupt report does not move it far.
class Wall {
 public:
  static constexpr double kStiffness = 300;   // N/m
  static constexpr double kRiseMax = 0.0002;  // m per tick; the hand moves 0.13 mm per tick

  Wall(int axis, double below) : axis_(axis), below_(below) {}

  driver::ForceCommand operator()(const driver::DeviceState& state) noexcept {
    const double height = state.p_WT[axis_];
    if (!placed_) top_ = height;
    placed_ = true;
    if (height > top_) top_ += std::min(height - top_, kRiseMax);
    driver::ForceCommand command;
    const double depth = top_ - below_ - height;
    if (depth > 0) {
      command.f_T_W[axis_] = kStiffness * depth;
      command.touch.in_contact = true;
      command.touch.depth = depth;
    }
    return command;
  }

 private:
  int axis_;
  double below_;  // m
  bool placed_ = false;
  double top_ = 0;
};

/// One of the arms that `thimble plug` exports, opened like by a driver: through its nodes in the
/// kernel.
struct VirtualArm {
  std::string name;
  std::string firmware;  ///< Firmware file of the Falcon.

  bool is_falcon() const { return name == "falcon"; }
  /// Returns whether it has one or two motors. Such an arm is that of an arm file, on the board of
  /// the Polhem.
  bool is_short() const { return name == "five_bar" || name == "hapkit"; }
  /// Returns the name of its board for `thimble plug`.
  std::string board() const { return is_short() ? "polhem" : name; }
  /// Returns a wall that the simulated hand presses the tip into. It moves 30 mm or more along z,
  /// or 15 mm along the last axis of a short arm.
  Wall wall() const {
    if (!is_short()) return {2, 0.019};
    return {name == "hapkit" ? 0 : 1, 0.007};
  }
  /// Returns whether it sends reports only after messages.
  bool answers() const { return name != "woodenhaptics"; }
  /// Returns the bytes of its messages, 0 for a Falcon.
  std::size_t message_size() const;
  /// Returns the serial number that its board reports.
  std::string serial() const;
  std::unique_ptr<const driver::Arm> protocol() const;

  /// Waits for the arm to be listed with this serial number (or any, if empty).
  driver::Result<driver::FoundArm> find(const std::string& serial = {},
                                        int timeout_ms = 5000) const;

  /// Opens the wire to it. Boots and homes a Falcon, whose grip is moved by the simulated hand.
  driver::Result<std::unique_ptr<driver::Transport>> open(const driver::FoundArm& found,
                                                          const driver::Clock& clock) const;
};

/// Returns the limits under which all checks run.
driver::DeviceSettings check_settings();

}  // namespace thimble::usb_test
