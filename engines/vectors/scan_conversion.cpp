// SPDX-License-Identifier: Apache-2.0
// Scan conversion on the processor: pixels that triangles may cover, tile by tile. scan_tile.cpp decides coverage, in
// double, as visibility::cover does; the code here must never lose a pixel that scan_tile.cpp would give to a triangle.
// For most triangles scan_boxes.cpp finds the pixels, in float; careful_box() does so in double for those near the
// eye's plane.
//
// Pixels outside of a triangle's projection can be covered because of rounding. cover() takes the signs of s₁ =
// d·(a×b), s₂ = d·(b×c), s₃ = −d·(a×c), where a, b, c are the corners seen from the eye and d is the ray. Exactly, d =
// (s₂a + s₃b + s₁c) / D with D = det(a, b, c), so that the ray's place on the screen is the mean of the corners' with
// weights s z / D. Rounding moves each s by at most E = 8 · 2⁻⁵³ |d| R², R the largest |corner| (sums of absolute
// components throughout): a pixel that is covered although it lies m pixels outside of the box of the projection has at
// least one weight below zero, none below −E R / |D|, and so m ≤ 3 E R extent / |D|. If |D| is large enough
// (`certain`), a margin of 1/32 pixel is therefore safe, and t is between the corners' depths except for a part in 2⁸
// (1 / t is the corners' mean of 1 / z with these weights). Triangles seen nearly edge-on get the margin of one pixel
// that proposals of the visibility buffer have (render/visibility_buffer.vert), and are never culled as hidden.

#include "engines/vectors/scan_conversion.hpp"

#include "engines/vectors/scan_boxes.hpp"
#include "engines/vectors/scan_tile.hpp"
#include "base/pages.hpp"
#include "base/size1.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

namespace penumbra::vectors {
namespace {

using visibility::PinholeCamera;
using visibility::SceneFloats;

constexpr double kMargin = 1.0 / 32;                         // in pixels, around a triangle that is certain
constexpr std::size_t kBatch = std::size_t{1} << 16U;        // triangles between two updates of hidden tiles
constexpr std::size_t kChunk = std::size_t{1} << 11U;        // triangles of a batch that one core sorts at a time
constexpr std::size_t kMostEntries = std::size_t{1} << 16U;  // of a chunk's lists, except those of its last triangle
constexpr std::uint32_t kFewTiles = 4;                       // up to this number the tiles of a triangle's box are used
                                                             // directly

/// Pixel centres that a triangle may cover, both ends included, and a lower bound of all its t (0: unknown).
struct PixelBox {
  std::uint32_t left, right, top, bottom;
  float nearest;
};

/// A triangle in the list of one tile.
struct Sorted {
  std::uint32_t tile;
  TileEntry entry;
};

/// Triangles that one core found, by tile.
class Chunk {
 public:
  /// `next` is the first of these triangles that is not sorted yet.
  std::size_t next = 0, end = 0;

  void clear() { found_.clear(); }
  [[nodiscard]] bool is_full() const { return found_.size() >= kMostEntries; }
  void add(std::uint32_t tile, const TileEntry& entry) { found_.push_back({tile, entry}); }
  void sort(std::size_t tiles) {
    end_.assign(tiles + 1, 0);
    for (const Sorted& one : found_) ++end_[one.tile + 1];
    for (std::size_t tile = 0; tile < tiles; ++tile) end_[tile + 1] += end_[tile];
    entries_.resize(found_.size());
    for (const Sorted& one : found_) entries_[end_[one.tile]++] = one.entry;  // from a tile's beginning to its end
  }
  [[nodiscard]] std::span<const TileEntry> of(std::uint32_t tile) const {
    const std::uint32_t begin = tile == 0 ? 0 : end_[tile - 1];
    return std::span(entries_).subspan(begin, end_[tile] - begin);
  }

