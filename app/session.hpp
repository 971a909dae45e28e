#pragma once

#include "app/machine.hpp"
#include "app/options.hpp"
#include "app/process/progress.hpp"
#include "engines/view_sampler.hpp"
#include "scenes/scene.hpp"
#include "visibility/alpha/alpha_reach.hpp"
#include "visibility/light_samples.hpp"
#include "visibility/scene_floats.hpp"
#include "visibility/view_samples.hpp"

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace penumbra::app {

/// The question that every method of a run answers: the scene, what each pixel sees of it, and the light samples.
struct Session {
  scenes::Scene scene;
  std::uint32_t width = 0, height = 0;
  visibility::SceneFloats floats;
  std::vector<visibility::SceneFloats> linked;  ///< the scene as some lights have it, whose casters are not all
  std::size_t camera_index = 0;                 ///< the chosen one of scene.cameras
  visibility::PinholeCamera camera;
  visibility::ViewSamples samples;
  std::vector<visibility::Light> lights;  ///< those asked for, in that order, or all of the scene's; pieces of one
                                          ///< (app/whole_lights.hpp) one after the other
  std::vector<std::vector<visibility::PixelClass>> classes;  ///< for each light, each pixel
  /// For each light, each pixel, 1: what lets light through may be on the way (AlphaReach). Empty: nowhere; then the
  /// light's filtered_by and dimmed_by are empty, too.
  std::vector<std::vector<std::uint8_t>> filtered;
  std::vector<double> filtered_seconds;  ///< finding them, of each light
  bool shading_normals = false;          ///< of beauty: vertices' normals, where there are any
  std::uint64_t mesh_version = 0;        ///< another number, another scene to prepare methods for
  double load_seconds = 0;               ///< reading the scene, its floats, and handing them to the visibility buffer
  double device_seconds = 0;             ///< starting the device
  double receiver_seconds = 0;           ///< classes
  double view_seconds = 0;               ///< finding the view samples: the median of the runs asked for
  std::vector<std::string> warnings;

  std::vector<std::optional<std::size_t>> linked_of;  ///< for each light, its own among these; nothing: `floats`

  [[nodiscard]] std::size_t pixel_count() const { return std::size_t{width} * height; }
  /// The scene as it casts shadows of this one of `lights`.
  [[nodiscard]] const visibility::SceneFloats& floats_for(std::size_t light) const {
    return light < linked_of.size() && linked_of[light] ? linked[*linked_of[light]] : floats;
  }
};

/// Finds view samples in place of a camera's pixels, as many as the camera's picture has: points on surfaces.
using ViewFinder =
    std::function<visibility::ViewSamples(const visibility::SceneFloats&, const visibility::PinholeCamera&)>;

/// Makes a session, and makes it again of the same scene at other times or from other cameras: what has not changed
/// since is kept, where methods look for it too. An object that stays where it is, since its session is looked at.
class SessionMaker {
 public:
  /// The options must outlive it, and may change before each show(). Throws UsageError for what is wrong with the
  /// options.
  SessionMaker(const RunOptions& options, const render::Machine& machine);
  SessionMaker(const SessionMaker&) = delete;
  SessionMaker& operator=(const SessionMaker&) = delete;

  /// `camera`: its name; empty: the first. View samples are found once if `runs` is 0 and the camera, the picture's
  /// size or the mesh is another than before, else `runs` times after a discarded one. Throws UsageError for what is
  /// wrong with the options.
  void show(scenes::Scene scene, const std::string& camera, std::uint32_t runs, Progress& progress);
  /// `scene` has the triangles, pictures and vertices' looks of the last one, and comes without them (without_meshes);
  /// after a show() that came to its end.
  void show_again(scenes::Scene scene, const std::string& camera, Progress& progress);
  /// From now on view samples are what `finder` finds; before the first show().
  void find_view_by(ViewFinder finder) { finder_ = std::move(finder); }
  /// Whether the last show() came to its end.
  [[nodiscard]] bool is_whole() const { return is_whole_; }
  [[nodiscard]] const Session& session() const { return session_; }
  /// Puts other view samples of the same camera in the place of the session's. Returns those.
  visibility::ViewSamples look_at(visibility::ViewSamples samples);
  /// Gives it away: this object is of no more use.
  Session take() { return std::move(session_); }

 private:
  /// `changed`: triangles, or whether they cast, are others than in the last one.
  void show(scenes::Scene scene, bool changed, const std::string& camera, std::uint32_t runs, Progress& progress);
  /// What the session's lights are to its view samples.
  void classify();

  const RunOptions& options_;
  render::Machine machine_;
  Session session_;
  struct Filters {
    std::string filtered_by, dimmed_by;
  };
  std::vector<Filters> filters_;  // of each light as made, whatever is looked at
  std::map<const visibility::SceneFloats*, visibility::AlphaReach> reaches_;  // of session_.floats and of those linked
  std::optional<engines::ViewSampler> sampler_;
  ViewFinder finder_;                              // empty: the camera's pixels
  bool is_whole_ = false;                          // the last show() came to its end
  std::optional<visibility::PinholeCamera> seen_;  // what session_.samples were found for
};

/// All of a scene but its triangles, pictures and vertices' looks.
scenes::Scene without_meshes(const scenes::Scene& scene);

/// The scene at a time of its animation; at rest without one. `lightmap`: ReadOptions::lightmap.
scenes::Scene read_session_scene(const RunOptions& options, std::optional<double> time,
                                 scenes::LightmapPlaces* lightmap = nullptr);

/// Reads the scene and finds its view samples; once if `runs` is 0, else `runs` times after a
/// discarded one. `time`: see read_session_scene.
/// Throws UsageError, InputError or ResourceError.
Session open_session(const RunOptions& options, std::optional<double> time, const render::Machine& machine,
                     std::uint32_t runs, Progress& progress);

/// Finds the view samples of a scene that has been read.
Session open_session(scenes::Scene scene, const RunOptions& options, const render::Machine& machine, std::uint32_t runs,
                     Progress& progress);

/// The middle one; of an even number, the mean of the two in the middle. Not of nothing.
double median(std::vector<double> values);

}  // namespace penumbra::app
