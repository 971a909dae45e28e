// SPDX-License-Identifier: Apache-2.0
// Computes view samples from the pixels proposed by OpenGL's rasteriser, with coverage decided in double on the host.

#include "render/proposed_view_samples.hpp"

#include "base/error.hpp"
#include "render/opengl/raster_pass.hpp"
#include "render/visibility_buffer.shared.h"
#include "render/visibility_buffer.vert.glsl.hpp"
#include "render/visibility_proposals.frag.glsl.hpp"

#include <algorithm>
#include <limits>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

namespace penumbra::render {
namespace {

/// Best candidate of a pixel: the smallest t, among equal t the smallest rank, and for each rank the first triangle
/// that has it.
struct Winner {
  double t = std::numeric_limits<double>::infinity();
  std::uint32_t rank = std::numeric_limits<std::uint32_t>::max();
  std::int32_t triangle = visibility::ViewSamples::kBackground;

  bool operator<(const Winner& other) const {
    return std::tie(t, rank, triangle) < std::tie(other.t, other.rank, other.triangle);
  }
};

/// Rows of a picture, and the triangles proposed for them.
struct Band {
  std::uint32_t first_row, rows, first_triangle, triangles;
};

gpu::VisibilityBufferPush push_of(const visibility::PinholeCamera& camera, const Band& band) {
  gpu::VisibilityBufferPush push{};
  for (int i = 0; i < 3; ++i) {
    push.eye[i] = camera.eye[i];
    push.right[i] = camera.right[i];
    push.up[i] = camera.up[i];
    push.middle[i] = camera.middle[i];
  }
  push.tan_half_fov = camera.tan_half_fov;
  push.width = camera.width;
  push.height = camera.picture_height();
  push.first_row = camera.first_row + band.first_row;
  push.row_count = band.rows;
  return push;
}

class Proposals {
 public:
  explicit Proposals(const opengl::Context& context)
      : context_(&context),
        pass_(context, {.name = "view sample proposals",
                        .vertex = shaders::kVisibilityBufferVertText,
                        .fragment = shaders::kVisibilityProposalsFragText,
                        .triangle_strip = true}),
        push_(context, "view sample camera", sizeof(gpu::VisibilityBufferPush)) {}

  /// Finds pairs of pixel (in the band) and triangle (in the band). The list grows; returns false if it cannot grow
  /// enough.
  bool find(const visibility::PinholeCamera& camera, const opengl::Buffer& corners, const Band& band,
            std::vector<std::uint32_t>& pairs) {
    const gpu::VisibilityBufferPush push = push_of(camera, band);
    push_.write<gpu::VisibilityBufferPush>(std::span(&push, 1));
    for (std::uint64_t room = std::max<std::uint64_t>(room_, std::uint64_t{camera.width} * band.rows * 8);;) {
      if (bytes_of(room) > context_->info().max_storage_block) return false;
      opengl::Buffer list(*context_, "view sample proposals", bytes_of(room));
      std::uint32_t count = 0;
      list.write<std::uint32_t>(std::span(&count, 1));
      pass_.draw(0u, {corners, push_, list},
                 {.width = camera.width, .height = band.rows, .vertices = 4, .instances = band.triangles});
      list.read<std::uint32_t>(std::span(&count, 1));
      if (count > room) {
        room = count;
        continue;
      }
      room_ = room;
      pairs.resize(2 * std::size_t{count});
      list.read<std::uint32_t>(pairs, sizeof(std::uint32_t));
      return true;
    }
  }

 private:
  static std::uint64_t bytes_of(std::uint64_t room) { return (1 + 2 * room) * sizeof(std::uint32_t); }
  const opengl::Context* context_;
  opengl::RasterPass pass_;
  opengl::Buffer push_;
  std::uint64_t room_ = 0;
};

}  // namespace

visibility::ViewSamples proposed_view_samples(const opengl::Context& context, const visibility::SceneFloats& scene,
                                              const visibility::PinholeCamera& camera) {
  const std::uint32_t most_side = context.info().max_image_size;
  if (camera.width > most_side) {
    throw ResourceError("--size {}x{}: OpenGL on {} draws at most {} pixels in a row", camera.width, camera.height,
                        context.info().name, most_side);
  }
  constexpr std::size_t kCornerBytes = 3 * sizeof(glm::vec3);
  const auto most = static_cast<std::size_t>(context.info().max_storage_block / kCornerBytes);
  const std::vector<std::uint32_t> ranks = visibility::ranks(scene);
  Proposals proposals(context);
  std::vector<Winner> winners(std::size_t{camera.width} * camera.height);
  std::vector<std::uint32_t> pairs;
  for (std::size_t first = 0; first < scene.triangles.size(); first += most) {
    const auto count = static_cast<std::uint32_t>(std::min(most, scene.triangles.size() - first));
    std::vector<glm::vec3> positions;
    positions.reserve(std::size_t{3} * count);
    for (std::uint32_t i = 0; i < count; ++i) {
      for (const glm::vec3& corner : scene.corners(static_cast<std::uint32_t>(first) + i)) positions.push_back(corner);
    }
    opengl::Buffer corners(context, "view sample corners", positions.size() * sizeof(glm::vec3));
    corners.write<glm::vec3>(positions);
    std::uint32_t rows = std::min(camera.height, most_side);
    for (std::uint32_t row = 0; row < camera.height;) {
      const Band band{row, std::min(rows, camera.height - row), static_cast<std::uint32_t>(first), count};
      if (!proposals.find(camera, corners, band, pairs)) {
        if (band.rows == 1) throw ResourceError("OpenGL: more proposals in one row than a storage block can hold");
        rows = (band.rows + 1) / 2;
        continue;
      }
      for (std::size_t i = 0; i < pairs.size(); i += 2) {
        const std::uint32_t x = pairs[i] % camera.width, y = row + pairs[i] / camera.width;
        const std::uint32_t triangle = band.first_triangle + pairs[i + 1];
        if (scene.plane[triangle] == visibility::SceneFloats::kNoPlane) continue;
        const auto t = visibility::cover(camera.ray(x, y), scene.corners(triangle));
        if (!t) continue;
        Winner& best = winners[std::size_t{y} * camera.width + x];
        const std::uint32_t rank = ranks[triangle];
        const Winner candidate{*t, rank, static_cast<std::int32_t>(triangle)};
        if (candidate < best) best = candidate;
      }
      row += band.rows;
    }
  }
  std::vector<std::int32_t> triangles(winners.size());
  std::ranges::transform(winners, triangles.begin(), &Winner::triangle);
  return visibility::complete_view_samples(scene, camera, std::move(triangles));
}

}  // namespace penumbra::render
