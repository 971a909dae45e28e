// SPDX-License-Identifier: Apache-2.0
// Sorts view samples into cells of directions from a light point, on the faces of a cube, and clusters them by depth;
// finds the cells and depths of polygons, boxes and segments. For reduced shadow volumes (volume_culling.cpp).

#include "volumes/raster/receiver_cells.hpp"

#include "base/parallel.hpp"
#include "visibility/pair_truth.hpp"
#include "visibility/receivers.hpp"
#include "volumes/raster/volume_count.shared.h"
#include "volumes/raster/small_vectors.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace penumbra::volumes {
namespace {

using visibility::ViewSamples;

constexpr double kCellPad = 1e-6;  // in cells; much larger than the rounding of positions
constexpr std::uint32_t kBuckets = 256;

/// Returns x in the coordinates of a face: across, down, and depth.
glm::dvec3 seen_on(std::uint32_t face, const glm::dvec3& x) {
  const int axis = static_cast<int>(face / 2);
  return {x[(axis + 1) % 3], x[(axis + 2) % 3], face % 2 == 0 ? x[axis] : -x[axis]};
}

/// Returns the position in cells, 0 to kSide, for `share`: across or down divided by depth, −1 to 1.
double place(double share) {
  return 0.5 * (share + 1) * ReceiverCells::kSide;
}

std::uint32_t clamped(double x) {
  return static_cast<std::uint32_t>(std::clamp(std::floor(x), 0.0, ReceiverCells::kSide - 1.0));
}

std::uint32_t face_of(const glm::dvec3& x) {
  const glm::dvec3 size = glm::abs(x);
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  return static_cast<std::uint32_t>(2 * axis + (x[axis] < 0 ? 1 : 0));
}

struct Keyed {
  std::uint64_t key;  // cell and bucket of depths
  std::size_t pixel;
};

/// Returns the logarithmic bucket of a depth: up to eight for each octave, around the scene's size.
std::uint64_t bucket_of(double depth, double size) {
  const double at = 8 * std::log2(std::max(depth, 1e-30) / size) + 0.75 * kBuckets;
  return static_cast<std::uint64_t>(std::clamp(at, 0.0, kBuckets - 1.0));
}

/// Returns the part of a polygon in the cone of a face: where |across| and |down| are at most the depth.
std::vector<glm::dvec3> in_cone(std::uint32_t face, std::span<const glm::dvec3> polygon) {
  std::vector<glm::dvec3> clipped;
  for (const glm::dvec3& x : polygon) clipped.push_back(seen_on(face, x));
  for (const int axis : {0, 1}) {
    for (const double sign : {1.0, -1.0}) {
      std::vector<glm::dvec3> next;
      for (std::size_t i = 0; i < clipped.size(); ++i) {
        const glm::dvec3 &from = clipped[i], &to = clipped[(i + 1) % clipped.size()];
        const double d = from.z + sign * from[axis], e = to.z + sign * to[axis];
        if (d >= 0) next.push_back(from);
        if ((d < 0 && e > 0) || (d > 0 && e < 0)) next.push_back(from + (to - from) * (d / (d - e)));
      }
      clipped = std::move(next);
    }
  }
  return clipped;
}

}  // namespace

