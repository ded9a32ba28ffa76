#pragma once

#include <cstddef>

namespace thimble::scene {

/// Says where an object begins in a mesh of several.
struct MeshPlace {
  std::size_t vertex = 0;
  std::size_t triangle = 0;
};

}  // namespace thimble::scene
