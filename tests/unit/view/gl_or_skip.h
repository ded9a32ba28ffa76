#pragma once

#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <memory>
#include <utility>

#include "view/gl/offscreen_context.h"

namespace thimble::support {

/// Opens OpenGL without a screen. Where there is none, says so loudly and gives nullptr; in CI,
/// which has it by app/setup.sh, that is a failure.
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
