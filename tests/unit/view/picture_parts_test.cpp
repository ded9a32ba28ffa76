#include "view/gl/picture_parts.h"

#include <gtest/gtest.h>

#include "gl_or_skip.h"
#include "view/gl/shaders.h"

namespace thimble::view {
namespace {

constexpr int kWidth = 96;
constexpr int kHeight = 64;
constexpr int kStrip = 8;

// One triangle over the whole picture.
const char* const kCover = R"(#version 330 core
void main() {
  gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0);
}
)";

using Box = Eigen::AlignedBox2i;

Box box(int left, int low, int right, int high) {
  return {Eigen::Vector2i(left, low), Eigen::Vector2i(right, high)};
}

/// Adds red to the pixels inside and green to those outside, so that a pixel painted twice is
/// brighter.
Picture painted(const Box& within) {
  const GlProgram program = GlProgram::make(kCover, shaders::plain_fragment()).value();
  const GlVertexArray nothing;
  Canvas canvas(kWidth, kHeight, kStrip);
  canvas.begin_pixels();
  glDisable(GL_DEPTH_TEST);
  glClearColor(0, 0, 0, 1);
  glClear(GL_COLOR_BUFFER_BIT);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE);
  glBindVertexArray(*nothing);
  glUseProgram(*program);
  const auto add = [&program](float red, float green) {
    glUniform4f(program.at("paint"), red, green, 0, 0);
    glDrawArrays(GL_TRIANGLES, 0, 3);
  };
  paint_apart(
      canvas, within, [&] { add(0.2F, 0); }, [&] { add(0, 0.2F); });
  glDisable(GL_BLEND);
  glBindVertexArray(0);
  return canvas.read();
}

TEST(PaintApart, PaintsEachPixelOnceInsideOrOutsideTheBox) {
  const auto context = support::open_gl();
  if (!context) GTEST_SKIP() << "no OpenGL";
  constexpr int kHigh = kHeight - kStrip;
  for (const Box& within : {box(10, 5, 40, 30), box(0, 0, kWidth, kHigh), box(0, 7, kWidth, 8),
                            box(90, 0, kWidth, kHigh), box(20, 20, 20, 30), Box()}) {
    const Picture picture = painted(within);
    int wrong = 0;
    for (int y = 0; y < kHigh; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const bool in = !within.isEmpty() && x >= within.min().x() && x < within.max().x() &&
                        y >= within.min().y() && y < within.max().y();
        const auto at = 3 * static_cast<std::size_t>((kHeight - 1 - kStrip - y) * kWidth + x);
        wrong += picture.rgb[at] != (in ? 51 : 0) || picture.rgb[at + 1] != (in ? 0 : 51);
      }
    }
    EXPECT_EQ(wrong, 0) << within.min().transpose() << " to " << within.max().transpose();
  }
}

}  // namespace
}  // namespace thimble::view
