#include "view/gl/shadow_map.h"

namespace thimble::view {
namespace {

void make_depths(const GlTexture& texture, const GlFramebuffer& frame) {
  constexpr GLsizei kPixels = ShadowMap::kPixels;
  glBindTexture(GL_TEXTURE_2D, *texture);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT24, kPixels, kPixels, 0, GL_DEPTH_COMPONENT,
               GL_FLOAT, nullptr);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  glBindFramebuffer(GL_FRAMEBUFFER, *frame);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, *texture, 0);
  glDrawBuffer(GL_NONE);
  glReadBuffer(GL_NONE);
}

}  // namespace

ShadowMap::ShadowMap() {
  make_depths(map_, map_frame_);
  make_depths(kept_, kept_frame_);
  for (const GLenum filter : {GLenum{GL_TEXTURE_MIN_FILTER}, GLenum{GL_TEXTURE_MAG_FILTER}}) {
    glSamplerParameteri(*texels_, filter, GL_NEAREST);
  }
  for (const GLenum wrap : {GLenum{GL_TEXTURE_WRAP_S}, GLenum{GL_TEXTURE_WRAP_T}}) {
    glSamplerParameteri(*texels_, wrap, GL_CLAMP_TO_EDGE);
  }
  glSamplerParameteri(*texels_, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
}

void ShadowMap::bind() const {
  glBindSampler(4, *texels_);
  for (const GLenum unit : {GLenum{GL_TEXTURE4}, GLenum{GL_TEXTURE0}}) {
    glActiveTexture(unit);
    glBindTexture(GL_TEXTURE_2D, *map_);
  }
}

void ShadowMap::begin_kept() {
  glBindFramebuffer(GL_FRAMEBUFFER, *kept_frame_);
  glViewport(0, 0, kPixels, kPixels);
  glClear(GL_DEPTH_BUFFER_BIT);
}

void ShadowMap::begin(bool on_kept) {
  glBindFramebuffer(GL_FRAMEBUFFER, *map_frame_);
  glViewport(0, 0, kPixels, kPixels);
  if (!on_kept) {
    glClear(GL_DEPTH_BUFFER_BIT);
    return;
  }
  glBindFramebuffer(GL_READ_FRAMEBUFFER, *kept_frame_);
  glBlitFramebuffer(0, 0, kPixels, kPixels, 0, 0, kPixels, kPixels, GL_DEPTH_BUFFER_BIT,
                    GL_NEAREST);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, *map_frame_);
}

}  // namespace thimble::view
