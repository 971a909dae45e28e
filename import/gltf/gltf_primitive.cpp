// SPDX-License-Identifier: Apache-2.0
// A primitive's vertices and triangles, from triangle lists, strips and fans (glTF 2.0, 3.7.2.1). Points and lines have
// no area, and are left out.

#include "import/gltf/gltf_primitive.hpp"

#include "base/error.hpp"
#include "import/gltf/gltf_accessor.hpp"

#include <tiny_gltf.h>

#include <limits>
#include <span>
#include <utility>

namespace penumbra::import {
namespace {

/// Returns the triangles of a primitive as indices into its vertices, with the windings of glTF 2.0, 3.7.2.1;
/// `leftover` counts the indices at the end that form no triangle.
std::vector<mesh::Triangle> assemble(int mode, std::span<const std::uint32_t> v, std::uint64_t& leftover) {
  std::vector<mesh::Triangle> triangles;
  triangles.reserve(mode == TINYGLTF_MODE_TRIANGLES ? v.size() / 3 : v.size());
  if (mode == TINYGLTF_MODE_TRIANGLES) {
    for (std::size_t i = 0; i + 2 < v.size(); i += 3) triangles.push_back({v[i], v[i + 1], v[i + 2]});
    leftover += v.size() % 3;
    return triangles;
  }
  for (std::size_t i = 0; i + 2 < v.size(); ++i) {
    if (mode == TINYGLTF_MODE_TRIANGLE_STRIP)
      triangles.push_back({v[i], v[i + 1 + i % 2], v[i + 2 - i % 2]});
    else
      triangles.push_back({v[i + 1], v[i + 2], v[0]});
  }
  if (v.size() < 3) leftover += v.size();
  return triangles;
}

}  // namespace

std::optional<PrimitiveMesh> read_primitive(const tinygltf::Model& model, const tinygltf::Primitive& primitive,
                                            const std::string& place, SkippedPrimitives& skipped) {
  const int mode = primitive.mode < 0 ? TINYGLTF_MODE_TRIANGLES : primitive.mode;
  if (mode > TINYGLTF_MODE_TRIANGLE_FAN) throw InputError("{}/mode: {}; expected 0 to 6", place, mode);
  if (mode < TINYGLTF_MODE_TRIANGLES) {
    ++skipped.points_and_lines;
    return std::nullopt;
  }
  if (primitive.extensions.contains("KHR_draco_mesh_compression")) {
    throw InputError("{}: KHR_draco_mesh_compression is not supported; export without compression", place);
  }
  const auto attribute = primitive.attributes.find("POSITION");
  if (attribute == primitive.attributes.end()) {
    ++skipped.without_positions;
    return std::nullopt;
  }
  std::vector<glm::dvec3> positions = read_positions(model, attribute->second);
  std::vector<std::uint32_t> indices;
  if (primitive.indices >= 0) {
    indices = read_indices(model, primitive.indices);
  } else {
    if (positions.size() > std::numeric_limits<std::uint32_t>::max()) throw InputError("{}: too many vertices", place);
    for (std::size_t i = 0; i < positions.size(); ++i) indices.push_back(static_cast<std::uint32_t>(i));
  }
  for (std::size_t i = 0; i < indices.size(); ++i) {
    if (indices[i] >= positions.size()) {
      throw InputError("{}: index {} at /accessors/{} names vertex {}, but there are only {}", place, i,
                       primitive.indices, indices[i], positions.size());
    }
  }
  std::vector<mesh::Triangle> triangles = assemble(mode, indices, skipped.leftover_indices);
  if (triangles.empty()) {
    ++skipped.without_triangles;
    return std::nullopt;
  }
  return PrimitiveMesh{std::move(positions), std::move(triangles)};
}

}  // namespace penumbra::import
