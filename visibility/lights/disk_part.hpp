#pragma once

#include <glm/vec2.hpp>

#include <array>
#include <cstddef>
#include <span>

namespace penumbra::visibility {

/// What of a convex polygon lies in the unit disk, as its boundary: straight pieces, and arcs of the rim between them.
///
/// Each edge is for itself: the part of it that is inside stays, what is outside is drawn radially onto the rim, as the
/// angle that it is seen at from the centre. So nothing is decided but how much of an edge is inside, and where that is
/// doubtful (an edge along a tangent, an end on the rim, a corner at the centre) chord and arc differ by less than the
/// doubt: where an edge leaves the disk may be off by δ, and the area then by δ² at most. An outside edge is seen at
/// less than π, so the sum of angles is ±2π around the disk, and 0 beside it.
class DiskPart {
 public:
  static constexpr std::size_t kMostCorners = 12;

  /// From `from` straight to `to`, then along the rim by `arc` (radians, counter-clockwise) to where the next begins.
  struct Piece {
    glm::dvec2 from{0}, to{0};
    double arc = 0;
  };

  /// Up to kMostCorners of them; the signs of all arcs and of the area are those of the way that they run.
  explicit DiskPart(std::span<const glm::dvec2> corners);

  /// In order and closed. None: nothing is inside. One of no length with an arc of ±2π: the whole disk is.
  [[nodiscard]] std::span<const Piece> pieces() const& { return std::span(pieces_).first(count_); }
  std::span<const Piece> pieces() const&& = delete;  ///< of a temporary: a range-for over them would outlive it
  /// Off by less than 16 · 2⁻⁵³ a corner: each edge has three terms, sums of a few roundings of numbers up to 2.
  [[nodiscard]] double area() const;

 private:
  void add_edge(const glm::dvec2& a, const glm::dvec2& b);
  void add_arc(double angle);

  std::array<Piece, kMostCorners> pieces_{};
  std::size_t count_ = 0;
  double before_ = 0;  // along the rim up to the first piece
};

}  // namespace penumbra::visibility
