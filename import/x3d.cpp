#include "import/x3d.hpp"

#include "import/assembly.hpp"
#include "import/text.hpp"
#include "import/x3d_geometry.hpp"
#include "import/xml.hpp"

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace penumbra::mesh {
namespace {

/// Nodes whose children are shown as they are, whatever else they do (Collision and Billboard for a camera that moves).
constexpr std::array<std::string_view, 16> kGroups = {
    "Scene",    "Group",   "StaticGroup",    "Collision",   "Anchor", "Billboard", "PickableGroup", "CADAssembly",
    "CADLayer", "CADFace", "ViewpointGroup", "LayoutGroup", "Layer",  "LayerSet",  "LayoutLayer",   "ScreenGroup"};
constexpr std::array<std::string_view, 2> kTransforms = {"Transform", "CADPart"};

template <std::size_t N>
bool is_one_of(std::string_view name, const std::array<std::string_view, N>& names) {
  return std::ranges::find(names, name) != names.end();
}

class X3dReader {
 public:
  explicit X3dReader(const XmlText& xml)
      : xml_(xml), resolve_([this](const pugi::xml_node& node) { return resolved(node); }) {}

  ImportedMesh read() {
    const pugi::xml_node x3d = xml_.document().document_element();
    if (local_name(x3d) != "X3D") xml_.fail(x3d, "the outermost element is <{}>; expected <X3D>", x3d.name());
    const pugi::xml_node scene = x3d.child("Scene");
    if (!scene) xml_.fail(x3d, "there is no <Scene>");
    find_names(scene);
    const std::size_t root = part_of(scene);
    while (!waiting_.empty()) {  // no recursion: a file may nest a million nodes
      const pugi::xml_node node = waiting_.back();
      waiting_.pop_back();
      expand(node, numbers_.at(node.hash_value()));
    }
    require_all_shapes();
    if (lines_only()) throw InputError("{}: there are no triangles in it ({})", xml_.file(), listed(lines_));
    ImportedMesh mesh = assemble(parts_, std::array{PlacedPart{root, glm::dmat4(1)}}, xml_.file());
    if (curved_ > 0) {
      mesh.notes.push_back(
          fmt::format("{} spheres, cones, cylinders or disks became polygons of {} sides", curved_, kX3dSides));
    }
    if (!lines_.empty()) mesh.notes.push_back("skipped, as they are no surfaces here: " + listed(lines_));
    if (left_out_ > 0) {
      mesh.notes.push_back(fmt::format(
          "{} of {} shapes are not shown by the file's own switches, levels of detail or visibility: left out",
          left_out_, shapes_));
    }
    if (!ignored_.empty()) mesh.notes.push_back("ignored: " + listed(ignored_));
    return mesh;
  }

 private:
  /// What each USE means: the last node before it that DEF gave this name.
  void find_names(const pugi::xml_node& scene) {
    std::map<std::string, pugi::xml_node> named;
    for (pugi::xml_node node = scene; node; node = following(node, scene)) {
      if (const pugi::xml_attribute use = node.attribute("USE")) {
        const auto found = named.find(use.value());
        if (found == named.end()) xml_.fail(node, "USE: there is no node '{}' before it", printable(use.value()));
        uses_.emplace(node.hash_value(), found->second);
      } else {
        if (const pugi::xml_attribute name = node.attribute("DEF")) named[name.value()] = node;
        shapes_ += local_name(node) == "Shape" ? 1 : 0;
      }
    }
  }
  /// In document order, below `top`.
  static pugi::xml_node following(pugi::xml_node node, const pugi::xml_node& top) {
    if (node.first_child()) return node.first_child();
    while (node && node != top && !node.next_sibling()) node = node.parent();
    return node == top ? pugi::xml_node() : node.next_sibling();
  }
  [[nodiscard]] pugi::xml_node resolved(const pugi::xml_node& node) const {
    const auto found = uses_.find(node.hash_value());
    return found == uses_.end() ? node : found->second;
  }

  std::size_t part_of(const pugi::xml_node& node) {
    const auto [known, is_new] = numbers_.emplace(node.hash_value(), parts_.size());
    if (is_new) {
      const char* name = node.attribute("DEF").value();
      parts_.push_back({*name == '\0' ? fmt::format("a <{}>", node.name()) : fmt::format("'{}'", printable(name)),
                        {},
                        {},
                        {},
                        {},
                        {}});
      waiting_.push_back(node);
    }
    return known->second;
  }

  void expand(const pugi::xml_node& node, std::size_t number) {
    if (local_name(node) == "Shape") return read_shape(node, parts_[number]);
    const glm::dmat4 placement = is_one_of(local_name(node), kTransforms) ? transform_of(node) : glm::dmat4(1);
    for (const pugi::xml_node& child : shown_children(node)) {
      const std::size_t child_number = part_of(child);
      parts_[number].children.push_back({child_number, placement});
    }
  }

  /// The children that can hold shapes, and are shown.
  std::vector<pugi::xml_node> shown_children(const pugi::xml_node& node) {
    std::vector<pugi::xml_node> all, shown;
    for (const pugi::xml_node& child : node.children()) {
      if (child.type() == pugi::node_element && !local_name(child).starts_with("Metadata")) all.push_back(child);
    }
    const bool is_switch = local_name(node) == "Switch", is_detail = local_name(node) == "LOD";
    const int choice = is_detail ? 0 : node.attribute("whichChoice").as_int(-1);
    for (std::size_t i = 0; i < all.size(); ++i) {
      const bool is_proxy = std::string_view(all[i].attribute("containerField").value()) == "proxy";
      const bool chosen = !(is_switch || is_detail) || static_cast<int>(i) == choice;
      const pugi::xml_node child = resolved(all[i]);
      if (is_proxy || !chosen || !child.attribute("visible").as_bool(true))
        leave_out(all[i]);
      else if (can_hold_shapes(child))
        shown.push_back(child);
      else
        ignore(child);
    }
    return shown;
  }
  static bool can_hold_shapes(const pugi::xml_node& node) {
    const std::string_view name = local_name(node);
    return name == "Shape" || name == "Switch" || name == "LOD" || is_one_of(name, kGroups) ||
           is_one_of(name, kTransforms);
  }

  /// Shapes below a node that the file itself does not show.
  void leave_out(const pugi::xml_node& node) {
    for (pugi::xml_node below = node; below; below = following(below, node)) {
      if (local_name(below) == "Shape" && !uses_.contains(below.hash_value()))
        left_out_nodes_.insert(below.hash_value());
    }
  }
  void ignore(const pugi::xml_node& node) {
    const std::string_view name = local_name(node);
    constexpr std::array<std::string_view, 3> kElsewhere = {"Inline", "ProtoInstance", "ParticleSystem"};
    bool holds = is_one_of(name, kElsewhere);
    if (name == "ProtoDeclare" || name == "ExternProtoDeclare") return leave_out(node);  // shown by instances alone
    for (pugi::xml_node below = node; below && !holds; below = following(below, node)) {
      holds = local_name(below) == "Shape";
    }
    if (holds) {
      xml_.fail(node, "<{}> may hold surfaces, but is not supported; write what it shows as Transform and Shape", name);
    }
    ++ignored_[std::string(name)];
  }

  void read_shape(const pugi::xml_node& shape, AssemblyPart& part) {
    ++reached_;
    for (const pugi::xml_node& child : shape.children()) {
      const std::string_view name = local_name(child);
      if (child.type() != pugi::node_element || name == "Appearance" || name.starts_with("Metadata")) continue;
      if (name == "ProtoInstance" && std::string_view(child.attribute("containerField").value()) == "appearance")
        continue;
      const pugi::xml_node geometry = resolved(child);
      switch (add_x3d_geometry(xml_, geometry, resolve_, part)) {
        case X3dGeometry::surface:
          break;
        case X3dGeometry::curved:
          ++curved_;
          break;
        case X3dGeometry::line:
          ++lines_[std::string(local_name(geometry))];
          break;
        case X3dGeometry::unknown:
          xml_.fail(geometry, "the geometry <{}> is not supported; write it as IndexedFaceSet", local_name(geometry));
      }
    }
  }

  /// Translation · centre · rotation · scale along turned axes, and back from the centre.
  [[nodiscard]] glm::dmat4 transform_of(const pugi::xml_node& node) const {
    const auto vector = [&](const char* name, double fallback) {
      const std::vector<double> v = x3d_reals(xml_, node, name, {fallback, fallback, fallback});
      return glm::dvec3(v[0], v[1], v[2]);
    };
    const auto rotation = [&](const char* name) {
      const std::vector<double> v = x3d_reals(xml_, node, name, {0, 0, 1, 0});
      const glm::dvec3 axis(v[0], v[1], v[2]);
      return glm::length(axis) > 0 ? glm::rotate(glm::dmat4(1), v[3], axis) : glm::dmat4(1);
    };
    const glm::dvec3 center = vector("center", 0);
    const glm::dmat4 axes = rotation("scaleOrientation");
    return glm::translate(glm::dmat4(1), vector("translation", 0) + center) * rotation("rotation") * axes *
           glm::scale(glm::dmat4(1), vector("scale", 1)) * glm::transpose(axes) *
           glm::translate(glm::dmat4(1), -center);
  }

  /// Every shape of the file is in the mesh, or the file itself does not show it.
  void require_all_shapes() {
    for (const auto& [node, number] : numbers_) left_out_nodes_.erase(node);  // shown elsewhere by USE
    left_out_ = left_out_nodes_.size();
    if (reached_ + left_out_ != shapes_) {
      throw InputError("{}: it holds {} shapes, but {} came through; the reader would lose some", xml_.file(), shapes_,
                       reached_ + left_out_);
    }
  }
  [[nodiscard]] bool lines_only() const {
    return std::ranges::all_of(parts_, [](const AssemblyPart& part) { return part.face_ends.empty(); });
  }
  using Counts = std::map<std::string, std::uint64_t>;
  static std::string listed(const Counts& counts) {
    std::string list;
    for (const auto& [name, count] : counts)
      list += fmt::format("{}{} {}", list.empty() ? "" : ", ", count, printable(name));
    return list;
  }

  const XmlText& xml_;
  X3dResolve resolve_;
  std::map<std::size_t, pugi::xml_node> uses_;  ///< by the hash of a node with USE: what it means
  std::map<std::size_t, std::size_t> numbers_;  ///< of parts, by their nodes' hashes
  std::set<std::size_t> left_out_nodes_;
  std::vector<pugi::xml_node> waiting_;  ///< nodes whose parts have no content yet
  std::vector<AssemblyPart> parts_;
  std::uint64_t shapes_ = 0, reached_ = 0, left_out_ = 0, curved_ = 0;
  Counts lines_, ignored_;
};

}  // namespace

ImportedMesh read_x3d(std::string_view content, const std::string& file) {
  return X3dReader(XmlText(content, file)).read();
}

}  // namespace penumbra::mesh
