#pragma once

namespace thimble::render {

/// Contact search while the tip is free. All give the same results.
enum class SearchChoice {
  kLinear,  ///< Tests every triangle [BP 3.1]: no data structure; time grows with the mesh.
  kGrid,    ///< Regular grid [BP 4.1]: fastest for few triangles of similar size.
  kTree,    ///< Tree of bounding boxes: fast for any distribution of triangles.
};

}  // namespace thimble::render
