#pragma once

#include "mesh/triangle_soup.hpp"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <numbers>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace penumbra::scenes {

/// A picture on surfaces, as its file has it.
struct Picture {
  std::string file;                                 ///< its name, for people
  std::uint32_t width = 0, height = 0;              ///< texels
  std::vector<std::array<std::uint8_t, 4>> texels;  ///< red green blue (sRGB), alpha; row by row from the top left

  bool operator==(const Picture&) const = default;
};

/// How a picture lies on an object; its places are VertexLooks::places.
struct PictureUse {
  enum class Wrap : std::uint8_t { repeat, mirror, clamp };
  std::uint32_t picture = 0;  ///< index into Scene::pictures
  Wrap wrap_s = Wrap::repeat, wrap_t = Wrap::repeat;
  bool nearest = false;  ///< the nearest texel; else bilinear

  bool operator==(const PictureUse&) const = default;
};

/// What lets light through a surface (glTF 2.0, 3.9.4): its alpha is factor × picture × vertices.
struct Alpha {
  enum class Mode : std::uint8_t { opaque, mask, blend };
  Mode mode = Mode::opaque;
  double factor = 1, cutoff = 0.5;

  bool operator==(const Alpha&) const = default;
};

/// One mesh of the scene. Its triangles are those of Scene::soup whose `object` is its index.
struct Object {
  std::string name;
  glm::dvec3 color{0.8};  ///< linear base colour, in [0, 1]; what follows here multiplies it
  bool casts_shadow = true;
  bool receives_shadow = true;
  std::optional<std::uint32_t> emits;  ///< the light (index into Scene::lights) that this mesh is the body of
  std::optional<std::vector<std::uint32_t>> lit_by = {};  ///< by these lights alone (ascending); nothing: by all
  std::string material = {};                              ///< its name; empty: it has none
  std::optional<PictureUse> picture = {};
  Alpha alpha = {};
};

struct Rectangle {
  glm::dvec3 center, half_u, half_v;  ///< emits to the side that half_u × half_v points to
};
struct Disk {
  glm::dvec3 center, normal;  ///< emits to the side of normal (unit length)
  double radius = 0;
};
struct Polygon {
  std::vector<glm::dvec3> vertices;  ///< flat, convex, counter-clockwise seen from the side it emits to
};
/// Of a spot lamp, half angles in degrees, 0 ≤ inner < outer ≤ 90: what is lit is full within `inner` of the direction,
/// dark beyond `outer`, and falls between as visibility::spot_share says.
struct Cone {
  glm::dvec3 direction;  ///< unit length
  double inner = 0, outer = 45;
  bool smooth = false;  ///< falls as Blender's spot lamps do; else as KHR_lights_punctual says
};
struct Sphere {
  glm::dvec3 center;
  double radius = 0;
  std::optional<Cone> cone = {};  ///< none: it shines all around
};
/// The points center + s half_u + t half_v with s² + t² ≤ 1; emits to the side that half_u × half_v points to.
struct Ellipse {
  glm::dvec3 center, half_u, half_v;
};
/// A disk infinitely far away.
struct Sun {
  glm::dvec3 direction;  ///< the way its light travels (unit length)
  double angle = 0;      ///< its full apparent diameter in degrees, 0 ≤ angle < 180; 0: a point
};
/// The irradiance, over the radiance, that a sun gives a surface that faces it: π sin²(angle / 2).
inline double irradiance_of_radiance(const Sun& sun) {
  const double sine = std::sin(sun.angle / 360 * std::numbers::pi);
  return std::numbers::pi * sine * sine;
}
/// The sky: the directions all around, or those with a positive part along `up`. A picture (AreaLight::texture) is
/// latitude-longitude: its top row is `up`, its middle column looks along −Z, turned about `up` by `rotate`, and to the
/// right of that lies +X. (For another `up` than +Y the shortest turn takes +Y there, and −Z and +X along.)
struct Dome {
  glm::dvec3 up{0, 1, 0};  ///< unit length
  double rotate = 0;       ///< degrees, right-handed about `up`
  bool half = false;
  std::string image = {};  ///< the picture's file as the scene names it; empty: one radiance everywhere
};
/// Several that are one light: an emitter that turns corners or lies apart, cut up.
struct Pieces {
  using Piece = std::variant<Rectangle, Polygon, Sphere>;
  std::vector<Piece> pieces;  ///< at least one; no cones
};
/// In the order of LightKind (scenes/light_kind.hpp); Pieces, which are of several kinds, last.
using LightShape = std::variant<Rectangle, Disk, Ellipse, Polygon, Sphere, Sun, Dome, Pieces>;

