// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <penumbra/export.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace penumbra {

/// Point or direction x, y, z in world space: the scene's unit of length, right-handed, Y up (as glTF 2.0).
using Vector = std::array<double, 3>;
/// 4x4 matrix by rows, for column vectors: elements 3, 7 and 11 are the translation.
using Matrix = std::array<double, 16>;

/// The points center + s·half_u + t·half_v with |s|, |t| <= 1; emits to the side to which half_u × half_v points.
struct Rectangle {
  Vector center{}, half_u{}, half_v{};
};
/// Disk that emits to the side of `normal`, which need not have unit length.
struct Disk {
  Vector center{}, normal{0, -1, 0};
  double radius = 0;
};
/// The points center + s·half_u + t·half_v with s² + t² <= 1; emits to the side to which half_u × half_v points.
struct Ellipse {
  Vector center{}, half_u{}, half_v{};
};
/// Flat and convex, counter-clockwise seen from the emitting side.
struct Polygon {
  std::vector<Vector> vertices;
};
struct Sphere {
  Vector center{};
  double radius = 0;
};
/// Disk at infinity. `direction`: direction of its light, of any length. `angle`: the full apparent diameter in
/// degrees, 0 <= angle < 180; 0 casts hard shadows.
struct Sun {
  Vector direction{0, -1, 0};
  double angle = 0.53;
};
/// Sky: light from all directions, or if `half`, from those with a positive component along `up`. Its radiance is
/// uniform, or multiplied by a latitude-longitude picture.
struct Dome {
  Vector up{0, 1, 0};
  double rotate = 0;  ///< degrees about `up`: direction of the picture's middle column, by default -z
  bool half = false;
  std::filesystem::path image = {};  ///< Radiance (.hdr), OpenEXR or PNG; empty: uniform radiance
  bool sampled = false;              ///< uses light samples by default instead of exact areas: faster
};
using LightShape = std::variant<Rectangle, Disk, Ellipse, Polygon, Sphere, Sun, Dome>;

struct LightOptions {
  Vector radiance{10, 10, 10};  ///< linear red green blue; for a sun of angle 0 the irradiance of a surface facing the
                                ///< sun
  bool two_sided = false;       ///< for flat lights: emits to both sides
};

struct Camera {
  Vector eye{}, target{0, 0, -1}, up{0, 1, 0};
  double vertical_fov = 45;           ///< degrees
  std::optional<double> height = {};  ///< of an orthographic camera: the picture's height, in place of an angle
  std::string name = "camera";
  /// Radius of a thin lens: surfaces away from the focus distance along the view axis are blurred if a pixel has
  /// several view samples. 0: everything is sharp.
  double aperture = 0;
  double focus_distance = 0;  ///< must be above 0 if there is an aperture
};

struct MeshOptions {
  Vector color{0.8, 0.8, 0.8};  ///< linear base colour, 0 to 1
  bool casts_shadow = true, receives_shadow = true;
};

/// Vertices and triangles for an entry of "meshes" in a scene file's text; they replace the source that the text names.
/// The entry's "transform", "fit" or "instances" apply to them.
struct MeshArrays {
  std::uint32_t mesh = 0;  ///< index in "meshes"
  std::span<const Vector> positions = {};
  std::span<const std::array<std::uint32_t, 3>> triangles = {};
};

/// Options of reading a file. Unset numbers have the file's own value, or the default of the command line.
struct LoadOptions {
  bool lenient = false;              ///< leave out, with a warning, unsupported features that would change a shadow
  bool allow_outside = false;        ///< let the scene name files outside its folder
  std::optional<double> frame = {};  ///< of the file's animation; nullopt: the scene at rest
  double fps = 24;                   ///< frame F is at F / fps seconds
  std::optional<double> lamp_radius = {}, sun_angle = {}, lumens_per_watt = {};  ///< for glTF lamps without their own
  std::vector<std::string> clips = {};  ///< for glTF: animations by name or index; empty: all that can play at once
  bool studio = false;                  ///< add a light and a floor also to a scene with lights
  /// For parse(): vertices and triangles of entries of "meshes".
  std::span<const MeshArrays> arrays = {};
  /// Progress of reading: before each mesh of a JSON scene, and ten times a second while another process reads a file.
  /// Reading ends if this function returns false or throws (RendererOptions::progress).
  std::function<bool(std::string_view stage, double done)> progress = {};
};

/// Identifies one mesh of one scene.
struct MeshId {
  std::uint32_t index = 0;
};

/// Identifies one instance of a mesh: the first that was added has number 0.
struct InstanceId {
  InstanceId(MeshId of, std::uint32_t which) : mesh(of), number(which) {}

  MeshId mesh;
  std::uint32_t number;
};

/// Triangles, area lights and cameras. Value type: copies are independent of each other. A call that throws leaves the
/// scene unchanged. A scene that was moved from is like a new one. Scenes on different threads are independent; one
/// scene is for one thread at a time.
class PENUMBRA_API Scene {
 public:
  /// Makes a scene without meshes, lights and cameras.
  Scene();
  Scene(const Scene& other);
  Scene(Scene&& other) noexcept;
  Scene& operator=(const Scene& other);
  Scene& operator=(Scene&& other) noexcept;
  ~Scene();

