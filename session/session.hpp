// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engines/view_sampler.hpp"
#include "scenes/formats/scenes_ahead.hpp"
#include "scenes/instances.hpp"
#include "scenes/scene.hpp"
#include "session/machine.hpp"
#include "session/options.hpp"
#include "session/process/progress.hpp"
#include "visibility/alpha/alpha_reach.hpp"
#include "visibility/bounds.hpp"
#include "visibility/light_samples.hpp"
#include "visibility/scene_floats.hpp"
#include "visibility/seen/all_placed.hpp"
#include "visibility/seen/seen_part.hpp"
#include "visibility/view_samples.hpp"

#include <cstdint>
#include <functional>
#include <map>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace penumbra::session {

/// Input common to all methods of a run: the scene, the view samples, and the light samples.
struct Session {
  scenes::Scene scene;
  std::uint32_t width = 0, height = 0;
  visibility::SceneFloats floats;
  std::vector<visibility::SceneFloats> linked;  ///< scenes of lights for which not all objects cast
  std::size_t camera_index = 0;                 ///< index of the chosen one of scene.cameras
  visibility::PinholeCamera camera;
  visibility::ViewSamples samples;
  std::vector<visibility::Light> lights;  ///< requested lights, in the order of the request, or all of the scene's;
                                          ///< pieces of one light (session/whole_lights.hpp) are consecutive
  std::vector<std::vector<visibility::PixelClass>> classes;  ///< for each light, each pixel
  /// For each light, each pixel, 1: a translucent surface or hole may be in between (AlphaReach). Empty: nowhere; then
  /// the light's filtered_by and dimmed_by are empty, too.
  std::vector<std::vector<std::uint8_t>> filtered;
  std::vector<double> filtered_seconds;  ///< time of computing `filtered`, of each light
  bool shading_normals = false;          ///< for the beauty: use vertices' normals where present
  std::uint64_t mesh_version = 0;        ///< changes whenever methods must be prepared again
  double load_seconds = 0;               ///< reading the scene, its floats, and passing them to the visibility buffer
  double device_seconds = 0;             ///< starting the device
  double receiver_seconds = 0;           ///< computing classes
  double view_seconds = 0;               ///< finding the view samples: the median of the requested runs
  std::vector<std::string> warnings;
  /// For a scene with instances, of which `scene` has the part that matters (visibility/seen/): each triangle's number
  /// in the whole scene, and the whole scene's number of triangles. Empty: `scene` is the whole one.
  std::vector<std::uint32_t> numbers;
  std::uint64_t whole_triangles = 0;

  std::vector<std::optional<std::size_t>> linked_of;  ///< for each light, index of its own scene in `linked`; nullopt:
                                                      ///< `floats`

  [[nodiscard]] std::uint64_t triangle_count() const {
    return numbers.empty() ? floats.triangles.size() : whole_triangles;
  }
  /// Returns the number in the whole scene of a triangle of `floats`; keeps ViewSamples::kBackground.
  [[nodiscard]] std::int32_t number_of(std::int32_t triangle) const {
    if (triangle < 0 || numbers.empty()) return triangle;
    return static_cast<std::int32_t>(numbers[static_cast<std::size_t>(triangle)]);
  }
  /// Returns the time of computing `filtered`, for all lights.
  [[nodiscard]] double filtering_seconds() const {
    return std::reduce(filtered_seconds.begin(), filtered_seconds.end());
  }
  [[nodiscard]] std::size_t pixel_count() const { return std::size_t{width} * height; }
  /// Returns the scene in which only the casters of this light cast (index into `lights`).
  [[nodiscard]] const visibility::SceneFloats& floats_for(std::size_t light) const {
    return light < linked_of.size() && linked_of[light] ? linked[*linked_of[light]] : floats;
  }
};

/// Function that finds view samples in place of a camera's pixels, as many as the camera's picture has: points on
/// surfaces.
using ViewFinder =
    std::function<visibility::ViewSamples(const visibility::SceneFloats&, const visibility::PinholeCamera&)>;

/// Makes a session, and again sessions of the same scene at other times or from other cameras: unchanged data are kept,
/// at the same addresses. Not movable, because its session is referenced.
class SessionMaker {
 public:
  /// `options` must outlive this object, and may change before each show(). Throws UsageError for invalid options.
  SessionMaker(const RunOptions& options, const render::Machine& machine);
  SessionMaker(const SessionMaker&) = delete;
  SessionMaker& operator=(const SessionMaker&) = delete;

