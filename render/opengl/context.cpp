// SPDX-License-Identifier: Apache-2.0
// EGL without a display server: each device of EGL_EXT_device_enumeration is a separate display; without that
// extension, EGL_MESA_platform_surfaceless gives one. Displays are shared by the process and not counted: none is
// terminated, since another context may use it.

#include "render/opengl/context.hpp"

#include "base/error.hpp"
#include "render/opengl/gl.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>

namespace penumbra::render::opengl {
namespace {

constexpr EGLint kMajor = 4, kMinor = 5;

bool has(const char* extensions, std::string_view name) {
  if (extensions == nullptr) return false;
  const std::string all = fmt::format(" {} ", extensions);
  return all.find(fmt::format(" {} ", name)) != std::string::npos;
}

const char* error_name(EGLint error) {
  switch (error) {
    case EGL_NOT_INITIALIZED:
      return "not initialised: no driver";
    case EGL_BAD_ALLOC:
      return "out of resources";
    case EGL_BAD_MATCH:
      return "not supported by the driver";
    case EGL_BAD_ACCESS:
      return "in use by another thread";
    case EGL_CONTEXT_LOST:
      return "the context was lost";
    default:
      return "refused";
  }
}

std::string egl_error() {
  const EGLint error = eglGetError();
  return fmt::format("{} (EGL error {:#x})", error_name(error), error);
}

/// A candidate for OpenGL on this machine.
struct DisplayChoice {
  std::string platform;
  EGLDisplay display;
  bool software;  ///< EGL reports that the device is a processor
};

std::vector<DisplayChoice> displays() {
  std::vector<DisplayChoice> found;
  const char* client = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
  if (has(client, "EGL_EXT_platform_device") &&
      (has(client, "EGL_EXT_device_enumeration") || has(client, "EGL_EXT_device_base"))) {
    const auto query = reinterpret_cast<PFNEGLQUERYDEVICESEXTPROC>(eglGetProcAddress("eglQueryDevicesEXT"));
    const auto text = reinterpret_cast<PFNEGLQUERYDEVICESTRINGEXTPROC>(eglGetProcAddress("eglQueryDeviceStringEXT"));
    std::array<EGLDeviceEXT, 32> devices{};
    EGLint count = 0;
    if (query != nullptr && query(static_cast<EGLint>(devices.size()), devices.data(), &count) == EGL_TRUE) {
      for (EGLint i = 0; i < count; ++i) {
        const EGLDeviceEXT device = devices.at(static_cast<std::size_t>(i));
        const char* extensions = text != nullptr ? text(device, EGL_EXTENSIONS) : nullptr;
        found.push_back({fmt::format("device {}", i), eglGetPlatformDisplay(EGL_PLATFORM_DEVICE_EXT, device, nullptr),
                         has(extensions, "EGL_MESA_device_software")});
      }
    }
  }
  if (found.empty() && has(client, "EGL_MESA_platform_surfaceless")) {
    found.push_back(
        {"surfaceless", eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr), false});
  }
  return found;
}

/// Makes a context of OpenGL 4.5 on a display; on failure sets the refusal.
EGLContext make_context(EGLDisplay display, ContextInfo& info) {
  const auto refuse = [&](const std::string& why) {
    info.refusals.push_back(why);
    return EGL_NO_CONTEXT;
  };
  EGLint major = 0, minor = 0;
  if (display == EGL_NO_DISPLAY) return refuse("EGL gives no display for it");
  if (eglInitialize(display, &major, &minor) != EGL_TRUE) return refuse("eglInitialize: " + egl_error());
  if (major == 1 && minor < 5) return refuse(fmt::format("EGL {}.{} is older than 1.5", major, minor));
  const char* extensions = eglQueryString(display, EGL_EXTENSIONS);
  for (const char* needed : {"EGL_KHR_surfaceless_context", "EGL_KHR_no_config_context"}) {
    if (!has(extensions, needed)) info.refusals.push_back(fmt::format("no {}", needed));
  }
  if (eglBindAPI(EGL_OPENGL_API) != EGL_TRUE) info.refusals.emplace_back("EGL makes no contexts of OpenGL");
  if (!info.usable()) return EGL_NO_CONTEXT;
  const std::array attributes{
      EGL_CONTEXT_MAJOR_VERSION,           kMajor,  EGL_CONTEXT_MINOR_VERSION, kMinor, EGL_CONTEXT_OPENGL_PROFILE_MASK,
      EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
  const EGLContext context = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes.data());
  if (context == EGL_NO_CONTEXT) {
    return refuse(fmt::format("no context of OpenGL {}.{} (core): {}", kMajor, kMinor, egl_error()));
  }
  return context;
}

std::string text_of(GLenum what) {
  const auto* text = reinterpret_cast<const char*>(glGetString(what));
  return text != nullptr ? text : "";
}

std::uint32_t number_of(GLenum what) {
  GLint value = 0;
  glGetIntegerv(what, &value);
  return static_cast<std::uint32_t>(std::max(value, 0));
}

/// Fills in the description of the current context.
void describe(ContextInfo& info, bool software) {
  info.name = text_of(GL_RENDERER);
  info.driver = fmt::format("{} {}", text_of(GL_VENDOR), text_of(GL_VERSION));
  const std::array processors{"llvmpipe", "softpipe", "swrast", "SwiftShader"};
  const bool named =
      std::ranges::any_of(processors, [&](const char* part) { return info.name.find(part) != std::string::npos; });
  info.kind = software || named ? "cpu" : "gpu";
  info.subpixel_bits = number_of(GL_SUBPIXEL_BITS);
  info.max_image_size = number_of(GL_MAX_TEXTURE_SIZE);
  GLint64 block = 0;
  glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &block);
  info.max_storage_block = static_cast<std::uint64_t>(std::max<GLint64>(block, 0));
  constexpr std::uint32_t kBlocks = 3;  // uniform and storage blocks that a pass binds
  for (const auto& [stage, limit] : {std::pair("vertex", GL_MAX_VERTEX_SHADER_STORAGE_BLOCKS),
                                     std::pair("fragment", GL_MAX_FRAGMENT_SHADER_STORAGE_BLOCKS)}) {
    const std::uint32_t blocks = number_of(static_cast<GLenum>(limit));
    if (blocks < kBlocks) {
      info.refusals.push_back(
          fmt::format("{} shader storage blocks in a {} shader ({} are needed)", blocks, stage, kBlocks));
    }
  }
}

