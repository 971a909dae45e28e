// SPDX-License-Identifier: Apache-2.0
// Converts shapes of lights between the public interface and scenes/.

#include "library/light_shape.hpp"

#include "base/error.hpp"

#include <glm/geometric.hpp>

#include <cmath>
#include <variant>

namespace penumbra {
namespace {

/// Returns the unit vector; throws InputError for a vector of length 0.
glm::dvec3 unit(const Vector& v, const char* what) {
  const double length = glm::length(to_glm(v));
  if (!(length > 0) || !std::isfinite(length))
    throw InputError("{} ({}, {}, {}): expected finite numbers that are not all 0", what, v[0], v[1], v[2]);
  return to_glm(v) / length;
}

}  // namespace

scenes::LightShape to_scene(const LightShape& shape) {
  struct Convert {
    scenes::LightShape operator()(const Rectangle& r) const {
      return scenes::Rectangle{to_glm(r.center), to_glm(r.half_u), to_glm(r.half_v)};
    }
    scenes::LightShape operator()(const Disk& d) const {
      return scenes::Disk{to_glm(d.center), unit(d.normal, "normal of a disk"), d.radius};
    }
    scenes::LightShape operator()(const Ellipse& e) const {
      return scenes::Ellipse{to_glm(e.center), to_glm(e.half_u), to_glm(e.half_v)};
    }
    scenes::LightShape operator()(const Polygon& p) const {
      scenes::Polygon polygon;
      for (const Vector& vertex : p.vertices) polygon.vertices.push_back(to_glm(vertex));
      return polygon;
    }
    scenes::LightShape operator()(const Sphere& s) const { return scenes::Sphere{to_glm(s.center), s.radius}; }
    scenes::LightShape operator()(const Sun& s) const {
      return scenes::Sun{unit(s.direction, "direction of a sun"), s.angle};
    }
    scenes::LightShape operator()(const Dome& d) const {
      return scenes::Dome{unit(d.up, "up of a dome"), d.rotate, d.half, d.sampled, d.image.string()};
    }
  };
  return std::visit(Convert(), shape);
}

std::optional<LightShape> from_scene(const scenes::LightShape& shape) {
  struct Convert {
    std::optional<LightShape> operator()(const scenes::Rectangle& r) const {
      return Rectangle{from_glm(r.center), from_glm(r.half_u), from_glm(r.half_v)};
    }
    std::optional<LightShape> operator()(const scenes::Disk& d) const {
      return Disk{from_glm(d.center), from_glm(d.normal), d.radius};
    }
    std::optional<LightShape> operator()(const scenes::Ellipse& e) const {
      return Ellipse{from_glm(e.center), from_glm(e.half_u), from_glm(e.half_v)};
    }
    std::optional<LightShape> operator()(const scenes::Polygon& p) const {
      Polygon polygon;
      for (const glm::dvec3& vertex : p.vertices) polygon.vertices.push_back(from_glm(vertex));
      return polygon;
    }
    std::optional<LightShape> operator()(const scenes::Sphere& s) const { return Sphere{from_glm(s.center), s.radius}; }
    std::optional<LightShape> operator()(const scenes::Sun& s) const { return Sun{from_glm(s.direction), s.angle}; }
    std::optional<LightShape> operator()(const scenes::Dome& d) const {
      return Dome{from_glm(d.up), d.rotate, d.half, d.image, d.sampled};
    }
    std::optional<LightShape> operator()(const scenes::Pieces&) const { return std::nullopt; }
  };
  return std::visit(Convert(), shape);
}

}  // namespace penumbra
