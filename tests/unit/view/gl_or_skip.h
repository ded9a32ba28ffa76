#pragma once

#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <memory>
#include <utility>

#include "view/gl/offscreen_context.h"

namespace thimble::support {

/// Opens OpenGL without a screen. If there is none, prints a warning and returns nullptr; in CI,
/// where app/setup.sh installs it, the test fails.
inline std::unique_ptr<view::OffscreenContext> open_gl() {
  auto context = view::OffscreenContext::open();
  if (context) return std::move(context).value();
  if (std::getenv("CI") != nullptr) {
    ADD_FAILURE() << context.error().message;
  } else {
    std::fprintf(stderr, "NOT TESTED: pictures. %s\n", context.error().message.c_str());
  }
  return nullptr;
}

}  // namespace thimble::support
