// SPDX-License-Identifier: Apache-2.0
// EXT_mesh_gpu_instancing: a node's mesh appears once for each element of the extension's TRANSLATION, ROTATION and
// SCALE accessors, instead of once at the node.

#include "import/gltf/gltf_instances.hpp"

#include "base/error.hpp"
#include "import/gltf/gltf_accessor.hpp"
#include "import/gltf/gltf_nodes.hpp"

#include <tiny_gltf.h>

#include <algorithm>
#include <span>
#include <string>

namespace penumbra::import {
namespace {

constexpr const char* kInstancing = "EXT_mesh_gpu_instancing";

/// One attribute's value of each instance; empty if the extension does not have it.
struct Attribute {
  Numbers numbers;
  [[nodiscard]] std::vector<double> of(std::size_t instance) const {
    if (numbers.values.empty()) return {};
    const auto all = std::span(numbers.values).subspan(instance * numbers.components, numbers.components);
    return {all.begin(), all.end()};
  }
};

}  // namespace

std::optional<std::vector<glm::dmat4>> instances_of(const tinygltf::Model& model, const tinygltf::Node& node,
                                                    int number) {
  const auto extension = node.extensions.find(kInstancing);
  if (extension == node.extensions.end()) return std::nullopt;
  const std::string place = fmt::format("/nodes/{}/extensions/{}", number, kInstancing);
  std::optional<std::size_t> count;
  const auto read = [&](const char* name, int type) {
    Attribute attribute;
    if (!extension->second.Has("attributes") || !extension->second.Get("attributes").Has(name)) return attribute;
    const tinygltf::Value& accessor = extension->second.Get("attributes").Get(name);
    attribute.numbers = read_numbers(model, accessor.IsInt() ? accessor.GetNumberAsInt() : -1, {type}, name);
    if (count && *count != attribute.numbers.count()) {
      throw InputError("{}/attributes/{}: {} instances; another attribute has {}", place, name,
                       attribute.numbers.count(), *count);
    }
    count = attribute.numbers.count();
    return attribute;
  };
  const Attribute translation = read("TRANSLATION", TINYGLTF_TYPE_VEC3),
                  rotation = read("ROTATION", TINYGLTF_TYPE_VEC4), scale = read("SCALE", TINYGLTF_TYPE_VEC3);
  // Attributes of other names also give the number of instances.
  const tinygltf::Value& extra = extension->second;
  for (const std::string& name :
       extra.Has("attributes") ? extra.Get("attributes").Keys() : std::vector<std::string>()) {
    const tinygltf::Value& accessor = extra.Get("attributes").Get(name);
    const auto number_of = static_cast<std::size_t>(accessor.IsInt() ? accessor.GetNumberAsInt() : -1);
    if (!count && number_of < model.accessors.size()) count = model.accessors[number_of].count;
  }
  std::vector<glm::dmat4> instances;
  for (std::size_t i = 0; i < count.value_or(0); ++i)
    instances.push_back(transform_of({translation.of(i), rotation.of(i), scale.of(i)}, place));
  return instances;
}

}  // namespace penumbra::import
