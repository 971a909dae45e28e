#include "import/gltf/gltf_extras.hpp"

#include "base/error.hpp"

#include <tiny_gltf.h>

#include <optional>
#include <string>
#include <utility>

namespace penumbra::scenes {
namespace {

std::optional<bool> flag(const tinygltf::Value& extras, const char* key, const std::string& owner) {
  if (!extras.IsObject() || !extras.Has(key)) return std::nullopt;
  const tinygltf::Value& value = extras.Get(key);
  if (value.IsBool()) return value.Get<bool>();
  const double number = value.IsNumber() ? value.GetNumberAsDouble() : -1;
  if (number != 0 && number != 1) throw InputError("{}: extras/{}: expected true or false, or 1 or 0", owner, key);
  return number == 1;
}

std::string text(const tinygltf::Value& extras, const char* key, const std::string& owner) {
  if (!extras.IsObject() || !extras.Has(key)) return {};
  const tinygltf::Value& value = extras.Get(key);
  if (!value.IsString()) throw InputError("{}: extras/{}: expected a name", owner, key);
  return value.Get<std::string>();
}

}  // namespace

ObjectFlags flags_of(const tinygltf::Node& node, const tinygltf::Mesh& mesh) {
  const auto read = [&](const char* key) {
    const auto own = flag(node.extras, key, fmt::format("node \"{}\"", node.name));
    return own ? *own : flag(mesh.extras, key, fmt::format("mesh \"{}\"", mesh.name)).value_or(true);
  };
  std::string light = text(node.extras, "lightName", fmt::format("node \"{}\"", node.name));
  if (light.empty()) light = text(mesh.extras, "lightName", fmt::format("mesh \"{}\"", mesh.name));
  return {read("castsShadow"), read("receivesShadow"), read("body"), std::move(light)};
}

bool lamp_casts_shadows(const tinygltf::Node& node) {
  return flag(node.extras, "castsShadow", fmt::format("node \"{}\"", node.name)).value_or(true);
}

}  // namespace penumbra::scenes
