#include "view/gl/gl_objects.h"

#include <array>
#include <optional>

namespace thimble::view {
namespace {

driver::Error refused(const std::string& what, const char* words) {
  return {"The graphics driver rejects " + what + " of Thimble: " + words +
          " Set LIBGL_ALWAYS_SOFTWARE=1 to use software rendering, and report this "
          "message."};
}

/// Compiles a shader into a program; returns the compiler's message on failure.
std::optional<driver::Error> add_shader(GLuint program, GLenum kind, const std::string& text) {
  const GLuint shader = glCreateShader(kind);
  const char* source = text.c_str();
  glShaderSource(shader, 1, &source, nullptr);
  glCompileShader(shader);
  GLint good = 0;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &good);
  std::array<char, 2000> words{};
  if (good == 0) glGetShaderInfoLog(shader, words.size(), nullptr, words.data());
  glAttachShader(program, shader);
  glDeleteShader(shader);  // the program keeps the shader
  if (good != 0) return std::nullopt;
  return refused("a shader", words.data());
}

}  // namespace

driver::Result<GlProgram> GlProgram::make(const std::string& vertex, const std::string& fragment) {
  GlProgram program(glCreateProgram());
  if (auto error = add_shader(*program, GL_VERTEX_SHADER, vertex)) return *error;
  if (auto error = add_shader(*program, GL_FRAGMENT_SHADER, fragment)) return *error;
  glLinkProgram(*program);
  GLint good = 0;
  glGetProgramiv(*program, GL_LINK_STATUS, &good);
  if (good != 0) return program;
  std::array<char, 2000> words{};
  glGetProgramInfoLog(*program, words.size(), nullptr, words.data());
  return refused("two shaders", words.data());
}

}  // namespace thimble::view
