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

/// Methods on the processor's own vector units: what they share. A light as seen from view samples that lie
/// together. Bounds are derived in docs/edge-scatter.md; names are those of the device's passes
/// (volumes/edges/device/edge_scatter.glsl). Lengths are scene floats times visibility::device_scale.
namespace penumbra::vectors {

struct NearCasters;
struct NearSpheres;

constexpr float kRound = 0x1p-24F;  ///< half a unit in the last place of 1

/// A sphere or a sun as one view sample sees it: the ways to its light points are middle + s u + t v over the unit
/// disk, scaled; middle, u and v are at right angles, u × v against middle. Of a sun middle is of unit length, and
/// every longer way is one to the same light point.
struct LightCone {
  glm::dvec3 middle{0}, u{0}, v{0};

  /// The way to the lower left corner of the square around it.
  [[nodiscard]] glm::dvec3 corner() const { return middle - u - v; }
};

/// The light, or a rectangle around it, as a grid of cells, for one of its two sides. A point x of its plane has the
/// grid coordinates (X, Y) = (across, along) · (x − center) + first_cell: where samples are in rows, column and row of
/// the light sample there, before the row's shift; else there are about as many cells as light samples, which are in
/// tiles. Made from a DeviceLight and the light's stored points. Of a sphere or sun: a rectangle that all of a few view
/// samples see it through (cone_light.hpp), which only says what may matter to them.
struct LightGrid {
  glm::vec3 center{0}, axis{0}, axis_size{0}, across{0}, along{0};
  glm::vec2 half_cells{0}, first_cell{0};
  glm::dvec3 corner{0};              ///< in the plane of the light's stored points: where rows and columns begin
  double corner_off = 0;             ///< how far it may be off that plane
  float radius = 0;                  ///< no light sample is farther from the centre
  std::array<glm::dvec3, 3> axes{};  ///< of a rectangle: across, along, axis in double, of its stored points
  float per_length = 0, skew = 1, deviation = 0, reach = 0, cut_reach = 0;
  float side = 1;
  std::uint32_t rows = 0, columns = 0, light = 0;  ///< cells; the light's number
  std::uint32_t padded_rows = 0;                   ///< to a multiple of 16
  std::uint32_t sample_count = 0;
  std::vector<float> shift;         ///< of each (padded) row, in cells
  std::vector<glm::vec3> points;    ///< the light samples as stored, scaled; of a sphere or sun none
  std::optional<LightTiles> tiles;  ///< where they form no rows
  /// What the view samples to the light's corner go through, in cells from the middle.
  struct Range {
    glm::vec2 low{0}, high{0};
  };
  Range corners{};
  /// Of a sphere or sun.
  struct Cones {
    std::span<const LightCone> of;  ///< view samples (GridSample::cone)
    bool end = false;               ///< at the light, so that what is behind it hides nothing: not a sun's
    float deviation = 0;            ///< a stored light point from its place, as LightCone::u
    float lowest_end = 0;           ///< nothing higher over the grid's plane is behind the light
    double reach = 0;               ///< of scene and light, whatever the grid's rectangle
    /// Casters that may meet the disks of a few view samples, if the method cuts them there; else a view sample that
    /// has such casters is left to exact predicates.
    const NearSpheres* near = nullptr;
    const NearCasters* casters = nullptr;  ///< all of the light's
  };
  std::optional<Cones> cones = {};
};
struct LightGridInput {
  const visibility::DeviceLight& light;
  std::array<glm::dvec3, 3> plane;  ///< the light's stored points: centre, centre + halfU, centre + halfV, scaled
  bool is_rectangle;                ///< else `light` is a rectangle around it
  std::uint32_t rows, columns;      ///< of light samples; 0: they form none
  std::uint32_t light_index;
  float side, reach, cut_reach, scale;
  std::span<const glm::vec3> points;  ///< light samples
  /// In place of `plane`: a corner and whole sides in that plane, scaled, off it by rounding that `skew` bounds.
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
  std::uint32_t cone = 0;  ///< LightGrid::Cones
  float height = 0;        ///< over the light's plane
  glm::vec2 foot{0};
  /// Light samples with above · (s, t, 1) > above_error are above the carrier's plane; < −above_error: below it.
  /// (bound horizon)
  glm::vec3 above{0};
  float above_error = 0;
  bool straddles = false;  ///< not all of the light is certainly above it
};

/// Where points appear on the light as p sees it: a way (x, y, w), w upward, at foot + height / w (x, y).
struct Placing {
  glm::vec2 foot{0};
  float height = 0;
  /// The error of a point at height w over p, `far_x` from the cluster's middle, that appears F from the foot:
  /// (far_x + far) / w · (per_way + per_reach F) + per_foot F + fixed. (bound X)
  float per_way = 0, per_reach = 0, per_foot = 0, fixed = 0;
  /// An edge within (far_x + far) · per_lift of p's height may pass through p within rounding. (bound window)
  float per_lift = 0;
  float through_p = 0;  ///< and one of which (far_x + far) times this is left does
};
/// An edge's end less than this below the light's plane may have been made by cutting the edge there; for a group of
/// view samples, whose heights are rounded once more, less than twice this. (bound cut)
inline float near_cut(const LightGrid& grid) {
  return 256 * kRound * grid.reach;
}
/// What the rounding of an end that was cut comes to, as lengths added to far_x. (bound cut)
inline float cut_far(const LightGrid& grid) {
  return grid.cut_reach / 8;
}

/// A GridSample of a cluster that has casters: p relative to the cluster's middle, in world axes (`local`) and in the
/// grid's (`in_grid`: across, along, axis), and error bounds.
struct ClusterSample : GridSample {
  glm::vec3 local{0}, in_grid{0};
  float away = 0;  ///< bounds |p − the light's centre|
  float far = 0;   ///< bounds |local|
  Placing on_grid;
  glm::vec2 lean{0};   ///< the way to the light's corner, in the grid's cells for a unit of height
  float end = 0;       ///< the height over p at which it ends
  float per_lean = 0;  ///< the error of a corner's place beside that way is (far_x + far) per_lean (bound corner)
  /// On the light, which of a sphere or sun is not the grid: there `turn` takes a way in the grid's coordinates to one
  /// in those of the light as p sees it.
  Placing on_light;
  glm::mat3 turn{1};
  LightGrid::Range window{};  ///< of the grid's cells, that p sees the light through
  bool meets_end = false;     ///< some of LightGrid::Cones::near may meet the square around its disk
};

/// The hull of view samples and a rectangle of the light's plane. (bound shaft)
struct Shaft {
  float lowest = 0, highest = 0;
  std::array<glm::vec3, 4> n{}, size{};  ///< |n|
  std::array<float, 4> beyond{};
};

/// View samples whose lists are found together: their box, and the shafts to the light and to its lower left corner.
struct Cluster {
  static constexpr std::uint32_t kSeveral = 0xfffffffeU;  ///< the number of no triangle

  glm::vec3 middle{0}, half_size{0};
  Shaft whole, corner;
  std::uint32_t plane = kSeveral;  ///< that all of their carriers are in: nothing in it hides a light sample
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
