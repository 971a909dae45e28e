// SPDX-License-Identifier: Apache-2.0
// Brightness of the cone of a spot lamp, by quadrature over the lamp's disk for smooth cones.

#include "visibility/light_samples.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace penumbra::visibility {
namespace {

/// The lamp's disk as p sees it, in units of the disk's radius: x toward the cone's axis, y across.
struct FacingDisk {
  double size = 0;    ///< the disk's radius over its distance
  double cosine = 0;  ///< of the angle between the cone's axis and the direction from the disk's middle to p
  double sine = 0;    ///< of the same angle
  double tilt = 0;    ///< growth of p's cosine along x, over its cosine at the middle
  double scale = 1, offset = 0;

  /// Returns the distance of a point from p, over that of the middle.
  [[nodiscard]] double toward(double x, double y) const { return std::sqrt(1 + size * size * (x * x + y * y)); }

  /// Returns the irradiance from the point, over that of full emission at the middle: reduced by the squared distance,
  /// and by the cosines at both ends.
  [[nodiscard]] double share(double x, double y) const {
    const double length = toward(x, y), c = (cosine - size * sine * x) / length;
    const double t = glm::clamp(c * scale + offset, 0.0, 1.0);
    return std::max(1 + tilt * x, 0.0) * c * t * t * (3 - 2 * t) / (length * length * length * length);
  }

  /// Returns the places on the chord at y where the cosine is `wanted`: both solutions, some of which may belong to the
  /// negative cosine; NaN if there is none.
  [[nodiscard]] std::array<double, 2> where(double wanted, double y) const {
    const double a = size * size * (sine * sine - wanted * wanted), b = -size * sine * cosine;
    const double c = cosine * cosine - wanted * wanted * (1 + size * size * y * y);
    const double root = std::sqrt(b * b - a * c), q = -(b + std::copysign(root, b));
    return {q / a, c / q};
  }
};

/// The four points of Gauss–Legendre quadrature on [−1, 1], and their weights.
constexpr std::array<double, 4> kPoints{-0.8611363115940526, -0.3399810435848563, 0.3399810435848563,
                                        0.8611363115940526};
constexpr std::array<double, 4> kWeights{0.3478548451374538, 0.6521451548625461, 0.6521451548625461,
                                         0.3478548451374538};

/// Returns the integral over x within the chord at y, in pieces: it is cut where the cone's soft edge begins and ends.
double over_chord(const FacingDisk& disk, double y, double half) {
  std::array<double, 6> ends{-half, half};
  std::size_t count = 2;
  for (const double t : {0.0, 1.0}) {
    for (const double x : disk.where((t - disk.offset) / disk.scale, y)) {
      if (x > -half && x < half) ends[count++] = x;
    }
  }
  std::sort(ends.begin(), ends.begin() + count);
  double sum = 0;
  for (std::size_t i = 0; i + 1 < count; ++i) {
    const double middle = (ends[i] + ends[i + 1]) / 2, reach = (ends[i + 1] - ends[i]) / 2;
    for (std::size_t j = 0; j < kPoints.size(); ++j)
      sum += reach * kWeights[j] * disk.share(middle + reach * kPoints[j], y);
  }
  return sum;
}

/// Integrates over chords at Chebyshev points of the second kind, symmetric about y = 0: half of them suffice.
double mean_over_chords(const FacingDisk& disk, int chords) {
  double sum = 0;
  for (int i = 0; i < chords; ++i) {
    const double place = std::numbers::pi * (i + 1) / (2 * chords + 1), half = std::sin(place);
    sum += half * over_chord(disk, std::cos(place), half);
  }
  return 2 * sum / (2 * chords + 1);
}

double mean_over(const FacingDisk& disk) {
  // Cosines at the disk's points farthest from the cone's axis and nearest to it: of the middle's angle plus and minus
  // the angle that the disk's radius subtends.
  const double rim = std::sqrt(1 + disk.size * disk.size), along = disk.cosine / rim,
               across = disk.size * disk.sine / rim;
  const double least = along - across, most = disk.sine > disk.size * disk.cosine ? along + across : 1.0;
  const double darkest = least * disk.scale + disk.offset, brightest = most * disk.scale + disk.offset;
  if (brightest <= 0) return 0;
  if (darkest >= 1) {
    // Means of 1 / r⁵ and of x² / r⁵ over the disk, where r is the distance from p to a point of it.
    const double cube = rim * rim * rim, plain = (rim * rim + rim + 1) / (1.5 * cube * (rim + 1));
    const double squared = (2 * rim + 1) / (3 * cube * (rim + 1) * (rim + 1));
    return disk.cosine * plain - disk.tilt * disk.size * disk.sine * squared;
  }
  // If neither the beginning nor the end of the cone's soft edge crosses the disk, the integrand is smooth.
  return mean_over_chords(disk, darkest >= 0 && brightest <= 1 ? 3 : 12);
}

}  // namespace

double spot_share(const Light& light, const glm::vec3& p, const glm::vec3& n) {
  if (!light.spot) return 1;
  const glm::dvec3 toward = glm::dvec3(p) - glm::dvec3(light.center);
  const double length = glm::length(toward);
  if (length == 0) return 0;
  const double cosine = glm::dot(toward, light.spot->direction) / length;
  if (!light.spot->smooth) {
    const double share = glm::clamp(cosine * light.spot->scale + light.spot->offset, 0.0, 1.0);
    return share * share;
  }
  FacingDisk disk{
      .size = light.radius / length, .cosine = cosine, .scale = light.spot->scale, .offset = light.spot->offset};
  // `across` is the component of the lamp's direction orthogonal to the line of sight. Seen from p, the cone's axis
  // lies along −across from the lamp's middle.
  const glm::dvec3 across = light.spot->direction - cosine * toward / length;
  disk.sine = glm::length(across);
  const double facing = -glm::dot(toward, glm::dvec3(n)) / length;
  if (disk.sine > 1e-9 && facing > 0)
    disk.tilt = disk.size * glm::dot(across, glm::dvec3(n)) / disk.sine / std::max(facing, disk.size);
  return mean_over(disk);
}

}  // namespace penumbra::visibility
