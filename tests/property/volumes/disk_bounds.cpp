// SPDX-License-Identifier: Apache-2.0
// Measures errors of the places where rows=exact cuts edges and casters at the disk that a view sample sees of a
// sphere, as shares of their bounds, and tests that edges and cuts that end at the same place have the same
// coordinates.

#include "engines/vectors/cone_light.hpp"
#include "engines/vectors/disk_plane.hpp"
#include "engines/vectors/near_casters.hpp"
#include "tests/property/volumes/row_cases.hpp"
#include "visibility/tree/triangle_tree.hpp"
#include "volumes/edges/light_window.hpp"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

namespace penumbra::volumes {
namespace {

using namespace tests_of_rows;

/// Returns a sphere, and an edge through the disk that p sees of it: at any angle to the disk, down to one in a
/// million.
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

/// rows=exact at one view sample under a sphere, with the casters near the disk.
class AtADisk {
 public:
  AtADisk(const Case& of, std::span<const std::array<glm::vec3, 3>> casters)
      : floats_(visibility::make_scene_floats(of.scene)),
        light_(visibility::make_light(of.scene, 0, floats_.origin, {})),
        scale_(visibility::device_scale(floats_)),
        seen_(visibility::light_frame_from(light_, of.p)),
        cones_{LightCone{to_scale() * (seen_.center - glm::dvec3(of.p)), to_scale() * seen_.u, to_scale() * seen_.v}},
        near_(near_casters(casters)),
        grid_(vectors::ConeLight(light_, floats_, visibility::make_triangle_tree(floats_), {"", false, true})
                  .make_grid()),
        region_(make_light_region(light_, window_of(light_), grid_, scale_)),
        rows_(grid_, region_, floats_, scale_) {
    grid_.cones->of = cones_;
    grid_.cones->near = &none_;
    grid_.cones->casters = &near_;
    at_.p = of.p * scale_;
    rows_.set_view_sample(at_);
    rows_.cut_at_disk(at_);
  }

  std::optional<RowSum::Placed> place(const std::array<glm::vec3, 2>& edge) {
    return rows_.place(in_front_of(at_.p, {edge[0] * scale_, edge[1] * scale_}, floats_.plane[1]), 0, nullptr);
  }
  std::optional<RowSum::Placed> place_cut(std::size_t caster) { return rows_.place_disk_cut(caster); }
  [[nodiscard]] const visibility::LightFrame& seen() const { return seen_; }

 private:
  [[nodiscard]] double to_scale() const { return static_cast<double>(scale_); }
  [[nodiscard]] vectors::NearCasters near_casters(std::span<const std::array<glm::vec3, 3>> casters) const {
    std::vector<vectors::NearCaster> near;
    for (const auto& corners : casters) {
      vectors::NearCaster& one = near.emplace_back();
      for (std::size_t i = 0; i < 3; ++i) one.corners[i] = glm::dvec3(corners[i] * scale_);
      std::ranges::sort(one.corners, vectors::comes_first);
      one.plane = floats_.plane[1];
    }
    return vectors::side_by_side(near);
  }

  visibility::SceneFloats floats_;
  visibility::Light light_;
  float scale_;
  visibility::LightFrame seen_;
  std::array<LightCone, 1> cones_;
  vectors::NearCasters near_;
  vectors::NearSpheres none_;
  vectors::LightGrid grid_;
  LightRegion region_;
  RowSum rows_;
  GridSample at_;
};

/// Returns the error of the place where an edge passes through a sphere's disk, as a share of its bound.
Use use_at_disk(const Case& of) {
  AtADisk rows(of, {});
  const auto found = rows.place(of.edge);
  if (!found || found->error >= 0.5) return {};
  const auto& seen = rows.seen();
  const Rational u = rational(seen.u), v = rational(seen.v), n = cross(u, v), center = rational(seen.center);
  const std::array ends{rational(of.edge[0]), rational(of.edge[1])};
  const std::array heights{dot(n, ends[0] - center), dot(n, ends[1] - center)};
  if (sgn(heights[0]) * sgn(heights[1]) >= 0) return {};
  Rational place = ends[0] - center;
  const Rational direction = ends[1] - ends[0];
  for (std::size_t i = 0; i < 3; ++i) place[i] += heights[0] / (heights[0] - heights[1]) * direction[i];
  const mpq_class volume = determinant(u, v, n), cells = 8;
  const std::array exact{mpq_class(cells * (1 + determinant(place, v, n) / volume)),
                         mpq_class(cells * (1 + determinant(u, place, n) / volume))};
  // The normal u × v points from the disk toward p: an end with a negative height is behind the disk.
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

TEST(DiskBounds, WhereEdgesPassThrough) {
  expect_within("disk", search(through_a_disk, use_at_disk), 0.005);
}

/// An outline whose parts end one ulp apart is open. If the gap is at the light's left side, all rows above have a
/// wrong depth.
TEST(DiskBounds, EdgesAndCutsEndAtTheSamePlace) {
  std::mt19937 random(3);
  constexpr int kRounds = 3000;
  int same = 0;
  for (int round = 0; round < kRounds; ++round) {
    tests::Numbers numbers = tests::Numbers::at_random(random);
    const Case of = through_a_disk(numbers);
    const std::array corners{of.edge[0], of.edge[1],
                             of.edge[0] + glm::vec3(0.3 * glm::length(of.edge[1] - of.edge[0]) * numbers.vector())};
    AtADisk rows(of, std::span(&corners, 1));
    const auto cut = rows.place_cut(0);
    if (!cut) continue;
    const std::array cut_ends{glm::dvec2(cut->edge.x0, cut->edge.y0), glm::dvec2(cut->edge.x1, cut->edge.y1)};
    int ends_there = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      std::array edge{corners[i], corners[(i + 1) % 3]};
      if (random() % 2 == 0) std::swap(edge[0], edge[1]);
      const auto placed = rows.place(edge);
      if (!placed) continue;
      for (const glm::dvec2 end :
           {glm::dvec2(placed->edge.x0, placed->edge.y0), glm::dvec2(placed->edge.x1, placed->edge.y1)})
        ends_there += static_cast<int>(std::ranges::count(cut_ends, end));
    }
    // Edges that leave a window twice as large as the light end at the window.
    const auto on_light = [](const glm::dvec2& x) { return glm::length(x - 8.0) < 17; };
    if (!std::ranges::all_of(cut_ends, on_light)) continue;
    EXPECT_EQ(ends_there, 2) << round;
    ++same;
  }
  EXPECT_GT(same, kRounds / 4);
}

}  // namespace
}  // namespace penumbra::volumes
