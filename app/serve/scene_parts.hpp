#pragma once

#include "app/view/live_renderer.hpp"
#include "scenes/joined_parts.hpp"
#include "scenes/scene.hpp"

#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace penumbra::app {

/// A scene of things, each of which is replaced by itself: what changes is read again, and nothing else. Things stand
/// in the order in which they came, or in one that is said.
///
/// Files that are put have the things' names in those of their nodes, THING␟NAME (kThingEnds); nodes of one thing stand
/// together. Nodes without that are of the thing "".
class SceneParts {
 public:
  static constexpr std::string_view kThingEnds = "\xe2\x90\x9f";  ///< ␟, U+241F

  /// What the file `glb` has of a thing takes the place of all that there was of it. `shadeless`: things whose lamps
  /// cast no shadows. `folder`: where the pictures lie that the file names; empty: it names none. Throws InputError for
  /// a file that is none, and then changes nothing.
  void put(std::span<const std::byte> glb, const std::set<std::string>& shadeless, const std::filesystem::path& folder);
  /// Things go; names of none are let be.
  void remove(const std::vector<std::string>& things);
  /// Things that are not named stand behind, as they stood. Throws InputError for a name of none.
  void put_in_order(const std::vector<std::string>& things);

  /// Whether scene() would be another one than the last time that one was shown.
  [[nodiscard]] bool has_changed() const { return changed_ || meshes_changed_; }
  /// All of it, or without meshes where those are the last scene's. Throws InputError for a scene that cannot be
  /// rendered: without a light, or without a triangle. `camera`: its only one.
  [[nodiscard]] LiveScene scene(const scenes::Camera& camera) const;
  /// What scene() gave is shown.
  void note_shown() { changed_ = meshes_changed_ = false; }

 private:
  struct Thing {
    std::shared_ptr<const scenes::Scene> file;  // shared by the things that came in it: one of them may be replaced
    scenes::ScenePart part;
  };
  void note_change_of(const Thing& thing) { (thing.part.objects > 0 ? meshes_changed_ : changed_) = true; }

  std::map<std::string, Thing> things_;
  std::vector<std::string> order_;  // all of them
  bool changed_ = false, meshes_changed_ = false;
};

}  // namespace penumbra::app
