// SPDX-License-Identifier: Apache-2.0
// View-sample mapping on a processor: tests one triangle for one view sample in double. The triangle may have any
// position: at or below p's height, through the light's plane, or with an edge within float rounding of a light sample.
// Uses the half-planes of docs/view-sample.md.

#include "vsm/vectors/pairs.hpp"

#include "base/size1.hpp"
#include "visibility/certain_meeting.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <optional>

namespace penumbra::vsm {
namespace {

constexpr double kSlack = 0x1p-44;  // relative to all lengths involved: hundreds of times double's rounding

/// A half-plane over the light's (row, column): at + row · per_row + column · per_column, known to ±error.
struct HalfPlane {
  double at = 0, per_row = 0, per_column = 0, error = 0;
};

/// The zero of a half-plane along a row. The half-plane is positive beyond it (rising) or before it (falling); this is
/// certain at distances of more than `slack`. (bound row)
struct Crossing {
  double at = 0, per_row = 0, per_shift = -1, slack = 0;  // the zero, in columns: at + row · per_row + shift ·
                                                          // per_shift
  bool rising = true;
};
Crossing crossing_of(const HalfPlane& f, double columns) {
  // A slope so small that the value hardly changes along the row may be replaced by a larger one.
  const double slope = std::max({std::abs(f.per_column), f.error / (16 * columns), 1e-300});
  const bool rising = f.per_column >= 0;
  const double inverse = (rising ? -1 : 1) / slope;
  return {f.at * inverse, f.per_row * inverse, f.per_column * inverse, 1.25 * f.error / slope + columns * kSlack,
          rising};
}

using Corners = std::array<glm::vec3, 3>;
Corners corners_of(const CarefulInput& input) {
  const WideTriangles& leaf = input.in.tree.leaves[input.slot / kWide];
  Corners corners;
  for (std::size_t corner = 0; corner < 3; ++corner) {
    const WidePoints& x = leaf.corner[corner];
    corners[corner] = {x[0][input.slot % kWide], x[1][input.slot % kWide], x[2][input.slot % kWide]};
  }
  return corners;
}

struct OneTriangle {
  const PairInput& in;
  const glm::vec3& p;
  const Corners& corners;
};
/// Decides one light sample by its stored point.
void decide(const OneTriangle& one, std::uint32_t row, std::uint32_t column, Blocked& blocked, Open& open) {
  if (blocked.test(row, column)) return;
  const std::uint32_t light_sample = row * one.in.grid.columns + column;
  const glm::dvec3 l = glm::dvec3(one.in.light.points[light_sample]) * static_cast<double>(one.in.scale);
  const std::optional<bool> meets = visibility::certainly_meets(glm::dvec3(one.p), l, one.corners);
  if (!meets) open.samples.push_back(light_sample);
  if (meets.value_or(false)) blocked.add(row, column, column);
}

class CarefulTest {
 public:
  CarefulTest(const CarefulInput& input, Blocked& blocked, Open& open)
      : in_(input.in), at_(input.at), p_(input.at.p), corners_(corners_of(input)), blocked_(blocked), open_(open) {
    const visibility::DeviceLight& light = in_.device_light;
    const glm::dvec3 u(light.u), v(light.v);
    per_column_ = 2.0 / in_.grid.columns * u;
    per_row_ = 2.0 / in_.grid.rows * v;
    first_ = glm::dvec3(light.center) - u - v + 0.5 * per_column_ + 0.5 * per_row_;
    reach_ = size1(first_ - p_) + 2 * size1(u) + 2 * size1(v);
  }

  void operator()() {
    const glm::dvec3 a(corners_[0]), b(corners_[1]), c(corners_[2]);
    const glm::dvec3 pa = a - p_, pb = b - p_, pc = c - p_, n = glm::cross(b - a, c - a);
    const std::array<HalfPlane, 3> edges{half_plane(glm::cross(pa, pb), p_, size1(pa) * size1(pb)),
                                         half_plane(glm::cross(pb, pc), p_, size1(pb) * size1(pc)),
                                         half_plane(glm::cross(pc, pa), p_, size1(pc) * size1(pa))};
    const HalfPlane plane = half_plane(n, a, size1(b - a) * size1(c - a));
    const double side = glm::dot(n, pa), error = kSlack * size1(b - a) * size1(c - a) * size1(pa);
    // A light sample is hidden where all f and the triangle's plane are positive, after multiplication with the sign of
    // p's side.
    for (const double sign : {1.0, -1.0}) {
      if (sign * side < -error) continue;
      mark({turned(edges[0], sign), turned(edges[1], sign), turned(edges[2], sign), turned(plane, sign)},
           sign * side > error);
    }
  }

