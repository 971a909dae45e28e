// SPDX-License-Identifier: Apache-2.0
// The raster passes of render/ by OpenGL: shaders compiled from text, push constants in a block of 128 bytes, depth
// images as textures.

#include "render/opengl/raster_pass.hpp"

#include "base/assert.hpp"
#include "base/error.hpp"
#include "render/opengl/gl.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

namespace penumbra::render::opengl {

struct Buffer::State {
  Context::State* context = nullptr;
  std::string name;
  std::uint64_t bytes = 0;
  GLuint buffer = 0;
  ~State();
};

struct DepthTarget::State {
  Context::State* context = nullptr;
  std::string name;
  GLuint texture = 0, frame = 0;
  std::uint32_t width = 0, height = 0;
  ~State();
};

struct RasterPass::State {
  Context::State* context = nullptr;
  std::string name;
  GLuint program = 0, vertices = 0, push = 0, frame = 0;
  GLenum topology = GL_TRIANGLES;
  bool depth = false, keep_greater = false;
  ~State();
};

namespace {

/// Runs a destructor's work on a context; a lost context has freed its objects already.
template <typename Work>
void release(Context::State* context, const Work& work) {
  if (context == nullptr) return;
  try {
    const Current current(*context);
    work();
  } catch (const ResourceError&) {
  }
}

/// Largest block of push constants: Vulkan guarantees no more either.
constexpr GLsizeiptr kPushBytes = 128;

GLuint compile(GLenum stage, std::string_view text, const std::string& name) {
  const GLuint shader = glCreateShader(stage);
  const char* source = text.data();
  const auto length = static_cast<GLint>(text.size());
  glShaderSource(shader, 1, &source, &length);
  glCompileShader(shader);
  GLint good = 0;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &good);
  if (good == GL_TRUE) return shader;
  std::array<char, 2048> log{};
  glGetShaderInfoLog(shader, static_cast<GLsizei>(log.size()), nullptr, log.data());
  throw ResourceError("{}: OpenGL's compiler refuses the {} shader: {}", name,
                      stage == GL_VERTEX_SHADER ? "vertex" : "fragment", log.data());
}

GLuint link(const RasterPassOptions& options) {
  const GLuint program = glCreateProgram();
  for (const auto& [stage, text] : {std::pair<GLenum, std::string_view>(GL_VERTEX_SHADER, options.vertex),
                                    std::pair<GLenum, std::string_view>(GL_FRAGMENT_SHADER, options.fragment)}) {
    const GLuint shader = compile(stage, text, options.name);
    glAttachShader(program, shader);
    glDeleteShader(shader);  // freed with the program
  }
  glLinkProgram(program);
  GLint good = 0;
  glGetProgramiv(program, GL_LINK_STATUS, &good);
  if (good == GL_TRUE) return program;
  std::array<char, 2048> log{};
  glGetProgramInfoLog(program, static_cast<GLsizei>(log.size()), nullptr, log.data());
  throw ResourceError("{}: OpenGL's linker refuses the shaders: {}", options.name, log.data());
}

}  // namespace

Buffer::State::~State() {
  release(context, [this] { glDeleteBuffers(1, &buffer); });
}

Buffer::Buffer(const Context& context, std::string name, std::uint64_t bytes) : state_(std::make_unique<State>()) {
  State& s = *state_;
  if (bytes > context.info().max_storage_block) {
    throw ResourceError("{}: {} bytes are more than a storage block of OpenGL on {} can have ({})", name, bytes,
                        context.info().name, context.info().max_storage_block);
  }
  const Current current(context.state());
  s.context = &context.state();
  glCreateBuffers(1, &s.buffer);
  s.name = std::move(name);
  s.bytes = std::max<std::uint64_t>(bytes, sizeof(std::uint32_t));
  glNamedBufferStorage(s.buffer, static_cast<GLsizeiptr>(s.bytes), nullptr, GL_DYNAMIC_STORAGE_BIT);
  current.check("making the buffer " + s.name);
}

Buffer::~Buffer() = default;
Buffer::Buffer(Buffer&&) noexcept = default;
Buffer& Buffer::operator=(Buffer&&) noexcept = default;

std::uint64_t Buffer::bytes() const {
  return state_->bytes;
}

void Buffer::upload(std::span<const std::byte> data, std::uint64_t offset) const {
  PENUMBRA_ASSERT(offset + data.size() <= state_->bytes, "{}: {} bytes at {} of {}", state_->name, data.size(), offset,
                  state_->bytes);
  if (data.empty()) return;
  const Current current(*state_->context);
  glNamedBufferSubData(state_->buffer, static_cast<GLintptr>(offset), static_cast<GLsizeiptr>(data.size()),
                       data.data());
  current.check("writing the buffer " + state_->name);
}

void Buffer::download(std::span<std::byte> data, std::uint64_t offset) const {
  PENUMBRA_ASSERT(offset + data.size() <= state_->bytes, "{}: {} bytes at {} of {}", state_->name, data.size(), offset,
                  state_->bytes);
  if (data.empty()) return;
  const Current current(*state_->context);
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  glGetNamedBufferSubData(state_->buffer, static_cast<GLintptr>(offset), static_cast<GLsizeiptr>(data.size()),
                          data.data());
  current.check("reading the buffer " + state_->name);
}

