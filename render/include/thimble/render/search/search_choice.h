#pragma once

namespace thimble::render {

/// How contact is looked for while the tip is free. All give the same answers.
enum class SearchChoice {
  kLinear,  ///< Every triangle [BP 3.1]: no structure, time grows with the mesh.
  kGrid,    ///< Space cut into volumes [BP 4.1]: fastest where few triangles are of like size.
  kTree,    ///< A tree of boxes: fast however the triangles lie.
};

}  // namespace thimble::render
