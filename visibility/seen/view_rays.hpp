#pragma once

#include "visibility/seen/placed_meshes.hpp"
#include "visibility/view_samples.hpp"

#include <glm/vec3.hpp>

#include <array>
#include <atomic>
#include <cstdint>
#include <vector>

namespace penumbra::visibility {

/// A bit for each triangle of all parts. Bits may be set by many threads at once.
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

/// A place from which a light may be asked for.
struct SeenPoint {
  glm::vec3 p{0}, n{0};  ///< scene floats; the surface's normal toward the viewer, of any length
};

/// What pixels see of meshes that are placed: along each ray, the nearest triangle that stops all light, and those
/// before it that do not.
class ViewRays {
 public:
  /// All must outlive it.
  ViewRays(const PlacedMeshes& meshes, const PinholeCamera& camera);

  /// Sets the bits of what the pixel sees, and adds where.
  void look(std::uint32_t x, std::uint32_t y, TriangleBits& seen, std::vector<SeenPoint>& points) const;

 private:
  struct Met {
    double t;
    std::uint64_t bit;
    std::array<glm::vec3, 3> corners;
  };
  class Walk;

  const PlacedMeshes& meshes_;
  const PinholeCamera& camera_;
  std::vector<std::uint8_t> is_solid_;  // each object
};

}  // namespace penumbra::visibility
