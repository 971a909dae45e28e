// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

/// Casters that may meet the disks of a sphere that view samples see, in columns for vector code.
namespace penumbra::vectors {

struct DiskPlane;
struct GridSample;
struct LightGrid;

/// A caster that may meet the disk of a sphere that a view sample sees.
struct NearCaster {
  std::array<glm::dvec3, 3> corners{};  ///< scaled, lexicographically sorted
  glm::dvec3 middle{0};
  double radius = 0;  ///< largest distance of a corner from the middle
  std::uint32_t triangle = 0, plane = 0;
};

/// Bounding spheres of some of a light's casters: columns padded for whole vectors.
struct NearSpheres {
  enum Field : std::size_t { kMiddle, kRadius = kMiddle + 3, kNumber, kFields };  // kNumber: index into NearCasters

  std::array<std::vector<double>, kFields> columns;
  std::size_t count = 0;

  /// Reserves space for `casters` casters; the content may be lost.
  void make_room(std::size_t casters);
};

/// All casters near a light, in rows of numbers: x, y, z of each corner, and its plane's index.
struct NearCasters {
  static constexpr std::size_t kPlane = 9, kRow = 10;

  std::vector<double> rows;
  std::vector<std::uint32_t> triangle;
  NearSpheres spheres;
};
NearCasters side_by_side(std::span<const NearCaster> casters);

/// Finds the casters in `among` that may meet the disks of any of the view samples.
void find_near_disks(const LightGrid& grid, std::span<const GridSample> samples, const NearSpheres& among,
                     NearSpheres& out);
/// Returns whether one of the casters may meet a disk.
bool any_may_meet(const DiskPlane& plane, const NearSpheres& casters, double slab, double around);

}  // namespace penumbra::vectors
