#include <gtest/gtest.h>

#include "gl_or_skip.h"
#include "support/refuses.h"
#include "view/gl/scene_programs.h"
#include "view/gl/shaders.h"

namespace thimble::view {
namespace {

using support::refuses;

TEST(GlProgram, ErrorContainsTheDriversMessage) {
  const auto context = support::open_gl();
  if (!context) GTEST_SKIP() << "no OpenGL";
  const auto broken = GlProgram::make("#version 330 core\nvoid main() { no_such_thing(); }\n",
                                      shaders::plain_fragment());
  EXPECT_TRUE(refuses(broken, "rejects a shader"));
  EXPECT_TRUE(refuses(broken, "no_such_thing"));
  // Two shaders that compile separately, but whose interfaces differ.
  const auto apart = GlProgram::make(
      "#version 330 core\nout float shade;\nvoid main() { shade = 1; gl_Position = vec4(0); }\n",
      "#version 330 core\nin vec3 shade;\nout vec4 c;\nvoid main() { c = vec4(shade, 1); }\n");
  EXPECT_TRUE(refuses(apart, "rejects two shaders"));
}

TEST(ScenePrograms, CompileWithTheDriver) {
  const auto context = support::open_gl();
  if (!context) GTEST_SKIP() << "no OpenGL";
  const auto programs = ScenePrograms::make();
  ASSERT_TRUE(programs) << programs.error().message;
  for (const GlProgram* program : programs->all()) {
    EXPECT_EQ(glIsProgram(**program), GL_TRUE);
  }
}

}  // namespace
}  // namespace thimble::view
