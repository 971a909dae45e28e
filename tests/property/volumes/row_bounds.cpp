// SPDX-License-Identifier: Apache-2.0
// Measures how much of its bounds for the ends of edges rows=exact ever uses: searches for the input that uses most,
// compared with exact places (rational numbers).

#include "tests/property/volumes/row_cases.hpp"
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

using namespace tests_of_rows;

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

  /// Returns the place at which x appears to p, in cells from the corner; nullopt unless it is above p and below the
  /// light.
  [[nodiscard]] std::optional<std::array<mpq_class, 2>> operator()(const glm::dvec3& p, const glm::dvec3& x) const {
    const Rational from = rational(p) - corner_, direction = rational(x) - rational(p);
    const mpq_class height = dot(normal_, from), over = -dot(normal_, direction);
    if (sgn(over) * sgn(height) <= 0 || abs(over) > abs(height)) return std::nullopt;
    const mpq_class t = height / over;
    Rational at = from;
    for (std::size_t i = 0; i < 3; ++i) at[i] += t * direction[i];
    return std::array<mpq_class, 2>{cells_ * dot(across_, at) / squared_, cells_ * dot(along_, at) / squared_};
  }

 private:
  mpq_class cells_, squared_;
  Rational corner_, normal_, across_, along_;
};

/// Returns |computed place − place| over its bound, the worse of two ends and two axes. (docs/edge-scatter.md, "What
/// double proves": foot, segment, place)
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
      // Edges outside a window twice as large as the light are cut to it.
      if (abs((*place)[axis] - 8) > 17) return {};
      const mpq_class off = mpq_class(computed.at(end)[static_cast<glm::length_t>(axis)]) - (*place)[axis];
      const double error = std::abs(off.get_d());
      if (error / found->error > worst.of_bound) worst = {error / found->error, error, found->error};
    }
  }
  return worst;
}

/// Returns a corner of an edge: at `share` of the segment from p to a place in the light's plane, given in half sides
/// from the light's centre.
glm::vec3 on_the_way(const Case& of, const glm::dvec2& place, double share) {
  const auto& light = std::get<scenes::Rectangle>(of.scene.lights[0].shape);
  const glm::dvec3 target = light.center + place.x * light.half_u + place.y * light.half_v;
  return glm::vec3(glm::mix(glm::dvec3(of.p), target, share));
}

/// Returns a case with a light and an edge at random places, of random sizes.
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

/// p is just under a wide skew light and far from its corner, with an edge straight above p: the largest error is in
/// the direction to p as seen from the corner.
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

TEST(RowBounds, PlacesOfEdges) {
  expect_within("place", search(anywhere, use_of), 0.005);
}

TEST(RowBounds, WherePIsSeen) {
  expect_within("foot", search(close_under_a_wide_light, use_of), 0.01);
}

/// An edge has the same place and the same error whether it is placed alone or side by side with others.
TEST(RowBounds, SideBySideIsTheSame) {
  std::mt19937 random(2);
  std::size_t placed = 0;
  constexpr std::size_t kRounds = 2000;
  for (std::size_t round = 0; round < kRounds; ++round) {
    const Case of = round % 2 == 0 ? anywhere(tests::Numbers::at_random(random))
                                   : close_under_a_wide_light(tests::Numbers::at_random(random));
    tests::UnderALight under(of.scene, 16);
    const auto at = under.place({of.p});
    if (!at) continue;
    const LightRegion region = make_light_region(under.light, window_of(under.light), under.grid, under.scale);
    RowSum rows(under.grid, region, under.floats, under.scale);
    rows.set_view_sample(at->front());
    const std::array ends{of.edge[0] * under.scale, of.edge[1] * under.scale};
    WidePlaces places;
    const std::size_t lane = places.count = random() % WidePlaces::kMost;  // the other lanes are zero
    ++places.count;
    for (std::size_t i = 0; i < 3; ++i) {
      places.a[i][lane] = ends[0][static_cast<glm::length_t>(i)];
      places.b[i][lane] = ends[1][static_cast<glm::length_t>(i)];
    }
    place_side_by_side(rows.frame(), places);
    if (places.how[lane] == WidePlaces::kUnplaced) continue;
    const auto alone = rows.place(in_front_of(at->front().p, ends, under.floats.plane[1]), 0, nullptr);
    ASSERT_TRUE(alone) << round;
    EXPECT_EQ(places.x0[lane], alone->edge.x0) << round;
    EXPECT_EQ(places.y0[lane], alone->edge.y0) << round;
    EXPECT_EQ(places.x1[lane], alone->edge.x1) << round;
    EXPECT_EQ(places.y1[lane], alone->edge.y1) << round;
    EXPECT_EQ(places.error[lane], alone->error) << round;
    ++placed;
  }
  EXPECT_GT(placed, kRounds / 4);
}

}  // namespace
}  // namespace penumbra::volumes
