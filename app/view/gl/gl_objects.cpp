#include "view/gl/gl_objects.h"

#include <array>
#include <stdexcept>

namespace thimble::app::view {
namespace {

GLuint compile(GLenum kind, const std::string& text) {
  const GLuint shader = glCreateShader(kind);
  const char* source = text.c_str();
  glShaderSource(shader, 1, &source, nullptr);
  glCompileShader(shader);
  GLint good = 0;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &good);
  if (good == 0) {
    std::array<char, 2000> words{};
    glGetShaderInfoLog(shader, words.size(), nullptr, words.data());
    throw std::runtime_error(std::string("A shader does not compile: ") + words.data());
  }
  return shader;
}

}  // namespace

GlProgram::GlProgram(const std::string& vertex, const std::string& fragment)
    : name_(glCreateProgram()) {
  const GLuint parts[] = {compile(GL_VERTEX_SHADER, vertex), compile(GL_FRAGMENT_SHADER, fragment)};
  for (const GLuint part : parts) glAttachShader(name_, part);
  glLinkProgram(name_);
  for (const GLuint part : parts) glDeleteShader(part);
  GLint good = 0;
  glGetProgramiv(name_, GL_LINK_STATUS, &good);
  if (good == 0) {
    std::array<char, 2000> words{};
    glGetProgramInfoLog(name_, words.size(), nullptr, words.data());
    throw std::runtime_error(std::string("Shaders do not go together: ") + words.data());
  }
}

}  // namespace thimble::app::view
