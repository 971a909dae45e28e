// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec2.hpp>

#include <array>
#include <cstddef>
#include <span>

namespace penumbra::visibility {

/// Boundary of the intersection of a convex polygon with the unit disk: straight pieces, and arcs of the rim between
/// them.
///
/// Each edge is handled separately: its part inside stays, its part outside is projected radially onto the rim, as the
/// angle that it subtends at the centre. So only the inside part of an edge has to be decided, and where that is
/// ill-conditioned (an edge along a tangent, an end on the rim, a corner at the centre) chord and arc differ by less
/// than the uncertainty: the point where an edge leaves the disk may be off by δ, and the area then by at most δ². An
/// outside edge subtends less than π, so the sum of angles is ±2π for a polygon around the disk, and 0 for one outside
/// of it.
class DiskPart {
 public:
  static constexpr std::size_t kMostCorners = 12;

  /// From `from` straight to `to`, then along the rim by `arc` (radians, counter-clockwise) to the start of the next
  /// piece.
  struct Piece {
    glm::dvec2 from{0}, to{0};
    double arc = 0;
  };

  /// Takes up to kMostCorners corners; the signs of all arcs and of the area follow their orientation.
  explicit DiskPart(std::span<const glm::dvec2> corners);

  /// Returns the pieces, in order and closed. Empty: nothing is inside. A single piece without length and with an arc
  /// of ±2π: the whole disk is inside.
  [[nodiscard]] std::span<const Piece> pieces() const& { return std::span(pieces_).first(count_); }
  std::span<const Piece> pieces() const&& = delete;  ///< deleted for temporaries: a range-for over the pieces would
                                                     ///< outlive them
  /// Returns the area, with an error below 16 · 2⁻⁵³ for each corner: each edge has three terms, sums of a few
  /// roundings of numbers up to 2.
  [[nodiscard]] double area() const;

 private:
  void add_edge(const glm::dvec2& a, const glm::dvec2& b);
  void add_arc(double angle);

  std::array<Piece, kMostCorners> pieces_{};
  std::size_t count_ = 0;
  double before_ = 0;  // arc along the rim before the first piece
};

}  // namespace penumbra::visibility
