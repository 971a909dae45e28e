// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>

namespace penumbra::visibility {

/// Answer for rays that start anywhere in a box: of each of them, or unknown.
enum class FloatMeeting : std::uint8_t { no, maybe, surely };

/// Share of a sum's terms below which a sign counts as undecided. Methods that decide a pair in float32 are off by some
/// 2⁻²² of the terms (a ray of Embree: three differences, six products, their sums), so that they, too, meet what
/// surely blocks. (ray_certainly_meets, in certain_meeting.hpp, decides all that double can.)
inline constexpr double kFloatDoubt = 0x1p-18;
/// Share of a box's distance by which a ray may pass beside the box and still be asked about its triangles: four times
/// what float32 rays are off at that distance, 2⁻²².
inline constexpr double kFloatBeside = 0x1p-20;

/// Returns x × y with all terms added, none subtracted: the size of the terms, for x and y of absolute values.
glm::dvec3 wide_cross(const glm::dvec3& x, const glm::dvec3& y);

/// Points at which rays start: a box by its middle and half its sides, 0 for a single point.
struct RayStarts {
  glm::dvec3 middle, half;
  /// Added to a corner's distance along each axis. The point that methods have may be off by a unit in the last place,
  /// 2⁻²³ of its largest coordinate; kFloatDoubt of this is four times as much.
  double room;

  explicit RayStarts(const glm::vec3& point) : RayStarts(point, point) {}
  RayStarts(const glm::vec3& lower, const glm::vec3& upper);
};

/// Returns whether the ray from each of the starting points along `direction` meets the triangle, for methods that
/// compute in float32 as well.
FloatMeeting float_rays_meet(const RayStarts& starts, const glm::dvec3& direction,
                             const std::array<glm::vec3, 3>& corners);

}  // namespace penumbra::visibility
