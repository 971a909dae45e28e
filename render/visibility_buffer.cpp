// SPDX-License-Identifier: Apache-2.0
// Computes view samples on the device: the rasteriser proposes pixels, and shaders decide coverage in double.

#include "render/visibility_buffer.hpp"

#include "base/error.hpp"
#include "render/features.hpp"
#include "render/raster_pass.hpp"
#include "render/visibility_buffer.frag.spv.hpp"
#include "render/visibility_buffer.shared.h"
#include "render/visibility_buffer.vert.spv.hpp"

#include <algorithm>
#include <array>
#include <limits>

namespace penumbra::render {
namespace {

constexpr std::uint32_t kNothing = 0xffffffffu;

void store(double (&to)[3], const glm::dvec3& from) {
  for (int i = 0; i < 3; ++i) to[i] = from[i];
}

RasterPass make_pass(const Device& device, const char* name, std::uint32_t second) {
  return RasterPass(device, {.name = name,
                             .vertex = shaders::kVisibilityBufferVert,
                             .fragment = shaders::kVisibilityBufferFrag,
                             .push_bytes = sizeof(gpu::VisibilityBufferPush),
                             .constants = {second},
                             .triangle_strip = true});
}

/// Triangles that fit into one storage buffer.
struct Batch {
  Buffer corners, ranks;
  std::uint32_t count;
};

std::vector<Batch> upload(const Device& device, const visibility::SceneFloats& scene,
                          std::span<const std::uint32_t> ranks) {
  constexpr std::size_t kCornerBytes = 3 * sizeof(glm::vec3);
  const std::size_t most = device.limits().max_storage_buffer_range / kCornerBytes;
  std::vector<Batch> batches;
  for (std::size_t first = 0; first < scene.triangles.size(); first += most) {
    const std::size_t count = std::min(most, scene.triangles.size() - first);
    std::vector<glm::vec3> corners;
    corners.reserve(3 * count);
    for (std::size_t i = first; i < first + count; ++i) {
      for (const glm::vec3& corner : scene.corners(static_cast<std::uint32_t>(i))) corners.push_back(corner);
    }
    batches.push_back({make_buffer<glm::vec3>(device, "visibility buffer corners", corners),
                       make_buffer<std::uint32_t>(device, "visibility buffer ranks", ranks.subspan(first, count)),
                       static_cast<std::uint32_t>(count)});
  }
  return batches;
}

/// Returns for each rank the first triangle that has it.
std::vector<std::int32_t> triangles_by_rank(std::span<const std::uint32_t> ranks) {
  std::vector<std::int32_t> by_rank(ranks.size(), visibility::ViewSamples::kBackground);
  for (std::size_t i = ranks.size(); i-- > 0;) by_rank[ranks[i]] = static_cast<std::int32_t>(i);
  return by_rank;
}

}  // namespace

struct VisibilityBuffer::State {
  const Device* device;
  const visibility::SceneFloats* scene;
  RasterPass nearest, winner;
  std::vector<Batch> batches;
  std::vector<std::int32_t> by_rank;
};

bool VisibilityBuffer::runs_on(const DeviceInfo& device) {
  return missing_for(device, shaders::kVisibilityBufferVert).empty() &&
         missing_for(device, shaders::kVisibilityBufferFrag).empty();
}

VisibilityBuffer::VisibilityBuffer(const Device& device, const visibility::SceneFloats& scene) {
  const std::vector<std::uint32_t> ranks = visibility::ranks(scene);
  state_ = std::make_unique<State>(State{&device, &scene, make_pass(device, "view samples: nearest", 0),
                                         make_pass(device, "view samples: rank", 1), upload(device, scene, ranks),
                                         triangles_by_rank(ranks)});
}

VisibilityBuffer::~VisibilityBuffer() = default;
VisibilityBuffer::VisibilityBuffer(VisibilityBuffer&&) noexcept = default;
VisibilityBuffer& VisibilityBuffer::operator=(VisibilityBuffer&&) noexcept = default;

visibility::ViewSamples VisibilityBuffer::render(const visibility::PinholeCamera& camera) {
  const Device& device = *state_->device;
  if (camera.width > device.limits().max_image_size) {
    throw ResourceError("--size {}x{}: this device draws at most {} pixels in a row", camera.width, camera.height,
                        device.limits().max_image_size);
  }
  const std::uint64_t most_rows =
      device.limits().max_storage_buffer_range / (std::uint64_t{camera.width} * sizeof(std::uint64_t));
  const auto band = static_cast<std::uint32_t>(
      std::min<std::uint64_t>({camera.height, std::max<std::uint64_t>(most_rows, 1), device.limits().max_image_size}));
  const std::uint64_t slots = std::uint64_t{camera.width} * band;
  Buffer nearest(device, "visibility buffer t", slots * sizeof(std::uint64_t));
  Buffer winner(device, "visibility buffer rank", slots * sizeof(std::uint32_t));

  gpu::VisibilityBufferPush push{};
  store(push.eye, camera.eye);
  store(push.right, camera.right);
  store(push.up, camera.up);
  store(push.middle, camera.middle);
  push.tan_half_fov = camera.tan_half_fov;
  push.width = camera.width;
  push.height = camera.picture_height();

  std::vector<std::uint32_t> ranks(slots);
  std::vector<std::int32_t> triangles;
  triangles.reserve(std::size_t{camera.width} * camera.height);
  Commands commands(device);
  for (std::uint32_t row = 0; row < camera.height; row += band) {
    push.first_row = camera.first_row + row;
    push.row_count = std::min(band, camera.height - row);
    commands.fill(nearest, kNothing);
    commands.fill(winner, kNothing);
    for (const RasterPass* pass : {&state_->nearest, &state_->winner}) {
      for (const Batch& batch : state_->batches) {
        pass->record(commands, push, {batch.corners, batch.ranks, nearest, winner},
                     {.width = camera.width, .height = push.row_count, .vertices = 4, .instances = batch.count});
      }
    }
    commands.submit();
    const std::span<std::uint32_t> rows = std::span(ranks).first(std::size_t{camera.width} * push.row_count);
    winner.read(rows);
    for (const std::uint32_t rank : rows) {
      triangles.push_back(rank == kNothing ? visibility::ViewSamples::kBackground : state_->by_rank[rank]);
    }
  }
  return visibility::complete_view_samples(*state_->scene, camera, std::move(triangles));
}

}  // namespace penumbra::render
