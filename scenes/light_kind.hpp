// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/scene.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <variant>
#include <vector>

/// The kinds of light, and their properties. Code tests the property that it needs instead of the kind: a new kind is
/// then a new row here, and code that depends on properties need not change.
namespace penumbra::scenes {

/// Kinds of light, in the order of LightShape, and of lists in messages.
enum class LightKind : std::uint8_t { rectangle, disk, ellipse, polygon, sphere, sun, dome };

/// Location of a light's points.
enum class LightPlace : std::uint8_t {
  plane,       ///< points of one plane, the same for every view sample
  body,        ///< a solid body: each view sample sees a different disk of it, with different points
  directions,  ///< infinitely far away: directions, not points
};

/// Boundary of a light in the coordinates (s, t) of its frame.
enum class LightRegion : std::uint8_t {
  square,   ///< |s| <= 1 and |t| <= 1
  disk,     ///< s² + t² <= 1
  corners,  ///< a convex polygon with its own corners
  faces,    ///< directions all around: the square |s| <= 1 and |t| <= 1 of each face of a cube, or half of it
};

struct LightTraits {
  LightKind kind;
  const char* name;  ///< in messages, in JSON, and the key of its shape in scene files
  LightPlace place;
  LightRegion region;
  bool circular;  ///< u and v are orthogonal and equally long, so that LightRegion::disk is a circle in space
};

/// The table: one row for each kind.
inline constexpr std::array kLightTraits{
    LightTraits{LightKind::rectangle, "rectangle", LightPlace::plane, LightRegion::square, false},
    LightTraits{LightKind::disk, "disk", LightPlace::plane, LightRegion::disk, true},
    LightTraits{LightKind::ellipse, "ellipse", LightPlace::plane, LightRegion::disk, false},
    LightTraits{LightKind::polygon, "polygon", LightPlace::plane, LightRegion::corners, false},
    LightTraits{LightKind::sphere, "sphere", LightPlace::body, LightRegion::disk, true},
    LightTraits{LightKind::sun, "sun", LightPlace::directions, LightRegion::disk, true},
    LightTraits{LightKind::dome, "dome", LightPlace::directions, LightRegion::faces, false},
};

constexpr const LightTraits& traits_of(LightKind kind) {
  return kLightTraits[static_cast<std::size_t>(kind)];
}
constexpr const char* name_of(LightKind kind) {
  return traits_of(kind).name;
}

/// A set of kinds, such as those that a method supports. Listed in the order of the table.
class LightKinds {
 public:
  constexpr LightKinds() = default;
  constexpr LightKinds(std::initializer_list<LightKind> kinds) {
    for (const LightKind kind : kinds) bits_ |= bit(kind);
  }
  /// Returns the kinds for which `property` is true.
  template <typename Property>
  static constexpr LightKinds with(Property property) {
    LightKinds kinds;
    for (const LightTraits& row : kLightTraits) {
      if (property(row)) kinds.bits_ |= bit(row.kind);
    }
    return kinds;
  }

  [[nodiscard]] constexpr bool contains(LightKind kind) const { return (bits_ & bit(kind)) != 0; }
  [[nodiscard]] std::vector<LightKind> list() const {
    std::vector<LightKind> kinds;
    for (const LightTraits& row : kLightTraits) {
      if (contains(row.kind)) kinds.push_back(row.kind);
    }
    return kinds;
  }
  /// Returns "rectangle, disk, sun"; `last` replaces the last comma.
  [[nodiscard]] std::string words(const char* last = ", ") const {
    std::string text;
    const std::vector<LightKind> kinds = list();
    for (std::size_t i = 0; i < kinds.size(); ++i)
      text.append(i == 0 ? "" : i + 1 < kinds.size() ? ", " : last).append(name_of(kinds[i]));
    return text;
  }

  friend constexpr LightKinds operator|(LightKinds a, LightKinds b) { return LightKinds(a.bits_ | b.bits_); }
  friend constexpr LightKinds operator&(LightKinds a, LightKinds b) { return LightKinds(a.bits_ & b.bits_); }
  friend constexpr LightKinds operator-(LightKinds a, LightKinds b) { return LightKinds(a.bits_ & ~b.bits_); }
  friend constexpr bool operator==(LightKinds, LightKinds) = default;

 private:
  explicit constexpr LightKinds(std::uint32_t bits) : bits_(bits) {}
  static constexpr std::uint32_t bit(LightKind kind) { return std::uint32_t{1} << static_cast<std::uint32_t>(kind); }

  std::uint32_t bits_ = 0;
};

inline constexpr LightKinds kEveryLight = LightKinds::with([](const LightTraits& /*row*/) { return true; });
inline constexpr LightKinds kPlanarLights =
    LightKinds::with([](const LightTraits& row) { return row.place == LightPlace::plane; });
inline constexpr LightKinds kBodies =
    LightKinds::with([](const LightTraits& row) { return row.place == LightPlace::body; });
inline constexpr LightKinds kParallelograms =
    LightKinds::with([](const LightTraits& row) { return row.region == LightRegion::square; });
inline constexpr LightKinds kRoundLights =
    LightKinds::with([](const LightTraits& row) { return row.region == LightRegion::disk; });
inline constexpr LightKinds kPolygons =
    LightKinds::with([](const LightTraits& row) { return row.region == LightRegion::corners; });
inline constexpr LightKinds kDomes =
    LightKinds::with([](const LightTraits& row) { return row.region == LightRegion::faces; });
inline constexpr LightKinds kCircles = LightKinds::with([](const LightTraits& row) { return row.circular; });

/// Returns whether the light has a plane, spanned by stored points.
constexpr bool is_planar(LightKind kind) {
  return kPlanarLights.contains(kind);
}
/// Returns whether the light is a solid body, whose light points differ between view samples.
constexpr bool is_body(LightKind kind) {
  return kBodies.contains(kind);
}
/// Returns whether the light is the square [−1, 1]² of its frame.
constexpr bool is_parallelogram(LightKind kind) {
  return kParallelograms.contains(kind);
}
/// Returns whether the light is the unit disk of its frame. (A body: as each p sees it.)
constexpr bool is_round(LightKind kind) {
  return kRoundLights.contains(kind);
}
/// Returns whether the light is bounded by its own corners.
constexpr bool is_polygon(LightKind kind) {
  return kPolygons.contains(kind);
}
/// Returns whether the light is all around, so that no plane has a picture of it. A method handles one face of a cube
/// after the other.
constexpr bool is_dome(LightKind kind) {
  return kDomes.contains(kind);
}
/// Returns whether the light is round, and a circle in space.
constexpr bool is_circle(LightKind kind) {
  return kCircles.contains(kind);
}

static_assert(kLightTraits.size() + 1 == std::variant_size_v<LightShape>, "a row for each shape but Pieces");

/// Returns the kind of a shape; nullopt for one in pieces.
inline std::optional<LightKind> kind_of(const LightShape& shape) {
  if (shape.index() >= kLightTraits.size()) return std::nullopt;
  return static_cast<LightKind>(shape.index());
}
/// Returns the kind of a shape; for a light in pieces the kinds of all pieces.
inline LightKinds kinds_of(const LightShape& shape) {
  if (const std::optional<LightKind> kind = kind_of(shape)) return {*kind};
  LightKinds kinds;
  for (const Pieces::Piece& piece : std::get<Pieces>(shape).pieces) {
    kinds = kinds | kinds_of(std::visit([](const auto& its) { return LightShape(its); }, piece));
  }
  return kinds;
}

}  // namespace penumbra::scenes
