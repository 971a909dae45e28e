// SPDX-License-Identifier: Apache-2.0
#pragma once

// Scenes in which everything happens within float rounding of a pair: each view sample has its own triangle, aimed at
// one of its light samples. If an error bound is too small, some pair is decided wrongly, and exact predicates show it.

#include "mesh/predicates.hpp"
#include "tests/agreement/crossings.hpp"
#include "tests/agreement/device_twins.hpp"
#include "tests/agreement/most_used.hpp"
#include "tests/agreement/support.hpp"
#include "visibility/lights/device_light.hpp"
#include "visibility/pair_truth.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace penumbra::tests {

/// The part of a triangle that a pair's segment passes, or another object that the segment comes near.
enum class Aim : std::uint8_t {
  edge,     ///< an edge through the light sample, as seen from p
  aligned,  ///< the same, parallel to one of the light's sides
  corner,   ///< an edge through the light's corner, where rows and columns begin
  left,     ///< an edge through the light's left side, at the height of a light sample
  vertex,   ///< a vertex on the light sample
  row,      ///< a vertex at the height of a row
  sliver,   ///< p in the triangle's plane, and near the triangle's edges or in it
  grazing,  ///< an edge just above p, so that it appears far away
  horizon,  ///< p's own plane through the light sample
  side,     ///< p in the plane of a triangle that stands above it on a narrow foot, under a panel
  det,      ///< p in the plane of a triangle that stands above it on a wide foot
  needle,   ///< the light's corner inside a needle between two triangles of a sheet
  beside,   ///< an edge whose place is computed to be on the wrong side of the light sample
};
inline constexpr std::array kAims{Aim::edge,    Aim::corner,  Aim::left, Aim::vertex, Aim::row,   Aim::sliver,
                                  Aim::grazing, Aim::horizon, Aim::side, Aim::det,    Aim::needle};
/// Aims for which the search maximises the used share of a bound over scenes. The last, `beside`, is for edge-scatter
/// on the device alone, with the bound of light samples in rows; 64 samples anywhere have the same cells.
inline constexpr std::array kSearchedAims{Aim::side, Aim::det, Aim::needle, Aim::beside};
/// The share of the bound that remains after tests/planted_faults has cut it.
inline double planted_cut(Aim aim) {
  return aim == Aim::det ? 1.0 / 256 : 0.01;
}
inline std::string name_of(Aim aim) {
  static constexpr std::array kNames{"edge",    "aligned", "corner", "left", "vertex", "row",   "sliver",
                                     "grazing", "horizon", "side",   "det",  "needle", "beside"};
  return kNames.at(static_cast<std::size_t>(aim));
}

class AimedScene {
 public:
  static constexpr visibility::SampleRequest kInRows{64, 8, 8, visibility::SamplePattern::rows, 0};

