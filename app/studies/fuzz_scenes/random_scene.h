#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "thimble/scene/arm_file.h"

namespace thimble::studies {

/// Limits of random scenes. Stiffness is within the limits of arm and loop by the laws, so that any
/// trouble is an error of the program or of a law. Scenes for which a law predicts a small limit
/// cycle (facets, textures, light bodies) are included, and `rest_causes` must name the cause.
struct RandomSceneLimits {
  scene::ArmFile arm;
  /// Paths of the arm's file and of the folder of small meshes, as written into the scene.
  std::string arm_path, mesh_path;
  /// Maximum stiffness as a fraction of the latency budget of this arm with the drawn hand [PHYSICS
  /// 1.1; PHYSICS 1.6 leaves a margin of 1.1 to 1.2, the drawn scenes leave 1.25].
  double stiffness_share = 0.8;
};

/// A scene as the text of its file, and properties for the energy account.
struct RandomScene {
  std::string text;  ///< YAML.
  /// Energy that the scene itself may add to the hand, J: from weights and from force fields.
  double own_energy = 0;
  /// Whether a friction of the scene inherently has a limit cycle at rest on coarse encoders: naive
  /// and paper, kept for comparison with [PHYSICS 2.2].
  bool oscillates = false;
};

/// Makes a random scene with one to three objects (shapes, small meshes with every contact method,
/// fields), stiffness, damping, friction, texture, and bodies of every kind. A hand of random
/// firmness strokes, presses, crosses and leaves them for 1.6 s, and then rests for the same time.
/// The same seed gives the same scene on every machine. Real-time: never from the servo thread.
RandomScene random_scene(std::uint64_t seed, const RandomSceneLimits& limits);

}  // namespace thimble::studies
