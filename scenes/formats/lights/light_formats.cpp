// SPDX-License-Identifier: Apache-2.0
// The table of light formats, and helpers that several shapes share: rims of round lights, and unit directions, which
// stay unchanged if their length is 1 up to rounding.

#include "scenes/formats/lights/light_formats.hpp"

#include "base/assert.hpp"
#include "base/error.hpp"
#include "scenes/formats/checks.hpp"

#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <variant>

namespace penumbra::scenes {
namespace {

/// Formats in the order of LightShape.
constexpr std::array kFormats{&kRectangleFormat, &kDiskFormat, &kEllipseFormat, &kPolygonFormat,
                              &kSphereFormat,    &kSunFormat,  &kDomeFormat,    &kPiecesFormat};
static_assert(kFormats.size() == std::variant_size_v<LightShape>);

const char* key_at(std::size_t index) {
  return index < kLightTraits.size() ? kLightTraits[index].name : "pieces";
}

}  // namespace

const LightFormat& format_of(const LightShape& shape) {
  return *kFormats[shape.index()];
}

const char* key_of(const LightShape& shape) {
  return key_at(shape.index());
}

LightShape read_light_shape(const nlohmann::json& object) {
  for (std::size_t i = 0; i < kFormats.size(); ++i) {
    if (const auto value = object.find(key_at(i)); value != object.end()) return kFormats[i]->read(*value);
  }
  PENUMBRA_ASSERT(false, "a light without a shape has passed the schema: {}", object.dump());
}

void write_light_shape(const LightShape& shape, TextStream& text) {
  text.print(R"("{}": )", key_of(shape));
  format_of(shape).write(shape, text);
}

void check_light_shape(const LightShape& shape, const std::string& where) {
  format_of(shape).check(shape, where);
}

std::vector<glm::dvec3> rim_points(const glm::dvec3& center, const glm::dvec3& u, const glm::dvec3& v) {
  std::vector<glm::dvec3> points;
  for (unsigned i = 0; i < kRimSides; ++i) {
    const double angle = 2 * std::numbers::pi * i / kRimSides;
    points.push_back(center + (std::cos(angle) * u + std::sin(angle) * v));
  }
  return points;
}

glm::dvec3 unit_direction(const glm::dvec3& direction) {
  const double length = glm::length(direction);
  constexpr double kRounding = 4 * std::numeric_limits<double>::epsilon();
  return length == 0 || std::abs(length - 1) <= kRounding ? direction : direction / length;
}

void check_radius(double radius, const std::string& where) {
  if (!std::isfinite(radius) || radius <= 0) {
    throw InputError("{}: the radius is {}; a light needs an area: expected a number above 0", where, radius);
  }
  if (radius > kLargestCoordinate)
    throw InputError("{}: the radius is {}; at most {:g}", where, radius, kLargestCoordinate);
}

}  // namespace penumbra::scenes