  /// Makes 64 view samples, and 64 light samples in rows or those of `request`.
  AimedScene(Aim aim, std::uint32_t seed, const visibility::SampleRequest& request = kInRows)
      : aim_(aim), random_(seed) {
    scenes::Scene scene;
    // Keeps the origin of scene floats at zero, whatever else is added.
    add_object(scene, "anchor", {{glm::dvec3(-16), glm::dvec3(16, 16, -16), glm::dvec3(16)}}).casts_shadow = false;
    // Sizes range from a speck to the whole floor: view samples are near one another, and far from zero. The searched
    // aims use most of their bounds if coordinates are no larger than lengths; `det` uses most of its bound if the
    // light is square and overhead.
    const double patch = std::exp2(-static_cast<double>(random_() % 8)),
                 size = std::exp2(1 - static_cast<double>(random_() % 6)), askew = aim_ == Aim::det ? 0.05 : 1;
    const glm::dvec3 middle = (aim_ >= Aim::side ? 0.25 : 1.0) * glm::dvec3(4 * real(), real(), 4 * real());
    const glm::dvec3 u = patch * glm::normalize(glm::dvec3(1, 0.4 * real(), 0.4 * real()));
    const glm::dvec3 v = patch * glm::normalize(glm::dvec3(0.4 * real(), 0.4 * real(), -1));
    const auto beside = [&](double most) { return askew * most * real(); };
    const glm::dvec3 over = {beside(3), 2 + 4 * std::abs(real()), beside(3)};
    const glm::dvec3 light_u = glm::normalize(glm::dvec3(1, beside(0.5), beside(0.5))),
                     light_v = glm::normalize(glm::dvec3(beside(0.5), beside(0.5), 1));
    scene.lights.push_back(rectangle_light(middle + over, size * light_u, size * light_v));
    std::vector<Corners> floor = quad(middle, u, v);
    light = visibility::make_light(scene, 0, visibility::make_scene_floats(scene).origin, request);
    frame_ = visibility::make_device_light(light, 1);

    std::vector<Corners> carriers, casters;
    std::vector<glm::dvec2> places;
    std::vector<glm::vec3> points;
    for (std::uint32_t i = 0; i < kSide * kSide; ++i) {
      const auto sample = static_cast<std::uint32_t>(random_() % light.points.size());
      const glm::vec3 l = light.points[sample];
      const glm::dvec2 st(positive() * 0.45, positive() * 0.45);
      Corners carrier = floor[random_() % 2];
      if (aim_ == Aim::horizon) {
        const glm::dvec3 at = middle + real() * u + real() * v;
        carrier = {at, at + (0.02 + 0.2 * positive()) * (glm::dvec3(l) - at),
                   at + 0.2 * patch * glm::normalize(vector())};
      }
      carriers.push_back(carrier);
      places.push_back(st);
      const glm::dvec3 a = rounded(carrier[0]), b = rounded(carrier[1]), c = rounded(carrier[2]);
      points.emplace_back(glm::vec3(a + st.x * (b - a) + st.y * (c - a)));
      // Only some view samples are aimed at: if they are near one another, all triangles are between each of them and
      // the light.
      const std::uint32_t every = aim_ == Aim::sliver || aim_ >= Aim::grazing ? 8 : 3;
      if (aim_ == Aim::horizon || i % every != 0) continue;
      const glm::dvec3 p(points.back());
      if (aim_ == Aim::needle) {
        const std::vector<Corners> sheet = needle(p, size);
        casters.insert(casters.end(), sheet.begin(), sheet.end());
      } else if (aim_ == Aim::beside) {
        casters.push_back(passing(points.back(), sample, 2 * size));
      } else {
        casters.push_back(aim_ == Aim::side || aim_ == Aim::det ? standing(p, l) : aimed(p, glm::dvec3(l), size));
      }
    }
    if (aim_ == Aim::side) {  // over half of the light: a wrong sign removes its one layer
      const glm::dvec3 center(light.center), half_u = 0.5 * (glm::dvec3(light.center_u) - center);
      const std::vector<Corners> panel =
          quad(center + 0.125 * (middle - center) + half_u, half_u, 1.5 * (glm::dvec3(light.center_v) - center));
      casters.insert(casters.end(), panel.begin(), panel.end());
    }
    add_object(scene, "carriers", carriers);
    if (!casters.empty()) add_object(scene, "casters", casters);
    floats = visibility::make_scene_floats(scene);
    EXPECT_EQ(floats.origin, glm::dvec3(0));
    take_samples(points);
  }

  visibility::SceneFloats floats;
  visibility::Light light;
  visibility::ViewSamples samples;
  double used = 0;  ///< for kSearchedAims: the share of the bound that is needed to notice that a sign is wrong

 private:
  static constexpr std::uint32_t kSide = 8;
  static constexpr int kTries = 1000;

  double positive() { return (static_cast<double>(random_() % (1U << 24U)) + 0.5) / (1U << 24U); }
  double real() { return 2 * positive() - 1; }
  glm::dvec3 vector() { return glm::dvec3(real(), real(), real()) + glm::dvec3(0x1p-30); }
  static glm::dvec3 rounded(const glm::dvec3& x) { return glm::dvec3(glm::vec3(x)); }

