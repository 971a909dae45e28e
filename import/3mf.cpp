// SPDX-License-Identifier: Apache-2.0
// Reads 3MF files: meshes, components and build items.

#include "import/3mf.hpp"

#include "import/assembly.hpp"
#include "import/text.hpp"
#include "import/xml.hpp"
#include "import/zip_archive.hpp"

#include <array>
#include <cctype>
#include <charconv>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <utility>

namespace penumbra::import {
namespace {

/// Returns a name in the form in which packages compare names: lower case, percent escapes decoded, forward slashes,
/// and no leading slash (paths have one, archive entries none).
std::string compared(std::string_view path) {
  std::string name;
  for (std::size_t i = 0; i < path.size(); ++i) {
    unsigned code = static_cast<unsigned char>(path[i]);
    if (code == '%' && i + 2 < path.size()) {
      const char* const digits = path.data() + i + 1;
      unsigned undone = 0;
      if (std::from_chars(digits, digits + 2, undone, 16).ptr == digits + 2) {
        code = undone;
        i += 2;
      }
    }
    name += code == '\\' ? '/' : static_cast<char>(std::tolower(static_cast<int>(code)));
  }
  return name.substr(name.starts_with('/') ? 1 : 0);
}

/// The archive's entries by their names in the package.
class Entries {
 public:
  explicit Entries(const ZipArchive& archive) {
    for (const std::string& name : archive.names()) by_name_.emplace(compared(name), name);
  }
  /// Returns the entry of that name as the archive spells it; `path` without its leading slash if there is none.
  [[nodiscard]] std::string find(std::string_view path) const {
    const auto found = by_name_.find(compared(path));
    return found != by_name_.end() ? found->second : std::string(path.substr(path.starts_with('/') ? 1 : 0));
  }

 private:
  std::map<std::string, std::string> by_name_;
};

/// Returns the part with which the package begins.
std::string find_start(const ZipArchive& archive, const Entries& entries, const std::string& file) {
  const std::string relationships = entries.find("_rels/.rels");
  if (archive.contains(relationships)) {
    const std::string text = archive.read(relationships);
    const XmlText xml(text, fmt::format("{}: {}", file, relationships));
    for (const pugi::xml_node& relationship : children_named(xml.document().document_element(), "Relationship")) {
      if (std::string_view(relationship.attribute("Type").value()).ends_with("/3dmodel"))
        return entries.find(relationship.attribute("Target").value());
    }
  }
  for (const std::string& name : archive.names()) {
    if (compared(name).ends_with(".model")) return name;
  }
  throw InputError("{}: a zip archive without a 3D model in it; this is no 3MF package", file);
}

class PackageReader {
 public:
  PackageReader(const ZipArchive& archive, const std::string& file)
      : archive_(archive), entries_(archive), file_(file) {}

  mesh::ImportedMesh read() {
    const std::string start = find_start(archive_, entries_, file_);
    want(start);
    while (!wanted_.empty()) {
      const std::string entry = wanted_.back();
      wanted_.pop_back();
      const std::string text = archive_.read(entry);
      read_model(XmlText(text, file_ + ": " + entry), entry, entry == start);
    }
    for (const Reference& reference : references_) {
      const auto target = numbers_.find(reference.target);
      if (target == numbers_.end()) {
        throw InputError("{}: {}: there is no object with the id '{}'", file_, reference.target.first,
                         reference.target.second);
      }
      auto& list = reference.part ? parts_[*reference.part].children : roots_;
      list.push_back({target->second, reference.placement});
    }
    if (roots_.empty() && !parts_.empty()) {
      throw InputError("{}: {}: its <build> lists no <item>, so that none of its {} objects is made; list them", file_,
                       start, parts_.size());
    }
    mesh::ImportedMesh mesh = assemble(parts_, roots_, file_);
    mesh.notes.insert(mesh.notes.end(), notes_.begin(), notes_.end());
    if (lattices_ > 0) mesh.notes.push_back(fmt::format("{} beam lattices skipped", lattices_));
    return mesh;
  }

 private:
  using Target = std::pair<std::string, std::string>;  ///< the entry and the id
  struct Reference {
    std::optional<std::size_t> part;  ///< the part made from the target; nullopt if the build lists the target
    Target target;
    glm::dmat4 placement;
  };

  void want(const std::string& entry) {
    if (known_.insert(entry).second) wanted_.push_back(entry);
  }

