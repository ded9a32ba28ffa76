#include "view/gl/shaders.h"

#include "view/gl/shader_parts.h"

namespace thimble::view::shaders {

std::string surface_vertex(Shading shading) {
  return kHead + choice(shading) + kLight + R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
uniform mat4 model;
uniform mat3 normal_matrix;
out vec3 n_W;
#ifdef MAPPED
layout(location = 2) in vec3 colour;
out vec3 colour_v;
#endif
#ifdef GOURAUD
uniform vec4 paint;  // as on the screen; gloss
out vec3 p_W;
out vec3 around_v;
out vec3 direct_v;
#else
vec3 p_W;
#endif
#ifdef MARKED
out vec3 p_B;
#endif
void main() {
#ifdef MAPPED
  colour_v = colour;
#endif
#ifdef MARKED
  p_B = position;
#endif
  p_W = (model * vec4(position, 1.0)).xyz;
  n_W = normalize(normal_matrix * normal);
#ifdef GOURAUD
  light(n_W, p_W, paint.rgb * paint.rgb, paint.w, around_v, direct_v);
#endif
  gl_Position = view_projection * vec4(p_W, 1.0);
}
)";
}

std::string dent_vertex(Shading shading) {
  return kHead + choice(shading) + kLight + R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec3 weights;
layout(location = 3) in vec3 p_a;
layout(location = 4) in vec3 n_a;
layout(location = 5) in vec3 p_b;
layout(location = 6) in vec3 n_b;
layout(location = 7) in vec3 p_c;
layout(location = 8) in vec3 n_c;
uniform mat4 model;
uniform mat3 normal_matrix;
out vec3 n_W;
#ifdef GOURAUD
uniform vec4 paint;  // as on the screen; gloss
out vec3 p_W;
out vec3 around_v;
out vec3 direct_v;
void add(float share, vec3 n, vec3 p, inout vec3 around, inout vec3 direct) {
  vec3 one_around, one_direct;
  light(normalize(normal_matrix * n), (model * vec4(p, 1.0)).xyz, paint.rgb * paint.rgb, paint.w,
        one_around, one_direct);
  around += share * one_around;
  direct += share * one_direct;
}
#else
vec3 p_W;
#endif
#ifdef MARKED
out vec3 p_B;
#endif
void main() {
#ifdef MARKED
  p_B = position;
#endif
  p_W = (model * vec4(position, 1.0)).xyz;
  n_W = normal_matrix * normal;
#ifdef GOURAUD
  around_v = vec3(0.0);
  direct_v = vec3(0.0);
  // The shade of the whole triangle at this place, plus the change by bending.
  add(weights.x, n_a, p_a, around_v, direct_v);
  add(weights.y, n_b, p_b, around_v, direct_v);
  add(weights.z, n_c, p_c, around_v, direct_v);
  vec3 n_rest = weights.x * n_a + weights.y * n_b + weights.z * n_c;
  vec3 p_rest = weights.x * p_a + weights.y * p_b + weights.z * p_c;
  add(-1.0, n_rest, p_rest, around_v, direct_v);
  add(1.0, normal, position, around_v, direct_v);
#endif
  gl_Position = view_projection * vec4(p_W, 1.0);
}
)";
}

std::string gouraud_fragment() {
  return kHead + kShadow + kToScreen + R"(
in vec3 p_W;
in vec3 n_W;
in vec3 around_v;
in vec3 direct_v;
uniform float shadow_offset;  // m
out vec4 pixel;
void main() {
  // Offset from the surface, so that it casts no shadow on itself.
  float open = lit(p_W + shadow_offset * normalize(n_W));
  pixel = vec4(to_screen(around_v * (0.82 + 0.18 * open) + direct_v * open), 1.0);
}
)";
}

