#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <utility>

#include "support/scratch.h"
#include "thimble/session/session.h"

namespace thimble::support {

/// Returns the file of the demo's scene.
inline std::filesystem::path elephant_scene() {
  return std::filesystem::path(THIMBLE_SOURCE_DIR) / "app/scenes/elephant.yaml";
}

/// Returns whether the scanned meshes are available (app/fetch_meshes.sh downloads them).
inline bool have_meshes() {
  return std::filesystem::exists(std::filesystem::path(THIMBLE_MESHES) / "elephant.off");
}

/// Opens the demo's scene on the virtual clock; fails the test on error.
inline std::unique_ptr<session::Session> open_elephant(std::optional<double> duration = {},
                                                       std::optional<std::uint64_t> seed = {}) {
  session::SessionOptions options;
  options.duration = duration;
  options.seed = seed;
  options.mesh_folder = THIMBLE_MESHES;
  auto session = session::Session::open(elephant_scene(), options);
  if (!session) {
    ADD_FAILURE() << session.error().message;
    return nullptr;
  }
  return std::move(session).value();
}

/// Returns the text of the demo's scene with a `contact:` section, for a file in any folder.
inline std::string elephant_text(const std::string& contact) {
  std::ifstream stream(elephant_scene());
  std::string text{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  const std::string damping = "    damping: 1 ";
  text.insert(text.find(damping), "    contact: {" + contact + "}\n");
  return text;
}

/// Opens a scene from its text; null on error. The message goes to `error`; without it the test
/// fails.
inline std::unique_ptr<session::Session> open_elephant_text(const std::string& text,
                                                            std::string* error = nullptr) {
  const auto file = scratch_folder() / "elephant.yaml";
  std::ofstream(file) << text;
  session::SessionOptions options;
  options.mesh_folder = THIMBLE_MESHES;
  auto session = session::Session::open(file, options);
  if (error != nullptr) *error = session ? "" : session.error().message;
  if (!session) {
    if (error == nullptr) ADD_FAILURE() << session.error().message;
    return nullptr;
  }
  return std::move(session).value();
}

}  // namespace thimble::support

/// Skips a test that needs the scanned meshes if they are not available.
#define THIMBLE_NEEDS_MESHES()                                                               \
  if (!thimble::support::have_meshes()) {                                                    \
    GTEST_SKIP() << "Needs the scanned meshes: run app/fetch_meshes.sh (it downloads them)"; \
  }