 private:
  std::vector<Sorted> found_;
  std::vector<TileEntry> entries_;
  std::vector<std::uint32_t> end_;
};

/// Finds tiles that a large triangle certainly does not cover: all rays through the tile are outside of one of its
/// edges.
class Outline {
 public:
  Outline(const PinholeCamera& view, const std::array<glm::vec3, 3>& corners, double longest_ray) {
    const glm::dvec3 a = glm::dvec3(corners[0]) - view.eye, b = glm::dvec3(corners[1]) - view.eye,
                     c = glm::dvec3(corners[2]) - view.eye;
    const double reach = std::max({size1(a), size1(b), size1(c)}), det = glm::dot(a, glm::cross(b, c));
    if (!(std::abs(det) > kScanNoise * longest_ray * reach * reach * reach)) return;  // no tile is excluded
    const double side = det > 0 ? 1 : -1;
    edges_ = {side * glm::cross(a, b), side * glm::cross(b, c), side * glm::cross(c, a)};
    error_ = 0x1p-48 * longest_ray * reach * reach;  // twice E, once for cover() and once for the test here
  }
  [[nodiscard]] bool misses(const std::array<glm::dvec3, 4>& rays) const {
    return std::ranges::any_of(edges_, [&](const glm::dvec3& edge) {
      return std::ranges::all_of(rays, [&](const glm::dvec3& ray) { return glm::dot(edge, ray) < -error_; });
    });
  }

 private:
  std::array<glm::dvec3, 3> edges_{};
  double error_ = 0;
};

class Scan {
 public:
  Scan(const SceneFloats& scene, const PinholeCamera& camera);
  std::vector<std::int32_t> run();

 private:
  [[nodiscard]] std::optional<PixelBox> box_of(const PixelBoxes& boxes, std::size_t i) const;
  [[nodiscard]] std::optional<PixelBox> careful_box(std::uint32_t triangle) const;
  [[nodiscard]] std::optional<PixelBox> pixels_in(glm::dvec2 lower, glm::dvec2 upper, double margin,
                                                  double nearest) const;
  void sort(Chunk& chunk) const;
  void sort(std::uint32_t triangle, const PixelBox& box, Chunk& chunk) const;
  void paint(std::span<const Chunk> chunks);
  [[nodiscard]] std::array<glm::dvec3, 4> rays_around(std::uint32_t tile_x, std::uint32_t tile_y) const;