std::string surface_fragment(Shading shading, bool bent) {
  const bool marked = shading == Shading::kMarked || shading == Shading::kMapped;
  const std::string marks = marked ? kMarks + "in vec3 p_B;\n" : "";
  return "#version 330 core\n" + choice(shading) + (bent ? "#define BENT\n" : "") + marks + R"(
in vec3 n_W;
uniform vec4 paint;  // as on the screen; gloss
#ifdef MAPPED
in vec3 colour_v;    // as on the screen
#else
#define colour_v paint.rgb
#endif
layout(location = 0) out vec4 normal;
layout(location = 1) out vec4 painted;
void main() {
#ifdef BENT
  vec3 n = normalize(n_W);
#else
  vec3 n = n_W;  // at most unit length, because those of the corners are unit vectors
#endif
  normal = vec4(0.5 * n + 0.5, paint.w);
#ifdef MARKED
  painted = vec4(colour_v * sqrt(unmarked(p_B)), 1.0);
#else
  painted = vec4(colour_v, 1.0);
#endif
}
)";
}

std::string shadow_vertex() {
  return kHead + R"(
layout(location = 0) in vec3 position;
uniform mat4 model;
void main() { gl_Position = shadow_from_world * model * vec4(position, 1.0); }
)";
}

std::string shadow_fragment() {
  return R"(#version 330 core
void main() {}
)";
}

std::string plain_vertex() {
  return kHead + R"(
layout(location = 0) in vec3 position;
uniform mat4 model;
uniform float nearer;  // fraction of the eye distance by which it is drawn closer
void main() {
  vec4 p_W = model * vec4(position, 1.0);
  p_W.xyz = mix(p_W.xyz, eye.xyz, nearer);
  gl_Position = view_projection * p_W;
}
)";
}

std::string plain_fragment() {
  return R"(#version 330 core
uniform vec4 paint;  // as on the screen
out vec4 pixel;
void main() { pixel = paint; }
)";
}

std::string coloured_vertex() {
  return kHead + R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec3 colour;
out vec3 shade;
void main() {
  // The colours represent numbers, so light changes them only slightly.
  shade = colour * colour * (0.72 + 0.28 * max(dot(normal, key.xyz), 0.0));
  gl_Position = view_projection * vec4(position, 1.0);
}
)";
}

std::string coloured_fragment() {
  return kHead + kToScreen + R"(
in vec3 shade;
out vec4 pixel;
void main() { pixel = vec4(to_screen(shade), 1.0); }
)";
}

std::string ground_vertex() {
  return kHead + R"(
out vec3 p_W;
void main() {
  vec2 at = vec2((gl_VertexID & 1) * 2 - 1, (gl_VertexID >> 1) * 2 - 1);
  p_W = vec3(ground_place.xy + at * ground_place.w, ground_place.z);
  gl_Position = view_projection * vec4(p_W, 1.0);
}
)";
}

std::string ground_fragment(Shading shading, bool shadowed) {
  const std::string marks = shading == Shading::kMarked ? kMarks : "";
  const std::string shadow = shadowed ? kShadow : "float lit(vec3 p) { return 1.0; }\n";
  return kHead + choice(shading) + shadow + kToScreen + marks + R"(
in vec3 p_W;
uniform float grid_strength;
uniform vec3 colour;   // linear
out vec4 pixel;
// Returns the fraction of the pixel that grid lines cover, for lines about a pixel wide.
float lines(float pitch, vec2 pixel_width) {
  vec2 at = p_W.xy / pitch;
  vec2 width = pixel_width / pitch;
  vec2 distance = abs(fract(at - 0.5) - 0.5) / max(width, vec2(1e-6));
  vec2 cover = (1.0 - smoothstep(0.4, 1.3, distance)) * (1.0 - smoothstep(0.2, 0.5, width));
  return max(cover.x, cover.y);
}
void main() {
  float away = length(p_W.xy - ground_place.xy) / ground_place.w;
  float fade = 1.0 - smoothstep(0.15, 0.9, away);
  // Seen from below, the ground is transparent.
  float cover = fade * smoothstep(0.0, 0.02, eye.z - p_W.z);
  vec2 width = fwidth(p_W.xy);
#ifdef MARKED
  float plain = unmarked(p_W);
#else
  const float plain = 1.0;
#endif
  if (cover <= 0.0) discard;
  float grid_cover = max(0.28 * lines(0.01, width), 0.6 * lines(0.05, width)) * grid_strength;
  vec3 shown = mix(colour, grid.rgb, grid_cover);
  shown *= plain * mix(vec3(0.52, 0.545, 0.58), vec3(1.0), lit(p_W));
  pixel = vec4(to_screen(shown), cover);
}
)";
}

}  // namespace thimble::view::shaders
