#pragma once

#include <string>

#include "view/gl/shaders.h"

// Parts shared by several shaders.
namespace thimble::view::shaders {

inline const std::string kHead = R"(#version 330 core
layout(std140) uniform View {
  mat4 view_projection;
  mat4 shadow_from_world;
  vec4 eye;          // m, W
  vec4 key;          // towards the light
  vec4 sky;          // colours of the background, linear
  vec4 ground;
  vec4 grid;
  vec4 ground_place; // centre x, y; height; radius, m
  vec4 ray_right;    // from the centre of the picture to its right edge, 1 m in front of the eye
  vec4 ray_up;       // and to its upper edge
  vec4 ray_ahead;    // from the eye to the centre
  vec4 from_depth;   // x, y: the distance ahead is x / (depth + y), depth in -1 to 1
  vec4 casters;      // box of the shadow casters in the light's map: min x, y; max x, y
};
)";

// Preprocessor definitions remove the code that a program does not need. Mesa's software renderer
// runs both sides of an `if`, and the code after a `discard`, with masked lanes. It skips eight
// pixels only if the depth test hides all of them. It leaves a loop when no lane continues, after
// it has run the body once.
inline std::string choice(Shading shading) {
  return shading == Shading::kGouraud  ? "#define GOURAUD\n"
         : shading == Shading::kMarked ? "#define MARKED\n"
         : shading == Shading::kMapped ? "#define MARKED\n#define MAPPED\n"
                                       : "";
}

// Dots on textures, lines on friction. They are in the object's frame and move with it. They are 2
// and 3 mm apart, so that a few are visible on typical objects.
inline const std::string kMarks = R"(
uniform int marks;  // 1: dots, 2: lines, 3: both
float unmarked(vec3 p) {
  // Rotated, so that no face of a box is parallel to the lattice: a cut shows dots of all sizes.
  const mat3 turn = mat3(0.36, 0.48, -0.8, -0.8, 0.6, 0.0, 0.48, 0.64, 0.6);
  vec3 q = turn * p / 0.002;
  float away = length(fract(q) - 0.5);
  float soft = clamp(length(fwidth(q)), 0.01, 1.0);
  float dots = (1.0 - smoothstep(0.26, 0.26 + soft, away)) * (1.0 - smoothstep(0.4, 1.0, soft));
  float s = dot(p, vec3(0.57, 0.71, 0.41)) / 0.003;
  float wide = clamp(fwidth(s), 0.005, 1.0);
  float lines = (1.0 - smoothstep(0.05, 0.05 + wide, abs(fract(s) - 0.5))) *
                (1.0 - smoothstep(0.3, 0.8, wide));
  float cover = max(0.34 * float(marks & 1) * dots, 0.22 * float(marks >> 1) * lines);
  return 1.0 - cover;
}
)";

// Light from a window to the left (key), a pale wall to the right (fill), the sky above and the
// table below.
inline const std::string kLight = R"(
// `colour` is linear; `gloss` is the share of the key's mirror image; `n` is a unit vector.
void light(vec3 n, vec3 p, vec3 colour, float gloss, out vec3 around, out vec3 direct) {
  vec3 to_eye = normalize(eye.xyz - p);
  float up = 0.5 + 0.5 * n.z;
  vec3 fill = normalize(vec3(0.35, 0.85, 0.15));
  around = colour * (mix(vec3(0.17, 0.155, 0.15), vec3(0.36, 0.39, 0.43), up) +
                     0.18 * max(dot(n, fill), 0.0));
  float facing = max(dot(n, key.xyz), 0.0);
  // 48th power by multiplication, which is faster in software.
  float mirror = max(dot(n, normalize(key.xyz + to_eye)), 0.0);
  mirror *= mirror;
  mirror *= mirror;
  mirror *= mirror;
  mirror *= mirror;
  mirror *= mirror * mirror;
  direct = colour * (0.90 * facing) + vec3(gloss * mirror * smoothstep(0.0, 0.2, facing));
}
)";

inline const std::string kShadow = R"(
uniform sampler2DShadow shadow_map;
uniform sampler2DShadow shadow_texels;  // the same map, with nearest-texel lookup
uniform float shadow_strength;
uniform int shadow_samples;   // along a side: 2 or 4
float lit(vec3 p) {
  vec3 at = (shadow_from_world * vec4(p, 1.0)).xyz * 0.5 + 0.5;
  // Shadows fade towards the border of the light's map, because there is no data beyond.
  float rim = 2.0 * max(abs(at.x - 0.5), abs(at.y - 0.5));
  float strength = max(rim, 2.0 * abs(at.z - 0.5)) > 1.0 ? 0.0 : shadow_strength;
  // There are no shadows outside of the box of the casters.
  bool outside = any(lessThan(at.xy, casters.xy)) || any(greaterThan(at.xy, casters.zw));
  // A square of samples, each the mean of four texels. If the texels at its corners and its centre
  // agree, all agree, which holds for most of a picture. These are loops with one lookup each,
  // because software runs the body once even if no lookup is needed.
  vec2 texel = 1.0 / vec2(textureSize(shadow_map, 0));
  int looks = strength > 0.0 && !outside ? 5 : 0;
  float agree = 0.0;
  for (int i = 0; i < looks; ++i) {
    vec2 corner = i == 4 ? vec2(0.0) : vec2(float(i & 1) * 2.0 - 1.0, float(i & 2) - 1.0);
    agree += textureLod(shadow_texels, vec3(at.xy + 3.0 * texel * corner, at.z), 0.0);
  }
  float open = looks == 0 || agree > 2.5 ? 1.0 : 0.0;
  int side = agree > 0.5 && agree < 4.5 ? shadow_samples : 0;
  float middle = 0.5 * float(side - 1);
  vec2 apart = 6.4 / float(shadow_samples) * texel;
  float sum = 0.0;
  for (int i = 0; i < side * side; ++i) {
    vec2 by = side == 4 ? vec2(float(i & 3), float(i >> 2)) : vec2(float(i & 1), float(i >> 1));
    sum += textureLod(shadow_map, vec3(at.xy + apart * (by - middle), at.z), 0.0);
  }
  if (side > 0) open = sum / float(side * side);
  return mix(1.0, open, strength * (1.0 - smoothstep(0.8, 0.98, rim)));
}
)";

inline const std::string kToScreen = R"(
// Uses a gamma of 2 instead of 2.2, as for the input colours: twice as fast in software.
vec3 to_screen(vec3 linear) { return sqrt(clamp(linear, 0.0, 1.0)); }
)";

}  // namespace thimble::view::shaders
