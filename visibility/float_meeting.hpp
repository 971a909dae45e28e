// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>

namespace penumbra::visibility {

/// Common answer for all rays that start in a box; `maybe`: unknown.
enum class FloatMeeting : std::uint8_t { no, maybe, surely };

/// A sum smaller than this share of its terms has an undecided sign. Methods that decide a pair in float32 are off by
/// about 2⁻²² of the terms (a ray of Embree: three differences, six products, their sums), so they, too, meet a
/// triangle for which the answer is `surely`. (ray_certainly_meets, in certain_meeting.hpp, decides all that double
/// can.)
inline constexpr double kFloatDoubt = 0x1p-18;
/// Share of its distance by which a box is enlarged before a ray is tested against it: four times the error of float32
/// rays at that distance, 2⁻²².
inline constexpr double kFloatBeside = 0x1p-20;

/// Returns x × y with all terms added, none subtracted: the size of the terms, for x and y of absolute values.
glm::dvec3 wide_cross(const glm::dvec3& x, const glm::dvec3& y);

/// Points at which rays start: a box, given by its middle and half its sides; these are 0 for a single point.
struct RayStarts {
  glm::dvec3 middle, half;
  /// Added to a corner's distance along each axis, because the point that a method uses may differ by a unit in the
  /// last place, 2⁻²³ of its largest coordinate: kFloatDoubt · room is four times that.
  double room;

  explicit RayStarts(const glm::vec3& point) : RayStarts(point, point) {}
  RayStarts(const glm::vec3& lower, const glm::vec3& upper);
};

/// Returns whether the rays from all starting points along `direction` meet the triangle. The answer also holds for
/// methods that compute in float32.
FloatMeeting float_rays_meet(const RayStarts& starts, const glm::dvec3& direction,
                             const std::array<glm::vec3, 3>& corners);

}  // namespace penumbra::visibility
