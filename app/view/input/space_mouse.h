#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "view/input/space_mouse_report.h"

struct hid_device_;

namespace thimble::view {

/// Returns whether a HID interface is that of a SpaceMouse: its USB ids are known, and where the
/// system tells what it is used as, it is a multi-axis controller.
bool is_space_mouse(unsigned vendor, unsigned product, unsigned usage_page,
                    unsigned usage) noexcept;

/// The SpaceMouse that is plugged in, if any, over hidapi. Looks for one now and then until there
/// is one, and again when it is gone. It is only read: nothing is ever written to it. Used by one
/// thread. Real-time: never from the servo thread.
class SpaceMouse {
 public:
  SpaceMouse() = default;
  SpaceMouse(const SpaceMouse&) = delete;
  SpaceMouse& operator=(const SpaceMouse&) = delete;
  ~SpaceMouse();

  /// Takes the reports that have come, and returns how it stands; nothing if there is none.
  std::optional<SpaceMouseState> read();

  /// Returns what to do where there is none; empty where there is.
  const std::string& trouble() const { return trouble_; }

 private:
  void look();
  void close();

  hid_device_* device_ = nullptr;
  SpaceMouseState state_;
  std::string trouble_;
  std::chrono::steady_clock::time_point next_look_{};
};

}  // namespace thimble::view
