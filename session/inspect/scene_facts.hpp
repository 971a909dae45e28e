// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/scene.hpp"

#include <nlohmann/json_fwd.hpp>

#include <optional>
#include <string>
#include <vector>

namespace penumbra::session {

/// Contents of a scene other than meshes.
struct SceneFacts {
  struct Named {
    std::string name, text;
  };
  struct Material {
    std::string name;
    scenes::Alpha alpha;               ///< of the first object with this material
    std::string picture;               ///< name of the file; empty: none
    std::vector<std::string> objects;  ///< objects with this material
  };

  std::vector<Named> lights;                  ///< in words, with the object that is the light's body
  std::vector<Named> cameras;                 ///< in words; the first is the default
  std::vector<Material> materials;            ///< in order of first use; objects without a material are left out
  std::optional<scenes::Motion> motion = {};  ///< nullopt: not animated

  /// First object with holes, or translucent, that casts shadow; empty: none.
  std::string filter;
  /// Translucent object among these (alphaMode BLEND); empty: there is none.
  std::string dimmer;
};

SceneFacts facts_of(const scenes::Scene& scene);

/// Returns rows of `inspect`'s table.
std::string facts_table(const SceneFacts& facts);
/// Returns "lights", "cameras", "materials", "animation".
nlohmann::ordered_json facts_json(const SceneFacts& facts);

}  // namespace penumbra::session
