// SPDX-License-Identifier: Apache-2.0
// Tests the part of a textured light beyond one edge by summing over its texels one by one.
//
// Points are multiples of 2⁻⁴ and reference points odd multiples of 2⁻¹⁰, as in coverage_properties.cpp: signs are
// exact.

#include "volumes/wedges/radial_coverage.hpp"
#include "volumes/wedges/texture_weights.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <array>
#include <cmath>
#include <optional>
#include <vector>

namespace penumbra::volumes {
namespace {

using Polygon = std::vector<glm::dvec2>;

const Polygon kSquare = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};

int drawn(int low, int high) {
  return *rc::gen::resize(rc::kNominalSize, rc::gen::inRange(low, high + 1));
}
glm::dvec2 draw_end() {
  return {drawn(-40, 40) / 16.0, drawn(-40, 40) / 16.0};
}
glm::dvec2 drawn_reference() {
  return {(2 * drawn(-500, 500) + 1) / 1024.0, (2 * drawn(-500, 500) + 1) / 1024.0};
}

visibility::LightTexture draw_texture() {
  visibility::LightTexture texture;
  texture.width = static_cast<std::uint32_t>(drawn(1, 7));
  texture.height = static_cast<std::uint32_t>(drawn(1, 7));
  for (std::uint32_t i = 0; i < texture.width * texture.height; ++i) {
    texture.luminance.push_back(i == 0 ? 1 : drawn(0, 16) / 8.0);
    texture.mean_luminance += texture.luminance.back();
  }
  texture.mean_luminance /= static_cast<double>(texture.luminance.size());
  return texture;
}

double cross_of(const glm::dvec2& a, const glm::dvec2& b) {
  return a.x * b.y - a.y * b.x;
}

/// Returns the part of a convex polygon on the left of a → b.
Polygon cut(const Polygon& polygon, const glm::dvec2& a, const glm::dvec2& b) {
  Polygon left;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const glm::dvec2 &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
    const double at_p = cross_of(b - a, p - a), at_q = cross_of(b - a, q - a);
    if (at_p >= 0) left.push_back(p);
    if ((at_p >= 0) != (at_q >= 0)) left.push_back(p + at_p / (at_p - at_q) * (q - p));
  }
  return left;
}

double area_of(const Polygon& polygon) {
  double doubled = 0;
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
    doubled += cross_of(polygon[i] - polygon[0], polygon[i + 1] - polygon[0]);
  }
  return doubled / 2;
}

/// Sums, texel by texel, the part of the convex polygon within it.
double weight_by_texels(const visibility::LightTexture& texture, const Polygon& polygon) {
  const glm::dvec2 size(2.0 / texture.width, 2.0 / texture.height);
  double sum = 0;
  for (std::uint32_t i = 0; i < texture.width * texture.height; ++i) {
    const std::uint32_t column = i % texture.width, row = i / texture.width;
    const glm::dvec2 low(-1 + column * size.x, 1 - (row + 1) * size.y), high = low + size;
    Polygon part = cut(polygon, low, {high.x, low.y});
    part = cut(part, {high.x, low.y}, high);
    part = cut(part, high, {low.x, high.y});
    part = cut(part, {low.x, high.y}, low);
    sum += texture.luminance[i] / (4 * texture.mean_luminance) * area_of(part);
  }
  return sum;
}

/// The mean of a function over less than 2⁻²⁰, whose slope jumps by at most brightest / 4, is taken in the middle: it
/// is off by at most 2⁻²⁰ / 8 of that, over a height of 2, in three walks. In addition there are sums of some hundred
/// rounding errors.
double tolerance(const TextureWeights& weights, int walks = 3) {
  return walks * 0x1p-24 * weights.brightest() + 1e-12;
}

RC_GTEST_PROP(CoverageTextures, WhatLiesBeyondAnEdgeWeighsItsTexels, ()) {
  const visibility::LightTexture texture = draw_texture();
  const TextureWeights weights(texture);
  const glm::dvec2 c = drawn_reference(), a = draw_end(), b = draw_end();
  const LightOutline outline{kSquare, 4};
  const auto edge = clip_to_light(outline, {a.x / 2, a.y / 2, 0.5}, {b.x / 2, b.y / 2, 0.5});
  const double turn = cross_of(a - c, b - c);
  if (!edge || turn == 0) RC_DISCARD("not on the light");
  const int side = turn > 0 ? 1 : -1;
  const glm::dvec2 first = side > 0 ? edge->from : edge->to, last = side > 0 ? edge->to : edge->from;
  const Polygon cone = cut(cut(kSquare, c, first), last, c);
  const double expected = weight_by_texels(texture, cone) - weight_by_texels(texture, {c, first, last});
  const double found = weights.weight_beyond({edge->from, edge->to, side}, c);
  RC_ASSERT(std::abs(found - side * expected) < tolerance(weights));
}

RC_GTEST_PROP(CoverageTextures, AnEvenTextureWeighsAreas, ()) {
  visibility::LightTexture texture = draw_texture();
  texture.luminance.assign(texture.luminance.size(), 3);
  texture.mean_luminance = 3;
  const TextureWeights weights(texture);
  RC_ASSERT(weights.brightest() == 1);
  const glm::dvec2 c = drawn_reference(), a = draw_end(), b = draw_end();
  const LightOutline outline{kSquare, 4};
  const auto edge = clip_to_light(outline, {a.x / 2, a.y / 2, 0.5}, {b.x / 2, b.y / 2, 0.5});
  const double turn = cross_of(a - c, b - c);
  if (!edge || turn == 0) RC_DISCARD("not on the light");
  const int side = turn > 0 ? 1 : -1;
  const double area = RadialCoverage(outline, c).beyond(*edge, side) / outline.area;
  RC_ASSERT(std::abs(weights.weight_beyond({edge->from, edge->to, side}, c) - area) < 1e-12);
}

RC_GTEST_PROP(CoverageTextures, APolygonWeighsItsTexels, ()) {
  const visibility::LightTexture texture = draw_texture();
  const TextureWeights weights(texture);
  Polygon triangle{draw_end() / 2.5, draw_end() / 2.5, draw_end() / 2.5};
  if (area_of(triangle) < 0) std::swap(triangle[0], triangle[1]);
  RC_ASSERT(std::abs(weights.weight_of(triangle) - weight_by_texels(texture, triangle)) < tolerance(weights));
}

}  // namespace
}  // namespace penumbra::volumes
