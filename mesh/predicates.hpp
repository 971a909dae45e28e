#pragma once

#include <glm/vec3.hpp>

#include <array>
#include <span>

/// Signs of polynomials in coordinates, exact for every finite input (CGAL's filtered kernel: floating point where its
/// error bound suffices, exact numbers where not). Every topological decision goes through here; no epsilon does.
namespace penumbra::mesh {

/// Three outcomes. A tie is read in one documented way everywhere: a triangle whose plane contains the point p
/// is seen edge-on from p, counts 0 on all three of its edges, and is not met (docs/definitions.md, "Truth of a pair").
enum class Side { back = -1, on = 0, front = 1 };

constexpr Side opposite(Side side) {
  return static_cast<Side>(-static_cast<int>(side));
}

/// Which side of the plane (a, b, c) p is on; front is where (b − a) × (c − a) points, from where a, b, c run counter-
/// clockwise. Never replace by `dot(n, p - a) > 0`: neighbouring faces would disagree about a shared edge and the
/// silhouette would not close.
Side side_of_plane(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& p);
Side side_of_plane(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, const glm::vec3& p);

/// Which side of the plane (a, b, c) the direction d points to: the sign of det(b − a, c − a, d); `on`: along the
/// plane.
Side side_of_direction(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, const glm::vec3& d);

/// Do the three points lie on a line (a triangle of zero area)?
bool collinear(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c);
bool collinear(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c);

/// −1, 0, 1: an order of the lines through v and p, and through v and q (p, q ≠ v); 0 exactly if they are one line.
int compare_lines(const glm::dvec3& v, const glm::dvec3& p, const glm::dvec3& q);

/// Is every corner of `other` on the plane of `carrier`? (Neither of zero area.)
bool coplanar(const std::array<glm::vec3, 3>& carrier, const std::array<glm::vec3, 3>& other);

/// The sign of x₀ y₀ + x₁ y₁ + …, for as many finite numbers on either side.
int sign_of_products(std::span<const double> x, std::span<const double> y);

}  // namespace penumbra::mesh
