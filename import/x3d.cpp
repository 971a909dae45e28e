// SPDX-License-Identifier: Apache-2.0
// Walks the scene graph of X3D by a list in place of recursion, resolves each USE to the last DEF before it, and
// checks in the end that every shape was placed, or is one that the file hides.

#include "import/x3d.hpp"

#include "import/assembly.hpp"
#include "import/obj_materials.hpp"
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

namespace penumbra::import {
namespace {

/// Nodes whose children are shown unchanged, regardless of other effects (Collision and Billboard for a moving camera).
constexpr std::array<std::string_view, 17> kGroups = {
    "Scene",         "Group",       "StaticGroup", "Collision",   "Anchor",         "Billboard",
    "PickableGroup", "CADAssembly", "CADLayer",    "CADFace",     "ViewpointGroup", "LayoutGroup",
    "Layer",         "LayerSet",    "LayoutLayer", "ScreenGroup", "Viewport"};
constexpr std::array<std::string_view, 2> kTransforms = {"Transform", "CADPart"};
/// Nodes whose surfaces are in another file or another node.
constexpr std::array<std::string_view, 4> kElsewhere = {"Inline", "GeoLOD", "ProtoInstance", "ParticleSystem"};
constexpr std::array<std::string_view, 3> kLamps = {"PointLight", "SpotLight", "DirectionalLight"};
/// Nodes that refer to others by USE without showing them; sensors do so, too.
constexpr std::array<std::string_view, 4> kTools = {"Script", "RigidBodyCollection", "CollisionCollection",
                                                    "CollisionSpace"};

template <std::size_t N>
bool is_one_of(std::string_view name, const std::array<std::string_view, N>& names) {
  return std::ranges::find(names, name) != names.end();
}

class X3dReader {
 public:
  explicit X3dReader(const XmlText& xml)
      : xml_(xml), resolve_([this](const pugi::xml_node& node) { return resolved(node); }) {}

  mesh::ImportedMesh read() {
    const pugi::xml_node x3d = xml_.document().document_element();
    if (local_name(x3d) != "X3D") xml_.fail(x3d, "the outermost element is <{}>; expected <X3D>", x3d.name());
    const pugi::xml_node scene = x3d.child("Scene");
    if (!scene) xml_.fail(x3d, "there is no <Scene>");
    find_names(scene);
    read_units(x3d.child("head"));
    const std::size_t root = part_of(scene);
    while (!waiting_.empty()) {  // no recursion: a file may nest a million nodes
      const pugi::xml_node node = waiting_.back();
      waiting_.pop_back();
      expand(node, numbers_.at(node.hash_value()));
    }
    require_all_shapes();
    const glm::dmat4 placement = glm::scale(glm::dmat4(1), glm::dvec3(metres_));
    mesh::ImportedMesh mesh = assemble(parts_, std::array{PlacedPart{root, placement}}, xml_.file(), listed(lines_));
    if (metres_ != 1) mesh.notes.push_back(fmt::format("a unit of {} m; positions times {}", metres_, metres_));
    if (curved_ > 0) {
      mesh.notes.push_back(
          fmt::format("{} spheres, cones, cylinders or disks became polygons of {} sides", curved_, kX3dSides));
    }
    if (!lines_.empty()) mesh.notes.push_back("skipped, as they are no surfaces here: " + listed(lines_));
    if (left_out_ > 0) {
      mesh.notes.push_back(
          fmt::format("{} of {} shapes are hidden by the file's own switches, levels of detail or visibility: left out",
                      left_out_, shapes_));
    }
    if (!missing_.empty()) {
      mesh.notes.push_back(fmt::format(
          "{} USE refer to names that no earlier node has ({}): ignored, since no visible surface needs them",
          missing_.size(), first_missing_));
    }
    if (!ignored_.empty()) mesh.notes.push_back("ignored: " + listed(ignored_));
    const std::vector<std::string> transparent(transparent_.begin(), transparent_.end());
    if (auto note = solid_materials_note(transparent)) mesh.notes.push_back(*std::move(note));
    if (auto note = left_out_lamps_note(lamps_)) mesh.notes.push_back(*std::move(note));
    return mesh;
  }

