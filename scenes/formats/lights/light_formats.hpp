#pragma once

#include "scenes/formats/writers.hpp"
#include "scenes/light_kind.hpp"

#include <nlohmann/json_fwd.hpp>

#include <optional>
#include <string>
#include <utility>
#include <vector>

/// How files have lights: one row a shape, each in a file of its own. Internal to scenes/.
namespace penumbra::scenes {

/// A lamp of KHR_lights_punctual; its size goes into the extras.
struct GltfLamp {
  const char* type;
  glm::dvec3 direction{0, 0, -1}, position{0};
  double intensity = 1;  ///< over radiance
  std::pair<const char*, double> size;
  std::optional<Cone> cone = {};
};

struct LightFormat {
  /// JSON: the value of the shape's key, which the schema has passed; and back.
  LightShape (*read)(const nlohmann::json& value);
  void (*write)(const LightShape& shape, TextStream& text);
  /// What must hold of the shape whatever file it came from (checks.hpp). `where` begins the message.
  void (*check)(const LightShape& shape, const std::string& where);
  /// What a reader of the shape warns of; empty: nothing. null: never anything.
  std::string (*hint)(const LightShape& shape) = nullptr;
  /// glTF: corners of the flat mesh that stands for the shape, counter-clockwise seen from where it emits. null: there
  /// is none.
  std::vector<glm::dvec3> (*outline)(const LightShape& shape) = nullptr;
  /// glTF: the lamp that it is. null: it is none.
  GltfLamp (*lamp)(const LightShape& shape) = nullptr;
};

const LightFormat& format_of(const LightShape& shape);
/// The key of the shape in scene files: the name of its kind, or "pieces".
const char* key_of(const LightShape& shape);

/// The shape whose key the object has: that of a light, or of a piece of one.
LightShape read_light_shape(const nlohmann::json& object);
/// `"key": value`
void write_light_shape(const LightShape& shape, TextStream& text);
void check_light_shape(const LightShape& shape, const std::string& where);

/// Sides of what stands for a round light in glTF.
inline constexpr unsigned kRimSides = 64;
std::vector<glm::dvec3> rim_points(const glm::dvec3& center, const glm::dvec3& u, const glm::dvec3& v);

/// Unit length; what already is, to rounding, stays as it is, so that writing and reading change nothing.
glm::dvec3 unit_direction(const glm::dvec3& direction);

void check_radius(double radius, const std::string& where);

// The rows.
extern const LightFormat kRectangleFormat, kDiskFormat, kEllipseFormat, kPolygonFormat, kSphereFormat, kSunFormat,
    kDomeFormat, kPiecesFormat;

}  // namespace penumbra::scenes
