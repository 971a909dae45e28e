// SPDX-License-Identifier: Apache-2.0
// Replaces the other sources in a build without EGL or OpenGL: nothing can be made, and every function reports the
// reason.

#include "base/assert.hpp"
#include "base/error.hpp"
#include "render/opengl/raster_pass.hpp"

#include <utility>

namespace penumbra::render::opengl {
namespace {

constexpr const char* kNotBuilt =
    "this build has no OpenGL: libEGL or libOpenGL was missing when it was configured (on Debian: libegl-dev, "
    "libopengl-dev, libgl-dev), or PENUMBRA_WITH_OPENGL was OFF";

}  // namespace

struct Context::State {
  ContextInfo info;
};
struct Buffer::State {};
struct DepthTarget::State {};
struct RasterPass::State {};

std::vector<ContextInfo> list_contexts() {
  ContextInfo none;
  none.platform = none.name = "none";
  none.refusals.emplace_back(kNotBuilt);
  return {none};
}

Context::Context(bool /*on_processor*/) {
  throw ResourceError("no OpenGL: {}", kNotBuilt);
}
Context::~Context() = default;
Context::Context(Context&&) noexcept = default;
Context& Context::operator=(Context&&) noexcept = default;
const ContextInfo& Context::info() const {
  return state_->info;
}

// Unreachable: no context can exist.
namespace {
[[noreturn]] void no_context(const std::string& name) {
  PENUMBRA_ASSERT(false, "{}: a context of OpenGL in a build without", name);
  std::abort();
}
}  // namespace

// NOLINTNEXTLINE(performance-unnecessary-value-param): the context that there is keeps the name
Buffer::Buffer(const Context& /*context*/, std::string name, std::uint64_t /*bytes*/) {
  no_context(name);
}
Buffer::~Buffer() = default;
Buffer::Buffer(Buffer&&) noexcept = default;
Buffer& Buffer::operator=(Buffer&&) noexcept = default;
std::uint64_t Buffer::bytes() const {
  no_context("buffer");
}
void Buffer::upload(std::span<const std::byte> /*data*/, std::uint64_t /*offset*/) const {
  no_context("buffer");
}
void Buffer::download(std::span<std::byte> /*data*/, std::uint64_t /*offset*/) const {
  no_context("buffer");
}

DepthTarget::DepthTarget(const Context& /*context*/, const std::string& name, std::uint32_t /*width*/,
                         std::uint32_t /*height*/) {
  no_context(name);
}
DepthTarget::~DepthTarget() = default;
DepthTarget::DepthTarget(DepthTarget&&) noexcept = default;
DepthTarget& DepthTarget::operator=(DepthTarget&&) noexcept = default;
void DepthTarget::read(std::span<float> /*depths*/) const {
  no_context("depth image");
}

RasterPass::RasterPass(const Context& /*context*/, const RasterPassOptions& options) {
  no_context(options.name);
}
RasterPass::~RasterPass() = default;
RasterPass::RasterPass(RasterPass&&) noexcept = default;
RasterPass& RasterPass::operator=(RasterPass&&) noexcept = default;
void RasterPass::run(std::span<const std::byte> /*push*/,
                     std::initializer_list<std::reference_wrapper<const Buffer>> /*buffers*/,
                     const Draw& /*draw*/) const {
  no_context("draw");
}

}  // namespace penumbra::render::opengl
