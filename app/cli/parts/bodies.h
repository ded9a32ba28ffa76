#pragma once

#include "collision/collide_objects.h"

namespace thimble::cli {

/// Bodies that meet, of the package thimble-bodies. They are a separate module, so that `thimble`
/// starts without the Bullet library and loads it only for a scene whose bodies meet.
struct Bodies {
  const char* version;  ///< Version of Thimble. Only programs of the same version use the module.
  decltype(&render::collide_objects) collide;
};

/// The name of the module's file, and of the Bodies variable in it.
inline constexpr const char* kBodiesFile = "thimble-bodies.so";
inline constexpr const char* kBodiesSymbol = "thimble_bodies";

}  // namespace thimble::cli
