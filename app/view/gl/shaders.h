#pragma once

#include <string>

namespace thimble::view {

/// Where the lighting of a surface is computed.
enum class Shading {
  kPhong,    ///< Per pixel, from the interpolated normal.
  kGouraud,  ///< Per vertex, then interpolated.
  kMarked,   ///< As kPhong, with marks on textures and friction.
  kMapped,   ///< As kMarked, with a colour per vertex.
};

}  // namespace thimble::view

namespace thimble::view::shaders {

// The sources of all shaders (GLSL 3.30). Those that use light read the block `View`
// (view_block.h).

std::string surface_vertex(Shading shading);  ///< For meshes and solids: position 0, normal 1.
std::string dent_vertex(Shading shading);     ///< For DentVertex: its members, in order.
/// Writes normal and paint, which light_fragment lights; `bent`: normals of any length.
std::string surface_fragment(Shading shading, bool bent);
std::string gouraud_fragment();  ///< Lit per vertex, shadows per pixel.
std::string shadow_vertex();     ///< Position 0; writes the depth from the light.
std::string shadow_fragment();
std::string plain_vertex();  ///< Position 0, in one colour: lines, planes, hidden solids.
std::string plain_fragment();
std::string ground_vertex();  ///< No attributes: a square on the ground.
/// `shadowed`: reads the shadow map; otherwise without shadows.
std::string ground_fragment(Shading shading, bool shadowed);
std::string coloured_vertex();  ///< For ColouredVertex: its members, in order.
std::string coloured_fragment();
std::string picture_vertex();  ///< No attributes: one triangle that covers the picture.
std::string backdrop_fragment();
std::string light_fragment();  ///< Lights the output of surface_fragment.
/// Discards all pixels except those at an edge, where neighbours differ in brightness [FXAA].
/// Writes only depths.
std::string edges_fragment();
/// Smooths an edge: finds both its ends, and blends each pixel with its neighbour according to the
/// position of the edge [FXAA].
std::string smooth_fragment();

}  // namespace thimble::view::shaders
