// SPDX-License-Identifier: Apache-2.0
// Computes FLIP (Andersson et al. 2020, cited in eye.hpp); section and equation numbers are the paper's. Both pictures
// are filtered by contrast sensitivity functions, and colours are compared by HyAB in Hunt-adjusted L*a*b* (the colour
// pipeline); edges and points of their unfiltered luminance are detected by derivatives of a Gaussian (the feature
// pipeline); feature differences amplify colour differences. Beyond a border the nearest pixel is repeated.

#include "base/assert.hpp"
#include "compare/eye.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

namespace penumbra::compare {
namespace {

constexpr double kPi = std::numbers::pi;

/// Matrix from sRGB's primaries to XYZ, by rows; white is D65, the sum of the columns.
const glm::dmat3 kXyzOfRgb =
    glm::transpose(glm::dmat3{10135552.0 / 24577794, 8788810.0 / 24577794, 4435075.0 / 24577794,  //
                              2613072.0 / 12288897, 8788810.0 / 12288897, 887015.0 / 12288897,    //
                              1425312.0 / 73733382, 8788810.0 / 73733382, 70074185.0 / 73733382});
const glm::dmat3 kRgbOfXyz = glm::inverse(kXyzOfRgb);
const glm::dvec3 kWhite = kXyzOfRgb * glm::dvec3(1);

/// Converts to opponent colours, in which a filter of one channel does not affect the others (section 4.1.1).
glm::dvec3 opponent_of_rgb(const glm::dvec3& rgb) {
  const glm::dvec3 xyz = kXyzOfRgb * rgb / kWhite;
  return {116 * xyz.y - 16, 500 * (xyz.x - xyz.y), 200 * (xyz.y - xyz.z)};
}

glm::dvec3 rgb_of_opponent(const glm::dvec3& c) {
  const double y = (c.x + 16) / 116;
  return kRgbOfXyz * (kWhite * glm::dvec3(y + c.y / 500, y, y - c.z / 200));
}

/// Converts linear sRGB to CIE L*a*b* with a and b scaled by 0.01 L (Hunt's effect: dark colours appear less
/// colourful).
glm::dvec3 hunt_lab(const glm::dvec3& rgb) {
  const glm::dvec3 t = kXyzOfRgb * rgb / kWhite;
  const auto f = [](double x) {
    constexpr double kDelta = 6.0 / 29;
    return x > kDelta * kDelta * kDelta ? std::cbrt(x) : x / (3 * kDelta * kDelta) + 4.0 / 29;
  };
  const double lightness = 116 * f(t.y) - 16;
  return {lightness, 0.01 * lightness * 500 * (f(t.x) - f(t.y)), 0.01 * lightness * 200 * (f(t.y) - f(t.z))};
}

/// Returns |ΔL| + the distance of (a, b): for large differences more accurate than ΔE (section 4.1.3).
double hyab(const glm::dvec3& a, const glm::dvec3& b) {
  return std::abs(a.x - b.x) + glm::length(glm::dvec2(a.y - b.y, a.z - b.z));
}

/// Returns the colour difference in [0, 1]: HyAB ^ 0.7, with values up to 0.4 of the largest (green against blue)
/// mapped to 0.95 of the range.
double redistributed(double difference) {
  static const double largest = std::pow(hyab(hunt_lab({0, 1, 0}), hunt_lab({0, 0, 1})), 0.7);
  constexpr double kShareOfLargest = 0.4, kShareOfRange = 0.95;
  const double power = std::pow(difference, 0.7), knee = kShareOfLargest * largest;
  if (power < knee) return kShareOfRange / knee * power;
  return kShareOfRange + (power - knee) / (largest - knee) * (1 - kShareOfRange);
}

/// Channel of a picture.
struct Plane {
  std::size_t width, height;
  std::vector<double> values;

