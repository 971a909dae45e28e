// SPDX-License-Identifier: Apache-2.0
// Reads the program's own entries in `extras`. A value of another type belongs to another tool: it is mentioned and
// ignored.

#include "import/gltf/gltf_extras.hpp"

#include "base/error.hpp"

#include <tiny_gltf.h>

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace penumbra::import {
namespace {

/// Returns the entry; null if there is none.
const tinygltf::Value* entry(const tinygltf::Value& extras, const char* key) {
  return extras.IsObject() && extras.Has(key) ? &extras.Get(key) : nullptr;
}

void mention_foreign(const char* key, const char* expected, const std::string& owner, scenes::Losses& losses) {
  losses.mention(fmt::format("has extras \"{}\" of another tool (no {}), which are left out", key, expected), owner);
}

std::string text(const tinygltf::Value& extras, const char* key, const std::string& owner, scenes::Losses& losses) {
  const tinygltf::Value* const value = entry(extras, key);
  if (value == nullptr) return {};
  if (value->IsString()) return value->Get<std::string>();
  mention_foreign(key, "name", owner, losses);
  return {};
}

}  // namespace

std::optional<bool> flag_of_extras(const tinygltf::Value& extras, const char* key, const std::string& owner,
                                   scenes::Losses& losses) {
  const tinygltf::Value* const value = entry(extras, key);
  if (value == nullptr) return std::nullopt;
  if (value->IsBool()) return value->Get<bool>();
  const double number = value->IsNumber() ? value->GetNumberAsDouble() : -1;
  if (number == 0 || number == 1) return number == 1;
  mention_foreign(key, "true or false, or 1 or 0", owner, losses);
  return std::nullopt;
}

ObjectFlags flags_of(const tinygltf::Node& node, const tinygltf::Mesh& mesh, scenes::Losses& losses) {
  const auto read = [&](const char* key) {
    const auto own = flag_of_extras(node.extras, key, node.name, losses);
    return own ? *own : flag_of_extras(mesh.extras, key, mesh.name, losses).value_or(true);
  };
  std::string light = text(node.extras, "lightName", node.name, losses);
  if (light.empty()) light = text(mesh.extras, "lightName", mesh.name, losses);
  return {read("castsShadow"), read("receivesShadow"), read("body"), std::move(light)};
}

bool lamp_casts_shadows(const tinygltf::Node& node, scenes::Losses& losses) {
  return flag_of_extras(node.extras, "castsShadow", node.name, losses).value_or(true);
}

std::optional<double> number_of_extras(const tinygltf::Value& extras, const char* key, const std::string& owner,
                                       scenes::Losses& losses) {
  const tinygltf::Value* const value = entry(extras, key);
  if (value == nullptr) return std::nullopt;
  if (value->IsNumber()) return value->GetNumberAsDouble();
  mention_foreign(key, "number", owner, losses);
  return std::nullopt;
}

std::vector<double> list_of_extras(const tinygltf::Value& object, const char* key, std::size_t count, double least,
                                   const std::string& place) {
  const tinygltf::Value& list = object.Get(key);
  bool good = list.IsArray() && list.ArrayLen() == count;
  std::vector<double> all;
  for (std::size_t i = 0; good && i < count; ++i) {
    const tinygltf::Value& value = list.Get(static_cast<int>(i));
    all.push_back(value.IsNumber() ? value.GetNumberAsDouble() : least - 1);
    good = std::isfinite(all.back()) && all.back() >= least;
  }
  if (!good) throw InputError("{}/{}: expected {} numbers from {} up", place, key, count, least);
  return all;
}

}  // namespace penumbra::import