  /// Reads .json (penumbra-scene/1), .gltf or .glb, or a mesh file. A mesh, and a glTF scene without lights, is placed
  /// in a studio: a soft rectangle light, a floor, a camera (noted in warnings()). Throws InputError, with the location
  /// in the file and the expected value, ResourceError, and Cancelled.
  static Scene load(const std::filesystem::path& file, const LoadOptions& options = {});
  /// Reads the text of a penumbra-scene/1 file with mesh files relative to `folder`. Throws as load(), and as
  /// add_mesh() for LoadOptions::arrays.
  static Scene parse(std::string_view json, const std::filesystem::path& folder = ".", const LoadOptions& options = {});

  /// Adds a mesh. `positions`: one row x, y, z for each vertex; `triangles`: three indices each; both are copied.
  /// Throws InputError for numbers that are not finite or too large, and for indices out of range.
  MeshId add_mesh(std::string name, std::span<const Vector> positions,
                  std::span<const std::array<std::uint32_t, 3>> triangles, const MeshOptions& options = {});
  /// Replaces the vertices and triangles of a mesh, which keeps its index and its options; vertices' own normals,
  /// colours and pictures are removed. Throws as add_mesh().
  void set_mesh(MeshId mesh, std::span<const Vector> positions,
                std::span<const std::array<std::uint32_t, 3>> triangles);
  /// Adds an instance of a mesh, whose vertices are stored once. As soon as a mesh has an instance, it appears only
  /// where its instances are: its vertices at that time become coordinates in the mesh's own space, which `matrix`
  /// transforms to the world. set_mesh() and set_positions() change all of its instances, and set_transform() of the
  /// mesh moves them all.
  ///
  /// Files have instances, too: JSON's "instances", EXT_mesh_gpu_instancing, and nodes of a glTF file that share a
  /// mesh. set_mesh() and set_positions() of such a node replace its instances by a separate mesh without instances;
  /// set_positions() then takes the world positions of the vertices of all these instances. Throws as set_transform().
  InstanceId add_instance(MeshId mesh, const Matrix& matrix);
  /// Moves an instance: replaces its matrix. Throws as set_transform() of a mesh.
  void set_transform(InstanceId instance, const Matrix& matrix);
  /// Returns the number of a mesh's instances; 0: the mesh itself is in the scene.
  [[nodiscard]] std::size_t instance_count(MeshId mesh) const;
  /// Returns the mesh with this name. Throws UsageError if there is none.
  [[nodiscard]] MeshId mesh(std::string_view name) const;
  [[nodiscard]] std::size_t mesh_count() const;
  [[nodiscard]] const std::string& mesh_name(MeshId mesh) const;
  /// Moves a mesh: applies `matrix` to the positions with which the mesh was added or read. Throws UsageError for a
  /// mesh that the scene does not have, InputError for a matrix that is not finite or whose last row is not 0 0 0 1,
  /// and for a mesh that is the body of a light.
  void set_transform(MeshId mesh, const Matrix& matrix);
  /// Replaces the positions with which a mesh was added or read by as many new ones, and resets its transform. Throws
  /// as add_mesh(), and for a mesh that is the body of a light.
  void set_positions(MeshId mesh, std::span<const Vector> positions);

  /// Adds a light. Throws InputError for an invalid shape, and UsageError for a name that is taken.
  void add_light(std::string name, const LightShape& shape, const LightOptions& options = {});
  /// Change a light's shape, or its options. Throw UsageError if there is no light of this name, InputError for an
  /// invalid shape and for a light whose body is a mesh.
  void set_light(std::string_view name, const LightShape& shape);
  void set_light(std::string_view name, const LightOptions& options);
  void remove_light(std::string_view name);
  /// Returns the names of the lights, in the order of Picture's lights.
  [[nodiscard]] std::vector<std::string> lights() const;
  /// Returns the shape of a light; nullopt for a kind not supported by this interface: an emitting mesh in pieces.
  [[nodiscard]] std::optional<LightShape> light_shape(std::string_view name) const;
  [[nodiscard]] LightOptions light_options(std::string_view name) const;

  /// Adds a camera, or replaces the one with the same name, and makes it the default. Throws InputError for a camera
  /// that sees nothing.
  void set_camera(const Camera& camera);
  [[nodiscard]] std::vector<Camera> cameras() const;

  /// Returns the number of triangles, counted once for each instance.
  [[nodiscard]] std::size_t triangle_count() const;
  /// Returns the default width and height of pictures in pixels.
  [[nodiscard]] std::array<std::uint32_t, 2> size() const;
  void set_size(std::uint32_t width, std::uint32_t height);
  /// Returns the parts that were skipped or changed when the scene was read.
  [[nodiscard]] const std::vector<std::string>& warnings() const;
  /// Writes .json, .glb or .obj, as `penumbra convert` does. Returns warnings about features that the format does not
  /// support.
  std::vector<std::string> save(const std::filesystem::path& file) const;

  struct State;
  /// Internal to the library.
  [[nodiscard]] const State& state() const { return *state_; }

 private:
  std::unique_ptr<State> state_;
};

}  // namespace penumbra
