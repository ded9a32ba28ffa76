#pragma once

#include <memory>
#include <vector>

#include "thimble/driver/result.h"
#include "view/gl/canvas.h"

struct GLFWwindow;

namespace thimble::view {

/// The window with its OpenGL and ImGui; all go with it. Real-time: never from the servo thread.
class Screen {
 public:
  /// The error says why there is none.
  static driver::Result<std::unique_ptr<Screen>> open();
  Screen(const Screen&) = delete;
  Screen& operator=(const Screen&) = delete;
  ~Screen();

  GLFWwindow* window() { return window_; }
  /// Returns how much larger than usual everything is to be.
  float scale() const { return scale_; }
  /// Returns the keys pressed since it was asked last, but those typed into a field.
  std::vector<int> take_keys();

  /// Scales text and panel by this from now on; 0: as the monitor is.
  void set_scale(double wanted) { wanted_scale_ = static_cast<float>(wanted); }
  /// Begins a picture of ImGui: takes what mouse and keys did.
  void begin(Theme theme);
  /// Draws what was asked of ImGui since.
  void end();
  /// Reads what the window shows.
  Picture read();

 private:
  Screen() = default;

  bool glfw_ = false;
  bool imgui_ = false;
  GLFWwindow* window_ = nullptr;
  float scale_ = 0;
  float wanted_scale_ = 0;  // 0: the monitor's
  Theme theme_ = Theme::kLight;
  std::vector<int> keys_;
};

}  // namespace thimble::view
