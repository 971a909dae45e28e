// SPDX-License-Identifier: Apache-2.0
// Tests changes that must not matter to the coverage integral: the reference point of a closed loop, the place where an
// edge is cut, mirroring, scale, and the order and winding of triangles.
//
// Points of the light are multiples of 2⁻⁴ and reference points odd multiples of 2⁻¹⁰ (none is on an edge's line,
// except on purpose): all signs here are exact in double. Tolerance: sums of a few dozen areas, each with an error of a
// few ulps of 4.

#include "tests/unit/coverage_stage.hpp"
#include "tests/unit/exact_area_soups.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace penumbra::volumes {
namespace {

using Loop = std::vector<glm::dvec2>;

constexpr double kShareRounding = 1e-12;

int draw(int low, int high) {
  return *rc::gen::inRange(low, high + 1);
}

double cross2(const glm::dvec2& a, const glm::dvec2& b) {
  return a.x * b.y - a.y * b.x;
}

int sign_of(double value) {
  return value > 0 ? 1 : value < 0 ? -1 : 0;
}

/// One of the square, the disk, a triangle and a pentagon; all contain the square of half-size 5/8 around 0.
LightOutline draw_outline() {
  switch (draw(0, 3)) {
    case 0:
      return {{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}, 4};
    case 1:
      return {{}, std::numbers::pi};
    case 2:
      return {{{-1, -1}, {3, -1}, {-1, 3}}, 8};
    default:
      return {{{-1, -1}, {1, -1}, {2, 0}, {1, 1}, {-1, 1}}, 5};
  }
}

Loop draw_loop() {
  Loop loop;
  for (int i = draw(2, 9); i >= 0; --i) loop.emplace_back(draw(-40, 40) / 16.0, draw(-40, 40) / 16.0);
  return loop;
}

glm::dvec2 draw_reference() {
  return {(2 * draw(-150, 150) + 1) / 1024.0, (2 * draw(-150, 150) + 1) / 1024.0};
}

std::optional<ClippedEdge> clipped(const LightOutline& outline, const glm::dvec2& a, const glm::dvec2& b) {
  return clip_to_light(outline, {a.x / 2, a.y / 2, 0.5}, {b.x / 2, b.y / 2, 0.5});  // half way to the light
}

/// Returns 0 if the edge does not appear, or its line goes through the reference point.
double beyond(const LightOutline& outline, const glm::dvec2& c, const glm::dvec2& a, const glm::dvec2& b) {
  const auto edge = clipped(outline, a, b);
  const int side = sign_of(cross2(a - c, b - c));
  return edge && side != 0 ? RadialCoverage(outline, c).beyond(*edge, side) : 0;
}

/// Returns the winding number of the loop around c: crossings of the ray to the right.
int winding(const Loop& loop, const glm::dvec2& c) {
  int sum = 0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const glm::dvec2 &a = loop[i], &b = loop[(i + 1) % loop.size()];
    if ((a.y > c.y) == (b.y > c.y)) continue;
    if (b.y > c.y && cross2(b - a, c - a) > 0) ++sum;
    if (b.y < c.y && cross2(b - a, c - a) < 0) --sum;
  }
  return sum;
}

bool is_on_a_line(const Loop& loop, const glm::dvec2& c) {
  for (std::size_t i = 0; i < loop.size(); ++i) {
    if (cross2(loop[i] - c, loop[(i + 1) % loop.size()] - c) == 0) return true;
  }
  return false;
}

/// Returns the integral of the winding number over the light.
double area_by(const LightOutline& outline, const Loop& loop, const glm::dvec2& c) {
  double sum = winding(loop, c) * outline.area;
  for (std::size_t i = 0; i < loop.size(); ++i) sum -= beyond(outline, c, loop[i], loop[(i + 1) % loop.size()]);
  return sum;
}

RC_GTEST_PROP(Coverage, AClosedLoopHasOneAreaFromWhereverItIsSeen, ()) {
  const LightOutline outline = draw_outline();
  const Loop loop = draw_loop();
  const glm::dvec2 one = draw_reference(), other = draw_reference();
  if (is_on_a_line(loop, one) || is_on_a_line(loop, other)) RC_DISCARD("on a line");
  RC_ASSERT(std::abs(area_by(outline, loop, one) - area_by(outline, loop, other)) < kShareRounding);
}

RC_GTEST_PROP(Coverage, ALoopWithinTheLightHasItsShoelaceArea, ()) {
  const LightOutline outline = draw_outline();
  Loop loop = draw_loop();
  for (glm::dvec2& q : loop) q /= 4.0;  // |s|, |t| ≤ 5/8: inside every outline
  const glm::dvec2 c = draw_reference();
  if (is_on_a_line(loop, c)) RC_DISCARD("on a line");
  double doubled = 0;
  for (std::size_t i = 0; i < loop.size(); ++i) doubled += cross2(loop[i], loop[(i + 1) % loop.size()]);
  RC_ASSERT(std::abs(area_by(outline, loop, c) - doubled / 2) < kShareRounding);
}