 private:
  /// Returns n · (l − through) for light samples l; n is known to ± 2⁻⁴⁹ of `sizes`.
  [[nodiscard]] HalfPlane half_plane(const glm::dvec3& n, const glm::dvec3& through, double sizes) const {
    return {
        glm::dot(n, first_ - through), glm::dot(n, per_row_), glm::dot(n, per_column_),
        static_cast<double>(in_.device_light.deviation) * size1(n) + kSlack * sizes * (reach_ + size1(through - p_))};
  }
  static HalfPlane turned(const HalfPlane& f, double sign) {
    return {sign * f.at, sign * f.per_row, sign * f.per_column, f.error};
  }

  void mark(const std::array<HalfPlane, 4>& planes, bool certain) {
    const double last_row = in_.grid.rows - 1.0, last_column = in_.grid.columns - 1.0;
    for (const HalfPlane& f : planes) {  // the test ends if the whole light is outside of one plane
      const double most =
          std::max(f.per_row, 0.0) * last_row + std::abs(f.per_column) + std::max(f.per_column, 0.0) * last_column;
      if (f.at + most < -f.error) return;
    }
    std::array<Crossing, 4> crossings;
    std::transform(planes.begin(), planes.end(), crossings.begin(),
                   [&](const HalfPlane& f) { return crossing_of(f, in_.grid.columns); });
    struct Columns {
      double from, to;
    };
    for (std::uint32_t row = 0; row < in_.grid.rows; ++row) {
      const auto shift = static_cast<double>(in_.grid.shift[row]);
      Columns sure{-1, last_column + 1}, possible{-1, last_column + 1};
      for (const Crossing& c : crossings) {
        const double x = c.at + row * c.per_row + shift * c.per_shift;
        if (c.rising) {
          sure.from = std::max(sure.from, x + c.slack);
          possible.from = std::max(possible.from, x - c.slack);
        } else {
          sure.to = std::min(sure.to, x - c.slack);
          possible.to = std::min(possible.to, x + c.slack);
        }
      }
      if (!(possible.from <= possible.to)) continue;
      const auto first = [](double x) { return std::max(static_cast<std::int64_t>(std::ceil(x)), std::int64_t{0}); };
      const auto last = [&](double x) {
        return std::min(static_cast<std::int64_t>(std::floor(x)), std::int64_t{in_.grid.columns} - 1);
      };
      std::int64_t sure_from = first(sure.from), sure_to = last(sure.to);
      if (!certain || !(sure.from <= sure.to)) sure_to = sure_from - 1;
      if (sure_from <= sure_to) {
        blocked_.add(row, static_cast<std::uint32_t>(sure_from), static_cast<std::uint32_t>(sure_to));
      }
      for (std::int64_t k = first(possible.from); k <= last(possible.to); ++k) {
        if (k == sure_from && sure_from <= sure_to) k = sure_to + 1;
        if (k <= last(possible.to)) decide({in_, at_.p, corners_}, row, static_cast<std::uint32_t>(k), blocked_, open_);
      }
    }
  }

