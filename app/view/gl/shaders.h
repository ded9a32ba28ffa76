#pragma once

#include <string>

namespace thimble::view {

/// Where the light on a surface is reckoned.
enum class Shading {
  kPhong,    ///< In every pixel, of the interpolated normal.
  kGouraud,  ///< In every corner, and interpolated.
  kMarked,   ///< As kPhong, with marks on textures and friction.
};

}  // namespace thimble::view

namespace thimble::view::shaders {

// The texts of all shaders (GLSL 3.30). Those that light read the block `View` (view_block.h).

std::string surface_vertex(Shading shading);  ///< Of meshes and solids: position 0, normal 1.
std::string dent_vertex(Shading shading);     ///< Of DentVertex: its members, in order.
/// Writes normal and paint, to be lit (light_fragment); `bent`: normals of any length.
std::string surface_fragment(Shading shading, bool bent);
std::string gouraud_fragment();  ///< Lit in the corners, shadows in the pixel.
std::string shadow_vertex();     ///< Position 0; the depth as the light sees it.
std::string shadow_fragment();
std::string plain_vertex();  ///< Position 0, in one colour: lines, planes, what shines through.
std::string plain_fragment();
std::string ground_vertex();  ///< No attributes: a square on the ground.
/// `shadowed`: it asks the light's map; without, no shadow falls on it.
std::string ground_fragment(Shading shading, bool shadowed);
std::string coloured_vertex();  ///< Of ColouredVertex: its members, in order.
std::string coloured_fragment();
std::string picture_vertex();  ///< No attributes: one triangle that covers the picture.
std::string backdrop_fragment();
std::string light_fragment();  ///< Lights what surface_fragment wrote.
/// Leaves out all pixels of a picture but those at an edge: where neighbours differ in brightness
/// [FXAA]. It writes nothing but depths.
std::string edges_fragment();
/// Smooths an edge: along it to both its ends, and each pixel takes of its neighbour what the edge
/// between those leaves it [FXAA].
std::string smooth_fragment();

}  // namespace thimble::view::shaders
