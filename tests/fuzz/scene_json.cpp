// SPDX-License-Identifier: Apache-2.0
// Fuzzes the reader of penumbra-scene/1 with any text: the result is an InputError, or a complete scene. No file except
// the package manager's lists is read: the scene's folder does not exist, and there is no import helper.
#include "base/assert.hpp"
#include "base/error.hpp"
#include "scenes/formats/checks.hpp"
#include "scenes/formats/json_reader.hpp"
#include "tests/fuzz/bytes.hpp"

#include <nlohmann/json.hpp>

#include <cmath>
#include <cstdlib>
#include <string_view>

namespace {

using nlohmann::json;

/// Returns whether generated shapes are small. They may have 50 million triangles, but here only the reader is tested.
bool is_small(const json& value, int depth = 0) {
  if (depth > 64) return false;  // the reader refuses such depths, too, but this walk would overflow the stack before
  if (value.is_number()) return std::abs(value.get<double>()) < 40;
  if (!value.is_structured()) return true;
  if (value.is_object() && value.contains("subdivisions")) {
    const json& levels = value["subdivisions"];
    if (levels.is_number() && levels.get<double>() > 4) return false;
  }
  if (value.is_array() && value.size() > 64) return false;
  for (const json& element : value) {
    if (!is_small(element, depth + 1)) return false;
  }
  return true;
}

bool shapes_are_small(const json& document) {
  if (!document.is_object() || !document.contains("meshes") || !document["meshes"].is_array()) return true;
  for (const json& mesh : document["meshes"]) {
    if (!mesh.is_object()) continue;
    if (mesh.contains("package")) return false;
    if (mesh.contains("shape") && !is_small(mesh["shape"])) return false;
  }
  return true;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  ::setenv("PENUMBRA_IMPORT_HELPER", "/nonexistent/penumbra-import", 1);
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const json document = json::parse(text, nullptr, false);
  if (!document.is_discarded() && !shapes_are_small(document)) return 0;
  try {
    const penumbra::scenes::Scene scene = penumbra::scenes::read_json_text(text, "/nonexistent/scene.json", {});
    penumbra::scenes::check_scene(scene, "scene.json");
    PENUMBRA_ASSERT(scene.sources.empty(), "{} files were read", scene.sources.size());
    PENUMBRA_ASSERT(scene.soup.object.size() == scene.soup.triangles.size() &&
                        scene.soup.source_face.size() == scene.soup.triangles.size(),
                    "{} triangles, {} objects", scene.soup.triangles.size(), scene.soup.object.size());
  } catch (const penumbra::InputError&) {
  }
  return 0;
}
