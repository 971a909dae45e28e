// SPDX-License-Identifier: Apache-2.0
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

/// A picture on surfaces, as stored in its file.
struct Picture {
  std::string file;                                 ///< file name, for messages
  std::uint32_t width = 0, height = 0;              ///< texels
  std::vector<std::array<std::uint8_t, 4>> texels;  ///< red green blue (sRGB), alpha; row by row from the top left

  bool operator==(const Picture&) const = default;
};

/// Mapping of a picture on an object; its coordinates are VertexLooks::places.
struct PictureUse {
  enum class Wrap : std::uint8_t { repeat, mirror, clamp };
  std::uint32_t picture = 0;  ///< index into Scene::pictures
  Wrap wrap_s = Wrap::repeat, wrap_t = Wrap::repeat;
  bool nearest = false;  ///< uses the nearest texel; else bilinear

  bool operator==(const PictureUse&) const = default;
};

/// Transparency of a surface (glTF 2.0, 3.9.4): its alpha is factor × picture × vertices.
struct Alpha {
  enum class Mode : std::uint8_t { opaque, mask, blend };
  Mode mode = Mode::opaque;
  double factor = 1, cutoff = 0.5;

  bool operator==(const Alpha&) const = default;
};

/// One mesh of the scene. Its triangles are those of Scene::soup whose `object` is its index.
struct Object {
  std::string name;
  glm::dvec3 color{0.8};  ///< linear base colour, in [0, 1]; picture and vertex colours multiply it
  bool casts_shadow = true;
  bool receives_shadow = true;
  std::optional<std::uint32_t> emits;  ///< index into Scene::lights of the light whose body this mesh is
  std::optional<std::vector<std::uint32_t>> lit_by = {};  ///< indices of the only lights that light it (ascending);
                                                          ///< nullopt: all lights do
  std::string material = {};                              ///< name of the material; empty if it has none
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
/// Cone of a spot lamp, half angles in degrees, 0 ≤ inner < outer ≤ 90: full intensity within `inner` of the direction,
/// dark beyond `outer`, between them as visibility::spot_share defines.
struct Cone {
  glm::dvec3 direction;  ///< unit length
  double inner = 0, outer = 45;
  bool smooth = false;  ///< falls off as Blender's spot lamps do; else as in KHR_lights_punctual
};
struct Sphere {
  glm::dvec3 center;
  double radius = 0;
  std::optional<Cone> cone = {};  ///< nullopt: shines in all directions
};
/// The points center + s half_u + t half_v with s² + t² ≤ 1; emits to the side that half_u × half_v points to.
struct Ellipse {
  glm::dvec3 center, half_u, half_v;
};
/// A disk infinitely far away.
struct Sun {
  glm::dvec3 direction;  ///< direction in which its light travels (unit length)
  double angle = 0;      ///< full apparent diameter in degrees, 0 ≤ angle < 180; 0: a point
};
/// Returns the irradiance of a surface that faces the sun, divided by the sun's radiance: π sin²(angle / 2).
inline double irradiance_of_radiance(const Sun& sun) {
  const double sine = std::sin(sun.angle / 360 * std::numbers::pi);
  return std::numbers::pi * sine * sine;
}
/// The sky: all directions, or those with a positive component along `up`. A picture (AreaLight::texture) is
/// latitude-longitude: its top row is `up`, its middle column points along −Z, rotated about `up` by `rotate`, and +X
/// lies to the right of that. (An `up` other than +Y is reached by the smallest rotation of +Y, which also rotates −Z
/// and +X.)
struct Dome {
  glm::dvec3 up{0, 1, 0};  ///< unit length
  double rotate = 0;       ///< degrees, right-handed about `up`
  bool half = false;
  bool sampled = false;    ///< uses light samples where a method could also compute exact areas
  std::string image = {};  ///< file name of the picture in the scene; empty: constant radiance
};
/// Several pieces that form one light: an emitter with bends or separate parts, cut into pieces.
struct Pieces {
  using Piece = std::variant<Rectangle, Polygon, Sphere>;
  std::vector<Piece> pieces;  ///< at least one; no cones
};
/// Shapes in the order of LightKind (scenes/light_kind.hpp); Pieces, which mix kinds, last.
using LightShape = std::variant<Rectangle, Disk, Ellipse, Polygon, Sphere, Sun, Dome, Pieces>;

/// A picture on a rectangle light. Upright and unmirrored for a viewer of the emitting side, half_u to the right and
/// half_v upward: texel (0, 0), the picture's top left, lies in the corner −half_u + half_v. Each texel is constant
/// over its cell; nothing is filtered. For a dome see Dome.
struct Texture {
  std::string file;                     ///< file name, for messages
  std::uint32_t width = 0, height = 0;  ///< texels
  std::vector<glm::vec3> texels;        ///< linear red green blue, row by row from the top left
};

/// An area light in world space: of constant radiance, or with a texture that multiplies it.
struct AreaLight {
  std::string name;
  LightShape shape;
  glm::dvec3 radiance{10.0};  ///< for a sun of angle 0, which has no radiance: irradiance of a surface that faces it
  bool two_sided = false;
  std::optional<Texture> texture = {};          ///< for a rectangle or a dome only
  std::vector<std::uint32_t> unshaded_by = {};  ///< objects (ascending) that cast no shadow for this light
  bool visible = false;                         ///< for a dome: visible as the background of pictures
};

/// A lens that is a disk at right angles to the view axis, around the camera's eye: a point that is not at the focus
/// distance along that axis is seen as a circle.
struct ThinLens {
  double radius = 0;          ///< above 0, in the scene's unit
  double focus_distance = 1;  ///< above 0, along the view axis
  bool operator==(const ThinLens&) const = default;
};

struct Camera {
  std::string name;
  glm::dvec3 eye{0}, target{0}, up{0, 1, 0};
  double vertical_fov = 45;           ///< degrees
  std::optional<double> height = {};  ///< for an orthographic camera: height of the picture in world units, in place of
                                      ///< an angle
  std::optional<double> aspect = {};  ///< the picture's width divided by its height, if the file has one
  /// A shifted lens: position of the picture's centre, right of and above the point that the camera looks at, in
  /// picture heights. The view is shifted, not rotated.
  glm::dvec2 shift{0};
  std::optional<ThinLens> lens = {};  ///< nullopt: everything is sharp
};

/// Vertex attributes other than positions. Each list is empty, or as long as the soup's positions.
struct VertexLooks {
  std::vector<glm::vec3> normals;  ///< unit, world space; 0 where the surface has only its triangles' normals
  std::vector<glm::vec4> colors;   ///< linear red green blue and alpha
  std::vector<glm::dvec2> places;  ///< coordinates in the object's picture, (0, 0) its top left, (1, 1) its bottom
                                   ///< right
};

/// Time span of a scene's animation: its first and last key, in seconds.
struct Motion {
  double first = 0, last = 0;
};

/// A complete scene: world space, double precision, right-handed, Y up.
struct Scene {
  std::string name;                         ///< the file's name without folder
  std::uint32_t width = 512, height = 512;  ///< pixels
  mesh::TriangleSoup soup;                  ///< world space; triangle order is that of `convert`'s output
  VertexLooks looks = {};
  std::vector<Object> objects;
  std::vector<Picture> pictures = {};          ///< pictures of objects
  std::vector<AreaLight> lights;               ///< at least one; names are unique
  std::vector<Camera> cameras;                 ///< at least one
  std::vector<std::filesystem::path> sources;  ///< all files opened for the scene, including its own
  /// Centre of the bounding box of all vertices at rest, before anything moves or bends them; nullopt: that of the
  /// soup.
  std::optional<glm::dvec3> origin = {};
  std::optional<Motion> motion = {};  ///< nullopt: the scene does not move
  std::vector<std::string> warnings;  ///< parts skipped or changed, each with its place and count
};

}  // namespace penumbra::scenes