  [[nodiscard]] std::span<const double> row(std::size_t y) const { return std::span(values).subspan(y * width, width); }
  [[nodiscard]] std::span<double> row(std::size_t y) { return std::span(values).subspan(y * width, width); }
};

void for_each_row(const Plane& plane, const std::function<void(std::size_t)>& of_row) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, plane.height), [&](const auto& rows) {
    for (std::size_t y = rows.begin(); y != rows.end(); ++y) of_row(y);
  });
}

/// Weights from −r to r.
using Weights = std::vector<double>;

Weights weights(std::ptrdiff_t radius, const std::function<double(double)>& of_place) {
  Weights result;
  for (std::ptrdiff_t i = -radius; i <= radius; ++i) result.push_back(of_place(static_cast<double>(i)));
  return result;
}

/// Returns the sum of all weights, or of those with this sign.
double sum_of(const Weights& all, double sign = 0) {
  double sum = 0;
  for (const double w : all) sum += sign == 0 || w * sign > 0 ? w : 0;
  return sum;
}

/// Returns the channel correlated with `across` along x, then with `down` along y.
Plane filtered(const Plane& in, const Weights& across, const Weights& down) {
  const std::size_t radius = across.size() / 2;
  const auto add = [](std::span<double> to, double weight, std::span<const double> from) {
    for (std::size_t x = 0; x < to.size(); ++x) to[x] += weight * from[x];
  };
  Plane middle{in.width, in.height, std::vector<double>(in.values.size())}, out = middle;
  for_each_row(in, [&](std::size_t y) {
    const std::span<const double> row = in.row(y);
    std::vector<double> longer(radius, row.front());
    longer.insert(longer.end(), row.begin(), row.end());
    longer.insert(longer.end(), radius, row.back());
    for (std::size_t i = 0; i < across.size(); ++i)
      add(middle.row(y), across[i], std::span(longer).subspan(i, in.width));
  });
  for_each_row(in, [&](std::size_t y) {
    for (std::size_t i = 0; i < down.size(); ++i) {
      const std::size_t from = std::clamp(y + i, radius, in.height - 1 + radius) - radius;
      add(out.row(y), down[i], std::as_const(middle).row(from));
    }
  });
  return out;
}

/// Contrast sensitivity function (equation 2, table 1): a sum of Gaussians a √(π/b) exp(−π² d² / b), d in degrees.
struct Sensitivity {
  double a1, b1, a2, b2;
};
constexpr std::array<Sensitivity, 3> kSensitivities{
    {{1, 0.0047, 0, 1e-5}, {1, 0.0053, 0, 1e-5}, {34.1, 0.04, 13.5, 0.025}}};

Plane as_seen(const Plane& in, const Sensitivity& eye, double pixels_per_degree) {
  constexpr double kWidest = 0.04;  // largest b: all filters have the same size
  const auto radius =
      static_cast<std::ptrdiff_t>(std::ceil(3 * std::sqrt(kWidest / (2 * kPi * kPi)) * pixels_per_degree));
  const auto gaussian = [&](double b) {
    return weights(
        radius, [&](double x) { return std::exp(-kPi * kPi * x * x / (pixels_per_degree * pixels_per_degree * b)); });
  };
  const Weights first = gaussian(eye.b1), second = gaussian(eye.b2);
  const double of_first = eye.a1 * std::sqrt(kPi / eye.b1), of_second = eye.a2 * std::sqrt(kPi / eye.b2);
  const double whole = of_first * std::pow(sum_of(first), 2) + of_second * std::pow(sum_of(second), 2);
  Plane out = filtered(in, first, first);
  for (double& v : out.values) v *= of_first / whole;
  if (of_second == 0) return out;
  const Plane more = filtered(in, second, second);
  for (std::size_t i = 0; i < out.values.size(); ++i) out.values[i] += of_second / whole * more.values[i];
  return out;
}

/// Strength of an edge and of a point at each pixel: lengths of gradients by a Gaussian's first and second derivative
/// (section 4.2). The positive weights of each derivative add up to 1, the negative ones to −1.
struct Features {
  std::vector<double> edges, points;
};

