#pragma once

#include <memory>
#include <string>

#include "thimble/driver/result.h"

namespace thimble::view {

/// OpenGL 3.3 without a screen: EGL without a surface, on the processor if there is no graphics
/// card (Mesa). Current on the thread that made it for as long as it lives.
class OffscreenContext {
 public:
  /// Makes one. The error says what is missing. Real-time: never from the servo thread.
  static driver::Result<std::unique_ptr<OffscreenContext>> open();
  OffscreenContext(const OffscreenContext&) = delete;
  OffscreenContext& operator=(const OffscreenContext&) = delete;
  ~OffscreenContext();

  /// Returns what draws, in its maker's words.
  std::string renderer() const;

 private:
  OffscreenContext() = default;

  void* display_ = nullptr;
  void* context_ = nullptr;
};

}  // namespace thimble::view
