#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

/// Casters that may meet the disks that view samples see of a sphere, side by side.
namespace penumbra::vectors {

struct DiskPlane;
struct GridSample;
struct LightGrid;

/// A caster that may meet the disk that a view sample sees of a sphere.
struct NearCaster {
  std::array<glm::dvec3, 3> corners{};  ///< scaled, lexicographically sorted
  glm::dvec3 middle{0};
  double radius = 0;  ///< no corner is farther from the middle
  std::uint32_t triangle = 0, plane = 0;
};

/// Spheres around some of a light's casters: columns that end with room for a vector.
struct NearSpheres {
  enum Field : std::size_t { kMiddle, kRadius = kMiddle + 3, kNumber, kFields };  // number: of NearCasters

  std::array<std::vector<double>, kFields> columns;
  std::size_t count = 0;

  /// Room for so many; what is there may be lost.
  void make_room(std::size_t casters);
};

/// All of a light's, in rows of numbers: x, y, z of each corner, and its plane's number.
struct NearCasters {
  static constexpr std::size_t kPlane = 9, kRow = 10;

  std::vector<double> rows;
  std::vector<std::uint32_t> triangle;
  NearSpheres spheres;
};
NearCasters side_by_side(std::span<const NearCaster> casters);

/// Of some casters those that may meet the disks of any of some view samples.
void find_near_disks(const LightGrid& grid, std::span<const GridSample> samples, const NearSpheres& among,
                     NearSpheres& out);
/// Whether one of them may meet a disk.
bool any_may_meet(const DiskPlane& plane, const NearSpheres& casters, double slab, double around);

}  // namespace penumbra::vectors
