// Bodies that meet, for programs whose package does not depend on Bullet. They are in the module
// thimble-bodies.so, which is loaded at the first use. This is linked before thimble_scene and
// replaces its function.
#include <utility>

#include "cli/parts/bodies.h"
#include "cli/parts/load_module.h"

namespace thimble::render {

driver::Result<CollidingTouches> collide_objects(std::vector<CollidingObject> objects,
                                                 const std::vector<ObjectJoint>& joints,
                                                 const CollisionQuality& quality,
                                                 std::size_t hands) {
  const auto bodies = cli::load_module(
      {cli::kBodiesFile, cli::kBodiesSymbol, "thimble-bodies"},
      "Bodies that meet, and joints, require the package thimble-bodies. Run `sudo apt install "
      "thimble-bodies`, or set collision: {shape: none} for all objects that move and remove "
      "joints.");
  if (!bodies) return bodies.error();
  return static_cast<const cli::Bodies*>(*bodies)->collide(std::move(objects), joints, quality,
                                                           hands);
}

}  // namespace thimble::render
