// SPDX-License-Identifier: Apache-2.0
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
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace penumbra::visibility {

class Sky;

// Properties of the kinds of light are defined in scenes/light_kind.hpp.
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

/// Number and pattern of light samples. `rows` × `columns` is set only by LxB on the command line.
struct SampleRequest {
  std::uint32_t count = 256;            ///< 1 … 4096
  std::uint32_t rows = 0, columns = 0;  ///< both 0: chosen by the pattern
  SamplePattern pattern = SamplePattern::rows;
  std::uint32_t seed = 0;  ///< seed of the patterns sobol and jittered
};

/// A light in scene floats (float32 of world − origin), with its light samples in their fixed order: the same points
/// for every method and every oracle.
struct Light {
  std::string name;
  std::int32_t index = 0;  ///< index in Scene::lights
  /// Index of this piece in a light in pieces (scenes::Pieces). Each piece is a Light with the name, index, and so the
  /// body, of the whole. docs/definitions.md defines their common V.
  std::uint32_t piece = 0;
  LightKind kind = LightKind::rectangle;
  bool two_sided = false;
  glm::dvec3 radiance{0};  ///< for a sun of one direction: irradiance / π
  double area = 0;         ///< |L| in world units, double (sphere: area of the disk of its radius; sun: at distance 1)

  /// The stored frame: three points that span the light's plane and define its emitting side: (u − c) × (v − c) points
  /// to it. rectangle, ellipse: centre, centre + halfU, centre + halfV; disk: centre and two points of its rim;
  /// polygon: its first three vertices that span its plane beyond rounding. (sphere: centre and radius only. sun: see
  /// `sun`.)
  glm::vec3 center{0}, center_u{0}, center_v{0};
  std::vector<glm::vec3> outline;  ///< stored corners that bound a planar light: rectangle 4, polygon all, disk a
                                   ///< circumscribed square's 4, ellipse a circumscribed parallelogram's 4;
                                   ///< conservative hull of light and samples
  double radius = 0;               ///< disk, sphere

  /// A sun consists of directions, not of points: `center` is the unit vector toward its middle, and `points` are not
  /// of unit length: middle + tangent · (s axis_u + t axis_v) over the unit disk, each rounded once. A pair's segment
  /// is the ray p + t · d, t > 0.
  struct Directions {
    glm::vec3 axis_u{0}, axis_v{0};  ///< unit, orthogonal; u × v is the direction in which light travels
    double tangent = 0;              ///< tan(angle / 2); 0: a single direction
  };
  std::optional<Directions> sun = {};

  /// A dome: `sun` is set, since its points are directions, here unit vectors rounded once. No single plane shows a
  /// whole dome, but each face of a cube shows a part of it, as made by light_faces (dome_faces.hpp): a square, s and t
  /// in [−1, 1], or for a side face of half a dome the part t ≥ 0. Edges are straight on the faces.
  struct Dome {
    std::array<glm::vec3, 3> axes{};  ///< stored; faces look along ± these, the third is `up`. Faces share corners: all
                                      ///< directions are covered once, without gaps
    bool half = false;                    ///< only the part above the plane of the first two axes
    std::shared_ptr<const Sky> sky = {};  ///< the picture, shared with copies and faces of this light; null: constant
                                          ///< radiance
    double power = 1;        ///< for radiance 1, 1/π ∫ luminance dω; all samples have equal parts of it
    std::int32_t face = -1;  ///< −1: the whole dome
    std::array<std::uint32_t, 7> first{};  ///< for the whole dome: face i has the samples from first[i] to first[i + 1]
  };
  std::optional<Dome> dome = {};

  /// Cone of a spot lamp: parameters of spot_share, as a function of the cosine between this direction and the
  /// direction to p.
  struct Spot {
    glm::dvec3 direction{0, -1, 0};
    double scale = 1, offset = 0;
    bool smooth = false;
  };
  std::optional<Spot> spot = {};

  /// A pyramid of directions from `center`, x · a + y · b + w with x and y from `lower` to `upper`.
  struct Beam {
    glm::dvec3 a, b, w;  ///< unit, orthogonal
    glm::dvec2 lower, upper;
  };
  /// For a disk that replaces a sphere (maps/host/lamp_disks.hpp): region of the receivers that maps are made for.
  std::optional<Beam> beam = {};

  SamplePattern pattern = SamplePattern::rows;
  std::uint32_t rows = 0, columns = 0;  ///< rows and grid: sample j = row · columns + column; else rows = 0
  std::vector<double> row_shift;        ///< rows pattern: each row's shift in cells, in (−0.5, 0.5); else empty
  std::vector<glm::vec3> points;        ///< the light samples as stored in float32 (a sphere's: empty)
  std::vector<glm::dvec2> coordinates;  ///< the same samples before rounding, in [−1, 1]² along (u − c, v − c)
                                        ///< (rectangle); disk, ellipse and sphere: on the unit disk; polygon: over its
                                        ///< bounding rectangle; dome: on its faces

  std::optional<LightTexture> texture = {};  ///< for a rectangle; nullopt: the radiance is constant
  std::vector<double> weights;  ///< with a texture, for each light sample: V = Σ weight · visible; the weights
                                ///< add up to exactly 1 (sample_weights). Else empty: each is 1 / N
  std::vector<glm::vec3> sample_colors;  ///< with a texture, for each light sample, its texel's colour; for a dome with
                                         ///< a picture, its texel's colour over its luminance. Else empty

  /// For each object of the scene, 1: it casts no shadow of this light. Empty: there is no such object. Methods can
  /// ignore this: the host gives them a scene in which these objects do not cast shadows (cast_for).
  std::vector<std::uint8_t> unshaded_by = {};
  /// Name of an object with holes, or a translucent one, that casts a shadow of this light; empty: there is none. The
  /// host computes this part of the shadow, for each light sample (visibility/alpha/).
  std::string filtered_by = {};
  /// Name of a translucent object among these (alphaMode BLEND); empty: there is none. For methods that draw surfaces
  /// with holes themselves (MethodDescription::draws_holes), the host computes only this part.
  std::string dimmed_by = {};
  /// For each object, 1: this light does not light it, V = 0. Empty: there is no such object. Handled by the host.
  std::vector<std::uint8_t> unlit = {};

  [[nodiscard]] std::uint32_t sample_count() const { return static_cast<std::uint32_t>(coordinates.size()); }
  [[nodiscard]] std::uint32_t words_per_mask() const { return (sample_count() + 31) / 32; }
};

/// Returns the vector from p to one of its light points; for a sun, whose points are directions, the direction itself.
/// Not rounded if double represents the difference.
glm::dvec3 direction_to(const Light& light, const glm::vec3& p, const glm::vec3& l);

/// Returns the brightness in [0, 1] of a spot lamp's cone at p, whose normal is n, by the formula that
/// KHR_lights_punctual recommends: with c the cosine of the angle at the lamp's centre between its direction and p, t =
/// clamp((c − cos outer) / max(0.001, cos inner − cos outer)), the result is t². For a smooth cone, as in Cycles: the
/// lamp is a disk of its radius that faces p, each point of which emits in proportion to c t² (3 − 2t), c measured from
/// that point; the result is p's irradiance divided by that from the same light concentrated at the centre at full
/// strength. 1 without a cone. Multiplies radiance; V does not depend on it.
double spot_share(const Light& light, const glm::vec3& p, const glm::vec3& n);

/// Returns bounds of all light points of all view samples.
Bounds point_bounds(const Light& light);

/// Returns the unit-square samples of a pattern, in [0, 1)², in the order of every method (row-major for rows and grid:
/// x along the row). rows: L = round(√N) rows of B = ceil(N / L) points, cell-centred, each row shifted along itself by
/// a fixed fraction of a cell. grid: the same without shifts. sobol: Owen-scrambled. jittered: one point in each of N
/// strata of equal area, in L = round(√N) rows.
std::vector<glm::dvec2> unit_square_samples(const SampleRequest& request);

/// Throws InputError `light "lamp" is a sun`, followed by `why`, which begins with a colon, a comma or similar, unless
/// the light is of one of these kinds.
template <typename... Values>
void require_kind(const Light& light, LightKinds kinds, fmt::format_string<Values...> why, Values&&... values) {
  if (kinds.contains(light.kind)) return;
  throw InputError("light \"{}\" is a {}{}", light.name, name_of(light.kind),
                   fmt::format(why, std::forward<Values>(values)...));
}

/// Makes a light. Throws InputError for a light of zero area, one whose points are not finite in float32 relative to
/// `origin`, one whose samples all lie on black texels, or one in pieces. If rows or grid rounded the count, a line
/// about this is added to `notes` (if given).
Light make_light(const scenes::Scene& scene, std::uint32_t light, const glm::dvec3& origin,
                 const SampleRequest& request, std::vector<std::string>* notes = nullptr);

/// Makes the pieces of a light in pieces, each with the requested light samples; for any other light, that one light.
/// Pieces without an area in float32 relative to `origin` are left out, unless all are.
std::vector<Light> make_light_pieces(const scenes::Scene& scene, std::uint32_t light, const glm::dvec3& origin,
                                     const SampleRequest& request, std::vector<std::string>* notes = nullptr);

/// Returns the point that represents the whole light: its stored centre; for a polygon, its centroid rounded to
/// float32.
glm::vec3 center_of(const Light& light);

/// The frame that a light is stored with, in double: its plane's points are center + s·u + t·v. A rectangle is s, t ∈
/// [−1, 1], a disk or ellipse the unit disk. u and v are differences of stored points, rounded once; u × v points to
/// the emitting side. Other descriptions of a light's plane are made from this frame: DeviceLight (a rectangle around
/// the samples in the floats of device passes), maps::LightBasis (orthonormal), vectors::LightGrid (in cells of light
/// samples), volumes::gpu::WedgePush (the duals of u and v). Only areas::IntegerFrame uses the stored points
/// themselves, since it is exact.
struct LightFrame {
  glm::dvec3 center{0}, u{0}, v{0};
};
/// Returns the stored frame. Not for spheres, which have no stored axes. For a sun the vectors are directions, and
/// `center` is the middle one.
LightFrame light_frame(const Light& light);
/// Returns the light's frame as p sees it: for a planar light the stored frame; for a sphere the disk bounded by the
/// circle along which lines from p touch the sphere, u × v toward p. With c and r the sphere's centre and radius, in
/// double, each operation rounded to nearest and in this order:
///
///     q = p − c;  d = √((q.x q.x + q.y q.y) + q.z q.z);  centre = c + (r / d) (r / d) q
///     ρ = r √(max(0, (d − r) (d + r))) / d;  u = ρ a, v = ρ b,  a, b the axes around q / d (Duff et al. 2017)
///
/// For a p inside the sphere (in_front_of_light is false) there is no such circle: the result is a point, the sphere's
/// centre.
LightFrame light_frame_from(const Light& light, const glm::vec3& p);

/// Computes the light points for one view sample: `light.points`, or for a sphere those on the disk that p sees: each
/// coordinate of (centre + s u) + t v, computed in double, rounded to float32 once. Writes sample_count() points to
/// `out`.
void light_points_for(const Light& light, const glm::vec3& p, glm::vec3* out);

}  // namespace penumbra::visibility
