#pragma once

#include "base/error.hpp"
#include "scenes/light_kind.hpp"
#include "visibility/bounds.hpp"
#include "visibility/light_texture.hpp"

#include <fmt/format.h>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace penumbra::visibility {

// What is true of each kind of light is in scenes/light_kind.hpp.
using scenes::is_body;
using scenes::is_circle;
using scenes::is_dome;
using scenes::is_parallelogram;
using scenes::is_planar;
using scenes::is_polygon;
using scenes::is_round;
using scenes::kBodies;
using scenes::kDomes;
using scenes::kEveryLight;
using scenes::kParallelograms;
using scenes::kPlanarLights;
using scenes::kPolygons;
using scenes::LightKind;
using scenes::LightKinds;
using scenes::name_of;

enum class SamplePattern { rows, grid, sobol, jittered, rgss };
const char* name_of(SamplePattern pattern);

/// How many light samples, and where. `rows` × `columns` is set only by LxB on the command line.
struct SampleRequest {
  std::uint32_t count = 256;            ///< 1 … 4096
  std::uint32_t rows = 0, columns = 0;  ///< both 0: chosen by the pattern
  SamplePattern pattern = SamplePattern::rows;
  std::uint32_t seed = 0;  ///< of sobol and jittered
};

/// A light in scene floats (float32 of world − origin), with its light samples in their fixed order: the same points
/// for every method and every oracle.
struct Light {
  std::string name;
  std::int32_t index = 0;  ///< in Scene::lights
  /// Of a light in pieces (scenes::Pieces), which this is. Each piece is a Light of its own, with the name, index, and
  /// so the body, of all. docs/definitions.md says what their V is together.
  std::uint32_t piece = 0;
  LightKind kind = LightKind::rectangle;
  bool two_sided = false;
  glm::dvec3 radiance{0};  ///< of a sun of one direction: irradiance / π
  double area = 0;  ///< |L| in world units, double (a sphere's: that of the disk of its radius; a sun's: at distance 1)

  /// The stored frame: three points that span the light's plane and say where it emits: (u − c) × (v − c) points to
  /// the emitting side. rectangle, ellipse: centre, centre + halfU, centre + halfV; disk: centre and two points of its
  /// rim; polygon: its first three vertices that span its plane beyond rounding. (sphere: centre and radius only. sun:
  /// see `sun`.)
  glm::vec3 center{0}, center_u{0}, center_v{0};
  std::vector<glm::vec3> outline;  ///< stored corners that bound a planar light: rectangle 4, polygon all, disk a
                                   ///< circumscribed square's 4, ellipse a circumscribed parallelogram's 4;
                                   ///< conservative hull of light and samples
  double radius = 0;               ///< disk, sphere

  /// A sun is no place but directions: `center`, the unit vector toward its middle, and `points`, which are not of unit
  /// length: middle + tangent · (s axis_u + t axis_v) over the unit disk, each rounded once. A pair's way is the ray p
  /// + t · d, t > 0.
  struct Directions {
    glm::vec3 axis_u{0}, axis_v{0};  ///< unit, at right angles; u × v is the way light travels
    double tangent = 0;              ///< tan(angle / 2); 0: one direction
  };
  std::optional<Directions> sun = {};

  /// A dome: `sun` says that its points are directions, here unit vectors rounded once. No plane has a picture of it;
  /// each face of a cube has, as light_faces (dome_faces.hpp) makes them: square, s and t in [−1, 1], or of a
  /// side of half a dome what has t ≥ 0. Edges are straight on them.
  struct Dome {
    std::array<glm::vec3, 3> axes{};  ///< stored; faces look along ± these, the third is `up`. Faces share corners: all
                                      ///< around is covered once, without gaps
    bool half = false;       ///< only what is above the first two axes' plane
    bool even = true;        ///< one radiance everywhere
    double power = 1;        ///< of radiance 1, 1/π ∫ luminance dω: that of all samples, which have equal shares
    std::int32_t face = -1;  ///< −1: all of it
    std::array<std::uint32_t, 7> first{};  ///< of all of it: face i has the samples from first[i] to first[i + 1]
  };
  std::optional<Dome> dome = {};

