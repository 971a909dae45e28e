#include "mesh/predicates.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

namespace penumbra::mesh {
namespace {

using Point = CGAL::Exact_predicates_inexact_constructions_kernel::Point_3;

template <typename Vector>
Point point(const Vector& v) {
  return {v.x, v.y, v.z};  // a float is a double is a number
}

template <typename Vector>
Side side(const Vector& a, const Vector& b, const Vector& c, const Vector& p) {
  return static_cast<Side>(CGAL::orientation(point(a), point(b), point(c), point(p)));
}

}  // namespace

Side side_of_plane(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& p) {
  return side(a, b, c, p);
}

Side side_of_plane(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, const glm::vec3& p) {
  return side(a, b, c, p);
}

bool collinear(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  return CGAL::collinear(point(a), point(b), point(c));
}

bool collinear(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
  return CGAL::collinear(point(a), point(b), point(c));
}

bool coplanar(const std::array<glm::vec3, 3>& carrier, const std::array<glm::vec3, 3>& other) {
  for (const glm::vec3& corner : other) {
    if (side_of_plane(carrier[0], carrier[1], carrier[2], corner) != Side::on) return false;
  }
  return true;
}

}  // namespace penumbra::mesh
