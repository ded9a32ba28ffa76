#pragma once

#include <string>

namespace thimble::app::view::shaders {

// The texts of all shaders (GLSL 3.30). Those that light read the block `View` (view_block.h).

std::string surface_vertex();  ///< Of meshes and solids: position 0, normal 1.
std::string dent_vertex();     ///< Of DentVertex: its members, in order.
std::string surface_fragment();
std::string shadow_vertex();  ///< Position 0; the depth as the light sees it.
std::string shadow_fragment();
std::string plain_vertex();  ///< Position 0, in one colour: lines, planes, what shines through.
std::string plain_fragment();
std::string backdrop_vertex();  ///< No attributes: one triangle that covers the picture.
std::string backdrop_fragment();
std::string ground_vertex();  ///< No attributes: a square on the ground.
std::string ground_fragment();

}  // namespace thimble::app::view::shaders
