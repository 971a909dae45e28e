// SPDX-License-Identifier: Apache-2.0
// Reads AMF files: meshes and constellations.

#include "import/amf.hpp"

#include "import/assembly.hpp"
#include "import/xml.hpp"
#include "import/zip_archive.hpp"

#include <glm/gtc/matrix_transform.hpp>
#include <glm/trigonometric.hpp>

#include <array>
#include <limits>
#include <map>

namespace penumbra::import {
namespace {

class AmfReader {
 public:
  explicit AmfReader(const XmlText& xml) : xml_(xml) {}

  mesh::ImportedMesh read() {
    const pugi::xml_node amf = xml_.document().document_element();
    if (local_name(amf) != "amf") xml_.fail(amf, "the outermost element is <{}>; expected <amf>", amf.name());
    const auto objects = children_named(amf, "object"), constellations = children_named(amf, "constellation");
    for (const pugi::xml_node& node : objects) add_part(node);
    for (const pugi::xml_node& node : constellations) add_part(node);
    for (const pugi::xml_node& node : objects) read_object(node);
    std::size_t part = objects.size();
    for (const pugi::xml_node& node : constellations) read_constellation(node, parts_[part++]);

    std::vector<bool> placed(parts_.size(), false);
    for (const AssemblyPart& parent : parts_) {
      for (const PlacedPart& child : parent.children) placed[child.part] = true;
    }
    std::vector<PlacedPart> roots;
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      if (!placed[i]) roots.push_back({i, glm::dmat4(1)});
    }
    if (roots.empty() && !parts_.empty()) roots.push_back({0, glm::dmat4(1)});  // every part is a child of another
    mesh::ImportedMesh mesh = assemble(parts_, roots, xml_.file());
    note_print_unit(amf, mesh.notes);
    if (curved_ > 0)
      mesh.notes.push_back(fmt::format("{} normals and curved edges ignored: triangles are flat", curved_));
    return mesh;
  }

 private:
  void add_part(const pugi::xml_node& node) {
    const std::string id = node.attribute("id").value();
    if (!numbers_.emplace(id, parts_.size()).second) xml_.fail(node, "the id '{}' occurs twice", id);
    parts_.push_back({fmt::format("{} '{}'", node.name(), id), {}, {}, {}});
  }

  void read_object(const pugi::xml_node& object) {
    AssemblyPart& part = parts_[numbers_.at(object.attribute("id").value())];
    for (const pugi::xml_node& mesh : children_named(object, "mesh")) {
      const std::size_t first = part.positions.size();
      for (const pugi::xml_node& vertices : children_named(mesh, "vertices")) {
        for (const pugi::xml_node& vertex : children_named(vertices, "vertex")) read_vertex(vertex, part);
        curved_ += children_named(vertices, "edge").size();
      }
      if (part.positions.size() > std::numeric_limits<std::uint32_t>::max()) xml_.fail(mesh, "too many vertices");
      const std::size_t count = part.positions.size() - first;
      for (const pugi::xml_node& volume : children_named(mesh, "volume")) {
        for (const pugi::xml_node& triangle : children_named(volume, "triangle")) {
          mesh::Triangle corners{};
          constexpr std::array<const char*, 3> kNames{"v1", "v2", "v3"};
          for (std::size_t i = 0; i < 3; ++i) {
            const pugi::xml_node corner = triangle.child(kNames[i]);
            if (!corner) xml_.fail(triangle, "the triangle has no <{}>", kNames[i]);
            corners[i] = static_cast<std::uint32_t>(first) + xml_.index(triangle, corner.child_value(), count);
          }
          part.triangles.push_back(corners);
        }
      }
    }
  }

  void read_vertex(const pugi::xml_node& vertex, AssemblyPart& part) {
    const pugi::xml_node coordinates = vertex.child("coordinates");
    if (!coordinates) xml_.fail(vertex, "the vertex has no <coordinates>");
    curved_ += vertex.child("normal") ? 1 : 0;
    glm::dvec3 position;
    constexpr std::array<const char*, 3> kNames{"x", "y", "z"};
    for (std::size_t i = 0; i < 3; ++i) {
      const pugi::xml_node child = coordinates.child(kNames[i]);
      if (!child) xml_.fail(coordinates, "there is no <{}>", kNames[i]);
      position[static_cast<glm::length_t>(i)] = xml_.coordinate(child, child.child_value(), kNames[i]);
    }
    part.positions.push_back(position);
  }

  /// Reads a vector; missing coordinates are 0.
  glm::dvec3 read_vector(const pugi::xml_node& node, const std::array<const char*, 3>& names) const {
    glm::dvec3 vector(0);
    for (std::size_t i = 0; i < 3; ++i) {
      const pugi::xml_node child = node.child(names[i]);
      if (child) vector[static_cast<glm::length_t>(i)] = xml_.real(child, child.child_value(), names[i]);
    }
    return vector;
  }

  void read_constellation(const pugi::xml_node& node, AssemblyPart& part) const {
    for (const pugi::xml_node& instance : children_named(node, "instance")) {
      const std::string id = instance.attribute("objectid").value();
      const auto found = numbers_.find(id);
      if (found == numbers_.end()) xml_.fail(instance, "there is no object or constellation with the id '{}'", id);
      // Rotated about x, then y, then z, and then translated.
      const glm::dvec3 degrees = read_vector(instance, {"rx", "ry", "rz"});
      glm::dmat4 placement = glm::translate(glm::dmat4(1), read_vector(instance, {"deltax", "deltay", "deltaz"}));
      for (glm::length_t axis = 2; axis >= 0; --axis) {
        glm::dvec3 around(0);
        around[axis] = 1;
        placement = glm::rotate(placement, glm::radians(degrees[axis]), around);
      }
      part.children.push_back({found->second, placement});
    }
  }

  const XmlText& xml_;
  std::vector<AssemblyPart> parts_;
  std::map<std::string, std::size_t> numbers_;  ///< of parts, by id
  std::uint64_t curved_ = 0;
};

}  // namespace

mesh::ImportedMesh read_amf(std::string_view content, const std::string& file) {
  if (!ZipArchive::is_one(content)) return AmfReader(XmlText(content, file)).read();
  ZipArchive archive(content, file);
  for (const std::string& name : archive.names()) {
    if (!name.ends_with(".amf") && !name.ends_with(".AMF")) continue;
    const std::string text = archive.read(name);
    return AmfReader(XmlText(text, file + ": " + name)).read();
  }
  throw InputError("{}: a zip archive without an .amf file in it", file);
}

}  // namespace penumbra::import
