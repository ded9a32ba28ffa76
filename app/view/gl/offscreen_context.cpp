#include "view/gl/offscreen_context.h"

#include <dlfcn.h>
#include <epoxy/egl.h>
#include <epoxy/gl.h>

namespace thimble::view {
namespace {

driver::Error missing(const std::string& what) {
  return {"No OpenGL 3.3: " + what +
          ". Install Mesa: apt-get install libegl1 libegl-mesa0 libgl1 libgl1-mesa-dri."};
}

/// Returns the display without a screen, from an EGL extension.
EGLDisplay surfaceless_display() {
  if (!epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless") ||
      !epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_platform_base")) {
    return EGL_NO_DISPLAY;
  }
  return eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
}

}  // namespace

driver::Result<std::unique_ptr<OffscreenContext>> OffscreenContext::open() {
  // The loader would end the program without EGL, so this is checked first.
  if (dlopen("libEGL.so.1", RTLD_LAZY | RTLD_GLOBAL) == nullptr)
    return missing("libEGL.so.1 was not found");
  EGLDisplay display = surfaceless_display();
  if (display == EGL_NO_DISPLAY) return missing("EGL needs a screen here");
  if (eglInitialize(display, nullptr, nullptr) == EGL_FALSE) {
    return missing("EGL cannot be initialised");
  }
  std::unique_ptr<OffscreenContext> opened(new OffscreenContext);
  opened->display_ = display;
  if (eglBindAPI(EGL_OPENGL_API) == EGL_FALSE) return missing("EGL does not support OpenGL");
  const EGLint config_wanted[] = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE,
                                  EGL_OPENGL_BIT, EGL_NONE};
  EGLConfig config = nullptr;
  EGLint found = 0;
  if (eglChooseConfig(display, config_wanted, &config, 1, &found) == EGL_FALSE || found == 0) {
    config = nullptr;  // EGL_KHR_no_config_context: Mesa needs no config without a surface
  }
  const EGLint wanted[] = {EGL_CONTEXT_MAJOR_VERSION,
                           3,
                           EGL_CONTEXT_MINOR_VERSION,
                           3,
                           EGL_CONTEXT_OPENGL_PROFILE_MASK,
                           EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                           EGL_NONE};
  opened->context_ = eglCreateContext(display, config, EGL_NO_CONTEXT, wanted);
  if (opened->context_ == EGL_NO_CONTEXT) return missing("EGL cannot create the context");
  if (eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, opened->context_) == EGL_FALSE) {
    return missing("EGL does not support contexts without a surface");
  }
  return opened;
}

OffscreenContext::~OffscreenContext() {
  eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  if (context_ != nullptr) eglDestroyContext(display_, context_);
  eglTerminate(display_);
}

std::string OffscreenContext::renderer() const {
  const auto* name = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  return name == nullptr ? "" : name;
}

}  // namespace thimble::view