 private:
  /// Reads the unit of length in metres, the default of X3D.
  void read_units(const pugi::xml_node& head) {
    for (const pugi::xml_node& unit : children_named(head, "unit")) {
      const std::string_view category = unit.attribute("category").value();
      if (category != "length" && category != "angle") continue;
      const double factor = xml_.real(unit, unit.attribute("conversionFactor").as_string("1"), "conversionFactor");
      if (!(factor > 0)) xml_.fail(unit, "conversionFactor is {}; expected a number above 0", factor);
      if (category == "length")
        metres_ = factor;
      else if (factor != 1)
        xml_.fail(unit, "a unit of angles other than the radian is not supported; write angles in radians");
    }
  }

  /// Resolves each USE: the last node before it to which DEF gave the name. The body of a prototype has its own names.
  void find_names(const pugi::xml_node& scene) {
    struct Scope {
      pugi::xml_node top;
      std::map<std::string, pugi::xml_node> named = {};
    };
    std::vector<Scope> scopes = {{scene}};
    for (pugi::xml_node node = scene; node;) {
      if (local_name(node) == "ProtoBody") scopes.push_back({node});
      find_name(node, scopes.back().named);
      if (node.first_child()) {
        node = node.first_child();
        continue;
      }
      for (;; node = node.parent()) {  // goes up to a node that has a next sibling
        if (node == scene) return;
        if (node == scopes.back().top) scopes.pop_back();
        if (node.next_sibling()) break;
      }
      node = node.next_sibling();
    }
  }
  void find_name(const pugi::xml_node& node, std::map<std::string, pugi::xml_node>& named) {
    if (const pugi::xml_attribute use = node.attribute("USE")) {
      const auto found = named.find(use.value());
      if (found != named.end()) {
        uses_.emplace(node.hash_value(), found->second);
      } else if (missing_.insert(node.hash_value()).second && first_missing_.empty()) {
        first_missing_ = fmt::format("the first is '{}' of a <{}>", mesh::printable(use.value()), local_name(node));
      }
      return;
    }
    if (const pugi::xml_attribute name = node.attribute("DEF")) named[name.value()] = node;
    shapes_ += local_name(node) == "Shape" ? 1 : 0;
  }
  /// Returns the next node in document order, below `top`.
  static pugi::xml_node following(pugi::xml_node node, const pugi::xml_node& top) {
    if (node.first_child()) return node.first_child();
    while (node && node != top && !node.next_sibling()) node = node.parent();
    return node == top ? pugi::xml_node() : node.next_sibling();
  }
  /// Returns the node that `node` refers to by USE; `node` itself if it has no USE, or if its USE is undefined and its
  /// kind shows no surfaces.
  [[nodiscard]] pugi::xml_node meant(const pugi::xml_node& node) const {
    const std::string_view name = local_name(node);
    const bool may_show =
        can_hold_shapes(node) || is_one_of(name, kElsewhere) || name.starts_with("Geo") || name.starts_with("HAnim");
    return may_show || !missing_.contains(node.hash_value()) ? resolved(node) : node;
  }
  /// Resolves the USE of a node that shows or contains surfaces; throws if it refers to none.
  [[nodiscard]] pugi::xml_node resolved(const pugi::xml_node& node) const {
    if (missing_.contains(node.hash_value()))
      xml_.fail(node, "USE: there is no node '{}' before it", mesh::printable(node.attribute("USE").value()));
    const auto found = uses_.find(node.hash_value());
    return found == uses_.end() ? node : found->second;
  }

