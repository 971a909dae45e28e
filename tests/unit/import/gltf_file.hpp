// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/unit/mesh/import_files.hpp"

#include <nlohmann/json.hpp>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace penumbra::test {

using nlohmann::json;

/// A scene as Blender 3.4 writes one: a triangle "Body", an emissive plane "Lamp" above it, a camera.
struct Gltf {
  json document = json::parse(R"({
    "asset": {"version": "2.0", "generator": "Khronos glTF Blender I/O v3.4.50"},
    "extensionsUsed": ["KHR_materials_emissive_strength"],
    "scene": 0, "scenes": [{"name": "Scene", "nodes": [0, 1, 2]}],
    "nodes": [
      {"name": "Body", "mesh": 0},
      {"name": "Lamp", "mesh": 1, "translation": [0, 5, 0]},
      {"name": "Camera", "camera": 0, "translation": [1, 2, 8], "rotation": [0, 0.7071067811865476, 0, 0.7071067811865476]}],
    "cameras": [{"type": "perspective", "perspective": {"aspectRatio": 1.7777, "yfov": 0.6911112070083618, "zfar": 100, "znear": 0.1}}],
    "materials": [
      {"name": "Grey", "pbrMetallicRoughness": {"baseColorFactor": [0.8, 0.4, 0.2, 1], "metallicFactor": 0}},
      {"name": "Light", "doubleSided": true, "pbrMetallicRoughness": {"metallicFactor": 0}, "emissiveFactor": [1, 0.5, 0],
       "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 20.0}}}],
    "meshes": [
      {"name": "Triangle", "primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]},
      {"name": "Plane", "primitives": [{"attributes": {"POSITION": 2}, "indices": 3, "material": 1}]}],
    "accessors": [
      {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]},
      {"bufferView": 1, "componentType": 5123, "count": 3, "type": "SCALAR"},
      {"bufferView": 2, "componentType": 5126, "count": 4, "type": "VEC3", "min": [-1, 0, -1], "max": [1, 0, 1]},
      {"bufferView": 3, "componentType": 5123, "count": 6, "type": "SCALAR"}],
    "bufferViews": [], "buffers": [{}]})");
  std::string data;

  Gltf() {
    add_view(bytes_of(0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f));
    add_view(bytes_of(std::uint16_t{0}, std::uint16_t{1}, std::uint16_t{2}));
    add_view(bytes_of(-1.f, 0.f, 1.f, 1.f, 0.f, 1.f, -1.f, 0.f, -1.f, 1.f, 0.f, -1.f));  // Blender's plane
    add_view(bytes_of(std::uint16_t{0}, std::uint16_t{1}, std::uint16_t{3}, std::uint16_t{0}, std::uint16_t{3},
                      std::uint16_t{2}));
  }
  /// Adds bytes to the buffer and a view of them; returns the view's number.
  std::size_t add_view(const std::string& bytes) {
    document["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", data.size()}, {"byteLength", bytes.size()}});
    data += bytes;
    data.resize((data.size() + 3) / 4 * 4);
    return document["bufferViews"].size() - 1;
  }
  /// Adds an accessor of floats ("SCALAR", "VEC3" …) with its data; returns its number.
  std::size_t add_floats(const std::string& type, const std::vector<float>& values) {
    const std::size_t components = type == "MAT4" ? 16 : type == "SCALAR" ? 1 : static_cast<std::size_t>(type[3] - '0');
    std::string bytes;
    for (const float value : values) bytes += bytes_of(value);
    document["accessors"].push_back({{"bufferView", add_view(bytes)},
                                     {"componentType", 5126},
                                     {"count", values.size() / components},
                                     {"type", type}});
    return document["accessors"].size() - 1;
  }
  /// Adds an animation of one channel.
  void animate(std::size_t node, const std::string& path, const std::vector<float>& times,
               const std::vector<float>& values, const std::string& interpolation = "LINEAR") {
    const std::string type = path == "rotation" ? "VEC4" : path == "weights" ? "SCALAR" : "VEC3";
    const std::size_t input = add_floats("SCALAR", times), output = add_floats(type, values);
    document["animations"].push_back(
        {{"samplers", {{{"input", input}, {"output", output}, {"interpolation", interpolation}}}},
         {"channels", {{{"sampler", 0}, {"target", {{"node", node}, {"path", path}}}}}}});
  }
  json& at(const std::string& pointer) { return document[json::json_pointer(pointer)]; }

  [[nodiscard]] std::string glb() {
    document["buffers"][0]["byteLength"] = data.size();
    std::string text = document.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    const auto size = [](const std::string& s) { return static_cast<std::uint32_t>(s.size()); };
    return "glTF" + bytes_of(std::uint32_t{2}, 28 + size(text) + size(data), size(text)) + "JSON" + text +
           bytes_of(size(data)) + std::string("BIN\0", 4) + data;
  }
};

}  // namespace penumbra::test