  void read_model(const XmlText& xml, const std::string& entry, bool is_start) {
    const pugi::xml_node model = xml.document().document_element();
    if (local_name(model) != "model") xml.fail(model, "the outermost element is <{}>; expected <model>", model.name());
    for (const pugi::xml_node& resources : children_named(model, "resources")) {
      for (const pugi::xml_node& object : children_named(resources, "object")) read_object(xml, object, entry);
    }
    note_print_unit(model, notes_);
    if (!is_start) return;  // other models have their own builds, which do not belong to this package
    for (const pugi::xml_node& build : children_named(model, "build")) {
      for (const pugi::xml_node& item : children_named(build, "item")) refer(xml, item, entry, std::nullopt);
    }
  }

  void read_object(const XmlText& xml, const pugi::xml_node& object, const std::string& entry) {
    const std::string id = object.attribute("id").value();
    const std::size_t number = parts_.size();
    if (!numbers_.emplace(Target{entry, id}, number).second) xml.fail(object, "the id '{}' occurs twice", id);
    parts_.push_back({fmt::format("object '{}'", id), {}, {}, {}});
    for (const pugi::xml_node& mesh : children_named(object, "mesh")) read_mesh(xml, mesh, parts_[number]);
    for (const pugi::xml_node& components : children_named(object, "components")) {
      for (const pugi::xml_node& component : children_named(components, "component"))
        refer(xml, component, entry, number);
    }
  }

  void read_mesh(const XmlText& xml, const pugi::xml_node& mesh, AssemblyPart& part) {
    const std::size_t first = part.positions.size();
    for (const pugi::xml_node& vertices : children_named(mesh, "vertices")) {
      for (const pugi::xml_node& vertex : children_named(vertices, "vertex")) {
        const auto at = [&](const char* name) { return xml.coordinate(vertex, vertex.attribute(name).value(), name); };
        part.positions.emplace_back(at("x"), at("y"), at("z"));
      }
    }
    if (part.positions.size() > std::numeric_limits<std::uint32_t>::max()) xml.fail(mesh, "too many vertices");
    const std::size_t count = part.positions.size() - first;
    for (const pugi::xml_node& triangles : children_named(mesh, "triangles")) {
      for (const pugi::xml_node& triangle : children_named(triangles, "triangle")) {
        const auto at = [&](const char* name) {
          return static_cast<std::uint32_t>(first) + xml.index(triangle, triangle.attribute(name).value(), count);
        };
        part.triangles.push_back({at("v1"), at("v2"), at("v3")});
      }
    }
    lattices_ += children_named(mesh, "beamlattice").size();
  }

  void refer(const XmlText& xml, const pugi::xml_node& node, const std::string& entry,
             std::optional<std::size_t> from) {
    const pugi::xml_attribute path = attribute_named(node, "path");  // attribute of the production extension
    const std::string target = path ? entries_.find(path.value()) : entry;
    want(target);
    references_.push_back({from, {target, node.attribute("objectid").value()}, read_transform(xml, node)});
  }

  /// Reads four rows of three numbers, a matrix for row vectors: its rows are the columns of a glm matrix.
  static glm::dmat4 read_transform(const XmlText& xml, const pugi::xml_node& node) {
    glm::dmat4 matrix(1);
    const pugi::xml_attribute transform = node.attribute("transform");
    if (!transform) return matrix;
    std::string_view rest = transform.value();
    for (glm::length_t i = 0; i < 12; ++i) {
      const std::string word(take_word(rest));
      matrix[i / 3][i % 3] = xml.real(node, word.c_str(), fmt::format("number {} of the transform", i + 1));
    }
    if (!take_word(rest).empty()) xml.fail(node, "the transform has more than 12 numbers");
    return matrix;
  }

  const ZipArchive& archive_;
  const Entries entries_;
  const std::string& file_;
  std::set<std::string> known_;  ///< entries that were requested before
  std::vector<std::string> wanted_;
  std::vector<AssemblyPart> parts_;
  std::map<Target, std::size_t> numbers_;
  std::vector<Reference> references_;
  std::vector<PlacedPart> roots_;
  std::vector<std::string> notes_;
  std::uint64_t lattices_ = 0;
};

}  // namespace

mesh::ImportedMesh read_3mf(std::string_view content, const std::string& file) {
  if (!ZipArchive::is_one(content)) throw InputError("{}: it is no zip archive, as 3MF packages are", file);
  const ZipArchive archive(content, file);
  return PackageReader(archive, file).read();
}

}  // namespace penumbra::import
