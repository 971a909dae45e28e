#pragma once

#include <penumbra/export.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace penumbra {

/// A point or direction x, y, z in world space: the scene's unit of length, right-handed, Y up (as glTF 2.0).
using Vector = std::array<double, 3>;
/// A 4x4 matrix row by row, for column vectors: elements 3, 7 and 11 are the translation.
using Matrix = std::array<double, 16>;

/// The points center + s·half_u + t·half_v with |s|, |t| <= 1; emits to the side that half_u × half_v points to.
struct Rectangle {
  Vector center{}, half_u{}, half_v{};
};
/// Emits to the side of `normal`, which need not have unit length.
struct Disk {
  Vector center{}, normal{0, -1, 0};
  double radius = 0;
};
/// The points center + s·half_u + t·half_v with s² + t² <= 1; emits to the side that half_u × half_v points to.
struct Ellipse {
  Vector center{}, half_u{}, half_v{};
};
/// Flat and convex, counter-clockwise seen from the side that it emits to.
struct Polygon {
  std::vector<Vector> vertices;
};
struct Sphere {
  Vector center{};
  double radius = 0;
};
/// A disk infinitely far away. `direction`: in which its light travels, of any length. `angle`: the full apparent
/// diameter in degrees, 0 <= angle < 180; 0 casts hard shadows.
struct Sun {
  Vector direction{0, -1, 0};
  double angle = 0.53;
};
/// The sky: directions all around, or with `half` those with a positive part along `up`, of one radiance or of a
/// latitude-longitude picture that multiplies it.
struct Dome {
  Vector up{0, 1, 0};
  double rotate = 0;  ///< degrees about `up`: where the picture's middle column, by default along -z, looks
  bool half = false;
  std::filesystem::path image = {};  ///< Radiance (.hdr), OpenEXR or PNG; empty: one radiance everywhere
};
using LightShape = std::variant<Rectangle, Disk, Ellipse, Polygon, Sphere, Sun, Dome>;

struct LightOptions {
  Vector radiance{10, 10, 10};  ///< linear red green blue; of a sun of angle 0 the irradiance of what faces it
  bool two_sided = false;       ///< of flat lights: emits to both sides
};

struct Camera {
  Vector eye{}, target{0, 0, -1}, up{0, 1, 0};
  double vertical_fov = 45;           ///< degrees
  std::optional<double> height = {};  ///< of an orthographic camera: the picture's height, in place of an angle
  std::string name = "camera";
};

struct MeshOptions {
  Vector color{0.8, 0.8, 0.8};  ///< linear base colour, 0 to 1
  bool casts_shadow = true, receives_shadow = true;
};

/// How a file is read. Where a number is not set, the file's own holds, or the default of the command line.
struct LoadOptions {
  bool lenient = false;              ///< leave out, with a warning, what would change a shadow and cannot be done
  bool allow_outside = false;        ///< let the scene name files outside its folder
  std::optional<double> frame = {};  ///< of the file's animation; without it the scene is at rest
  double fps = 24;                   ///< frame F is at F / fps seconds
  std::optional<double> lamp_radius = {}, sun_angle = {}, lumens_per_watt = {};  ///< of glTF lamps without their own
  std::vector<std::string> clips = {};  ///< of glTF: animations by name or number; empty: all that can play at once
  bool studio = false;                  ///< a light and a floor also around a scene that has lights
};

/// One mesh of one scene.
struct MeshId {
  std::uint32_t index = 0;
};

/// Triangles, area lights and cameras. A value: copies are independent of each other. A call that throws leaves the
/// scene as it was. Scenes on different threads do not meet; one scene is for one thread at a time.
class PENUMBRA_API Scene {
 public:
  /// Without meshes, lights and cameras.
  Scene();
  Scene(const Scene& other);
  Scene(Scene&& other) noexcept;
  Scene& operator=(const Scene& other);
  Scene& operator=(Scene&& other) noexcept;
  ~Scene();