RC_GTEST_PROP(Coverage, AnEdgeIsTheSumOfItsPieces, ()) {
  const LightOutline outline = draw_outline();
  const Loop ends = draw_loop();
  const glm::dvec2 c = draw_reference(), a = ends[0], b = ends[1], middle = (a + b) / 2.0;
  const double pieces = beyond(outline, c, a, middle) + beyond(outline, c, middle, b);
  RC_ASSERT(std::abs(beyond(outline, c, a, b) - pieces) < kShareRounding);
}

RC_GTEST_PROP(Coverage, TurningAnEdgeOverOrSeeingItInAMirrorChangesTheSign, ()) {
  const LightOutline outline = draw_outline();
  LightOutline mirrored = outline;
  for (glm::dvec2& corner : mirrored.corners) corner.x = -corner.x;
  std::ranges::reverse(mirrored.corners);
  const Loop ends = draw_loop();
  const glm::dvec2 c = draw_reference(), a = ends[0], b = ends[1];
  const auto mirror = [](const glm::dvec2& q) { return glm::dvec2(-q.x, q.y); };
  const double area = beyond(outline, c, a, b);
  RC_ASSERT(std::abs(area + beyond(outline, c, b, a)) < kShareRounding);
  RC_ASSERT(std::abs(area + beyond(mirrored, mirror(c), mirror(a), mirror(b))) < kShareRounding);
}

/// By definition, the expected value is the share of grid points whose segment from c crosses the edge.
RC_GTEST_PROP(Coverage, IsTheAreaThatSegmentsFromTheReferencePointReachAcrossTheEdge, ()) {
  const LightOutline outline = {{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}, 4};
  const Loop ends = draw_loop();
  const glm::dvec2 c = draw_reference(), a = ends[0], b = ends[1];
  constexpr int kGrid = 64;
  int across = 0;
  for (int i = 0; i < kGrid * kGrid; ++i) {
    const glm::dvec2 l = 2.0 * (glm::dvec2(i % kGrid, i / kGrid) + 0.5) / double{kGrid} - 1.0;
    const bool parted = (cross2(b - a, c - a) > 0) != (cross2(b - a, l - a) > 0);
    const bool between = (cross2(l - c, a - c) > 0) != (cross2(l - c, b - c) > 0);
    across += parted && between ? 1 : 0;
  }
  // The region is convex except for its notch at c: its boundary, at most 12 long, passes through at most 2 · 12 · 32 +
  // 8 of the cells of side 1/32; each of them may be counted wrong.
  const double expected = sign_of(cross2(a - c, b - c)) * 4.0 * across / (kGrid * kGrid);
  RC_ASSERT(std::abs(beyond(outline, c, a, b) - expected) < (2 * 12 * 32 + 8) * 4.0 / (kGrid * kGrid));
}

scenes::Scene scaled_by_two(scenes::Scene scene) {
  for (glm::dvec3& at : scene.soup.positions) at *= 2.0;
  auto& light = std::get<scenes::Rectangle>(scene.lights[0].shape);
  light.center *= 2.0;
  light.half_u *= 2.0;
  light.half_v *= 2.0;
  return scene;
}

/// Returns strips of triangles between the floor and a tilted light, which they do not reach.
std::vector<tests::Corners> draw_soup(std::mt19937& random) {
  std::vector<tests::Corners> soup = tests::lattice_soup(random, draw(2, 8));
  for (tests::Corners& corners : soup) {
    for (glm::dvec3& corner : corners) corner.y = corner.y * 0.5 - 0.25;
  }
  return soup;
}

RC_GTEST_PROP(Coverage, ScalingByTwoChangesNoBit, ()) {
  std::mt19937 random(*rc::gen::arbitrary<std::uint32_t>());
  const scenes::Scene scene = tests::soup_scene(draw_soup(random), tests::Lamp::tilted);
  const tests::CoverageStage stage(scene), twice(scaled_by_two(scene));
  for (int i = 0; i < 5; ++i) {
    const glm::vec3 p = tests::soup_receiver(random);
    RC_ASSERT(stage.center(p).blocked == twice.center(2.0F * p).blocked);
    RC_ASSERT(stage.receiver(p).blocked == twice.receiver(2.0F * p).blocked);
  }
}

RC_GTEST_PROP(Coverage, OrderAndWindingOfTrianglesChangeNoMoreThanTheOrderOfTheSum, ()) {
  std::mt19937 random(*rc::gen::arbitrary<std::uint32_t>());
  std::vector<tests::Corners> soup = draw_soup(random);
  const auto lamp = static_cast<tests::Lamp>(draw(0, 3));
  const tests::CoverageStage stage(tests::soup_scene(soup, lamp));
  std::shuffle(soup.begin(), soup.end(), random);
  for (std::size_t i = 0; i < soup.size(); i += 2) std::swap(soup[i][0], soup[i][2]);
  const tests::CoverageStage shuffled(tests::soup_scene(soup, lamp));
  for (int i = 0; i < 5; ++i) {
    const glm::vec3 p = tests::soup_receiver(random);
    RC_ASSERT(std::abs(stage.center(p).blocked - shuffled.center(p).blocked) < kShareRounding);
    RC_ASSERT(std::abs(stage.receiver(p).blocked - shuffled.receiver(p).blocked) < kShareRounding);
  }
}

}  // namespace
}  // namespace penumbra::volumes
