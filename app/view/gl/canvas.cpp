#include "view/gl/canvas.h"

#include <cstddef>

namespace thimble::view {
namespace {

void store(const GlTexture& texture, GLint format, GLenum kind, GLint filter, int width,
           int height) {
  glBindTexture(GL_TEXTURE_2D, *texture);
  glTexImage2D(GL_TEXTURE_2D, 0, format, width, height, 0, kind, GL_FLOAT, nullptr);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, filter);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, filter);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

void attach(GLenum place, const GlTexture& texture) {
  glFramebufferTexture2D(GL_FRAMEBUFFER, place, GL_TEXTURE_2D, *texture, 0);
}

void attach(GLenum place, const GlRenderbuffer& buffer) {
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, place, GL_RENDERBUFFER, *buffer);
}

void bind_texture(GLenum unit, const GlTexture& texture) {
  glActiveTexture(unit);
  glBindTexture(GL_TEXTURE_2D, *texture);
}

}  // namespace

Canvas::Canvas(int width, int height, int strip) : width_(width), height_(height), strip_(strip) {
  // Normals of 16 bits: with 8, highlights show steps.
  store(normals_, GL_RGBA16, GL_RGBA, GL_NEAREST, width, height);
  store(paints_, GL_RGBA8, GL_RGBA, GL_NEAREST, width, height);
  store(depths_, GL_DEPTH_COMPONENT24, GL_DEPTH_COMPONENT, GL_NEAREST, width, height);
  store(lit_colours_, GL_RGBA8, GL_RGBA, GL_LINEAR, width, height);
  glBindRenderbuffer(GL_RENDERBUFFER, *pixel_colours_);
  glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, width, height);
  glBindRenderbuffer(GL_RENDERBUFFER, *covered_depths_);
  glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT24, width, height);
  glBindFramebuffer(GL_FRAMEBUFFER, *surfaces_);
  attach(GL_COLOR_ATTACHMENT0, normals_);
  attach(GL_COLOR_ATTACHMENT1, paints_);
  attach(GL_DEPTH_ATTACHMENT, depths_);
  const GLenum both[] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
  glDrawBuffers(2, both);
  glBindFramebuffer(GL_FRAMEBUFFER, *lit_);
  attach(GL_COLOR_ATTACHMENT0, lit_colours_);
  attach(GL_DEPTH_ATTACHMENT, covered_depths_);
  glBindFramebuffer(GL_FRAMEBUFFER, *pixels_);
  attach(GL_COLOR_ATTACHMENT0, pixel_colours_);
  attach(GL_DEPTH_ATTACHMENT, covered_depths_);
}

void Canvas::bind(const GlFramebuffer& frame) {
  glBindFramebuffer(GL_FRAMEBUFFER, *frame);
  glViewport(0, strip_, width_, height_ - strip_);
}

void Canvas::begin_surfaces() {
  bind(surfaces_);
  glClear(GL_DEPTH_BUFFER_BIT);
}

void Canvas::copy(const GlFramebuffer& from, const GlFramebuffer& to, GLbitfield what) {
  glBindFramebuffer(GL_READ_FRAMEBUFFER, *from);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, *to);
  glBlitFramebuffer(0, 0, width_, height_, 0, 0, width_, height_, what, GL_NEAREST);
  bind(to);
}

void Canvas::begin_light() {
  copy(surfaces_, lit_, GL_DEPTH_BUFFER_BIT);
  bind_texture(GL_TEXTURE1, normals_);
  bind_texture(GL_TEXTURE2, paints_);
  bind_texture(GL_TEXTURE3, depths_);
  glActiveTexture(GL_TEXTURE0);
}

void Canvas::begin_pixels() {
  copy(lit_, pixels_, GL_COLOR_BUFFER_BIT);
  glClearDepth(0);
  glClear(GL_DEPTH_BUFFER_BIT);
  glClearDepth(1);
  bind_texture(GL_TEXTURE1, lit_colours_);
  glActiveTexture(GL_TEXTURE0);
}

void Canvas::show(int x, int y) {
  glBindFramebuffer(GL_READ_FRAMEBUFFER, *pixels_);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
  glBlitFramebuffer(0, 0, width_, height_, x, y, x + width_, y + height_, GL_COLOR_BUFFER_BIT,
                    GL_NEAREST);
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
}

Picture Canvas::read() {
  Picture picture{width_, height_, {}};
  const auto row = 3 * static_cast<std::size_t>(width_);
  std::vector<std::uint8_t> upward(row * static_cast<std::size_t>(height_));
  glBindFramebuffer(GL_READ_FRAMEBUFFER, *pixels_);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, width_, height_, GL_RGB, GL_UNSIGNED_BYTE, upward.data());
  picture.rgb.reserve(upward.size());
  for (auto from = upward.end(); from != upward.begin();) {
    from -= static_cast<std::ptrdiff_t>(row);
    picture.rgb.insert(picture.rgb.end(), from, from + static_cast<std::ptrdiff_t>(row));
  }
  return picture;
}

}  // namespace thimble::view