DepthTarget::State::~State() {
  release(context, [this] {
    glDeleteFramebuffers(1, &frame);
    glDeleteTextures(1, &texture);
  });
}

DepthTarget::DepthTarget(const Context& context, const std::string& name, std::uint32_t width, std::uint32_t height)
    : state_(std::make_unique<State>()) {
  State& s = *state_;
  if (std::max(width, height) > context.info().max_image_size) {
    throw ResourceError("{}: {}×{} is more than the largest image of OpenGL on {} ({})", name, width, height,
                        context.info().name, context.info().max_image_size);
  }
  const Current current(context.state());
  s.name = name;
  s.width = width;
  s.height = height;
  s.context = &context.state();
  glCreateTextures(GL_TEXTURE_2D, 1, &s.texture);
  glCreateFramebuffers(1, &s.frame);
  glTextureStorage2D(s.texture, 1, GL_DEPTH_COMPONENT32F, static_cast<GLsizei>(width), static_cast<GLsizei>(height));
  glNamedFramebufferTexture(s.frame, GL_DEPTH_ATTACHMENT, s.texture, 0);
  current.check("making the depth image " + name);
  if (glCheckNamedFramebufferStatus(s.frame, GL_DRAW_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    throw ResourceError("{}: OpenGL on {} draws into no 32-bit float depth image of {}×{}", name, context.info().name,
                        width, height);
  }
}

DepthTarget::~DepthTarget() = default;
DepthTarget::DepthTarget(DepthTarget&&) noexcept = default;
DepthTarget& DepthTarget::operator=(DepthTarget&&) noexcept = default;

void DepthTarget::read(std::span<float> depths) const {
  const State& s = *state_;
  PENUMBRA_ASSERT(depths.size() == std::size_t{s.width} * s.height, "{}: {} floats for {}×{}", s.name, depths.size(),
                  s.width, s.height);
  const Current current(*s.context);
  glGetTextureImage(s.texture, 0, GL_DEPTH_COMPONENT, GL_FLOAT, static_cast<GLsizei>(depths.size_bytes()),
                    depths.data());
  current.check("reading the depth image " + s.name);
}

RasterPass::State::~State() {
  release(context, [this] {
    glDeleteProgram(program);
    glDeleteVertexArrays(1, &vertices);
    glDeleteBuffers(1, &push);
    glDeleteFramebuffers(1, &frame);
  });
}

RasterPass::RasterPass(const Context& context, const RasterPassOptions& options) : state_(std::make_unique<State>()) {
  State& s = *state_;
  const Current current(context.state());
  s.context = &context.state();
  s.name = options.name;
  s.topology = options.triangle_strip ? GL_TRIANGLE_STRIP : GL_TRIANGLES;
  s.depth = options.depth;
  s.keep_greater = options.keep_greater;
  s.program = link(options);
  glCreateVertexArrays(1, &s.vertices);
  glCreateBuffers(1, &s.push);
  glCreateFramebuffers(1, &s.frame);
  glNamedBufferStorage(s.push, kPushBytes, nullptr, GL_DYNAMIC_STORAGE_BIT);
  current.check("building the pass " + s.name);
}

RasterPass::~RasterPass() = default;
RasterPass::RasterPass(RasterPass&&) noexcept = default;
RasterPass& RasterPass::operator=(RasterPass&&) noexcept = default;

void RasterPass::run(std::span<const std::byte> push,
                     std::initializer_list<std::reference_wrapper<const Buffer>> buffers, const Draw& draw) const {
  const State& s = *state_;
  PENUMBRA_ASSERT(s.depth == (draw.depth != nullptr), "{}: depth target given: {}", s.name, draw.depth != nullptr);
  PENUMBRA_ASSERT(push.size() <= kPushBytes, "{}: {} bytes of push constants", s.name, push.size());
  const Current current(*s.context);
  glNamedBufferSubData(s.push, 0, static_cast<GLsizeiptr>(push.size()), push.data());
  glBindBufferBase(GL_UNIFORM_BUFFER, 0, s.push);
  GLuint binding = 0;
  for (const Buffer& buffer : buffers) glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding++, buffer.state().buffer);
  glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  glViewportIndexedf(0, 0.0F, 0.0F, static_cast<GLfloat>(draw.width), static_cast<GLfloat>(draw.height));
  if (draw.depth != nullptr) {
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, draw.depth->state().frame);
    glEnable(GL_DEPTH_TEST);
    glDepthMask(GL_TRUE);
    glDepthFunc(s.keep_greater ? GL_GREATER : GL_LESS);
    const GLfloat cleared = s.keep_greater ? 0.0F : 1.0F;
    if (draw.clear) glClearBufferfv(GL_DEPTH, 0, &cleared);
  } else {
    glNamedFramebufferParameteri(s.frame, GL_FRAMEBUFFER_DEFAULT_WIDTH, static_cast<GLint>(draw.width));
    glNamedFramebufferParameteri(s.frame, GL_FRAMEBUFFER_DEFAULT_HEIGHT, static_cast<GLint>(draw.height));
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, s.frame);
    glDisable(GL_DEPTH_TEST);
  }
  glUseProgram(s.program);
  glBindVertexArray(s.vertices);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  glDrawArraysInstanced(s.topology, 0, static_cast<GLsizei>(draw.vertices), static_cast<GLsizei>(draw.instances));
  current.check("drawing " + s.name);
}

}  // namespace penumbra::render::opengl
