#pragma once
// Inside render/opengl/ only: the one header that sees EGL and OpenGL. Functions are libEGL's and libOpenGL's own, the
// vendor-neutral libraries that ask whichever driver is there.

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

/// While it lives the context is this thread's, and nobody else's; then the thread has the EGL context again that it
/// had before, a calling program's own. Throws ResourceError if that cannot be.
class Current {
 public:
  explicit Current(Context::State& state);
  ~Current();
  Current(const Current&) = delete;
  Current& operator=(const Current&) = delete;

  /// Throws ResourceError with what OpenGL says went wrong since it was last asked.
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