std::unique_ptr<Context::State> open(const DisplayChoice& choice, std::uint32_t index) {
  auto state = std::make_unique<Context::State>();
  ContextInfo& info = state->info;
  info.index = index;
  info.platform = info.name = choice.platform;
  info.kind = choice.software ? "cpu" : "gpu";
  state->display = choice.display;
  state->context = make_context(choice.display, info);
  if (!info.usable()) return state;
  try {
    const Current current(*state);
    describe(info, choice.software);
    current.check("reading its description");
  } catch (const ResourceError& error) {
    info.refusals.emplace_back(error.what());
  }
  return state;
}

constexpr const char* kNoDriver =
    "EGL finds no driver that works without a display (libegl-mesa0 and libgl1-mesa-dri have one that runs on the "
    "processor; __EGL_VENDOR_LIBRARY_FILENAMES may point nowhere)";

}  // namespace

Context::State::~State() {
  if (context != EGL_NO_CONTEXT) eglDestroyContext(display, context);
}

Current::Current(Context::State& state)
    : state_(state),
      lock_(state.in_use),
      before_{eglQueryAPI(), eglGetCurrentDisplay(), eglGetCurrentContext(), eglGetCurrentSurface(EGL_DRAW),
              eglGetCurrentSurface(EGL_READ)} {
  eglBindAPI(EGL_OPENGL_API);  // per-thread state of EGL
  if (eglMakeCurrent(state_.display, EGL_NO_SURFACE, EGL_NO_SURFACE, state_.context) != EGL_TRUE) {
    throw ResourceError("OpenGL on {}: the context cannot be made current: {}", state_.info.name, egl_error());
  }
}

Current::~Current() {
  eglMakeCurrent(state_.display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  eglBindAPI(before_.api);
  if (before_.context != EGL_NO_CONTEXT) eglMakeCurrent(before_.display, before_.draw, before_.read, before_.context);
}

void Current::check(const std::string& doing) const {
  const GLenum error = glGetError();
  if (error == GL_NO_ERROR) return;
  for (GLenum more = glGetError(); more != GL_NO_ERROR && more != GL_CONTEXT_LOST;) more = glGetError();
  if (error == GL_OUT_OF_MEMORY) {
    throw ResourceError("OpenGL on {}: out of memory while {}; try a smaller size", state_.info.name, doing);
  }
  throw ResourceError("OpenGL on {}: error {:#x} while {}", state_.info.name, error, doing);
}

std::vector<ContextInfo> list_contexts() {
  std::vector<ContextInfo> list;
  for (const DisplayChoice& choice : displays())
    list.push_back(open(choice, static_cast<std::uint32_t>(list.size()))->info);
  if (list.empty()) {
    ContextInfo none;
    none.platform = none.name = "none";
    none.refusals.emplace_back(kNoDriver);
    list.push_back(none);
  }
  return list;
}

Context::Context(bool on_processor) {
  const auto is_wanted = [&](const ContextInfo& info) { return (info.kind == "cpu") == on_processor; };
  std::string reasons;
  std::uint32_t index = 0;
  for (const DisplayChoice& choice : displays()) {
    std::unique_ptr<State> candidate = open(choice, index++);
    if (!candidate->info.usable()) {
      reasons += fmt::format("\n  {}: {}", candidate->info.name, fmt::join(candidate->info.refusals, "; "));
    } else if (!state_ || (is_wanted(candidate->info) && !is_wanted(state_->info))) {
      state_ = std::move(candidate);
    }
  }
  if (!state_) throw ResourceError("no OpenGL: {}", reasons.empty() ? kNoDriver : "no context can be used:" + reasons);
}

Context::~Context() = default;
Context::Context(Context&&) noexcept = default;
Context& Context::operator=(Context&&) noexcept = default;

const ContextInfo& Context::info() const {
  return state_->info;
}

}  // namespace penumbra::render::opengl