  /// Returns the triangle that is aimed at a pair.
  Corners aimed(const glm::dvec3& p, glm::dvec3 l, double light_size) {
    const glm::dvec3 center(light.center), u = glm::dvec3(light.center_u) - center,
                                           v = glm::dvec3(light.center_v) - center;
    const double s = glm::dot(l - center, u) / glm::dot(u, u);
    if (aim_ == Aim::corner) l = center - u - v;
    if (aim_ == Aim::left) l -= (1 + s) * u;
    if (aim_ == Aim::row) l += 2 * real() * u;
    const glm::dvec3 direction = l - p;
    // The triangle covers a few light samples as seen from p, and sometimes many more.
    const double share = 0.05 + 0.9 * positive();
    double size = share * light_size * (random_() % 8 == 0 ? 4 : std::exp2(-0.5 - 2.5 * positive()));
    // An edge that passes the corner matters most if no row of light samples crosses it: half a cell is an eighth of
    // the light's half-size.
    if (aim_ == Aim::corner && random_() % 2 == 0) size /= 16;
    const glm::dvec3 at = p + share * direction,
                     e = aim_ == Aim::aligned ? glm::normalize(random_() % 2 == 0 ? u : v) : glm::normalize(vector()),
                     f = glm::normalize(vector());
    switch (aim_) {
      case Aim::vertex:
      case Aim::row:
        return {at, at + size * e, at + size * f};
      case Aim::sliver: {  // p = a + α (b − a) + β (c − a), just outside an edge or inside
        const glm::dvec3 a = at + 0.1 * size * e, b = p + share * positive() * (direction + size / share * f);
        const bool inside = random_() % 2 == 0;
        const double alpha = inside ? -positive() : positive(), beta = inside ? -positive() : real();
        return {a, b, p + alpha * (a - p) + beta * (b - p)};
      }
      case Aim::grazing: {  // low above p: its ends appear far away, or as near as a small height allows
        const double low = std::exp2(-4 - 16 * positive());
        const glm::dvec3 near = p + low * direction, along = glm::normalize(glm::cross(direction, e));
        const double wide = 16 * low / share * size;
        return {near - wide * along, near + wide * (along + std::exp2(-20 * positive()) * f), near + 0.1 * wide * f};
      }
      default:
        return {at - size * positive() * e, at + size * positive() * e, at + size * f};
    }
  }

  /// Returns the triangle as scene floats will store it.
  static FloatCorners stored(const Corners& corners) {
    FloatCorners at{glm::vec3(corners[0]), glm::vec3(corners[1]), glm::vec3(corners[2])};
    std::sort(at.begin(), at.end(), [](const glm::vec3& a, const glm::vec3& b) {
      return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z;
    });
    return at;
  }

  /// Returns a triangle above p that hides l, with p within rounding of its plane: of many, the one for which the sign
  /// of p's side is most wrong. l is farther from the plane than p is, so that the triangle's edges pass at some
  /// distance from l.
  Corners standing(const glm::dvec3& p, const glm::vec3& l) {
    const glm::dvec3 direction = glm::dvec3(l) - p;
    const double length = glm::length(direction);
    const bool on_wide_foot = aim_ == Aim::det;
    const auto make = [&](Numbers numbers) -> Corners {
      const glm::dvec3 e = glm::normalize(glm::cross(direction, numbers.vector())),
                       n = glm::cross(direction, e) / length;
      // Relative to the length of the segment: the foot's height and half its width, and the distances of p and l from
      // the plane. The bound of `det` grows with the foot; the other bound grows only with the distance of the first
      // corner, which therefore must be the top.
      const double low = std::exp2(-3 - 10 * numbers.next());
      const auto wide = [&] { return numbers.next() * (on_wide_foot ? 1 : low); };
      const double off = std::exp2((on_wide_foot ? -18 : -23) - 6 * numbers.next()),
                   beyond = off / low * numbers.next();
      const glm::dvec3 tilted = direction + length * beyond * n, from = p - length * off * n;
      return {from + low * tilted + length * wide() * e, from + low * tilted - length * wide() * e,
              from + (0.3 + 0.6 * numbers.next()) * tilted + 0.4 * length * numbers.real() * e};
    };
    const auto sign = [&](const Numbers& numbers) -> Rounded {
      const FloatCorners at = stored(make(numbers));
      if (!visibility::segment_meets_triangle(glm::vec3(p), l, at, light).meets) return {};
      return on_wide_foot ? det_as_rounded(frame_, at, glm::vec3(p)) : side_as_rounded(at, glm::vec3(p));
    };
    const Numbers best = most_used(random_, kTries, [&](const Numbers& numbers) { return sign(numbers).far_wrong(); });
    used = std::max(used, sign(best).wrong());
    return make(best);
  }