  /// Of a spot lamp: what spot_share makes of the cosine between this direction and the way to p.
  struct Spot {
    glm::dvec3 direction{0, -1, 0};
    double scale = 1, offset = 0;
    bool smooth = false;
  };
  std::optional<Spot> spot = {};

  /// A pyramid of directions from `center`, x · a + y · b + w with x and y from `lower` to `upper`.
  struct Beam {
    glm::dvec3 a, b, w;  ///< unit, at right angles
    glm::dvec2 lower, upper;
  };
  /// Of a disk that stands for a sphere (maps/host/lamp_disks.hpp): where the receivers are that maps are made for.
  std::optional<Beam> beam = {};

  SamplePattern pattern = SamplePattern::rows;
  std::uint32_t rows = 0, columns = 0;  ///< rows and grid: sample j = row · columns + column; else rows = 0
  std::vector<double> row_shift;        ///< rows pattern: each row's shift in cells, in (−0.5, 0.5); else empty
  std::vector<glm::vec3> points;        ///< the light samples as stored in float32 (a sphere's: empty)
  std::vector<glm::dvec2> coordinates;  ///< the same samples before rounding, in [−1, 1]² along (u − c, v − c)
                                        ///< (rectangle); a disk's, an ellipse's and a sphere's: on the unit disk;
                                        ///< a polygon's: over its bounding rectangle; a dome's: on their faces

  std::optional<LightTexture> texture = {};  ///< of a rectangle; none: the radiance is constant
  std::vector<double> weights;           ///< with a texture, of each light sample: V = Σ weight · visible; they add
                                         ///< up to exactly 1 (sample_weights). Else empty: each is 1 / N
  std::vector<glm::vec3> sample_colors;  ///< with a texture, of each light sample: its texel's colour; of a dome with a
                                         ///< picture, its texel's over that one's luminance. Else empty

  /// For each object of the scene, 1: it casts no shadow of this light. Empty: none such. Methods need not look: the
  /// host gives them a scene in which these cast none (cast_for).
  std::vector<std::uint8_t> unshaded_by = {};
  /// An object with holes, or translucent, that casts shadow of this light; empty: there is none. Its part of the
  /// shadow is the host's business, light sample by light sample (visibility/alpha/).
  std::string filtered_by = {};
  /// A translucent one of these (alphaMode BLEND); empty: there is none. All that is left to the host by methods that
  /// draw surfaces with holes themselves (MethodDescription::draws_holes).
  std::string dimmed_by = {};
  /// For each object, 1: this light does not light it, V = 0. Empty: none such. The host's business, too.
  std::vector<std::uint8_t> unlit = {};

  [[nodiscard]] std::uint32_t sample_count() const { return static_cast<std::uint32_t>(coordinates.size()); }
  [[nodiscard]] std::uint32_t words_per_mask() const { return (sample_count() + 31) / 32; }
};

/// The way from p to one of its light points; of a sun, whose points are directions, that itself. Not rounded where
/// double holds the difference.
glm::dvec3 way_to(const Light& light, const glm::vec3& p, const glm::vec3& l);

/// How bright a spot lamp's cone is at p, whose normal is n, in [0, 1], by the formula that KHR_lights_punctual
/// recommends: c the cosine of the angle at the lamp's centre between its direction and p, t = clamp((c − cos outer) /
/// max(0.001, cos inner − cos outer)), t². Of a smooth cone, as Cycles has it: the lamp is a disk of its radius that
/// faces p, each point of which shines by c t² (3 − 2t), c from there; what p gets, divided by what it would get if all
/// the light came from the centre at full strength. 1 of what has no cone. It multiplies radiance; V knows nothing of
/// it.
double spot_share(const Light& light, const glm::vec3& p, const glm::vec3& n);

