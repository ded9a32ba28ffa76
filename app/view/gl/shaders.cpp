#include "view/gl/shaders.h"

namespace thimble::app::view::shaders {
namespace {

const std::string kHead = R"(#version 330 core
layout(std140) uniform View {
  mat4 view_projection;
  mat4 shadow_from_world;
  vec4 eye;          // m, W
  vec4 key;          // towards the light
  vec4 sky;          // colours of the background, linear
  vec4 ground;
  vec4 grid;
  vec4 ground_place; // centre x, y; height; radius, m
};
)";

// What follows is left out of a program that does not need it: Mesa's software runs both sides of
// an `if`, for a condition masks lanes and does not jump, but leaves a loop when no lane is in it.
std::string choice(Shading shading) {
  return shading == Shading::kGouraud  ? "#define GOURAUD\n"
         : shading == Shading::kMarked ? "#define MARKED\n"
                                       : "";
}

// Dots on what has a texture, lines on what has friction, in the object's own frame so that they
// move with it; 2 and 3 mm apart, so that a few are seen on what a hand strokes.
const std::string kMarks = R"(
uniform int marks;  // 1: dots, 2: lines, 3: both
float unmarked(vec3 p) {
  // Turned, so that no face of a box lies along the lattice: what cuts it sees dots of all sizes.
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

// Light from a window to the left (the key), from a pale wall to the right (the fill), from the sky
// above and from the table below.
const std::string kLight = R"(
uniform vec3 colour;   // linear
uniform float gloss;   // share of the key's mirror image
void light(vec3 n_any, vec3 p, out vec3 around, out vec3 direct) {
  vec3 n = normalize(n_any);
  vec3 to_eye = normalize(eye.xyz - p);
  float up = 0.5 + 0.5 * n.z;
  vec3 fill = normalize(vec3(0.35, 0.85, 0.15));
  around = colour * (mix(vec3(0.17, 0.155, 0.15), vec3(0.36, 0.39, 0.43), up) +
                     0.18 * max(dot(n, fill), 0.0));
  float facing = max(dot(n, key.xyz), 0.0);
  // To the 48th power by multiplying, which software does faster.
  float mirror = max(dot(n, normalize(key.xyz + to_eye)), 0.0);
  mirror *= mirror;
  mirror *= mirror;
  mirror *= mirror;
  mirror *= mirror;
  mirror *= mirror * mirror;
  direct = colour * (0.90 * facing) + vec3(gloss * mirror * smoothstep(0.0, 0.2, facing));
}
)";

const std::string kShadow = R"(
uniform sampler2DShadow shadow_map;
uniform float shadow_strength;
uniform int shadow_samples;   // along a side; >= 2
float open_at(vec3 at, vec2 by) { return textureLod(shadow_map, vec3(at.xy + by, at.z), 0.0); }
float lit(vec3 p) {
  vec3 at = (shadow_from_world * vec4(p, 1.0)).xyz * 0.5 + 0.5;
  // Towards the rim of what the light's map holds, shadows fade: beyond nothing is known.
  float rim = 2.0 * max(abs(at.x - 0.5), abs(at.y - 0.5));
  float strength = max(rim, 2.0 * abs(at.z - 0.5)) > 1.0 ? 0.0 : shadow_strength;
  // Of a square of samples, each the mean of four already. Where its corners and its middle agree,
  // the rest would as well: most of a picture is that.
  int side = strength > 0.0 ? shadow_samples : 0;
  float middle = 0.5 * float(shadow_samples - 1);
  vec2 texel = 6.4 / float(shadow_samples) / vec2(textureSize(shadow_map, 0));
  float open = 1.0;
  for (int once = 0; once < min(side, 1); ++once) {
    vec2 c = middle * texel;
    float corners = open_at(at, c) + open_at(at, -c) + open_at(at, vec2(c.x, -c.y)) +
                    open_at(at, vec2(-c.x, c.y));
    float all = corners + open_at(at, vec2(0.0));
    open = 0.25 * corners;
    bool mixed = all > 0.001 && all < 4.999 && side > 2;
    float sum = corners;
    int rows = mixed ? side : 0;
    for (int i = 0; i < rows; ++i) {
      // The corners are known: their rows begin and end one further in.
      int in_by = i == 0 || i == side - 1 ? 1 : 0;
      for (int j = in_by; j < side - in_by; ++j) sum += open_at(at, (vec2(i, j) - middle) * texel);
    }
    open = mixed ? sum / float(side * side) : open;
  }
  return mix(1.0, open, strength * (1.0 - smoothstep(0.8, 0.98, rim)));
}
)";