  /// Returns a triangle with an edge that passes the light sample: of many, the one that is computed to pass farthest
  /// on the wrong side.
  Corners passing(const glm::vec3& p, std::uint32_t sample, double width) {
    const std::uint32_t row = sample / light.columns, column = sample % light.columns;
    const glm::dvec3 to_next = glm::dvec3(frame_.u) * (2.0 / static_cast<double>(light.columns));
    const glm::vec2 half_cells = 0.5F * glm::vec2(static_cast<float>(light.columns), static_cast<float>(light.rows));
    const DevicePlaces places(frame_, p, half_cells);
    const auto make = [&](Numbers numbers) -> Corners {
      return triangle_at(glm::dvec3(p), glm::dvec3(light.points[sample]), width, numbers);
    };
    const auto crossing = [&](const Numbers& numbers) {
      const Corners corners = make(numbers);
      const std::array edge{glm::vec3(corners[0]), glm::vec3(corners[1])};
      return crossing_as_rounded(
          places(edge), half_cells,
          {static_cast<float>(row), static_cast<float>(column), static_cast<float>(light.row_shift[row])},
          exact_crossing(p, light.points[sample], edge, to_next));
    };
    const Numbers best =
        most_used(random_, kTries, [&](const Numbers& numbers) { return crossing(numbers).far_wrong(); });
    used = std::max(used, crossing(best).wrong());
    return make(best);
  }

  /// Returns two triangles side by side that cover the light's corner and its surroundings, and between them one as
  /// narrow as floats allow, with the corner in it: of many, the one that rounding mirrors most.
  std::vector<Corners> needle(const glm::dvec3& p, double light_size) {
    const glm::dvec3 center(frame_.center), direction = center - glm::dvec3(frame_.u) - glm::dvec3(frame_.v) - p;
    const auto make = [&](Numbers numbers) -> std::vector<Corners> {
      const double share = 0.05 + 0.9 * numbers.next(), size = share * light_size * std::exp2(-2 * numbers.next());
      const glm::dvec3 at = p + share * direction, e = glm::normalize(numbers.vector()),
                       f = glm::normalize(glm::cross(direction, e));
      const glm::dvec3 a = rounded(at + size * e), b = rounded(at - (0.4 + 0.6 * numbers.next()) * size * e);
      glm::dvec3 c = b;  // differs from b by at most a unit in the last place of each coordinate
      for (int axis = 0; axis < 3; ++axis)
        c[axis] += std::ldexp(std::round(1.5 * numbers.real()), std::ilogb(b[axis]) - 23);
      return {{a, b, rounded(at - size * f)}, {a, b, c}, {a, c, rounded(at + size * f)}};
    };
    const auto wrong = [&](const Numbers& numbers) {
      const std::vector<Corners> sheet = make(numbers);
      const auto& [a, b, c] = sheet[1];
      if (mesh::side_of_plane(a, b, c, p) != mesh::side_of_plane(a, b, sheet[2][2], p)) return 0.0;
      return corner_products(frame_, stored(sheet[1]), glm::vec3(p)).wrong();
    };
    const Numbers best = most_used(random_, kTries, wrong);
    used = std::max(used, wrong(best));
    return make(best);
  }

  void take_samples(const std::vector<glm::vec3>& points) {
    samples.width = samples.height = kSide;
    for (std::uint32_t i = 0; i < points.size(); ++i) {
      const std::uint32_t triangle = 1 + i;  // the anchor comes first
      const auto [a, b, c] = floats.corners(triangle);
      const glm::dvec3 n = glm::cross(glm::dvec3(b) - glm::dvec3(a), glm::dvec3(c) - glm::dvec3(a));
      const glm::dvec3 to_light = glm::dvec3(light.center) - glm::dvec3(points[i]);
      const bool front = aim_ == Aim::horizon ? random_() % 2 == 0 : glm::dot(n, to_light) > 0;
      const bool background = floats.plane[triangle] == visibility::SceneFloats::kNoPlane;
      samples.triangle.push_back(background ? visibility::ViewSamples::kBackground
                                            : static_cast<std::int32_t>(triangle));
      samples.p.push_back(points[i] + 0.0F);
      samples.n.push_back(background ? glm::vec3(0) : glm::vec3(glm::normalize(front ? n : -n)));
      samples.depth.push_back(1);
      samples.facing.push_back(static_cast<std::int8_t>(background ? 0 : front ? 1 : -1));
    }
  }

  Aim aim_;
  std::mt19937 random_;
  visibility::DeviceLight frame_;
};

}  // namespace penumbra::tests
