// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cmath>
#include <span>

/// Signs of polynomials in coordinates, exact for every finite input (CGAL's filtered kernel: floating point where its
/// error bound suffices, exact numbers elsewhere). Every topological decision uses these functions; none uses an
/// epsilon.
namespace penumbra::mesh {

/// Side of a plane that a point is on. A tie has one documented meaning everywhere: a triangle whose plane contains the
/// point p is seen edge-on from p, counts 0 on all three of its edges, and is not met (docs/definitions.md, "Truth of a
/// pair").
enum class Side { back = -1, on = 0, front = 1 };

constexpr Side opposite(Side side) {
  return static_cast<Side>(-static_cast<int>(side));
}

/// Returns the side of the plane (a, b, c) that p is on; front is the side that (b − a) × (c − a) points to, from which
/// a, b, c run counter-clockwise. Never replace by `dot(n, p - a) > 0`: neighbouring faces would disagree about a
/// shared edge and the silhouette would not close.
Side side_of_plane(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& p);
Side side_of_plane(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, const glm::vec3& p);

/// Equals side_of_plane() for one plane and many points: the plane's terms are computed once, and where rounding in
/// double cannot change the sign, a side costs only a few products.
class SidesOfPlane {
 public:
  SidesOfPlane(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) : corners_{a, b, c} {
    const glm::dvec3 u = b - a, v = c - a, wide_u = glm::abs(u), wide_v = glm::abs(v);
    normal_ = glm::cross(u, v);
    size_ = {wide_u.y * wide_v.z + wide_u.z * wide_v.y, wide_u.z * wide_v.x + wide_u.x * wide_v.z,
             wide_u.x * wide_v.y + wide_u.y * wide_v.x};
  }

  /// Returns (b − a) × (c − a), rounded.
  [[nodiscard]] const glm::dvec3& normal() const { return normal_; }
  [[nodiscard]] Side operator()(const glm::dvec3& p) const {
    const glm::dvec3 d = p - corners_[0];
    const double value = normal_.x * d.x + normal_.y * d.y + normal_.z * d.z;
    const glm::dvec3 wide = glm::abs(d);
    const double size = size_.x * wide.x + size_.y * wide.y + size_.z * wide.z;
    // Relative to `size`: two differences, their product, the difference of two products, d, three products and two
    // sums round by 2⁻⁵³ each, eight in all; the bound is twice that. Where numbers are subnormal, each product loses
    // up to 2⁻¹⁰⁷⁴.
    const double error = 0x1p-49 * size + 0x1p-1000 * (wide.x + wide.y + wide.z + 1);
    if (!(std::abs(value) > error)) return side_of_plane(corners_[0], corners_[1], corners_[2], p);
    return value > 0 ? Side::front : Side::back;
  }

 private:
  std::array<glm::dvec3, 3> corners_;
  glm::dvec3 normal_, size_;  // size_: the sums of the absolute values of the normal's terms
};

/// Returns the side of the plane (a, b, c) that the direction d points to: the sign of det(b − a, c − a, d); `on` means
/// along the plane.
Side side_of_direction(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, const glm::vec3& d);

/// Returns whether the three points lie on a line (a triangle of zero area).
bool collinear(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c);
bool collinear(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c);

/// Returns −1, 0 or 1: an order of the lines through v and p, and through v and q (p, q ≠ v); 0 exactly if they are one
/// line.
int compare_lines(const glm::dvec3& v, const glm::dvec3& p, const glm::dvec3& q);

/// Returns whether every corner of `other` is on the plane of `carrier`. (Neither may have zero area.)
bool coplanar(const std::array<glm::vec3, 3>& carrier, const std::array<glm::vec3, 3>& other);

/// Returns the sign of x₀ y₀ + x₁ y₁ + … of finite numbers; x and y have the same size.
int sign_of_products(std::span<const double> x, std::span<const double> y);

}  // namespace penumbra::mesh