  std::size_t part_of(const pugi::xml_node& node) {
    const auto [known, is_new] = numbers_.emplace(node.hash_value(), parts_.size());
    if (is_new) {
      const char* name = node.attribute("DEF").value();
      parts_.push_back({*name == '\0' ? fmt::format("a <{}>", node.name()) : fmt::format("'{}'", mesh::printable(name)),
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

  /// Returns the visible children that can contain shapes.
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
      const pugi::xml_node child = meant(all[i]);
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

  /// Marks shapes below a node that the file does not show.
  void leave_out(const pugi::xml_node& node) {
    for (pugi::xml_node below = node; below; below = following(below, node)) {
      if (local_name(below) == "Shape" && !below.attribute("USE")) left_out_nodes_.insert(below.hash_value());
    }
  }
  void ignore(const pugi::xml_node& node) {
    const std::string_view name = local_name(node);
    if (name == "ProtoDeclare" || name == "ExternProtoDeclare") return leave_out(node);  // only instances are shown
    if (may_show_surfaces(node)) {
      xml_.fail(node, "<{}> may hold surfaces, but is not supported; write what it shows as Transform and Shape", name);
    }
    if (is_one_of(name, kLamps)) return note_lamp(node);
    ++ignored_[std::string(name)];
  }
  /// Keeps the name of a lamp that is switched on, or the kind of lamp if it has no name.
  void note_lamp(const pugi::xml_node& node) {
    if (!meant(node).attribute("on").as_bool(true)) return;
    const std::string_view name = meant(node).attribute("DEF").value();
    lamps_.push_back(mesh::printable(name.empty() ? local_name(node) : name));
  }

  /// Returns whether a node of an unsupported kind, or a node that it refers to by USE, may contain a surface.
  bool may_show_surfaces(const pugi::xml_node& top) {
    const bool is_tool = is_one_of(local_name(top), kTools) || local_name(top).ends_with("Sensor");
    std::vector<pugi::xml_node> stack = {top};
    while (!stack.empty()) {
      const pugi::xml_node node = stack.back();
      stack.pop_back();
      const std::string_view name = local_name(node);
      if (is_tool ? name == "Shape" && !node.attribute("USE") : name == "Shape" || shows_elsewhere(node)) return true;
      if (!is_tool && !without_surfaces_.insert(node.hash_value()).second) continue;
      if (!is_tool && node.attribute("USE")) stack.push_back(meant(node));
      for (const pugi::xml_node& child : node.children()) stack.push_back(child);
    }
    return false;
  }
  static bool shows_elsewhere(const pugi::xml_node& node) {
    return is_one_of(local_name(node), kElsewhere) && !is_appearance(node);
  }
  static bool is_appearance(const pugi::xml_node& node) {
    return std::string_view(node.attribute("containerField").value()) == "appearance";
  }

  /// Keeps the name of a material that lets light through. A USE that refers to no node is no error here: no surface
  /// needs it.
  void note_transparency(const pugi::xml_node& appearance) {
    for (const pugi::xml_node& child : meant(appearance).children()) {
      if (local_name(child) != "Material" && local_name(child) != "PhysicalMaterial") continue;
      const pugi::xml_node material = meant(child);
      if (!(material.attribute("transparency").as_double() > 0)) continue;
      const std::string_view name = material.attribute("DEF").value();
      transparent_.emplace(name.empty() ? "without a name" : name);
    }
  }

  void read_shape(const pugi::xml_node& shape, AssemblyPart& part) {
    ++reached_;
    for (const pugi::xml_node& child : shape.children()) {
      const std::string_view name = local_name(child);
      if (name == "Appearance") note_transparency(child);
      if (child.type() != pugi::node_element || name == "Appearance" || name == "AcousticProperties" ||
          name.starts_with("Metadata") || (name == "ProtoInstance" && is_appearance(child)))
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

  /// Returns translation · centre · rotation · scale along rotated axes, and back from the centre.
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

  /// Checks that every shape of the file is in the mesh, or is one that the file does not show.
  void require_all_shapes() {
    for (const auto& [node, number] : numbers_) left_out_nodes_.erase(node);  // shown elsewhere by USE
    left_out_ = left_out_nodes_.size();
    if (reached_ + left_out_ != shapes_) {
      throw InputError("{}: it holds {} shapes, but {} came through; the reader would lose some", xml_.file(), shapes_,
                       reached_ + left_out_);
    }
  }
  using Counts = std::map<std::string, std::uint64_t>;
  static std::string listed(const Counts& counts) {
    std::string list;
    for (const auto& [name, count] : counts)
      list += fmt::format("{}{} {}", list.empty() ? "" : ", ", count, mesh::printable(name));
    return list;
  }

  const XmlText& xml_;
  X3dResolve resolve_;
  std::map<std::size_t, pugi::xml_node> uses_;  ///< by the hash of a node with USE: the node it refers to
  std::map<std::size_t, std::size_t> numbers_;  ///< indices of parts, by their nodes' hashes
  std::set<std::size_t> missing_;               ///< hashes of nodes whose USE is undefined
  std::string first_missing_;
  std::set<std::size_t> left_out_nodes_, without_surfaces_;
  double metres_ = 1;                    ///< length of a unit in metres
  std::vector<pugi::xml_node> waiting_;  ///< nodes whose parts have no content yet
  std::vector<AssemblyPart> parts_;
  std::uint64_t shapes_ = 0, reached_ = 0, left_out_ = 0, curved_ = 0;
  Counts lines_, ignored_;
  std::set<std::string> transparent_;  // names of materials that let light through
  std::vector<std::string> lamps_;     // names of the file's lamps, which are left out
};

}  // namespace

mesh::ImportedMesh read_x3d(std::string_view content, const std::string& file) {
  return X3dReader(XmlText(content, file)).read();
}

}  // namespace penumbra::import
