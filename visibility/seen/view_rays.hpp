// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/seen/placed_meshes.hpp"
#include "visibility/view_samples.hpp"

#include <glm/vec3.hpp>

#include <array>
#include <atomic>
#include <cstdint>
#include <vector>

namespace penumbra::visibility {

/// A bit for each triangle of all parts. Several threads may set bits at once.
class TriangleBits {
 public:
  explicit TriangleBits(std::uint64_t triangles);

  void set(std::uint64_t bit) {
    std::atomic<std::uint64_t>& word = words_[bit / 64];
    const std::uint64_t mask = std::uint64_t{1} << bit % 64;
    if ((word.load(std::memory_order_relaxed) & mask) == 0) word.fetch_or(mask, std::memory_order_relaxed);
  }
  [[nodiscard]] std::uint64_t count() const;
  [[nodiscard]] bool any(std::uint64_t first, std::uint64_t end) const;
  [[nodiscard]] bool has(std::uint64_t bit) const {
    return (words_[bit / 64].load(std::memory_order_relaxed) >> bit % 64 & 1) != 0;
  }

 private:
  std::vector<std::atomic<std::uint64_t>> words_;
};

/// A point at which lights may be evaluated.
struct SeenPoint {
  glm::vec3 p{0}, n{0};              ///< scene floats; the surface's normal toward the viewer, of any length
  std::array<glm::vec3, 3> carrier;  ///< corners of the surface
};

/// Finds what pixels see of placed meshes: along each ray, the nearest opaque triangle, and the translucent ones in
/// front of it.
class ViewRays {
 public:
  /// All arguments must outlive this object.
  ViewRays(const PlacedMeshes& meshes, const PinholeCamera& camera);

  /// Appends the bits of the triangles that the pixel sees, and the points seen.
  void look(std::uint32_t x, std::uint32_t y, std::vector<std::uint64_t>& bits, std::vector<SeenPoint>& points) const;

 private:
  struct Met {
    double t;
    std::uint64_t bit;
    std::array<glm::vec3, 3> corners;
  };
  class Walk;

  const PlacedMeshes& meshes_;
  const PinholeCamera& camera_;
  std::vector<std::uint8_t> is_solid_;  // for each object
};

}  // namespace penumbra::visibility