ReceiverCells::ReceiverCells(const visibility::SceneFloats& scene, const visibility::Light& light, const glm::vec3& l,
                             const ViewSamples& samples) {
  std::vector<Keyed> keyed(samples.size());
  const double size = std::max(1e-30, glm::length(glm::dvec3(scene.upper) - glm::dvec3(scene.lower)));
  constexpr std::uint64_t kNone = std::numeric_limits<std::uint64_t>::max();
  for_each_index(keyed.size(), [&](std::size_t pixel) {
    keyed[pixel] = {kNone, pixel};
    if (!visibility::is_receiver(scene, light, samples, pixel)) return;
    const auto carrier = static_cast<std::uint32_t>(samples.triangle[pixel]);
    if (!visibility::above_horizon(scene.corners(carrier), samples.facing[pixel], l)) return;
    const glm::dvec3 x = glm::dvec3(samples.p[pixel]) - glm::dvec3(l);
    const std::uint32_t face = face_of(x);
    const glm::dvec3 seen = seen_on(face, x);
    const std::size_t cell =
        seen.z > 0 ? cell_of(face, clamped(place(seen.x / seen.z)), clamped(place(seen.y / seen.z))) : 0;
    keyed[pixel].key = cell * kBuckets + bucket_of(seen.z, size);
  });
  std::erase_if(keyed, [](const Keyed& sample) { return sample.key == kNone; });
  tbb::parallel_sort(keyed.begin(), keyed.end(),
                     [](const Keyed& a, const Keyed& b) { return a.key != b.key ? a.key < b.key : a.pixel < b.pixel; });
  first_.assign(kCells + 1, 0);
  for (std::size_t i = 0; i < keyed.size(); ++i) {
    const std::size_t pixel = keyed[i].pixel, cell = keyed[i].key / kBuckets;
    const glm::dvec3 x = glm::dvec3(samples.p[pixel]) - glm::dvec3(l);
    const std::uint32_t plane = scene.plane[static_cast<std::uint32_t>(samples.triangle[pixel])];
    const double depth = seen_on(static_cast<std::uint32_t>(cell / (std::size_t{kSide} * kSide)), x).z;
    if (i == 0 || keyed[i - 1].key != keyed[i].key) {
      clusters_.push_back({x, x, depth, plane});
      ++first_[cell + 1];
      continue;
    }
    Cluster& cluster = clusters_.back();
    cluster.lower = glm::min(cluster.lower, x);
    cluster.upper = glm::max(cluster.upper, x);
    cluster.depth = std::max(cluster.depth, depth);
    if (cluster.plane != plane) cluster.plane = kManyPlanes;
  }
  for (std::size_t cell = 0; cell < kCells; ++cell) first_[cell + 1] += first_[cell];
}

std::vector<CellBlock> blocks_of(std::span<const glm::dvec3> polygon) {
  std::vector<CellBlock> blocks;
  for (std::uint32_t face = 0; face < 6; ++face) {
    const std::vector<glm::dvec3> corners = in_cone(face, polygon);
    if (corners.empty()) continue;
    CellBlock block{face, {}, {}, std::numeric_limits<double>::infinity(), 0};
    glm::dvec2 lower(std::numeric_limits<double>::infinity()), upper = -lower;
    for (const glm::dvec3& corner : corners) {
      block.least = std::min(block.least, corner.z);
      block.most = std::max(block.most, corner.z);
      const glm::dvec2 at(place(corner.x / corner.z), place(corner.y / corner.z));
      lower = glm::min(lower, at - kCellPad);
      upper = glm::max(upper, at + kCellPad);
    }
    if (!(block.least > 0)) {  // l is on the plane: depths are unknown
      lower = glm::dvec2(0);
      upper = glm::dvec2(ReceiverCells::kSide);
    }
    block.first = {clamped(lower.x), clamped(lower.y)};
    block.last = {clamped(upper.x), clamped(upper.y)};
    blocks.push_back(block);
  }
  return blocks;
}

std::vector<CellBlock> blocks_of_box(const glm::dvec3& lower, const glm::dvec3& upper) {
  std::vector<CellBlock> blocks;
  for (std::uint32_t face = 0; face < 6; ++face) {
    CellBlock block{
        face, {0, 0}, {ReceiverCells::kSide - 1, ReceiverCells::kSide - 1}, std::numeric_limits<double>::infinity(), 0};
    glm::dvec2 low(std::numeric_limits<double>::infinity()), high = -low;
    for (int i = 0; i < 8; ++i) {
      const glm::dvec3 corner = seen_on(
          face, {(i & 1) != 0 ? lower.x : upper.x, (i & 2) != 0 ? lower.y : upper.y, (i & 4) != 0 ? lower.z : upper.z});
      block.least = std::min(block.least, corner.z);
      block.most = std::max(block.most, corner.z);
      low = glm::min(low, glm::dvec2(corner) / corner.z);
      high = glm::max(high, glm::dvec2(corner) / corner.z);
    }
    if (!(block.most > 0)) continue;
    if (block.least > 0) {
      if (low.x > 1 + kCellPad || low.y > 1 + kCellPad || high.x < -1 - kCellPad || high.y < -1 - kCellPad) continue;
      block.first = {clamped(place(low.x) - kCellPad), clamped(place(low.y) - kCellPad)};
      block.last = {clamped(place(high.x) + kCellPad), clamped(place(high.y) + kCellPad)};
    } else {
      block.least = 0;
    }
    blocks.push_back(block);
  }
  return blocks;
}

