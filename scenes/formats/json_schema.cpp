// SPDX-License-Identifier: Apache-2.0
// Validates a scene against the schema that is compiled in. Long lists of triangles are checked by a separate loop, and
// set aside while the rest is validated.

#include "scenes/formats/json_schema.hpp"

#include "base/error.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

namespace penumbra::scenes {
namespace {

using nlohmann::json;

bool is_triangle_list(const json& list) {
  return list.is_array() && !list.empty() && std::all_of(list.begin(), list.end(), [](const json& triangle) {
           return triangle.is_array() && triangle.size() == 9 &&
                  std::all_of(triangle.begin(), triangle.end(), [](const json& value) { return value.is_number(); });
         });
}

/// Sets long lists of triangles aside while the rest is validated: a number takes a fraction of a microsecond, and a
/// scene may have millions. Only lists that satisfy the schema's "triangles" are set aside; one triangle of each stays.
/// The destructor puts all back.
class ShelvedTriangles {
 public:
  explicit ShelvedTriangles(json& document) {
    if (!document.is_object() || !document.contains("meshes") || !document["meshes"].is_array()) return;
    for (json& mesh : document["meshes"]) {
      if (!mesh.is_object() || !mesh.contains("triangles") || !is_triangle_list(mesh["triangles"])) continue;
      json& list = mesh["triangles"];
      json one = json::array({list[0]});
      shelf_.emplace_back(&list, std::exchange(list, std::move(one)));
    }
  }
  ShelvedTriangles(const ShelvedTriangles&) = delete;
  ShelvedTriangles& operator=(const ShelvedTriangles&) = delete;
  ~ShelvedTriangles() {
    for (auto& [place, list] : shelf_) *place = std::move(list);
  }

 private:
  std::vector<std::pair<json*, json>> shelf_;
};

}  // namespace

void enforce_schema(json& document, const std::string& file) {
  const ShelvedTriangles shelved(document);
  if (const auto words = find_violation(json::parse(kSceneSchemaText), document, file)) throw InputError("{}", *words);
}

}  // namespace penumbra::scenes
