#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "thimble/scene/arm_file.h"

namespace thimble::studies {

/// Between what limits random scenes are drawn. Stiffness lies within what an arm and a loop
/// can carry by the laws, so that any trouble is a mistake of the program or of a law. What a law
/// foretells a small limit cycle of (facets, textures, light bodies) is drawn all the same, and
/// `rest_causes` must name it.
struct RandomSceneLimits {
  scene::ArmFile arm;
  /// Where the scene will say that the arm's file and the folder of the small meshes are.
  std::string arm_path, mesh_path;
  /// Of the stiffness that the latency budget allows this arm with the hand that was drawn, so much
  /// is asked for at most [PHYSICS 1.1; PHYSICS 1.6 leaves 1.1 to 1.2, what is drawn leaves
  /// 1.25].
  double stiffness_share = 0.8;
};

/// A scene as its file says it, and what the energy account must know of it.
struct RandomScene {
  std::string text;  ///< YAML.
  /// Energy that the scene itself may give to the hand, J: of weights and of fields of force.
  double own_energy = 0;
  /// Whether a friction of the scene is one that has a limit cycle at rest on coarse encoders by
  /// its nature: naive and paper, kept to compare with [PHYSICS 2.2].
  bool oscillates = false;
};

/// Draws a scene and a hand: one to three objects (shapes, small meshes in every way of contact,
/// fields), stiffness, damping, friction, texture, bodies of every kind, and 1.6 s of a hand
/// of random firmness that strokes, presses, crosses and leaves them, and then rests for as long.
/// The same seed gives the same scene on every machine. Real-time: never from the servo thread.
RandomScene random_scene(std::uint64_t seed, const RandomSceneLimits& limits);

}  // namespace thimble::studies
