// SPDX-License-Identifier: Apache-2.0
// Cones of normals of edge records, on vector units, and their unions.

#include "volumes/edges/normal_cones.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "volumes/edges/normal_cones.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
#include <hwy/highway.h>

#ifndef PENUMBRA_VOLUMES_EDGES_NORMAL_CONES_CPP  // once, not once for each target
#define PENUMBRA_VOLUMES_EDGES_NORMAL_CONES_CPP
namespace penumbra::volumes {
namespace {

constexpr std::size_t kWidth = visibility::TriangleTree::kWidth;
constexpr NormalCone kAllDirections{{0, 0, 0}, 0};
constexpr double kWidest = 1.57;  // in radians; a cone of nearly a half-space excludes nothing

const double kLeastCosine = std::cos(kWidest);

NormalCone unless_wide(const NormalCone& cone) {
  return cone.cosine <= kLeastCosine ? kAllDirections : cone;
}

/// The mean of directions, each reversed if it opposes the sum of the previous ones. The axis is 0 if there is no mean.
class Middle {
 public:
  /// Adds a direction. Returns false if it was reversed.
  bool add(const glm::dvec3& one) {
    const bool turn = glm::dot(sum_, one) < 0;
    sum_ = turn ? sum_ - one : sum_ + one;
    return !turn;
  }
  [[nodiscard]] glm::dvec3 axis() const {
    const double length = glm::length(sum_);
    return length > 0 ? sum_ / length : glm::dvec3(0);
  }

 private:
  glm::dvec3 sum_{0};
};

}  // namespace
}  // namespace penumbra::volumes
#endif

HWY_BEFORE_NAMESPACE();
namespace penumbra::volumes::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using D = hn::CappedTag<double, kWidth>;

/// One direction for each record.
struct Directions {
  HWY_ALIGN std::array<std::array<double, kWidth>, 3> of;

  [[nodiscard]] glm::dvec3 operator[](std::size_t i) const { return {of[0][i], of[1][i], of[2][i]}; }

  /// Normalises to unit length, as glm::normalize does.
  void normalise() {
    const D d;
    for (std::size_t i = 0; i < kWidth; i += hn::Lanes(d)) {
      const auto x = hn::Load(d, &of[0][i]), y = hn::Load(d, &of[1][i]), z = hn::Load(d, &of[2][i]);
      const auto squared = hn::Add(hn::Add(hn::Mul(x, x), hn::Mul(y, y)), hn::Mul(z, z));
      const auto inverse = hn::Div(hn::Set(d, 1), hn::Sqrt(squared));
      hn::Store(hn::Mul(x, inverse), d, &of[0][i]);
      hn::Store(hn::Mul(y, inverse), d, &of[1][i]);
      hn::Store(hn::Mul(z, inverse), d, &of[2][i]);
    }
  }
  /// Returns the dot products with the axis, each multiplied by its sign in `signs`.
  [[nodiscard]] hn::Vec<D> cosines(const glm::dvec3& axis, const double* signs, std::size_t i) const {
    const D d;
    const auto part = [&](int k) {
      return hn::Mul(hn::Set(d, axis[k]), hn::Load(d, &of[static_cast<std::size_t>(k)][i]));
    };
    return hn::Mul(hn::Load(d, signs + i), hn::Add(hn::Add(part(0), part(1)), part(2)));
  }
};

/// The second normal of each record is oriented so that k_e = 0 where p is on the same side of both.
NormalCone cone_of_records(const LeafNormals& records) {
  if (records.count == 0) return {};
  std::array<Directions, 2> n;
  for (std::size_t i = 0; i < kWidth; ++i) {  // the first record fills the unused lanes, which changes nothing
    const auto& sides = records.n[i < records.count ? i : 0];
    if (sides[0] == glm::vec3(0) || sides[1] == glm::vec3(0)) return kAllDirections;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      n[0].of[axis][i] = static_cast<double>(sides[0][static_cast<int>(axis)]);
      n[1].of[axis][i] = -static_cast<double>(sides[1][static_cast<int>(axis)]);
    }
  }
  for (Directions& side : n) side.normalise();
  HWY_ALIGN std::array<double, kWidth> signs;
  Middle middle;
  for (std::size_t i = 0; i < records.count; ++i) signs[i] = middle.add(n[0][i] + n[1][i]) ? 1 : -1;
  std::fill(signs.begin() + static_cast<std::ptrdiff_t>(records.count), signs.end(), signs[0]);
  const glm::dvec3 axis = middle.axis();
  const D d;
  auto least = hn::Set(d, 1);
  for (std::size_t i = 0; i < kWidth; i += hn::Lanes(d)) {
    for (const Directions& side : n) least = hn::Min(least, side.cosines(axis, signs.data(), i));
  }
  return unless_wide({axis, hn::GetLane(hn::MinOfLanes(d, least))});
}

}  // namespace
}  // namespace penumbra::volumes::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace penumbra::volumes {

HWY_EXPORT(cone_of_records);

NormalCone cone_of(const LeafNormals& records) {
  return HWY_DYNAMIC_DISPATCH(cone_of_records)(records);
}

NormalCone joined(std::span<const NormalCone> cones) {
  std::array<glm::dvec3, kWidth> axes;
  Middle middle;
  for (std::size_t i = 0; i < cones.size(); ++i) {
    if (cones[i].is_all()) return kAllDirections;
    axes[i] = middle.add(cones[i].axis) ? cones[i].axis : -cones[i].axis;
  }
  NormalCone all{middle.axis(), 1};
  for (std::size_t i = 0; i < cones.size(); ++i) {
    const double between = glm::dot(all.axis, axes[i]), own = cones[i].cosine;
    if (between <= 0) return kAllDirections;
    // Both angles are below 90 degrees: this is the cosine of their sum.
    const auto sine = [](double cosine) { return std::sqrt(std::max(1 - cosine * cosine, 0.0)); };
    all.cosine = std::min(all.cosine, between * own - sine(between) * sine(own));
  }
  return unless_wide(all);
}

}  // namespace penumbra::volumes
#endif
