#pragma once

#include "scenes/scene.hpp"

#include <nlohmann/json_fwd.hpp>

#include <optional>
#include <string>
#include <vector>

namespace penumbra::app {

/// What a scene has beside meshes.
struct SceneFacts {
  struct Named {
    std::string name, text;
  };
  struct Material {
    std::string name;
    scenes::Alpha alpha;               ///< of the first object that has it
    std::string picture;               ///< its file; empty: none
    std::vector<std::string> objects;  ///< that have it
  };

  std::vector<Named> lights;                  ///< in words, with the object that is the light's body
  std::vector<Named> cameras;                 ///< in words; the first is the default
  std::vector<Material> materials;            ///< in order of first use; objects without one are left out
  std::optional<scenes::Motion> motion = {};  ///< nothing: it stands still

  /// The first object with holes, or translucent, that casts shadow; empty: none.
  std::string filter;
  /// A translucent one of these (alphaMode BLEND); empty: there is none.
  std::string dimmer;
};

SceneFacts facts_of(const scenes::Scene& scene);

/// Rows of `inspect`'s table.
std::string facts_table(const SceneFacts& facts);
/// "lights", "cameras", "materials", "animation".
nlohmann::ordered_json facts_json(const SceneFacts& facts);

}  // namespace penumbra::app
