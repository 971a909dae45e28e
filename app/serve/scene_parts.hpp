// SPDX-License-Identifier: Apache-2.0
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

/// Scene made of named parts ("things"), each of which can be replaced separately: only changed things are read again.
/// Things are in the order of their arrival, or in a given order.
///
/// Names of nodes in put files begin with the name of their thing, THING␟NAME or THING␟NUMBER␟NAME (kThingEnds); nodes
/// of one thing are contiguous. The numbers make all node names of a file distinct, so that equal NAMEs are renamed
/// only where all things are joined, as if they were in one file. Nodes without this prefix belong to the thing "".
class SceneParts {
 public:
  static constexpr std::string_view kThingEnds = "\xe2\x90\x9f";  ///< ␟, U+241F

  /// The parts of the scene that a file replaces.
  struct Put {
    std::set<std::string> things = {};     ///< things to be replaced; those that the file lacks become empty
    std::set<std::string> shadeless = {};  ///< things whose lamps cast no shadows
    std::filesystem::path folder = {};     ///< of the pictures named in the file; empty: the file names none
  };
  /// Replaces each thing by its contents in the file `glb`. Throws InputError for an invalid file, and then changes
  /// nothing.
  void put(std::span<const std::byte> glb, const Put& what);
  /// Removes things; ignores unknown names.
  void remove(const std::vector<std::string>& things);
  /// Orders the things; things not listed follow, in their previous order. Throws InputError for an unknown name.
  void put_in_order(const std::vector<std::string>& things);

  /// Returns whether scene() would differ from the last scene shown.
  [[nodiscard]] bool has_changed() const { return changed_ || meshes_changed_; }
  /// Returns the whole scene, or the scene without meshes if these equal the last scene's. Throws InputError for a
  /// scene that cannot be rendered: without a light, or without a triangle. `camera`: its only camera.
  [[nodiscard]] LiveScene scene(const scenes::Camera& camera) const;
  /// Records that the last result of scene() is shown.
  void note_shown() { changed_ = meshes_changed_ = false; }

 private:
  struct Thing {
    std::shared_ptr<const scenes::Scene> file;  // shared by the things of one file: each may be replaced separately
    scenes::ScenePart part;
  };
  void note_change_of(const Thing& thing) {
    meshes_changed_ = meshes_changed_ || thing.part.objects > 0;
    changed_ = changed_ || thing.part.lights > 0;
  }

  std::map<std::string, Thing> things_;
  std::vector<std::string> order_;  // of all things
  bool changed_ = false, meshes_changed_ = false;
};

}  // namespace penumbra::app