  const SceneFloats& scene_;
  const ScanCamera camera_;
  const PinholeCamera& view_;
  const Screen screen_;
  const BoxCamera floats_;
  std::uint32_t tiles_x_, tiles_y_;
  UnsetList<double> nearest_;
  UnsetList<std::int64_t> carrier_;
  std::vector<double> farthest_;  // for each tile, the largest of its pixels' smallest t
};

Scan::Scan(const SceneFloats& scene, const PinholeCamera& camera)
    : scene_(scene),
      camera_(camera),
      view_(camera_.view),
      screen_(camera),
      floats_(scene, camera, screen_),
      tiles_x_((camera.width + kScanTile - 1) / kScanTile),
      tiles_y_((camera.height + kScanTile - 1) / kScanTile) {
  const std::size_t tiles = std::size_t{tiles_x_} * tiles_y_;
  nearest_.resize(tiles * kScanSlots);
  carrier_.resize(tiles * kScanSlots);
  farthest_.assign(tiles, std::numeric_limits<double>::infinity());
  tbb::parallel_for(std::size_t{0}, tiles, [&](std::size_t i) {
    const auto tile = static_cast<std::uint32_t>(i);
    const auto nearest = std::span(nearest_).subspan(i * kScanSlots, kScanSlots);
    std::ranges::fill(nearest, -std::numeric_limits<double>::infinity());  // outside of the picture
    const std::uint32_t columns = std::min(camera.width - tile % tiles_x_ * kScanTile, kScanTile),
                        rows = std::min(camera.height - tile / tiles_x_ * kScanTile, kScanTile);
    for (std::uint32_t row = 0; row < rows; ++row)
      std::ranges::fill(nearest.subspan(std::size_t{row} * kScanTile, columns),
                        std::numeric_limits<double>::infinity());
    std::ranges::fill(std::span(carrier_).subspan(i * kScanSlots, kScanSlots), visibility::ViewSamples::kBackground);
  });
}

std::optional<PixelBox> Scan::pixels_in(glm::dvec2 lower, glm::dvec2 upper, double margin, double nearest) const {
  lower = glm::max(lower - margin - 0.5, glm::dvec2(0));
  upper = glm::min(upper + margin - 0.5, screen_.size - 1.0);
  const double left = std::ceil(lower.x), right = std::floor(upper.x), top = std::ceil(lower.y),
               bottom = std::floor(upper.y);
  if (!(left <= right && top <= bottom)) return std::nullopt;
  const auto whole = [](double x) { return static_cast<std::uint32_t>(x); };
  return PixelBox{whole(left), whole(right), whole(top), whole(bottom), static_cast<float>(nearest * (1 - 0x1p-7))};
}

std::optional<PixelBox> Scan::box_of(const PixelBoxes& boxes, std::size_t i) const {
  if (boxes.left[i] == PixelBoxes::kOpen) return careful_box(boxes.triangle[i]);
  const auto whole = [](std::int32_t pixel) { return static_cast<std::uint32_t>(pixel); };
  return PixelBox{whole(boxes.left[i]), whole(boxes.right[i]), whole(boxes.top[i]), whole(boxes.bottom[i]),
                  boxes.nearest[i]};
}

std::optional<PixelBox> Scan::careful_box(std::uint32_t triangle) const {
  std::array<glm::dvec3, 3> corners;
  glm::dvec2 lower = screen_.size, upper(0);
  double reach = 0, nearest = std::numeric_limits<double>::infinity();
  bool in_front = false, behind = false;
  for (std::size_t i = 0; i < 3; ++i) {
    corners[i] = glm::dvec3(scene_.positions[scene_.triangles[triangle][i]]) - view_.eye;
    const double z = glm::dot(corners[i], view_.forward), here = size1(corners[i]);
    reach = std::max(reach, here);
    nearest = std::min(nearest, z);
    in_front = in_front || z > 0;
    if (z <= here * 1e-9) {  // a projection could be off by a pixel
      behind = true;
      continue;
    }
    const glm::dvec2 at(screen_.middle.x + glm::dot(corners[i], view_.right) / z * screen_.scale,
                        screen_.middle.y - glm::dot(corners[i], view_.up) / z * screen_.scale);
    lower = glm::min(lower, at);
    upper = glm::max(upper, at);
  }
  if (!in_front) return std::nullopt;
  if (behind) return pixels_in(glm::dvec2(0), screen_.size, 1, 0);
  const double extent = std::max(upper.x - lower.x, upper.y - lower.y);
  const double det = std::abs(glm::dot(corners[0], glm::cross(corners[1], corners[2])));
  const bool certain = det > kScanNoise * (1 + extent / 32) * screen_.longest_ray * reach * reach * reach;
  return pixels_in(lower, upper, certain ? kMargin : 1, certain ? nearest : 0);
}

std::array<glm::dvec3, 4> Scan::rays_around(std::uint32_t tile_x, std::uint32_t tile_y) const {
  const std::uint32_t left = tile_x * kScanTile, top = tile_y * kScanTile,
                      right = std::min(left + kScanTile, view_.width) - 1,
                      bottom = std::min(top + kScanTile, view_.height) - 1;
  return {view_.direction(left, top), view_.direction(right, top), view_.direction(left, bottom),
          view_.direction(right, bottom)};
}

void Scan::sort(std::uint32_t triangle, const PixelBox& box, Chunk& chunk) const {
  const std::uint32_t left = box.left / kScanTile, right = box.right / kScanTile, top = box.top / kScanTile,
                      bottom = box.bottom / kScanTile;
  std::optional<Outline> outline;
  if ((right - left + 1) * (bottom - top + 1) > kFewTiles)
    outline.emplace(view_, scene_.corners(triangle), screen_.longest_ray);
  for (std::uint32_t y = top; y <= bottom; ++y) {
    for (std::uint32_t x = left; x <= right; ++x) {
      const std::uint32_t tile = y * tiles_x_ + x;
      if (static_cast<double>(box.nearest) > farthest_[tile]) continue;
      if (outline && outline->misses(rays_around(x, y))) continue;
      const auto within = [](std::uint32_t pixel, std::uint32_t of) {
        const std::uint32_t first = of * kScanTile;
        return static_cast<std::uint8_t>(std::clamp(pixel, first, first + kScanTile - 1) - first);
      };
      chunk.add(tile, {triangle, within(box.left, x), within(box.right, x), within(box.top, y), within(box.bottom, y)});
    }
  }
}

void Scan::sort(Chunk& chunk) const {
  chunk.clear();
  PixelBoxes boxes;
  while (chunk.next < chunk.end && !chunk.is_full()) {
    const std::size_t end = std::min(chunk.next + PixelBoxes::kMost, chunk.end);
    find_boxes(scene_, floats_, chunk.next, end, boxes);
    chunk.next = end;
    for (std::size_t i = 0; i < boxes.count; ++i) {
      const std::uint32_t triangle = boxes.triangle[i];
      if (chunk.is_full()) {
        chunk.next = triangle;
        break;
      }
      if (scene_.plane[triangle] == SceneFloats::kNoPlane) continue;
      if (const std::optional<PixelBox> box = box_of(boxes, i)) sort(triangle, *box, chunk);
    }
  }
  chunk.sort(farthest_.size());
}

void Scan::paint(std::span<const Chunk> chunks) {
  tbb::parallel_for(std::size_t{0}, farthest_.size(), [&](std::size_t i) {
    const auto tile = static_cast<std::uint32_t>(i);
    std::vector<TileEntry> entries;
    for (const Chunk& chunk : chunks) entries.insert(entries.end(), chunk.of(tile).begin(), chunk.of(tile).end());
    if (entries.empty()) return;
    farthest_[i] = scan_tile(scene_, camera_, entries,
                             {.first_x = tile % tiles_x_ * kScanTile,
                              .first_y = tile / tiles_x_ * kScanTile,
                              .nearest = std::span(nearest_).subspan(i * kScanSlots, kScanSlots),
                              .carrier = std::span(carrier_).subspan(i * kScanSlots, kScanSlots)});
  });
}

std::vector<std::int32_t> Scan::run() {
  const std::size_t count = scene_.triangles.size();
  std::vector<Chunk> chunks;
  for (std::size_t first = 0; first < count; first += kBatch) {
    const std::size_t here = std::min(kBatch, count - first);
    chunks.resize((here + kChunk - 1) / kChunk);
    for (std::size_t i = 0; i < chunks.size(); ++i) {
      chunks[i].next = first + i * kChunk;
      chunks[i].end = std::min(chunks[i].next + kChunk, first + here);
    }
    while (std::ranges::any_of(chunks, [](const Chunk& chunk) { return chunk.next < chunk.end; })) {
      tbb::parallel_for(std::size_t{0}, chunks.size(), [&](std::size_t i) { sort(chunks[i]); });
      paint(chunks);
    }
  }
  std::vector<std::int32_t> triangles(std::size_t{view_.width} * view_.height);
  tbb::parallel_for(std::uint32_t{0}, view_.height, [&](std::uint32_t y) {
    for (std::uint32_t x = 0; x < view_.width; ++x) {
      const std::size_t tile = std::size_t{y / kScanTile} * tiles_x_ + x / kScanTile;
      triangles[std::size_t{y} * view_.width + x] = static_cast<std::int32_t>(
          carrier_[tile * kScanSlots + std::size_t{y % kScanTile} * kScanTile + x % kScanTile]);
    }
  });
  return triangles;
}

}  // namespace

visibility::ViewSamples scan_view_samples(const SceneFloats& scene, const PinholeCamera& camera) {
  return visibility::complete_view_samples(scene, camera, Scan(scene, camera).run());
}

}  // namespace penumbra::vectors
