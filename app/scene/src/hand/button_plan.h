#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "thimble/scene/hand_route.h"

namespace thimble::scene {

/// One press of a button.
struct ButtonPress {
  double begin = 0;           ///< Time, s; 0: the run begins.
  double duration = 0;        ///< s
  std::uint16_t buttons = 0;  ///< One bit.
};

/// Returns the press that "SECONDS[:BUTTON[:DURATION]]" describes; without them, the first button
/// for 0.2 s. The error states what was expected. Real-time: never from the servo thread.
THIMBLE_EXPORT driver::Result<ButtonPress> read_button_press(const std::string& text);

/// Reads several presses of an option; the error names `option`. Real-time: never from the servo
/// thread.
THIMBLE_EXPORT driver::Result<std::vector<ButtonPress>> read_button_presses(
    const std::string& option, const std::vector<std::string>& texts);

/// Returns the steps of buttons that are held by `held` (in order of time) or by a press.
/// Real-time: never from the servo thread.
THIMBLE_EXPORT std::vector<ButtonStep> steps_of(const std::vector<ButtonPress>& presses,
                                                const std::vector<ButtonStep>& held = {});

/// Buttons of a simulated arm over time.
class ButtonPlan {
 public:
  /// Takes steps in order of time. Real-time: never from the servo thread.
  explicit ButtonPlan(std::vector<ButtonStep> steps = {}) : steps_(std::move(steps)) {}

  /// Returns whether no button is ever held. Real-time: safe.
  bool empty() const noexcept { return steps_.empty(); }
  /// Returns the buttons that are held at a time, s. Precondition: times do not decrease.
  /// Real-time: safe.
  std::uint16_t at(double time) noexcept {
    while (passed_ < steps_.size() && steps_[passed_].time <= time) ++passed_;
    return passed_ > 0 ? steps_[passed_ - 1].buttons : std::uint16_t{0};
  }

 private:
  std::vector<ButtonStep> steps_;
  std::size_t passed_ = 0;  // steps that have begun
};

}  // namespace thimble::scene
