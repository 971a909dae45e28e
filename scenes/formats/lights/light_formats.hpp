// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/formats/writers.hpp"
#include "scenes/light_kind.hpp"

#include <nlohmann/json_fwd.hpp>

#include <optional>
#include <string>
#include <utility>
#include <vector>

/// File formats of lights: one row for each shape, each in its own file. Internal to scenes/.
namespace penumbra::scenes {

/// A lamp of KHR_lights_punctual; its size is stored in the extras.
struct GltfLamp {
  const char* type;
  glm::dvec3 direction{0, 0, -1}, position{0};
  double intensity = 1;  ///< the lamp's intensity divided by the light's radiance
  std::pair<const char*, double> size;
  std::optional<Cone> cone = {};
};

struct LightFormat {
  /// JSON: reads and writes the value of the shape's key. The value must have passed the schema.
  LightShape (*read)(const nlohmann::json& value);
  void (*write)(const LightShape& shape, TextStream& text);
  /// Checks requirements on the shape that hold for every file format (checks.hpp). `where` begins the message.
  void (*check)(const LightShape& shape, const std::string& where);
  /// Returns a reader's warning about the shape, or an empty text; null if there never is one.
  std::string (*hint)(const LightShape& shape) = nullptr;
  /// glTF: returns the corners of the flat mesh that represents the shape, counter-clockwise as seen from the emitting
  /// side; null if there is none.
  std::vector<glm::dvec3> (*outline)(const LightShape& shape) = nullptr;
  /// glTF: returns the equivalent lamp; null if there is none.
  GltfLamp (*lamp)(const LightShape& shape) = nullptr;
};

const LightFormat& format_of(const LightShape& shape);
/// Returns the key of the shape in scene files: the name of its kind, or "pieces".
const char* key_of(const LightShape& shape);

/// Reads the shape of a light, or of a piece of one, under whichever key `object` has.
LightShape read_light_shape(const nlohmann::json& object);
/// Writes `"key": value`.
void write_light_shape(const LightShape& shape, TextStream& text);
void check_light_shape(const LightShape& shape, const std::string& where);

/// Sides of the polygon that represents a round light in glTF.
inline constexpr unsigned kRimSides = 64;
std::vector<glm::dvec3> rim_points(const glm::dvec3& center, const glm::dvec3& u, const glm::dvec3& v);

/// Returns the direction with unit length; one that has unit length up to rounding stays unchanged, so that writing and
/// reading change nothing.
glm::dvec3 unit_direction(const glm::dvec3& direction);

void check_radius(double radius, const std::string& where);

// Rows of the table.
extern const LightFormat kRectangleFormat, kDiskFormat, kEllipseFormat, kPolygonFormat, kSphereFormat, kSunFormat,
    kDomeFormat, kPiecesFormat;

}  // namespace penumbra::scenes
