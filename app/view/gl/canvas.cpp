#include "view/gl/canvas.h"

#include <algorithm>
#include <cstddef>

namespace thimble::app::view {
Canvas::Canvas(int width, int height, int strip, int samples_wanted)
    : width_(width), height_(height), strip_(strip) {
  GLint most = 0;
  glGetIntegerv(GL_MAX_SAMPLES, &most);
  const GLint samples = samples_wanted > 1 ? std::min(samples_wanted, most) : 0;
  const auto storage = [&](const GlRenderbuffer& buffer, GLint count, GLenum format) {
    glBindRenderbuffer(GL_RENDERBUFFER, *buffer);
    glRenderbufferStorageMultisample(GL_RENDERBUFFER, count, format, width, height);
  };
  storage(sample_colours_, samples, GL_RGBA8);
  storage(sample_depths_, samples, GL_DEPTH_COMPONENT24);
  storage(pixel_colours_, 0, GL_RGBA8);
  const auto attach = [](GLenum place, const GlRenderbuffer& buffer) {
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, place, GL_RENDERBUFFER, *buffer);
  };
  glBindFramebuffer(GL_FRAMEBUFFER, *samples_);
  attach(GL_COLOR_ATTACHMENT0, sample_colours_);
  attach(GL_DEPTH_ATTACHMENT, sample_depths_);
  glBindFramebuffer(GL_FRAMEBUFFER, *pixels_);
  attach(GL_COLOR_ATTACHMENT0, pixel_colours_);
}

void Canvas::begin() {
  glBindFramebuffer(GL_FRAMEBUFFER, *samples_);
  glViewport(0, strip_, width_, height_ - strip_);
}

void Canvas::finish() {
  glBindFramebuffer(GL_READ_FRAMEBUFFER, *samples_);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, *pixels_);
  glBlitFramebuffer(0, 0, width_, height_, 0, 0, width_, height_, GL_COLOR_BUFFER_BIT, GL_NEAREST);
  glBindFramebuffer(GL_FRAMEBUFFER, *pixels_);
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

}  // namespace thimble::app::view