  /// Reads .json (penumbra-scene/1), .gltf or .glb, or a mesh file. Around a mesh, and a glTF scene without lights, a
  /// studio is put: a soft rectangle light, a floor, a camera (warnings() says so). Throws InputError, with the place
  /// in the file and what would be right, and ResourceError.
  static Scene load(const std::filesystem::path& file, const LoadOptions& options = {});
  /// Reads the text of a penumbra-scene/1 file whose meshes' files are relative to `folder`. Throws as load().
  static Scene parse(std::string_view json, const std::filesystem::path& folder = ".", const LoadOptions& options = {});

  /// Adds a mesh. `positions`: one row x, y, z a vertex; `triangles`: three indices each; both are copied. Throws
  /// InputError for numbers that are not finite or too large, and indices out of range.
  MeshId add_mesh(std::string name, std::span<const Vector> positions,
                  std::span<const std::array<std::uint32_t, 3>> triangles, const MeshOptions& options = {});
  /// Replaces the vertices and triangles of a mesh, which keeps its place among the meshes and its options; vertices'
  /// own normals, colours and pictures go. Throws as add_mesh().
  void set_mesh(MeshId mesh, std::span<const Vector> positions,
                std::span<const std::array<std::uint32_t, 3>> triangles);
  /// Throws UsageError without a mesh of that name.
  [[nodiscard]] MeshId mesh(std::string_view name) const;
  [[nodiscard]] std::size_t mesh_count() const;
  [[nodiscard]] const std::string& mesh_name(MeshId mesh) const;
  /// Moves a mesh: its vertices are where `matrix` takes the positions that it was added or read with. Throws
  /// UsageError for a mesh that the scene does not have, InputError for a matrix that is not finite or whose last row
  /// is not 0 0 0 1, or a mesh that is the body of a light.
  void set_transform(MeshId mesh, const Matrix& matrix);
  /// Replaces the positions that a mesh was added or read with, as many as it has, and takes its transform back. Throws
  /// as add_mesh(), and for a mesh that is the body of a light.
  void set_positions(MeshId mesh, std::span<const Vector> positions);

  /// Adds a light. Throws InputError for a shape that is none, and UsageError for a name that is taken.
  void add_light(std::string name, const LightShape& shape, const LightOptions& options = {});
  /// Gives a light another shape, or other options. Throws UsageError without a light of that name, InputError for a
  /// shape that is none and for a light whose body is a mesh.
  void set_light(std::string_view name, const LightShape& shape);
  void set_light(std::string_view name, const LightOptions& options);
  void remove_light(std::string_view name);
  /// In their order, which is that of Picture's lights.
  [[nodiscard]] std::vector<std::string> lights() const;
  /// Nullopt for a light of a kind that this interface cannot make: an emitting mesh in pieces.
  [[nodiscard]] std::optional<LightShape> light_shape(std::string_view name) const;
  [[nodiscard]] LightOptions light_options(std::string_view name) const;

  /// Adds a camera, or replaces that of the same name; it becomes the one that looks by default. Throws InputError for
  /// one that sees nothing.
  void set_camera(const Camera& camera);
  [[nodiscard]] std::vector<Camera> cameras() const;

  [[nodiscard]] std::size_t triangle_count() const;
  /// Width and height in pixels of pictures for which none is asked for.
  [[nodiscard]] std::array<std::uint32_t, 2> size() const;
  void set_size(std::uint32_t width, std::uint32_t height);
  /// What was skipped or changed while the scene was read.
  [[nodiscard]] const std::vector<std::string>& warnings() const;
  /// Writes .json, .glb or .obj, as `penumbra convert` does. Returns warnings about what the format cannot hold.
  std::vector<std::string> save(const std::filesystem::path& file) const;

  struct State;
  /// For the library's own sources.
  [[nodiscard]] const State& state() const { return *state_; }

 private:
  std::unique_ptr<State> state_;
};

}  // namespace penumbra
