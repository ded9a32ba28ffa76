#pragma once

#include <memory>
#include <string>
#include <vector>

#include "thimble/driver/result.h"
#include "view/gl/canvas.h"
#include "view/gl/palette.h"

struct GLFWwindow;

namespace thimble::view {

/// The window with its OpenGL and ImGui contexts. Real-time: never from the servo thread.
class Screen {
 public:
  /// Opens a window; the error says why it cannot.
  static driver::Result<std::unique_ptr<Screen>> open();
  Screen(const Screen&) = delete;
  Screen& operator=(const Screen&) = delete;
  ~Screen();

  GLFWwindow* window() { return window_; }
  /// Returns the scale of text and panel; 1 is the usual size.
  float scale() const { return scale_; }
  /// Returns the keys pressed since the last call, except those typed into a field.
  std::vector<int> take_keys();
  /// Returns the files that were dropped on the window since the last call.
  std::vector<std::string> take_drops();

  /// Sets the scale of text and panel; 0: that of the monitor.
  void set_scale(double wanted) { wanted_scale_ = static_cast<float>(wanted); }
  /// Begins a picture of ImGui and takes the input of mouse and keys.
  void begin(Theme theme);
  /// Draws the ImGui content since `begin`.
  void end();
  /// Reads the content of the window.
  Picture read();

 private:
  Screen() = default;
  void poll_events();

  bool glfw_ = false;
  bool imgui_ = false;
  GLFWwindow* window_ = nullptr;
  float scale_ = 0;
  float wanted_scale_ = 0;  // 0: the monitor's
  Theme theme_ = Theme::kLight;
  std::vector<int> keys_;
  std::vector<int> pressed_;  // since the last picture
  std::vector<int> short_;    // down in this picture only
  std::vector<std::string> drops_;
};

}  // namespace thimble::view
