#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <string>

#include "support/scratch.h"
#include "view/shot.h"

namespace thimble::support {

/// Returns the file of a shipped scene.
inline std::filesystem::path shipped_scene(const std::string& name) {
  return std::filesystem::path(THIMBLE_SOURCE_DIR) / "app/scenes" / (name + ".yaml");
}

/// Records a run of a scene in virtual time, and returns the file NAME.h5.
inline std::filesystem::path record_touch(const std::filesystem::path& scene,
                                          const std::string& name, double duration,
                                          std::uint64_t seed) {
  session::SessionOptions options;
  options.several_arms = true;
  options.duration = duration;
  options.seed = seed;
  options.record = scratch_folder() / (name + ".h5");
  options.overwrite = true;
  auto played = view::PlayedScene::open(scene, options);
  if (!played) {
    ADD_FAILURE() << played.error().message;
    return options.record;
  }
  (*played)->play({duration}, [](view::DrawnMoment&, const view::Plots&) {});
  return options.record;
}

}  // namespace thimble::support
