// SPDX-License-Identifier: Apache-2.0
#pragma once
// Inside render/opengl/ only: the one header that includes EGL and OpenGL. Functions come from libEGL and libOpenGL,
// the vendor-neutral libraries that dispatch to the installed driver.

#define EGL_NO_X11
#define MESA_EGL_NO_X11_HEADERS
#include <EGL/egl.h>
#include <EGL/eglext.h>
#define GL_GLEXT_PROTOTYPES
#include <GL/glcorearb.h>

#include "render/opengl/context.hpp"

#include <mutex>
#include <string>

namespace penumbra::render::opengl {

struct Context::State {
  ContextInfo info;
  EGLDisplay display = EGL_NO_DISPLAY;
  EGLContext context = EGL_NO_CONTEXT;
  std::mutex in_use;
  ~State();
};

/// Makes the context current on this thread, exclusively, during its lifetime; then restores the thread's previous EGL
/// context, which may be the calling program's. Throws ResourceError on failure.
class Current {
 public:
  explicit Current(Context::State& state);
  ~Current();
  Current(const Current&) = delete;
  Current& operator=(const Current&) = delete;

  /// Throws ResourceError with the error that OpenGL has recorded since the last check, if any.
  void check(const std::string& doing) const;

 private:
  Context::State& state_;
  std::unique_lock<std::mutex> lock_;
  struct Binding {
    EGLenum api;
    EGLDisplay display;
    EGLContext context;
    EGLSurface draw, read;
  } before_;
};

}  // namespace penumbra::render::opengl