Features features_of(const Plane& luminance, double pixels_per_degree) {
  constexpr double kSeenWidth = 0.082;  // width of a perceived edge, in degrees
  const double deviation = 0.5 * kSeenWidth * pixels_per_degree;
  const auto radius = static_cast<std::ptrdiff_t>(std::ceil(3 * deviation));
  const auto gauss = [&](double x) { return std::exp(-x * x / (2 * deviation * deviation)); };
  const Weights smooth = weights(radius, gauss);
  const Weights first = weights(radius, [&](double x) { return -x * gauss(x); });
  const Weights second = weights(radius, [&](double x) { return (x * x / (deviation * deviation) - 1) * gauss(x); });
  const auto length = [&](Weights derivative) {
    const double positive = sum_of(derivative, 1) * sum_of(smooth), negative = -sum_of(derivative, -1) * sum_of(smooth);
    for (double& w : derivative) w /= w > 0 ? positive : negative;
    const Plane across = filtered(luminance, derivative, smooth), down = filtered(luminance, smooth, derivative);
    std::vector<double> lengths(luminance.values.size());
    for (std::size_t i = 0; i < lengths.size(); ++i) lengths[i] = std::hypot(across.values[i], down.values[i]);
    return lengths;
  };
  return {length(first), length(second)};
}

/// Intermediate results of one picture.
struct Seen {
  std::vector<glm::dvec3> lab;
  Features features;
};

Seen seen(const Image8& picture, double pixels_per_degree) {
  const std::size_t width = picture.width, height = picture.height;
  std::array<Plane, 3> planes;
  planes.fill({width, height, std::vector<double>(picture.pixels.size())});
  Plane luminance = planes[0];
  for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
    glm::dvec3 rgb;
    for (int c = 0; c < 3; ++c) rgb[c] = linear_of_srgb(picture.pixels[i][static_cast<std::size_t>(c)] / 255.0);
    const glm::dvec3 opponent = opponent_of_rgb(rgb);
    for (int c = 0; c < 3; ++c) planes[static_cast<std::size_t>(c)].values[i] = opponent[c];
    luminance.values[i] = (opponent.x + 16) / 116;
  }
  for (std::size_t c = 0; c < planes.size(); ++c) planes[c] = as_seen(planes[c], kSensitivities[c], pixels_per_degree);
  Seen result{std::vector<glm::dvec3>(picture.pixels.size()), features_of(luminance, pixels_per_degree)};
  for (std::size_t i = 0; i < result.lab.size(); ++i) {
    const glm::dvec3 rgb = rgb_of_opponent({planes[0].values[i], planes[1].values[i], planes[2].values[i]});
    result.lab[i] = hunt_lab(glm::clamp(rgb, 0.0, 1.0));
  }
  return result;
}

}  // namespace

std::vector<float> flip_map(const Image8& reference, const Image8& picture, double pixels_per_degree) {
  PENUMBRA_ASSERT(reference.width == picture.width && reference.height == picture.height && !picture.pixels.empty(),
                  "{} x {} and {} x {} pixels", reference.width, reference.height, picture.width, picture.height);
  const Seen a = seen(reference, pixels_per_degree), b = seen(picture, pixels_per_degree);
  std::vector<float> map(a.lab.size());
  for (std::size_t i = 0; i < map.size(); ++i) {
    const double color = redistributed(hyab(a.lab[i], b.lab[i]));
    const double feature = std::sqrt(std::max(std::abs(a.features.edges[i] - b.features.edges[i]),
                                              std::abs(a.features.points[i] - b.features.points[i])) /
                                     std::numbers::sqrt2);
    map[i] = static_cast<float>(std::pow(color, 1 - feature));
  }
  return map;
}

Flip flip_of(const Image8& reference, const Image8& picture) {
  if (reference.pixels == picture.pixels) return {};
  Flip flip;
  for (const float difference : flip_map(reference, picture)) {
    flip.mean += difference;
    flip.max = std::max(flip.max, double{difference});
  }
  flip.mean /= static_cast<double>(picture.pixels.size());
  return flip;
}

}  // namespace penumbra::compare