/// Bounds all light points of all view samples.
Bounds point_bounds(const Light& light);

/// The unit-square samples of a pattern, in [0, 1)², in the order of every method (row-major for rows and grid: x along
/// the row). rows: L = round(√N) rows of B = ceil(N / L) points, cell-centred, each row shifted along itself by its own
/// fixed fraction of a cell. grid: the same without shifts. sobol: Owen-scrambled. jittered: one point in each of N
/// strata of equal area, in L = round(√N) rows.
std::vector<glm::dvec2> unit_square_samples(const SampleRequest& request);

/// Throws InputError unless the light is of one of these kinds: `light "lamp" is a sun`, and what `why` says, which
/// begins with a colon, a comma or the like.
template <typename... Values>
void require_kind(const Light& light, LightKinds kinds, fmt::format_string<Values...> why, Values&&... values) {
  if (kinds.contains(light.kind)) return;
  throw InputError("light \"{}\" is a {}{}", light.name, name_of(light.kind),
                   fmt::format(why, std::forward<Values>(values)...));
}

/// Throws InputError for a light of zero area, one whose points are not finite in float32 relative to `origin`, one
/// whose samples all lie on black texels, or one in pieces.
/// If rows or grid rounded the count, `notes` (when given) gets a line that says so.
Light make_light(const scenes::Scene& scene, std::uint32_t light, const glm::dvec3& origin,
                 const SampleRequest& request, std::vector<std::string>* notes = nullptr);

/// The same for a light that may be in pieces: each piece, with the light samples that were asked for; of any other
/// light that itself. Pieces without an area in float32 relative to `origin` are left out, unless all are.
std::vector<Light> make_light_pieces(const scenes::Scene& scene, std::uint32_t light, const glm::dvec3& origin,
                                     const SampleRequest& request, std::vector<std::string>* notes = nullptr);

/// The point that stands for the whole light: its stored centre; of a polygon, its centroid rounded to float32.
glm::vec3 center_of(const Light& light);

/// The frame that a light is stored with, in double: its plane's points are center + s·u + t·v. A rectangle is
/// s, t ∈ [−1, 1], a disk or ellipse the unit disk. u and v are differences of stored points, rounded once; u × v
/// points to the emitting side. What else describes a light's plane is made from this: DeviceLight (a rectangle around
/// the samples in the floats of device passes), maps::LightBasis (orthonormal), vectors::LightGrid (in cells of light
/// samples), volumes::gpu::WedgePush (the duals of u and v). Only areas::IntegerFrame takes the stored points
/// themselves, since it is exact.
struct LightFrame {
  glm::dvec3 center{0}, u{0}, v{0};
};
/// As stored. Not for spheres, which have no stored axes. Of a sun, directions: center is the middle's.
LightFrame light_frame(const Light& light);
/// As p sees the light: a planar one as stored; of a sphere the disk that the circle bounds along which lines from p
/// touch it, u × v toward p. With c and r the sphere's centre and radius, in double, each operation rounded to nearest
/// and in this order:
///
///   q = p − c;  d = √((q.x q.x + q.y q.y) + q.z q.z);  centre = c + (r / d) (r / d) q
///   ρ = r √(max(0, (d − r) (d + r))) / d;  u = ρ a, v = ρ b,  a, b the axes around q / d (Duff et al. 2017)
///
/// Of a p that the sphere contains (in_front_of_light is false) there is no such circle: a point, the sphere's centre.
LightFrame light_frame_from(const Light& light, const glm::vec3& p);

/// The light points of one view sample: `light.points`, or for a sphere those on its disk that p sees: each coordinate
/// of (centre + s u) + t v, computed in double, rounded to float32 once. Writes sample_count() points to `out`.
void light_points_for(const Light& light, const glm::vec3& p, glm::vec3* out);

}  // namespace penumbra::visibility
