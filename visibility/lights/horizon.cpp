// SPDX-License-Identifier: Apache-2.0
// Condition (1) of the truth of a pair for many light points, in double with an error bound, exact where needed.

#include "visibility/lights/horizon.hpp"

#include "visibility/pair_truth.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace penumbra::visibility {

// The height of l is h = Σ nᵢ (lᵢ − aᵢ), n = u × v; for a direction, Σ nᵢ lᵢ. With δ = 2⁻⁵³ and to first order: the
// differences u, v and l − a are off by a factor 1 ± δ each; nᵢ, a difference of two products, by at most 4δ Nᵢ where
// Nᵢ is the sum of the products' magnitudes; nᵢ (lᵢ − aᵢ) by 6δ Nᵢ |lᵢ − aᵢ|; and the sum of three by 8δ Σ Nᵢ |lᵢ −
// aᵢ|. The bound is twice that, at the largest |lᵢ − aᵢ|. Products of three differences of floats neither overflow nor
// underflow in double.
HorizonTest::HorizonTest(const Light& light, const std::array<glm::vec3, 3>& carrier, std::int8_t facing,
                         const Bounds& bounds)
    : light_(&light), carrier_(carrier), a_(light.sun ? glm::vec3(0) : carrier[0]), facing_(facing) {
  const auto& [lower, upper] = bounds;
  const glm::dvec3 first(carrier[0]), u = glm::dvec3(carrier[1]) - first, v = glm::dvec3(carrier[2]) - first;
  normal_ = glm::cross(u, v) * static_cast<double>(facing);
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    const double size = std::abs(u[j] * v[k]) + std::abs(u[k] * v[j]);
    const double below = lower[i] - a_[i], above = upper[i] - a_[i];
    error_ += 0x1p-49 * size * std::max(std::abs(below), std::abs(above));
    lowest_ += std::min(normal_[i] * below, normal_[i] * above);
    highest_ += std::max(normal_[i] * below, normal_[i] * above);
  }
}

bool HorizonTest::above(const glm::vec3& l) const {
  const double height = glm::dot(normal_, glm::dvec3(l) - a_);
  if (height > error_) return true;
  if (height < -error_) return false;
  return above_horizon(*light_, carrier_, facing_, l);
}

void HorizonTest::mask(std::span<const glm::vec3> points, std::span<std::uint32_t> words) const {
  std::fill(words.begin(), words.end(), 0u);
  if (none_above()) return;
  const bool all = all_above();
  for (std::size_t j = 0; j < points.size(); ++j) {
    if (all || above(points[j])) words[j / 32] |= 1u << (j % 32);
  }
}

}  // namespace penumbra::visibility
