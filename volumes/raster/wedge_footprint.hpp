// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/view_samples.hpp"
#include "volumes/wedges/penumbra_wedge.hpp"
#include "volumes/wedges/wedge_plane.hpp"

#include <glm/common.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace penumbra::volumes {

/// A convex polygon on the screen, in pixels from the picture's upper left; its corners in order.
struct Footprint {
  static constexpr std::size_t kMost = 8;
  std::array<glm::vec2, kMost> corners;
  std::size_t size = 0;
};

/// Receivers that footprints must contain (E. Lengyel, Advanced stencil shadow and penumbral wedge rendering, GDC 2005,
/// discards fragments by depth and by orientation; here whole parts of footprints are discarded).
enum class WedgeTests {
  none,  ///< wedges are cut by the box of all receivers
  z,     ///< footprints are also cut by the hull of the blocks of pixels whose receivers' box is not beyond a plane of
         ///< the wedge
  both,  ///< as z, and receivers that face away from the light's centre, which are dark, are ignored
};

/// Places of receivers, by square blocks of pixels: wedges, which have no caps, are cut by them.
class Receivers {
 public:
  /// Uses all pixels that are not background, or only those that do not face away from `center`.
  explicit Receivers(const visibility::ViewSamples& samples, const std::optional<glm::dvec3>& center = {});

  [[nodiscard]] bool empty() const { return !(nearest_ > 0); }
  /// Returns the bounds of all receivers.
  [[nodiscard]] const Box& bounds() const { return bounds_; }
  /// Calls body(lower, upper, bounds) for each block that has receivers and meets these pixels: its pixels' corners and
  /// its box.
  template <typename Body>
  void for_each_block(const glm::dvec2& lower, const glm::dvec2& upper, const Body& body) const {
    const auto block = [](double at, std::uint32_t count) {
      return static_cast<std::uint32_t>(glm::clamp(at / kBlock, 0.0, static_cast<double>(count - 1)));
    };
    for (std::uint32_t y = block(lower.y, rows_); y <= block(upper.y, rows_); ++y) {
      for (std::uint32_t x = block(lower.x, columns_); x <= block(upper.x, columns_); ++x) {
        const Box& box = blocks_[std::size_t{y} * columns_ + x];
        const glm::dvec2 corner(x * kBlock, y * kBlock);
        if (box.lower.x <= box.upper.x) body(corner, corner + static_cast<double>(kBlock), box);
      }
    }
  }
  /// Returns half of the nearest receiver's distance along the view axis. At this distance no visible point is cut off
  /// or projected to infinity.
  [[nodiscard]] double nearest() const { return nearest_; }
  /// Returns the largest coordinate of any receiver.
  [[nodiscard]] double reach() const { return reach_; }

 private:
  static constexpr std::uint32_t kBlock = 8;  // pixels along each side
  std::uint32_t columns_ = 0, rows_ = 0;
  std::vector<Box> blocks_;  // lower > upper for blocks without receivers
  Box bounds_;
  double nearest_ = 0, reach_ = 0;
};

/// Finds the screen region of the receivers in a wedge. The region only proposes pixels; shaders decide.
class FootprintFinder {
 public:
  /// Borrows the receivers.
  FootprintFinder(const visibility::PinholeCamera& camera, const Receivers& receivers, WedgeTests tests);

  /// Returns a footprint that contains every pixel whose centre is within an eighth of a pixel of a receiver in one of
  /// the wedges (pieces of one edge; `split` ones are skipped). Returns nullopt if it contains no pixel. The eye may be
  /// inside.
  [[nodiscard]] std::optional<Footprint> around(std::span<const Wedge> pieces) const;

 private:
  using Points = std::vector<glm::dvec2>;
  void add_projection(const Wedge& wedge, Points& points) const;
  [[nodiscard]] Points blocks_in(std::span<const Wedge> pieces, const Points& polygon) const;

  visibility::PinholeCamera camera_;
  const Receivers* receivers_;
  WedgeTests tests_;
};

}  // namespace penumbra::volumes
