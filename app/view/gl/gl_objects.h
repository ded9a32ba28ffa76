#pragma once

#include <epoxy/gl.h>

#include <string>
#include <utility>

#include "thimble/driver/result.h"

namespace thimble::view {

/// Owns one OpenGL name; deletes it in the context that is current then.
template <auto make, auto remove>
class GlName {
 public:
  GlName() { make(&name_); }
  GlName(GlName&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
  GlName& operator=(GlName&& other) noexcept {
    std::swap(name_, other.name_);
    return *this;
  }
  ~GlName() {
    if (name_ != 0) remove(&name_);
  }
  GLuint operator*() const { return name_; }

 private:
  GLuint name_ = 0;
};

// Wrappers, because the OpenGL functions are resolved at run time: their addresses are no
// constants.
inline void make_buffer(GLuint* name) {
  glGenBuffers(1, name);
}
inline void remove_buffer(GLuint* name) {
  glDeleteBuffers(1, name);
}
inline void make_vertex_array(GLuint* name) {
  glGenVertexArrays(1, name);
}
inline void remove_vertex_array(GLuint* name) {
  glDeleteVertexArrays(1, name);
}
inline void make_texture(GLuint* name) {
  glGenTextures(1, name);
}
inline void remove_texture(GLuint* name) {
  glDeleteTextures(1, name);
}
inline void make_framebuffer(GLuint* name) {
  glGenFramebuffers(1, name);
}
inline void remove_framebuffer(GLuint* name) {
  glDeleteFramebuffers(1, name);
}
inline void make_renderbuffer(GLuint* name) {
  glGenRenderbuffers(1, name);
}
inline void remove_renderbuffer(GLuint* name) {
  glDeleteRenderbuffers(1, name);
}
inline void make_sampler(GLuint* name) {
  glGenSamplers(1, name);
}
inline void remove_sampler(GLuint* name) {
  glDeleteSamplers(1, name);
}

using GlBuffer = GlName<make_buffer, remove_buffer>;
using GlVertexArray = GlName<make_vertex_array, remove_vertex_array>;
using GlTexture = GlName<make_texture, remove_texture>;
using GlFramebuffer = GlName<make_framebuffer, remove_framebuffer>;
using GlSampler = GlName<make_sampler, remove_sampler>;
using GlRenderbuffer = GlName<make_renderbuffer, remove_renderbuffer>;

/// A program of a vertex and a fragment shader.
class GlProgram {
 public:
  /// Compiles and links a program. Fails with the compiler's message if the graphics driver rejects
  /// it.
  static driver::Result<GlProgram> make(const std::string& vertex, const std::string& fragment);
  GlProgram(GlProgram&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
  GlProgram& operator=(GlProgram&& other) noexcept {
    std::swap(name_, other.name_);
    return *this;
  }
  ~GlProgram() {
    if (name_ != 0) glDeleteProgram(name_);
  }

  GLuint operator*() const { return name_; }
  /// Returns the location of a uniform; -1, which OpenGL ignores, if the program does not use it.
  GLint at(const char* uniform) const { return glGetUniformLocation(name_, uniform); }

 private:
  explicit GlProgram(GLuint name) : name_(name) {}

  GLuint name_;
};

}  // namespace thimble::view