/// A picture on a rectangle light. It stands upright and unmirrored before who looks at the side that emits, half_u to
/// the right and half_v upward: texel (0, 0), the picture's top left, lies in the corner −half_u + half_v. Each texel
/// is constant over its cell; nothing is filtered. Of a dome: see there.
struct Texture {
  std::string file;                     ///< its name, for people
  std::uint32_t width = 0, height = 0;  ///< texels
  std::vector<glm::vec3> texels;        ///< linear red green blue, row by row from the top left
};

/// An area light in world space: of constant radiance, or with a texture that multiplies it.
struct AreaLight {
  std::string name;
  LightShape shape;
  glm::dvec3 radiance{10.0};  ///< of a sun of angle 0, which has none: irradiance of what faces it
  bool two_sided = false;
  std::optional<Texture> texture = {};          ///< of a rectangle or a dome only
  std::vector<std::uint32_t> unshaded_by = {};  ///< objects (ascending) that cast no shadow of this light
  bool visible = false;                         ///< of a dome: the background of pictures shows it
};

struct Camera {
  std::string name;
  glm::dvec3 eye{0}, target{0}, up{0, 1, 0};
  double vertical_fov = 45;           ///< degrees
  std::optional<double> height = {};  ///< of an orthographic camera: the picture's in world units, in place of an angle
  std::optional<double> aspect = {};  ///< the picture's width over its height, if the file says so
  /// A shifted lens: where the picture's middle is, right of and above what the camera looks at, in heights of the
  /// picture. What is seen is moved, not turned.
  glm::dvec2 shift{0};
};

/// What a file says of vertices beside where they are. Each list is empty, or as long as the soup's positions.
struct VertexLooks {
  std::vector<glm::vec3> normals;  ///< unit, world space; 0 where the surface has none but its triangles'
  std::vector<glm::vec4> colors;   ///< linear red green blue and alpha
  std::vector<glm::dvec2> places;  ///< in the object's picture, (0, 0) its top left, (1, 1) its bottom right
};

/// When a scene moves: its first and last key, in seconds.
struct Motion {
  double first = 0, last = 0;
};

/// A scene as the program understood it: world space, double precision, right-handed, Y up.
struct Scene {
  std::string name;                         ///< the file's name without folder
  std::uint32_t width = 512, height = 512;  ///< pixels
  mesh::TriangleSoup soup;                  ///< world space; triangle order is that of `convert`'s output
  VertexLooks looks = {};
  std::vector<Object> objects;
  std::vector<Picture> pictures = {};          ///< of objects
  std::vector<AreaLight> lights;               ///< at least one; names are unique
  std::vector<Camera> cameras;                 ///< at least one
  std::vector<std::filesystem::path> sources;  ///< all files that were opened for the scene, its own included
  /// The centre of the bounding box of all vertices as they rest, before anything moves or bends them; nothing: that of
  /// the soup.
  std::optional<glm::dvec3> origin = {};
  std::optional<Motion> motion = {};  ///< nothing: it stands still
  std::vector<std::string> warnings;  ///< what was skipped or changed on the way, each with its place and count
};

}  // namespace penumbra::scenes
