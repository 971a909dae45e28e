// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/view/live_pace.hpp"
#include "app/view/live_picture.hpp"
#include "app/view/live_state.hpp"
#include "app/view/whole_scene.hpp"
#include "render/machine.hpp"
#include "session/light_methods.hpp"
#include "session/options.hpp"
#include "session/pictures/frame_render.hpp"

#include <nlohmann/json.hpp>

#include <condition_variable>
#include <cstdint>
#include <exception>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

namespace penumbra::app {

/// Callbacks of the renderer, called on its thread; empty ones are not called.
struct LiveEvents {
  std::function<void(std::shared_ptr<const std::string>)> frame;  ///< frame_message()
  std::function<void(std::string_view level, const std::string& text)> say;
  std::function<void()> reloaded;                                        ///< the scene's file was read again
  std::function<void(std::shared_ptr<const LivePicture>)> picture = {};  ///< numbers of the displayed picture
  /// Whether LiveRenderer::shown() is called for frames. The next picture of a drag then waits for the last frame.
  bool says_shown = false;
};

/// Scene that replaces the displayed one.
struct LiveScene {
  scenes::Scene scene;
  bool same_meshes = false;  ///< `scene` was made by without_meshes(); the last scene's meshes are used
};

/// Several changes applied together.
struct LiveUpdate {
  std::optional<LiveScene> scene = {};       ///< nullopt: the displayed scene
  std::vector<nlohmann::json> changes = {};  ///< messages, in the form of apply()
  std::optional<double> stamp = {};          ///< returned with the first picture that includes all changes
  bool moving = false;                       ///< further changes will follow soon
};

/// Scene as displayed.
struct LiveScenery {
  std::shared_ptr<const WholeScene> whole;     ///< lights and cameras may be of an earlier file
  scenes::Scene lights;                        ///< without meshes; lights as changed
  std::shared_ptr<const LivePicture> picture;  ///< may be null, or of an earlier state
};

/// Renders a state that changes during rendering, on a separate thread: quick pictures while it changes, then a final
/// one, which is cancelled if the state changes again. Meshes, view samples and methods are kept from picture to
/// picture. Thread-safe.
class LiveRenderer {
 public:
  /// `whole`: read with `options`.
  LiveRenderer(session::RunOptions options, WholeScene whole, LiveEvents events);
  LiveRenderer(const LiveRenderer&) = delete;
  LiveRenderer& operator=(const LiveRenderer&) = delete;
  ~LiveRenderer();

  /// Changes the state by a message; `client` and its `stamp` are returned with the first picture that includes the
  /// change.
  LiveChange apply(const nlohmann::json& message, std::uint64_t client);
  /// Applies the changes. Throws InputError or UsageError for an invalid change, and then changes nothing.
  void update(LiveUpdate update, std::uint64_t client);
  [[nodiscard]] nlohmann::ordered_json state() const;
  /// Shows the current picture again, for a new client.
  void show_again();
  /// Records that a client has shown the last frame.
  void shown();
  /// Reads the scene's file again.
  void reload();
  /// Returns all files that the scene was read from.
  [[nodiscard]] std::vector<std::filesystem::path> sources() const;
  [[nodiscard]] LiveScenery scenery() const;
  [[nodiscard]] nlohmann::ordered_json pixel(std::uint32_t x, std::uint32_t y) const;
  /// Returns the name of the file that the changed scene is saved as.
  [[nodiscard]] std::string saved_name() const;
  /// Returns the changed scene, in the form of `convert`; lights that are off have no radiance. The text uses the
  /// file names of lights' pictures that state() lists under `saved`.
  [[nodiscard]] std::string scene_text() const;
  /// Returns the picture of a light, as an EXR file. Throws UsageError if there is none.
  [[nodiscard]] std::string light_picture(const std::string& light) const;
  /// Waits for this time. Throws the exception that ended the thread, if any.
  void watch(std::chrono::milliseconds time) const;

 private:
  struct Order {
    LiveState state;
    std::shared_ptr<const WholeScene> whole;  // with the meshes of `state`
    std::uint64_t revision = 0;
    LiveQuality quality;
    bool is_final = false;
    std::map<std::uint64_t, double> stamps = {};
  };
  class GivenUp;
  class Steps;

  void work();
  void work_on(std::unique_lock<std::mutex>& lock);
  [[nodiscard]] bool has_work() const;
  void read_again();
  void make_picture(const Order& order);
  void make_masks(const Order& order);
  /// Returns whether masks are requested but do not exist yet.
  [[nodiscard]] bool needs_masks() const;
  /// Returns whether pictures must report the number of the mesh's edges, and it is not yet known.
  [[nodiscard]] bool needs_edges() const { return events_.frame && counted_ != whole_; }
  /// Counts the edges of the displayed mesh, and shows the picture again with their number.
  void count_edges(const std::shared_ptr<const WholeScene>& whole);
  /// Returns whether a change has made the current picture obsolete.
  [[nodiscard]] bool is_overtaken(std::uint64_t revision) const;
  LiveAnswer answer(const Order& order, const std::string& entry, scenes::Scene& scene);
  session::MethodWish wish_for(const Order& order, const std::string& entry);
  [[nodiscard]] scenes::Scene scene_of(const Order& order) const;
  /// `scene`: scene_of(order), perhaps with other lights.
  void render(const Order& order, scenes::Scene scene, bool keeps_masks);
  void publish(std::shared_ptr<LivePicture> picture);
  void show();
  void failed(std::uint64_t revision, const std::string& message);

  session::RunOptions options_;
  LiveEvents events_;
  render::Machine machine_;

  mutable std::mutex mutex_;
  mutable std::condition_variable wake_, ended_;
  bool ending_ = false, wants_reload_ = false, wants_show_ = false;
  bool is_awaited_ = false;  // the last frame has not yet been shown
  LiveState state_;
  std::uint64_t revision_ = 1;                 // of state_; a different number requires another picture
  std::map<std::uint64_t, double> stamps_;     // of each client, of its last change
  std::shared_ptr<const WholeScene> whole_;    // with the meshes displayed
  std::shared_ptr<const scenes::Scene> file_;  // as read, without meshes
  std::uint64_t meshes_ = 1;                   // of whole_; a different number: other meshes
  std::shared_ptr<const LivePicture> picture_;
  std::shared_ptr<const LiveMasks> masks_;
  std::shared_ptr<const WholeScene> counted_;    // scene whose edges were counted
  std::optional<std::size_t> edges_;             // of counted_
  std::uint64_t failed_ = 0, masks_failed_ = 0;  // revision that could not be shown
  std::exception_ptr thrown_;

  // Used only by the thread:
  session::RunOptions run_;
  session::MethodWish wish_;
  std::unique_ptr<Steps> steps_;
  std::unique_ptr<session::FrameRenderer> frames_;  // refers to run_, wish_ and steps_
  std::shared_ptr<const WholeScene> rendered_;      // scene whose meshes frames_ has
  LivePace pace_;
  SlowMethods slow_;  // of slow_of_
  std::shared_ptr<const WholeScene> slow_of_;
  double final_milliseconds_ = 1000;
  float automatic_stops_ = 0;
  bool has_stops_ = false;
  std::uint64_t frame_ = 0;
  std::thread thread_;
};

}  // namespace penumbra::app
