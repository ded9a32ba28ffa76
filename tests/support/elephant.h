#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <memory>

#include "session.h"

namespace thimble::support {

/// Says where the demo's scene is.
inline std::filesystem::path elephant_scene() {
  return std::filesystem::path(THIMBLE_SOURCE_DIR) / "app/scenes/elephant.yaml";
}

/// Tells whether the scanned meshes are there (app/fetch_meshes.sh brings them).
inline bool have_meshes() {
  return std::filesystem::exists(std::filesystem::path(THIMBLE_MESHES) / "elephant.off");
}

/// Opens the demo's scene on the virtual clock; fails the test if that cannot be done.
inline std::unique_ptr<app::Session> open_elephant(std::optional<double> duration = {},
                                                   std::optional<std::uint64_t> seed = {}) {
  app::SessionOptions options;
  options.duration = duration;
  options.seed = seed;
  options.mesh_folder = THIMBLE_MESHES;
  auto session = app::Session::open(elephant_scene(), options);
  if (!session) {
    ADD_FAILURE() << session.error().message;
    return nullptr;
  }
  return std::move(session).value();
}

}  // namespace thimble::support

/// Skips a test that needs the scanned meshes where they are not there.
#define THIMBLE_NEEDS_MESHES()                                                               \
  if (!thimble::support::have_meshes()) {                                                    \
    GTEST_SKIP() << "Needs the scanned meshes: run app/fetch_meshes.sh (it downloads them)"; \
  }