  /// Makes the session. `camera`: name; empty: the first. View samples are found once if `runs` is 0 and the camera,
  /// the picture's size or the mesh has changed, else `runs` times after a discarded run. Throws UsageError for invalid
  /// options.
  void show(scenes::Scene scene, const std::string& camera, std::uint32_t runs, Progress& progress);
  /// Makes the session of `scene`, which was made by without_meshes(), with the triangles, pictures and vertices' looks
  /// of the last one; callable after a completed show().
  void show_again(scenes::Scene scene, const std::string& camera, Progress& progress);
  /// Replaces the search for view samples by `finder`; to be called before the first show().
  void find_view_by(ViewFinder finder) { finder_ = std::move(finder); }
  /// Sets how view samples look through the camera's lens, if it has one, from the next show() on: `share` contains
  /// everything but the lens's size. nullopt: view samples look through the lens's middle.
  void look_through_lens(std::optional<visibility::Lens> share) { lens_share_ = share; }
  /// Restricts the session to some rows of its picture from the next show() on; nullopt: all rows. Not together with
  /// show_part().
  void look_at_rows(std::optional<visibility::Tile> rows) { band_ = rows; }
  /// Sets the scene without copies of its instances, for following calls of show_part() and show_viewed(). `scene` and
  /// `instances` must outlive these calls. Trees over meshes are kept from one scene to the next. `dome_samples`:
  /// of domes, methods evaluate only light samples, no areas (counts_dome_samples).
  void look_into(const scenes::Scene& scene, const scenes::Instances& instances, bool dome_samples);
  void look_away() { placed_.leave(); }
  /// Makes the session from the part of the scene that matters to some rows of its picture (visibility/seen/): visible
  /// triangles, and those that may lie between them and the lights. Pixels of other rows are background.
  void show_part(const visibility::Tile& rows, const std::string& camera, Progress& progress);
  /// Makes the session from the visible triangles alone, for methods that are also given all_triangles().
  void show_seen(const std::string& camera, Progress& progress);
  /// Returns all triangles of the scene given to look_into(); valid until look_away() and the next look_into().
  [[nodiscard]] const visibility::AllTriangles& all_triangles() const { return all_; }
  /// Makes the session from the triangles that are visible in all shown parts, without those that only shade them.
  void show_viewed(const std::string& camera, Progress& progress);
  /// Returns the number of trees over shared meshes that look_into() built.
  [[nodiscard]] std::size_t mesh_trees_built() const { return placed_.trees_built(); }
  /// Returns the size of the picture of one of a scene's cameras; empty: the first.
  [[nodiscard]] std::pair<std::uint32_t, std::uint32_t> picture_size(const scenes::Scene& scene,
                                                                     const std::string& camera) const;
  /// Returns whether the last show() was completed.
  [[nodiscard]] bool is_whole() const { return is_whole_; }
  [[nodiscard]] const Session& session() const { return session_; }
  /// Frees the session's view samples and their classes, which the next show() finds again.
  void forget_view();
  /// Replaces the session's view samples by others of the same camera. Returns the previous ones.
  visibility::ViewSamples look_at(visibility::ViewSamples samples);
  /// Returns the session by move: this object must not be used afterwards.
  Session take() { return std::move(session_); }

 private:
  /// `changed`: triangles, or whether they cast, differ from the last scene.
  void show(scenes::Scene scene, bool changed, const std::string& camera, std::uint32_t runs, Progress& progress);
  void show_part(visibility::SeenPart part, const visibility::Tile& rows, const std::string& camera, double seconds,
                 Progress& progress);
  /// Returns the camera of a whole picture, through its lens if it looks through one.
  [[nodiscard]] visibility::PinholeCamera look_through(const scenes::Camera& camera, const glm::dvec3& origin,
                                                       std::uint32_t width, std::uint32_t height) const;
  /// Computes the classes of the session's view samples for its lights.
  void classify();
  /// Returns the requested lights of a scene, pieces one after the other.
  [[nodiscard]] std::vector<visibility::Light> make_lights(const scenes::Scene& scene, const glm::dvec3& origin,
                                                           std::vector<std::string>* notes) const;

  const RunOptions& options_;
  render::Machine machine_;
  Session session_;
  struct Filters {
    std::string filtered_by, dimmed_by;
  };
  std::vector<Filters> filters_;  // of each light, independent of the view samples
  std::map<const visibility::SceneFloats*, visibility::AlphaReach> reaches_;  // of session_.floats and of the linked
                                                                              // scenes
  std::optional<engines::ViewSampler> sampler_;
  std::optional<visibility::Lens> lens_share_;
  visibility::PlacedMeshes placed_;
  visibility::AllPlaced all_{placed_};
  bool dome_samples_ = false;                      // of look_into()
  std::vector<std::uint64_t> viewed_;              // triangles of placed_ that pixels of shown parts see
  visibility::Bounds whole_;                       // box of the whole scene's floats, if session_.numbers is filled
  std::optional<visibility::Tile> rows_;           // pixels of other rows are background
  std::optional<visibility::Tile> band_;           // the picture has only these rows
  ViewFinder finder_;                              // empty: the camera's pixels
  bool is_whole_ = false;                          // the last show() was completed
  std::optional<visibility::PinholeCamera> seen_;  // camera of session_.samples
};

/// Returns the scene without triangles, pictures and vertices' looks.
scenes::Scene without_meshes(const scenes::Scene& scene);

/// Additional results of reading a scene; null: not requested.
struct ReadBeside {
  scenes::LightmapPlaces* lightmap = nullptr;  ///< ReadOptions::lightmap
  scenes::Instances* instances = nullptr;      ///< ReadOptions::instances
  scenes::ScenesAhead* ahead = nullptr;        ///< ReadOptions::ahead
  std::uint64_t bytes_per_copy = 0;            ///< ReadOptions::bytes_per_copy
};
/// Reads the scene at a time of its animation; at rest without a time.
scenes::Scene read_session_scene(const RunOptions& options, std::optional<double> time, const ReadBeside& beside = {});

/// Reads the scene and finds its view samples; once if `runs` is 0, else `runs` times after a discarded run. `time`:
/// see read_session_scene; `bytes_per_copy`: see ReadOptions. Throws UsageError, InputError or ResourceError.
Session open_session(const RunOptions& options, std::optional<double> time, const render::Machine& machine,
                     std::uint32_t runs, Progress& progress, std::uint64_t bytes_per_copy);

/// Finds the view samples of a scene in memory.
Session open_session(scenes::Scene scene, const RunOptions& options, const render::Machine& machine, std::uint32_t runs,
                     Progress& progress);

/// Returns the middle value; for an even number, the mean of the two in the middle. `values` must not be empty.
double median(std::vector<double> values);

}  // namespace penumbra::session
