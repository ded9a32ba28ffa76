// Shaders over the whole picture, run once per pixel.
#include "view/gl/shader_parts.h"
#include "view/gl/shaders.h"

namespace thimble::view::shaders {

std::string picture_vertex() {
  return kHead + R"(
out vec3 ray;
out float height;
void main() {
  vec2 at = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
  ray = ray_ahead.xyz + at.x * ray_right.xyz + at.y * ray_up.xyz;
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

std::string light_fragment() {
  return kHead + kLight + kShadow + kToScreen + R"(
in vec3 ray;
uniform sampler2D depths;
uniform sampler2D normals;
uniform sampler2D paints;
uniform float shadow_offset;  // m
out vec4 pixel;
void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  float depth = texelFetch(depths, at, 0).r;
  vec3 p = eye.xyz + ray * (from_depth.x / (2.0 * depth - 1.0 + from_depth.y));
  vec4 normal = texelFetch(normals, at, 0);
  vec3 n = normalize(2.0 * normal.xyz - 1.0);
  vec3 paint = texelFetch(paints, at, 0).rgb;
  vec3 around, direct;
  light(n, p, paint * paint, normal.w, around, direct);
  // Offset from the surface, so that it casts no shadow on itself.
  float open = lit(p + shadow_offset * n);
  pixel = vec4(to_screen(around * (0.82 + 0.18 * open) + direct * open), 1.0);
}
)";
}

namespace {

// Detects an edge: the brightness of a pixel and of its neighbours, and their difference.
const std::string kEdge = R"(
uniform sampler2D picture;
uniform int lowest;  // row of the picture
float bright(vec3 c) { return dot(c, vec3(0.299, 0.587, 0.114)); }
float bright_at(ivec2 at) {
  ivec2 max_at = textureSize(picture, 0) - 1;
  return bright(texelFetch(picture, clamp(at, ivec2(0, lowest), max_at), 0).rgb);
}
struct Cross { float m, s, n, w, e, brightest, range; };
Cross cross_at(ivec2 at) {
  Cross c;
  c.m = bright_at(at);
  c.s = bright_at(at - ivec2(0, 1));
  c.n = bright_at(at + ivec2(0, 1));
  c.w = bright_at(at - ivec2(1, 0));
  c.e = bright_at(at + ivec2(1, 0));
  c.brightest = max(c.m, max(max(c.s, c.n), max(c.w, c.e)));
  c.range = c.brightest - min(c.m, min(min(c.s, c.n), min(c.w, c.e)));
  return c;
}
)";

}  // namespace

std::string edges_fragment() {
  return "#version 330 core\n" + kEdge + R"(
void main() {
  Cross c = cross_at(ivec2(gl_FragCoord.xy));
  if (c.range <= max(0.04, 0.125 * c.brightest)) discard;
}
)";
}

std::string smooth_fragment() {
  return "#version 330 core\n" + kEdge + R"(
out vec4 pixel;
float off(vec2 at, float level) { return bright(textureLod(picture, at, 0.0).rgb) - level; }
void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  Cross c = cross_at(at);
  float m = c.m, s = c.s, n = c.n, w = c.w, e = c.e;
  float sw = bright_at(at + ivec2(-1, -1));
  float se = bright_at(at + ivec2(1, -1));
  float nw = bright_at(at + ivec2(-1, 1));
  float ne = bright_at(at + ivec2(1, 1));
  float by_y = abs(nw + sw - 2.0 * w) + 2.0 * abs(n + s - 2.0 * m) + abs(ne + se - 2.0 * e);
  float by_x = abs(nw + ne - 2.0 * n) + 2.0 * abs(w + e - 2.0 * m) + abs(sw + se - 2.0 * s);
  bool horizontal = by_y >= by_x;  // the edge runs along x
  float one = horizontal ? s : w;
  float other = horizontal ? n : e;
  bool to_one = abs(one - m) >= abs(other - m);
  float across = to_one ? one : other;
  float level = 0.5 * (across + m);
  float ends = 0.25 * abs(across - m);
  vec2 texel = 1.0 / vec2(textureSize(picture, 0));
  vec2 here = gl_FragCoord.xy * texel;
  vec2 over = (horizontal ? vec2(0.0, texel.y) : vec2(texel.x, 0.0)) * (to_one ? -1.0 : 1.0);
  vec2 along = horizontal ? vec2(texel.x, 0.0) : vec2(0.0, texel.y);
  vec2 between = here + 0.5 * over;
  // Along the edge in both directions until it ends; each sample is the mean of its two sides.
  float back = 1.0, forth = 1.0;
  float back_off = off(between - along, level);
  float forth_off = off(between + along, level);
  bool going = true;
  for (int i = 0; i < 10 && going; ++i) {
    bool go_back = abs(back_off) < ends;
    bool go_forth = abs(forth_off) < ends;
    float stride = i < 4 ? 1.0 : 2.0;
    if (go_back) back += stride;
    if (go_forth) forth += stride;
    if (go_back) back_off = off(between - back * along, level);
    if (go_forth) forth_off = off(between + forth * along, level);
    going = go_back || go_forth;
  }
  float near_off = back < forth ? back_off : forth_off;
  // The pixel is blended if its side of the edge ends at the nearer end.
  bool blends = (m < level) != (near_off < 0.0);
  float share = blends ? 0.5 - min(back, forth) / (back + forth) : 0.0;
  // Details smaller than a pixel are also smoothed.
  float around = (2.0 * (n + s + w + e) + nw + ne + sw + se) / 12.0;
  float small = smoothstep(0.0, 1.0, min(abs(around - m) / c.range, 1.0));
  pixel = vec4(textureLod(picture, here + max(share, 0.5 * small * small) * over, 0.0).rgb, 1.0);
}
)";
}

}  // namespace thimble::view::shaders
