// SPDX-License-Identifier: Apache-2.0
// Tells from `asset.generator` whether Blender's exporter wrote a file, and whether that version wrote lamps in watts.

#include "import/gltf/blender_exporter.hpp"

#include <tiny_gltf.h>

#include <array>
#include <charconv>
#include <optional>
#include <string_view>

namespace penumbra::import {
namespace {

constexpr std::string_view kGenerator = "Khronos glTF Blender I/O";

/// Returns the three numbers of "v3.4.50"; nullopt if the generator's name does not end with a version.
std::optional<std::array<int, 3>> version_of(std::string_view generator) {
  const std::size_t at = generator.rfind('v');
  if (at == std::string_view::npos) return std::nullopt;
  const char* next = generator.data() + at + 1;
  const char* const end = generator.data() + generator.size();
  std::array<int, 3> version{};
  for (int& number : version) {
    const auto read = std::from_chars(next, end, number);
    if (read.ec != std::errc()) return std::nullopt;
    next = read.ptr;
    if (next != end && *next == '.') ++next;
  }
  return version;
}

}  // namespace

bool is_from_blender(const tinygltf::Model& model) {
  return model.asset.generator.starts_with(kGenerator);
}

bool writes_watts(const tinygltf::Model& model) {
  if (!is_from_blender(model)) return false;
  const auto version = version_of(std::string_view(model.asset.generator).substr(kGenerator.size()));
  return version && *version < std::array{3, 4, 36};
}

}  // namespace penumbra::import
