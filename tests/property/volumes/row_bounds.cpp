// How much of its bounds rows=exact ever uses of where an edge's ends appear: searches for the input that uses most,
// held against exact places (rational numbers).

#include "engines/vectors/cone_light.hpp"
#include "engines/vectors/near_casters.hpp"
#include "tests/agreement/most_used.hpp"
#include "tests/property/volumes/under_a_light.hpp"
#include "volumes/edges/light_window.hpp"
#include "volumes/scatter/vectors/rows.hpp"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/vec3.hpp>
#include <gmpxx.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <numbers>
#include <optional>
#include <random>

namespace penumbra::volumes {
namespace {

using Rational = std::array<mpq_class, 3>;

Rational rational(const glm::dvec3& x) {
  return {mpq_class(x.x), mpq_class(x.y), mpq_class(x.z)};
}
Rational operator-(const Rational& a, const Rational& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
mpq_class dot(const Rational& a, const Rational& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
Rational cross(const Rational& a, const Rational& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

mpq_class determinant(const Rational& a, const Rational& b, const Rational& c) {
  return dot(a, cross(b, c));
}

/// A parallelogram light's plane, its corner and cells, without rounding.
class ExactLight {
 public:
  explicit ExactLight(const tests::UnderALight& under) : cells_(under.grid.columns) {
    const Rational center = rational(under.scaled(under.light.center)),
                   u = rational(under.scaled(under.light.center_u)) - center,
                   v = rational(under.scaled(under.light.center_v)) - center;
    corner_ = center - u - v;
    normal_ = cross(u, v);
    across_ = cross(v, normal_);
    along_ = cross(normal_, u);
    squared_ = 2 * dot(normal_, normal_);
  }

  /// Where x appears to p, in cells from the corner; nothing if it is not above p and below the light.
  [[nodiscard]] std::optional<std::array<mpq_class, 2>> operator()(const glm::dvec3& p, const glm::dvec3& x) const {
    const Rational from = rational(p) - corner_, way = rational(x) - rational(p);
    const mpq_class height = dot(normal_, from), over = -dot(normal_, way);
    if (sgn(over) * sgn(height) <= 0 || abs(over) > abs(height)) return std::nullopt;
    const mpq_class t = height / over;
    Rational at = from;
    for (std::size_t i = 0; i < 3; ++i) at[i] += t * way[i];
    return std::array<mpq_class, 2>{cells_ * dot(across_, at) / squared_, cells_ * dot(along_, at) / squared_};
  }

 private:
  mpq_class cells_, squared_;
  Rational corner_, normal_, across_, along_;
};

struct Use {
  double of_bound = 0, error = 0, bound = 0;
};

/// What a search varies: a scene of a floor and a light, p on the floor, and an edge over p.
struct Case {
  scenes::Scene scene;
  glm::vec3 p{0};
  std::array<glm::vec3, 2> edge{};
};

/// An edge of one triangle, which p is well in front of, in another plane than its own.
WideEdges in_front_of(const glm::vec3& p, const std::array<glm::vec3, 2>& edge, std::uint32_t plane) {
  WideEdges leaf{};
  const glm::vec3 n = p - edge[0];
  for (std::size_t i = 0; i < 3; ++i) {
    const auto axis = static_cast<glm::length_t>(i);
    leaf.a[i][0] = leaf.anchor[0][i][0] = edge[0][axis];
    leaf.b[i][0] = edge[1][axis];
    leaf.n[0][i][0] = n[axis];
  }
  leaf.plane[0][0] = leaf.plane[1][0] = plane;
  return leaf;
}

/// |place as computed − place| over its bound, the worse of two ends and two axes. (docs/edge-scatter.md, "What double
/// proves": foot, segment, place)
Use use_of(const Case& of) {
  tests::UnderALight under(of.scene, 16);
  const auto placed = under.place({of.p});
  if (!placed) return {};
  const LightRegion region = make_light_region(under.light, window_of(under.light), under.grid, under.scale);
  RowSum rows(under.grid, region, under.floats, under.scale);
  rows.set_view_sample(placed->front());
  const glm::vec3 a = of.edge[0] * under.scale, b = of.edge[1] * under.scale, p = placed->front().p;
  const std::optional<RowSum::Placed> found = rows.place(in_front_of(p, {a, b}, under.floats.plane[1]), 0, nullptr);
  if (!found || found->error >= 0.5) return {};
  const ExactLight exact(under);
  const std::array<glm::dvec2, 2> computed{glm::dvec2(found->edge.x0, found->edge.y0),
                                           glm::dvec2(found->edge.x1, found->edge.y1)};
  Use worst;
  for (std::size_t end = 0; end < 2; ++end) {
    const auto place = exact(glm::dvec3(p), glm::dvec3(end == 0 ? a : b));
    if (!place) return {};
    for (std::size_t axis = 0; axis < 2; ++axis) {
      // What is outside of a window of twice the light is cut to it.
      if (abs((*place)[axis] - 8) > 17) return {};
      const mpq_class off = mpq_class(computed.at(end)[static_cast<glm::length_t>(axis)]) - (*place)[axis];
      const double error = std::abs(off.get_d());
      if (error / found->error > worst.of_bound) worst = {error / found->error, error, found->error};
    }
  }
  return worst;
}

/// A corner of an edge: `share` of the way from p to a place of the light's plane, in half sides from its centre.
glm::vec3 on_the_way(const Case& of, const glm::dvec2& place, double share) {
  const auto& light = std::get<scenes::Rectangle>(of.scene.lights[0].shape);
  const glm::dvec3 target = light.center + place.x * light.half_u + place.y * light.half_v;
  return glm::vec3(glm::mix(glm::dvec3(of.p), target, share));
}

/// A small floor, and p on it: bounds grow with the scene's largest coordinate.
Case on_a_floor(const glm::dvec3& at) {
  Case of;
  of.scene.origin = glm::dvec3(0);
  const double size = 0x1p-6;
  tests::add_object(
      of.scene, "floor",
      {{at + size * glm::dvec3(-1, 0, 1), at + size * glm::dvec3(1, 0.3, 0), at + size * glm::dvec3(0, 0, -1)}});
  tests::add_object(of.scene, "another plane",
                    {{at, at + size * glm::dvec3(1, 0, 0), at + size * glm::dvec3(0, 1, 0)}});
  of.p = glm::vec3(at + size * glm::dvec3(0, 0.1, 0));
  return of;
}

/// Any light, any edge.
Case anywhere(tests::Numbers numbers) {
  const double size = std::exp2(1 - 6 * numbers.next()), tilt = numbers.next();
  const glm::dvec3 at = std::exp2(2 - 6 * numbers.next()) * numbers.vector();
  Case of = on_a_floor(at);
  const auto tilted = [&] { return tilt * numbers.real(); };
  of.scene.lights.push_back(
      tests::rectangle_light(at + glm::dvec3(2 * numbers.real(), 1 + 4 * numbers.next(), 2 * numbers.real()),
                             size * glm::dvec3(1, tilted(), tilted()), size * glm::dvec3(tilted(), tilted(), 1)));
  for (glm::vec3& end : of.edge) {
    const double share = std::exp2(-12 * numbers.next());
    end = on_the_way(of, {2 * numbers.real(), 2 * numbers.real()}, 0.99 * share);
  }
  return of;
}

/// p just under a wide light of skew sides and far from its corner, an edge straight over p: what is off is where p is
/// seen from the corner.
Case close_under_a_wide_light(tests::Numbers numbers) {
  Case of = on_a_floor(numbers.vector());
  const double low = std::exp2(-2 - 10 * numbers.next()), narrow = std::exp2(-10 * numbers.next());
  const glm::dvec3 u = 8.0 * glm::dvec3(1, 0.2 * numbers.real(), 0.5 * numbers.real()),
                   v = numbers.real() * u + narrow * glm::dvec3(numbers.real(), 0.2 * numbers.real(), 8);
  const glm::dvec2 foot(0.3 + 0.6 * numbers.next(), 0.3 + 0.6 * numbers.next());
  of.scene.lights.push_back(tests::rectangle_light(
      glm::dvec3(of.p) + low * glm::normalize(glm::cross(v, u)) - foot.x * u - foot.y * v, u, v));
  const glm::dvec2 spread(0.01 * low, 0.01 * low / narrow);
  for (glm::vec3& end : of.edge) {
    const double share = std::exp2(-6 * numbers.next());
    end = on_the_way(of, foot + spread * glm::dvec2(numbers.real(), numbers.real()), 0.99 * share);
  }
  return of;
}

Use search(const std::function<Case(tests::Numbers)>& make, Use (*use)(const Case&) = use_of) {
  std::mt19937 random(1);
  const tests::Numbers most =
      tests::most_used(random, 10000, [&](const tests::Numbers& numbers) { return use(make(numbers)).of_bound; });
  return use(make(most));
}

/// A sphere, and an edge through the disk that p sees of it: at any angle to the disk, down to one in a million.
Case through_a_disk(tests::Numbers numbers) {
  Case of = on_a_floor(std::exp2(2 - 6 * numbers.next()) * numbers.vector());
  const glm::dvec3 middle = glm::dvec3(of.p) + glm::dvec3(numbers.real(), 1 + 3 * numbers.next(), numbers.real());
  of.scene.lights.push_back(tests::rectangle_light(middle, {1, 0, 0}, {0, 0, 1}));
  of.scene.lights[0].shape = scenes::Sphere{middle, std::exp2(-6 * numbers.next()) * 0.9};
  const visibility::LightFrame disk =
      visibility::light_frame_from(visibility::make_light(of.scene, 0, glm::dvec3(0), {}), of.p);
  const glm::dvec3 x = disk.center + numbers.real() * disk.u + numbers.real() * disk.v;
  const double angle = std::numbers::pi * numbers.real();
  const glm::dvec3 along = std::cos(angle) * disk.u + std::sin(angle) * disk.v +
                           std::exp2(-20 * numbers.next()) * (glm::dvec3(of.p) - disk.center);
  of.edge[0] = glm::vec3(x + std::exp2(-6 * numbers.next()) * along);
  of.edge[1] = glm::vec3(x - std::exp2(-6 * numbers.next()) * along);
  return of;
}

/// The same of where an edge passes through a sphere's disk. (bound pass)
Use use_at_disk(const Case& of) {
  const visibility::SceneFloats floats = visibility::make_scene_floats(of.scene);
  const visibility::Light light = visibility::make_light(of.scene, 0, floats.origin, {});
  const float scale = visibility::device_scale(floats);
  const vectors::ConeLight cone_light(light, floats, visibility::make_triangle_tree(floats), {"", false, true});
  vectors::LightGrid grid = cone_light.make_grid();
  const visibility::LightFrame seen = visibility::light_frame_from(light, of.p);
  const double to_scale = scale;
  const std::array cones{LightCone{to_scale * (seen.center - glm::dvec3(of.p)), to_scale * seen.u, to_scale * seen.v}};
  const vectors::NearSpheres none;
  grid.cones->of = cones;
  grid.cones->near = &none;
  const LightRegion region = make_light_region(light, window_of(light), grid, scale);
  RowSum rows(grid, region, floats, scale);
  GridSample at;
  at.p = of.p * scale;
  rows.set_view_sample(at);
  rows.cut_at_disk();
  const auto found =
      rows.place(in_front_of(at.p, {of.edge[0] * scale, of.edge[1] * scale}, floats.plane[1]), 0, nullptr);
  if (!found || found->error >= 0.5) return {};
  const Rational u = rational(seen.u), v = rational(seen.v), n = cross(u, v), center = rational(seen.center);
  const std::array ends{rational(of.edge[0]), rational(of.edge[1])};
  const std::array heights{dot(n, ends[0] - center), dot(n, ends[1] - center)};
  if (sgn(heights[0]) * sgn(heights[1]) >= 0) return {};
  Rational place = ends[0] - center;
  const Rational way = ends[1] - ends[0];
  for (std::size_t i = 0; i < 3; ++i) place[i] += heights[0] / (heights[0] - heights[1]) * way[i];
  const mpq_class volume = determinant(u, v, n), cells = 8;
  const std::array exact{mpq_class(cells * (1 + determinant(place, v, n) / volume)),
                         mpq_class(cells * (1 + determinant(u, place, n) / volume))};
  // u × v is against the way to the disk: behind it is below.
  const bool first = sgn(heights[0]) < 0;
  const glm::dvec2 computed =
      first ? glm::dvec2(found->edge.x0, found->edge.y0) : glm::dvec2(found->edge.x1, found->edge.y1);
  Use worst;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    if (abs(exact.at(axis) - 8) > 17) return {};
    const mpq_class off = mpq_class(computed[static_cast<glm::length_t>(axis)]) - exact.at(axis);
    const double error = std::abs(off.get_d());
    if (error / found->error > worst.of_bound) worst = {error / found->error, error, found->error};
  }
  return worst;
}

TEST(RowBounds, PlacesOfEdges) {
  const Use most = search(anywhere);
  fmt::print("place: {:.1f} % of the bound used (off by {:.2e} cells, allowed {:.2e})\n", 100 * most.of_bound,
             most.error, most.bound);
  RecordProperty("percent_of_bound_place", fmt::format("{:.1f}", 100 * most.of_bound));
  EXPECT_LT(most.of_bound, 1);
  EXPECT_GT(most.of_bound, 0.005) << "planted_faults cuts it to that";
}

TEST(RowBounds, WherePIsSeen) {
  const Use most = search(close_under_a_wide_light);
  fmt::print("foot: {:.1f} % of the bound used (off by {:.2e} cells, allowed {:.2e})\n", 100 * most.of_bound,
             most.error, most.bound);
  RecordProperty("percent_of_bound_foot", fmt::format("{:.1f}", 100 * most.of_bound));
  EXPECT_LT(most.of_bound, 1);
  EXPECT_GT(most.of_bound, 0.01) << "planted_faults cuts it to that";
}

TEST(RowBounds, WhereEdgesPassThroughADisk) {
  const Use most = search(through_a_disk, use_at_disk);
  fmt::print("disk: {:.1f} % of the bound used (off by {:.2e} cells, allowed {:.2e})\n", 100 * most.of_bound,
             most.error, most.bound);
  RecordProperty("percent_of_bound_disk", fmt::format("{:.1f}", 100 * most.of_bound));
  EXPECT_LT(most.of_bound, 1);
  EXPECT_GT(most.of_bound, 0.005) << "planted_faults cuts it to that";
}

}  // namespace
}  // namespace penumbra::volumes
