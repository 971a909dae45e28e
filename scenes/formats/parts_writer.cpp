// SPDX-License-Identifier: Apache-2.0
// Writes parts (named polygons with colours, such as wedges) as GLB, OBJ or PLY, in world space.

#include "scenes/formats/parts_writer.hpp"

#include "base/atomic_file.hpp"
#include "base/error.hpp"
#include "mesh/soup_ply.hpp"
#include "scenes/formats/glb_model.hpp"
#include "scenes/formats/writers.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace penumbra::scenes {
namespace {

bool is_bare(const Part& part) {
  return part.triangles.empty() && part.lines.empty();
}

int add_material(GlbModel& glb, const Part& part) {
  tinygltf::Material material;
  material.name = part.name;
  material.pbrMetallicRoughness.baseColorFactor = {part.color.x, part.color.y, part.color.z, part.color.w};
  material.pbrMetallicRoughness.metallicFactor = 0;
  material.pbrMetallicRoughness.roughnessFactor = 1;
  material.doubleSided = true;
  if (part.color.w < 1) material.alphaMode = "BLEND";
  return glb.add_material(std::move(material));
}

template <typename Element>
std::vector<std::uint32_t> flattened(const std::vector<Element>& elements) {
  std::vector<std::uint32_t> indices;
  for (const Element& element : elements) indices.insert(indices.end(), element.begin(), element.end());
  return indices;
}

void write_parts_glb(const std::filesystem::path& path, std::span<const Part> parts, const glm::dvec3& origin) {
  GlbModel glb;
  tinygltf::Node root;
  root.name = "parts";
  root.translation = {origin.x, origin.y, origin.z};
  for (const Part& part : parts) {
    if (is_bare(part)) continue;
    const int material = add_material(glb, part);
    const int positions = glb.add_positions({part.positions.begin(), part.positions.end()});
    tinygltf::Mesh mesh;
    mesh.name = part.name;
    if (!part.triangles.empty()) {
      mesh.primitives.push_back(glb.primitive(TINYGLTF_MODE_TRIANGLES, positions, flattened(part.triangles), material));
    }
    if (!part.lines.empty()) {
      mesh.primitives.push_back(glb.primitive(TINYGLTF_MODE_LINE, positions, flattened(part.lines), material));
    }
    root.children.push_back(glb.add_mesh_node(std::move(mesh)));
  }
  glb.add_root(glb.add_node(std::move(root)));
  write_file_atomically(path, glb.encoded());
}

void write_parts_obj(const std::filesystem::path& path, std::span<const Part> parts, const glm::dvec3& origin) {
  AtomicFile file(path);
  TextStream text(file);
  std::uint64_t first = 1;
  for (const Part& part : parts) {
    if (is_bare(part)) continue;
    text.print("o {}\n", part.name);
    for (const glm::dvec3& position : part.positions) text.print("v ").numbers(position + origin, " ").print("\n");
    for (const auto& [a, b, c] : part.triangles) text.print("f {} {} {}\n", first + a, first + b, first + c);
    for (const auto& [a, b] : part.lines) text.print("l {} {}\n", first + a, first + b);
    first += part.positions.size();
  }
  text.flush();
  file.commit();
}

mesh::Color bytes_of(const glm::dvec4& color) {
  const auto byte = [](double value) {
    return static_cast<std::uint8_t>(std::lround(255 * std::clamp(value, 0.0, 1.0)));
  };
  return {byte(color.x), byte(color.y), byte(color.z)};
}

void write_parts_ply(const std::filesystem::path& path, std::span<const Part> parts, const glm::dvec3& origin) {
  mesh::PlyMesh whole;
  for (const Part& part : parts) {
    const auto first = static_cast<std::uint32_t>(whole.positions.size());
    for (const glm::dvec3& position : part.positions) whole.positions.push_back(position + origin);
    for (const auto& [a, b, c] : part.triangles) {
      whole.triangles.push_back({first + a, first + b, first + c});
      whole.triangle_colors.push_back(bytes_of(part.color));
    }
    for (const auto& [a, b] : part.lines) whole.edges.push_back({first + a, first + b, bytes_of(part.color)});
  }
  mesh::write_ply(path, whole);
}

}  // namespace

void write_parts(const std::filesystem::path& file, std::span<const Part> parts, const glm::dvec3& origin) {
  const std::filesystem::path extension = file.extension();
  if (extension == ".glb") {
    write_parts_glb(file, parts, origin);
  } else if (extension == ".obj") {
    write_parts_obj(file, parts, origin);
  } else if (extension == ".ply") {
    write_parts_ply(file, parts, origin);
  } else {
    throw UsageError("{}: expected a name that ends in .glb, .obj or .ply", file.string());
  }
}

}  // namespace penumbra::scenes
