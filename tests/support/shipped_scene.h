#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <string>
#include <utility>

#include "thimble/session/session.h"

namespace thimble::support {

/// Opens a shipped scene on the virtual clock; fails the test on error.
inline std::unique_ptr<session::Session> open_shipped(const std::string& name,
                                                      const session::SessionOptions& options = {}) {
  auto opened = session::Session::open(
      std::filesystem::path(THIMBLE_SOURCE_DIR) / "app/scenes" / (name + ".yaml"), options);
  if (!opened) {
    ADD_FAILURE() << opened.error().message;
    return nullptr;
  }
  return std::move(opened).value();
}

}  // namespace thimble::support