const std::string kToScreen = R"(
// The screen's 2.2 taken as 2: colours come in by the same, and software is twice as fast.
vec3 to_screen(vec3 linear) { return sqrt(clamp(linear, 0.0, 1.0)); }
)";

}  // namespace

std::string surface_vertex(Shading shading) {
  return kHead + choice(shading) + kLight + R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
uniform mat4 model;
uniform mat3 normal_matrix;
out vec3 p_W;
out vec3 n_W;
#ifdef GOURAUD
out vec3 around_v;
out vec3 direct_v;
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
  light(n_W, p_W, around_v, direct_v);
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
out vec3 p_W;
out vec3 n_W;
#ifdef GOURAUD
out vec3 around_v;
out vec3 direct_v;
void add(float share, vec3 n, vec3 p, inout vec3 around, inout vec3 direct) {
  vec3 one_around, one_direct;
  light(normal_matrix * n, (model * vec4(p, 1.0)).xyz, one_around, one_direct);
  around += share * one_around;
  direct += share * one_direct;
}
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
  // The shade that the whole triangle had here, and what the bending changed.
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

std::string surface_fragment(Shading shading) {
  const std::string marks = shading == Shading::kMarked ? kMarks + "in vec3 p_B;\n" : "";
  return kHead + choice(shading) + kLight + kShadow + kToScreen + marks + R"(
in vec3 p_W;
in vec3 n_W;
#ifdef GOURAUD
in vec3 around_v;
in vec3 direct_v;
#endif
uniform float shadow_offset;  // m
out vec4 pixel;
void main() {
#ifdef GOURAUD
  vec3 around = around_v;
  vec3 direct = direct_v;
#else
  vec3 around, direct;
  light(n_W, p_W, around, direct);
#endif
#ifdef MARKED
  float plain = unmarked(p_B);
  around *= plain;
  direct *= plain;
#endif
  // Asked a little off the surface, or it would cast shadows on itself.
  float open = lit(p_W + shadow_offset * normalize(n_W));
  pixel = vec4(to_screen(around * (0.82 + 0.18 * open) + direct * open), 1.0);
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
uniform float nearer;  // share of the distance that it is drawn before its place
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
  // The colours stand for numbers: light changes them little.
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

std::string backdrop_vertex() {
  return kHead + R"(
out float height;
void main() {
  vec2 at = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
  height = 0.5 * at.y + 0.5;
  gl_Position = vec4(at, 1.0, 1.0);
}
)";
}

std::string backdrop_fragment() {
  return kHead + kToScreen + R"(
in float height;
out vec4 pixel;
void main() {
  pixel = vec4(to_screen(mix(ground.rgb, sky.rgb, smoothstep(0.25, 0.95, height))), 1.0);
}
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

std::string ground_fragment(Shading shading) {
  const std::string marks = shading == Shading::kMarked ? kMarks : "";
  return kHead + choice(shading) + kShadow + kToScreen + marks + R"(
in vec3 p_W;
uniform float grid_strength;
uniform vec3 colour;   // linear
out vec4 pixel;
// How much of the pixel a grid's lines cover, for lines about a pixel wide.
float lines(float pitch) {
  vec2 at = p_W.xy / pitch;
  vec2 width = fwidth(at);
  vec2 distance = abs(fract(at - 0.5) - 0.5) / max(width, vec2(1e-6));
  vec2 cover = (1.0 - smoothstep(0.4, 1.3, distance)) * (1.0 - smoothstep(0.2, 0.5, width));
  return max(cover.x, cover.y);
}
void main() {
  float away = length(p_W.xy - ground_place.xy) / ground_place.w;
  float fade = 1.0 - smoothstep(0.15, 0.9, away);
  float grid_cover = max(0.28 * lines(0.01), 0.6 * lines(0.05)) * grid_strength;
  float open = lit(p_W);
  vec3 shown = mix(colour, grid.rgb, grid_cover) * mix(vec3(0.52, 0.545, 0.58), vec3(1.0), open);
#ifdef MARKED
  shown *= unmarked(p_W);
#endif
  // Seen from below the ground is not in the way.
  float from_above = smoothstep(0.0, 0.02, eye.z - p_W.z);
  pixel = vec4(to_screen(shown), fade * from_above);
}
)";
}

}  // namespace thimble::app::view::shaders