  const PairInput& in_;
  const ClusterSample& at_;
  const glm::dvec3 p_;
  const Corners corners_;
  glm::dvec3 first_{0}, per_row_{0}, per_column_{0};  // grid of the light samples, without deviations
  double reach_ = 0;                                  // bounds |l − p|₁
  Blocked& blocked_;
  Open& open_;
};

/// The light as p sees it: the direction to (s, t) is middle + s u + t v, with an error of at most `off`.
struct SeenLight {
  glm::dvec3 middle{0}, u{0}, v{0};
  double off = 0;
};
SeenLight seen_light(const CarefulInput& input) {
  if (const auto& cones = input.in.grid.cones) {
    const vectors::LightCone& cone = cones->of[input.at.cone];
    return {cone.middle, cone.u, cone.v, static_cast<double>(cones->deviation)};
  }
  const visibility::DeviceLight& light = input.in.device_light;
  return {glm::dvec3(light.center) - glm::dvec3(input.at.p), glm::dvec3(light.u), glm::dvec3(light.v),
          static_cast<double>(light.deviation)};
}

/// Converts a plane from s and t to cells. Storing it in floats rounds it.
CellPlanes::Plane in_cells(const LightGrid& grid, const glm::dvec3& f, double error) {
  const glm::dvec2 half(grid.half_cells), first(grid.first_cell);
  const double per_x = f.x / half.x, per_y = f.y / half.y, at = f.z - first.x * per_x - first.y * per_y;
  const double size = std::abs(f.x) + std::abs(f.y) + std::abs(f.z);
  if (!(size > 0)) return {.near = 1};
  const double near = error / size + 64 * static_cast<double>(kRound);
  return {static_cast<float>(at / size), static_cast<float>(per_x / size), static_cast<float>(per_y / size),
          static_cast<float>(1.001 * near)};
}

}  // namespace

CellPlanes planes_in_cells(const CarefulInput& input) {
  const SeenLight seen = seen_light(input);
  const glm::dvec3 &middle = seen.middle, &u = seen.u, &v = seen.v;
  const Corners corners = corners_of(input);
  const glm::dvec3 p(input.at.p), pa = glm::dvec3(corners[0]) - p, pb = glm::dvec3(corners[1]) - p,
                                  pc = glm::dvec3(corners[2]) - p;
  const glm::dvec3 ab = pb - pa, ac = pc - pa, n = glm::cross(ab, ac);
  const double reach = size1(middle) + size1(u) + size1(v);
  const auto plane = [&](const glm::dvec3& normal, double from, double sizes, double lengths) {
    return in_cells(input.in.grid, {glm::dot(normal, u), glm::dot(normal, v), glm::dot(normal, middle) - from},
                    seen.off * size1(normal) + kSlack * sizes * lengths);
  };
  // Differences of differences have errors relative to the lengths of their operands.
  const double side = glm::dot(n, pa), far = size1(pa) + size1(pb) + size1(pc), sizes = far * far;
  const bool at_infinity = input.in.light.sun.has_value();
  CellPlanes planes{{plane(glm::cross(pa, pb), 0, size1(pa) * size1(pb), reach),
                     plane(glm::cross(pb, pc), 0, size1(pb) * size1(pc), reach),
                     plane(glm::cross(pc, pa), 0, size1(pc) * size1(pa), reach),
                     plane(n, at_infinity ? 0 : side, sizes, at_infinity ? reach : reach + far)}};
  if (std::abs(side) > kSlack * sizes * far) planes.side = side > 0 ? 1 : -1;
  return planes;
}

std::optional<bool> hides(const CarefulInput& input, const glm::vec3& l) {
  const glm::dvec3 p(input.at.p);
  const Corners corners = corners_of(input);
  if (input.in.light.sun) return visibility::ray_certainly_meets(p, glm::dvec3(l), corners);
  return visibility::certainly_meets(p, glm::dvec3(l) * static_cast<double>(input.in.scale), corners);
}

void Blocked::reset(std::uint32_t rows, std::uint32_t columns) {
  words_per_row_ = (columns + 63) / 64;
  bits_.assign(rows * words_per_row_, 0);
}

std::uint32_t Blocked::count() const {
  std::uint32_t count = 0;
  for (const std::uint64_t word : bits_) count += static_cast<std::uint32_t>(std::popcount(word));
  return count;
}

void test_carefully(const CarefulInput& input, Blocked& blocked, Open& open) {
  CarefulTest(input, blocked, open)();
}

void test_one(const CarefulInput& input, std::uint32_t row, std::uint32_t column, Blocked& blocked, Open& open) {
  const Corners corners = corners_of(input);
  decide({input.in, input.at.p, corners}, row, column, blocked, open);
}

}  // namespace penumbra::vsm
