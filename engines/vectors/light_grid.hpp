// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engines/vectors/light_tiles.hpp"
#include "visibility/lights/device_light.hpp"

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

/// Shared by methods on the processor's own vector units: a light as seen from neighbouring view samples. Bounds are
/// derived in docs/edge-scatter.md; names are those of the device's passes (volumes/edges/device/edge_scatter.glsl).
/// Lengths are scene floats times visibility::device_scale.
namespace penumbra::vectors {

struct NearCasters;
struct NearSpheres;

constexpr float kRound = 0x1p-24F;  ///< half a unit in the last place of 1

/// A sphere or a sun as one view sample sees it: the directions to its light points are middle + s u + t v over the
/// unit disk, scaled; middle, u and v are orthogonal, u × v opposite to middle. For a sun, middle has unit length, and
/// a direction of any larger length stands for the same light point.
struct LightCone {
  glm::dvec3 middle{0}, u{0}, v{0};

  /// Returns the direction to the lower left corner of the square around the cone.
  [[nodiscard]] glm::dvec3 corner() const { return middle - u - v; }
};

/// The light, or a rectangle around it, as a grid of cells, for one of its two sides. A point x of its plane has the
/// grid coordinates (X, Y) = (across, along) · (x − center) + first_cell: if samples are in rows, these are column and
/// row of the light sample there, before the row's shift; else there are about as many cells as light samples, which
/// are in tiles. Made from a DeviceLight and the light's stored points. For a sphere or sun: a rectangle that contains
/// the projections of the light from a few view samples (cone_light.hpp), used only to find the casters that may affect
/// them.
struct LightGrid {
  glm::vec3 center{0}, axis{0}, axis_size{0}, across{0}, along{0};
  glm::vec2 half_cells{0}, first_cell{0};
  glm::dvec3 corner{0};              ///< origin of rows and columns, in the plane of the light's stored points
  double corner_off = 0;             ///< largest distance of `corner` from that plane
  float radius = 0;                  ///< distance of the farthest light sample from the centre
  std::array<glm::dvec3, 3> axes{};  ///< for a rectangle: across, along, axis in double, from its stored points
  float per_length = 0, skew = 1, deviation = 0, reach = 0, cut_reach = 0;
  float side = 1;
  std::uint32_t rows = 0, columns = 0, light = 0;  ///< cells; the light's index
  std::uint32_t padded_rows = 0;                   ///< rounded up to a multiple of 16
  std::uint32_t sample_count = 0;
  std::vector<float> shift;         ///< shift of each (padded) row, in cells
  std::vector<glm::vec3> points;    ///< the stored light samples, scaled; empty for a sphere or sun
  std::optional<LightTiles> tiles;  ///< if samples are not in rows
  /// Cells, relative to the middle, that segments from the view samples to the light's corner pass through.
  struct Range {
    glm::vec2 low{0}, high{0};
  };
  Range corners{};
  /// Additional data for a sphere or sun.
  struct Cones {
    std::span<const LightCone> of;  ///< cone of each view sample (GridSample::cone)
    bool end = false;               ///< true if segments end at the light, so that nothing behind it hides it; false
                                    ///< for a sun
    float deviation = 0;            ///< distance of a stored light point from its place, in units of LightCone::u
    float lowest_end = 0;           ///< casters above this height over the grid's plane are not behind the light
    double reach = 0;               ///< reach of scene and light, independent of the grid's rectangle
    /// Casters that may meet the disks of a few view samples, if the method cuts them there; else view samples that
    /// have such casters are left to exact predicates.
    const NearSpheres* near = nullptr;
    const NearCasters* casters = nullptr;  ///< all casters near the light
  };
  std::optional<Cones> cones = {};
};
struct LightGridInput {
  const visibility::DeviceLight& light;
  std::array<glm::dvec3, 3> plane;  ///< the light's stored points: centre, centre + halfU, centre + halfV, scaled
  bool is_rectangle;                ///< else `light` is a rectangle around it
  std::uint32_t rows, columns;      ///< rows and columns of light samples; 0: not in rows
  std::uint32_t light_index;
  float side, reach, cut_reach, scale;
  std::span<const glm::vec3> points;  ///< the light samples
  /// Replaces `plane`: a corner and whole sides in that plane, scaled, with a rounding error bounded by `skew`.
  struct Window {
    glm::dvec3 corner{0}, u{0}, v{0};
    double skew = 1;
  };
  std::optional<Window> window = {};
};
LightGrid make_light_grid(const LightGridInput& input);

/// A view sample on the grid's side of the light, in the grid's coordinates.
struct GridSample {
  glm::vec3 p{0};  ///< scaled
  std::uint32_t pixel = 0, plane = 0;
  std::uint32_t cone = 0;  ///< index into LightGrid::Cones::of
  float height = 0;        ///< over the light's plane
  glm::vec2 foot{0};
  /// Light samples with above · (s, t, 1) > above_error are above the carrier's plane; those with < −above_error are
  /// below it. (bound horizon)
  glm::vec3 above{0};
  float above_error = 0;
  bool straddles = false;  ///< true unless all of the light is certainly above the carrier's plane
};

/// Maps directions from p to places on the light: direction (x, y, w), w upward, to foot + height / w (x, y).
struct Placing {
  glm::vec2 foot{0};
  float height = 0;
  /// Coefficients of the error of a point at height w over p, `far_x` from the cluster's middle, whose place is F from
  /// the foot: (far_x + far) / w · (per_ray + per_reach F) + per_foot F + fixed. (bound X)
  float per_ray = 0, per_reach = 0, per_foot = 0, fixed = 0;
  /// An edge within (far_x + far) · per_lift of p's height may pass through p within rounding. (bound window)
  float per_lift = 0;
  float through_p = 0;  ///< likewise an edge whose clipped part is shorter than (far_x + far) times this
};
/// An end of an edge that is less than this distance below the light's plane may be the place where the edge was cut
/// there; for a group of view samples, whose heights are rounded once more, twice this distance. (bound cut)
inline float near_cut(const LightGrid& grid) {
  return 256 * kRound * grid.reach;
}
/// Rounding of an end that was cut, as a length added to far_x. (bound cut)
inline float cut_far(const LightGrid& grid) {
  return grid.cut_reach / 8;
}

/// A GridSample of a cluster that has casters: p relative to the cluster's middle, in world axes (`local`) and in the
/// grid's (`in_grid`: across, along, axis), and error bounds.
struct ClusterSample : GridSample {
  glm::vec3 local{0}, in_grid{0};
  float away = 0;  ///< upper bound of |p − the light's centre|
  float far = 0;   ///< upper bound of |local|
  Placing on_grid;
  glm::vec2 lean{0};   ///< direction to the light's corner, in the grid's cells for a unit of height
  float end = 0;       ///< height of the light's corner over p
  float per_lean = 0;  ///< error of a corner's place relative to that direction: (far_x + far) per_lean (bound corner)
  /// Placing on the light itself, which differs from the grid for a sphere or sun: there `turn` maps a direction in the
  /// grid's coordinates to one in the coordinates of the light as p sees it.
  Placing on_light;
  glm::mat3 turn{1};
  LightGrid::Range window{};  ///< the grid's cells through which p sees the light
  bool meets_end = false;     ///< true if some of LightGrid::Cones::near may meet the square around p's disk
};

/// The hull of view samples and a rectangle in the light's plane. (bound shaft)
struct Shaft {
  float lowest = 0, highest = 0;
  std::array<glm::vec3, 4> n{}, size{};  ///< |n|
  std::array<float, 4> beyond{};
};

/// View samples that share lists: their box, and the shafts to the light and to its lower left corner.
struct Cluster {
  static constexpr std::uint32_t kSeveral = 0xfffffffeU;  ///< not a plane's index

  glm::vec3 middle{0}, half_size{0};
  Shaft whole, corner;
  std::uint32_t plane = kSeveral;  ///< index of the plane of all their carriers, which hides no light sample; kSeveral
                                   ///< if they differ
};
Cluster make_cluster(const LightGrid& grid, std::span<const GridSample> samples);
ClusterSample complete(const LightGrid& grid, const Cluster& cluster, const GridSample& at);

/// The hull of some of a cluster's view samples and the light, in the grid's axes relative to the cluster's middle:
/// between two heights and within four planes ±across (or ±along) − slope · height ≤ beyond. (bound shaft)
struct Hull {
  std::array<float, 4> slope{}, beyond{};
  float lowest = 0, highest = 0;
};
Hull hull_of(const LightGrid& grid, const Cluster& cluster, std::span<const ClusterSample> samples);

}  // namespace penumbra::vectors