glm::dvec3 direction_of(std::uint32_t face, double x, double y) {
  const double across = 2 * x / ReceiverCells::kSide - 1, down = 2 * y / ReceiverCells::kSide - 1;
  const int axis = static_cast<int>(face / 2);
  glm::dvec3 direction;
  direction[axis] = face % 2 == 0 ? 1 : -1;
  direction[(axis + 1) % 3] = across;
  direction[(axis + 2) % 3] = down;
  return direction;
}

std::vector<CellSegment> segments_of(const glm::dvec3& a, const glm::dvec3& b) {
  std::vector<CellSegment> segments;
  for (std::uint32_t face = 0; face < 6; ++face) {
    glm::dvec3 from = seen_on(face, a), to = seen_on(face, b);
    bool any = true;
    for (const int axis : {0, 1}) {
      for (const double sign : {1.0, -1.0}) {
        const double d = from.z + sign * from[axis], e = to.z + sign * to[axis];
        any = any && !(d < 0 && e < 0);
        if (!any || (d >= 0 && e >= 0)) continue;
        (d < 0 ? from : to) = from + (to - from) * (d / (d - e));
      }
    }
    if (!any) continue;
    // Replaces a segment that passes through l, which has no position on the face, by the face's diagonal.
    if (!(from.z > 0 && to.z > 0)) {
      segments.push_back({face, {0, 0}, glm::dvec2(ReceiverCells::kSide)});
      continue;
    }
    segments.push_back(
        {face, {place(from.x / from.z), place(from.y / from.z)}, {place(to.x / to.z), place(to.y / to.z)}});
  }
  return segments;
}

PlaneDepths::PlaneDepths(const std::array<glm::dvec3, 3>& corners)
    : n_(glm::cross(corners[1] - corners[0], corners[2] - corners[0])), d_(glm::dot(n_, corners[0])) {
  for (std::size_t i = 0; i < 3; ++i) {
    const glm::dvec3 &from = corners[i], &to = corners[(i + 1) % 3];
    planes_[i] = (d_ < 0 ? -1.0 : 1.0) * glm::cross(from, to);
    errors_[i] = 1e-9 * norm1(from) * norm1(to);
  }
}

PlaneDepths::Range PlaneDepths::in(const CellBlock& block, std::uint32_t x, std::uint32_t y) const {
  double least = std::numeric_limits<double>::infinity(), most = 0;
  for (const double right : {-kCellPad, 1 + kCellPad}) {
    for (const double down : {-kCellPad, 1 + kCellPad}) {
      const glm::dvec3 direction = direction_of(block.face, x + right, y + down);
      const double depth = d_ / glm::dot(n_, direction);  // 1 / depth is linear over the cell
      if (!(depth > 0)) return {block.least, block.most};
      least = std::min(least, depth);
      most = std::max(most, depth);
    }
  }
  return {std::max(block.least, least * (1 - 1e-6)), std::min(block.most, most * (1 + 1e-6))};
}

bool PlaneDepths::covers_middle(std::uint32_t face, std::uint32_t x, std::uint32_t y) const {
  const glm::dvec3 direction = direction_of(face, x + 0.5371, y + 0.4219);  // offsets chosen so that the ray is on no
                                                                            // diagonal of the face
  for (std::size_t i = 0; i < 3; ++i) {
    if (!(glm::dot(planes_[i], direction) > errors_[i] * norm1(direction))) return false;
  }
  return true;
}

}  // namespace penumbra::volumes
