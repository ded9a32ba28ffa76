#pragma once

#include <memory>
#include <string>

#include "thimble/driver/result.h"

namespace thimble::view {

/// OpenGL 3.3 without a screen: EGL without a surface, in software if there is no graphics card
/// (Mesa). The context is current on the thread that made it, for its lifetime.
class OffscreenContext {
 public:
  /// Makes a context. The error says what is missing. Real-time: never from the servo thread.
  static driver::Result<std::unique_ptr<OffscreenContext>> open();
  OffscreenContext(const OffscreenContext&) = delete;
  OffscreenContext& operator=(const OffscreenContext&) = delete;
  ~OffscreenContext();

  /// Returns the name of the renderer, as its vendor gives it.
  std::string renderer() const;

 private:
  OffscreenContext() = default;

  void* display_ = nullptr;
  void* context_ = nullptr;
};

}  // namespace thimble::view
