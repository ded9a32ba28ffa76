#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "view/input/space_mouse_report.h"

struct hid_device_;

namespace thimble::view {

/// Returns whether a HID interface is that of a SpaceMouse: its USB ids are known, and its usage,
/// if the system reports it, is that of a multi-axis controller.
bool is_space_mouse(unsigned vendor, unsigned product, unsigned usage_page,
                    unsigned usage) noexcept;

/// The plugged SpaceMouse, if any, over hidapi. Searches for one at intervals until one is found,
/// and again after it is unplugged. The device is only read, never written to. Used by one thread.
/// Real-time: never from the servo thread.
class SpaceMouse {
 public:
  SpaceMouse() = default;
  SpaceMouse(const SpaceMouse&) = delete;
  SpaceMouse& operator=(const SpaceMouse&) = delete;
  ~SpaceMouse();

  /// Takes the reports that have arrived, and returns its state; empty if there is no device.
  std::optional<SpaceMouseState> read();

  /// Returns what to do if there is no device; empty if there is one.
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
