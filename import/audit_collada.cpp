// SPDX-License-Identifier: Apache-2.0
// Counts the triangles of COLLADA files and checks their polygons before Assimp reads them.

#include "import/audit_collada.hpp"

#include "import/text.hpp"
#include "import/xml.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <sstream>
#include <vector>

namespace penumbra::import {
namespace {

std::uint64_t words_in(const pugi::xml_node& node) {
  std::string_view text = node.child_value();
  std::uint64_t count = 0;
  while (!take_word(text).empty()) ++count;
  return count;
}

class Counter {
 public:
  explicit Counter(const XmlText& xml) : xml_(xml) {}

  std::uint64_t run() {
    const pugi::xml_node collada = xml_.document().document_element();
    std::vector<pugi::xml_node> roots;
    for (pugi::xml_node node = collada; node; node = following(node)) {
      if (const pugi::xml_attribute id = node.attribute("id")) named_.emplace(id.value(), node);
      if (local_name(node) == "instance_visual_scene") roots.push_back(node);
    }
    std::vector<pugi::xml_node> waiting;
    for (const pugi::xml_node& root : roots) waiting.push_back(target_of(root, "url"));
    std::uint64_t triangles = 0, visits = 0;
    while (!waiting.empty() && ++visits < kMostVisits) {
      const pugi::xml_node node = waiting.back();
      waiting.pop_back();
      for (const pugi::xml_node& child : node.children()) {
        const std::string_view name = local_name(child);
        if (name == "node") waiting.push_back(child);
        if (name == "instance_node") waiting.push_back(target_of(child, "url"));
        if (name == "instance_geometry" || name == "instance_controller")
          triangles += triangles_of(target_of(child, "url"));
      }
    }
    return visits < kMostVisits ? triangles : 0;  // 0 for endless repetition: reading then exceeds the memory limit
  }

 private:
  static constexpr std::uint64_t kMostVisits = 10'000'000;

  static pugi::xml_node following(pugi::xml_node node) {
    if (node.first_child()) return node.first_child();
    while (node && !node.next_sibling()) node = node.parent();
    return node.next_sibling();
  }

  pugi::xml_node target_of(const pugi::xml_node& node, const char* attribute) const {
    const std::string_view url = node.attribute(attribute).value();
    if (!url.empty() && !url.starts_with('#')) {
      xml_.fail(node, "<{}> shows '{}' of another file, which is not read; export the scene as one file", node.name(),
                mesh::printable(url));
    }
    const auto found = named_.find(std::string(url.substr(url.empty() ? 0 : 1)));
    return found == named_.end() ? pugi::xml_node() : found->second;
  }

  /// Returns the number of triangles of a geometry, or of the geometry that a controller deforms.
  std::uint64_t triangles_of(pugi::xml_node node) {
    for (int depth = 0; node && local_name(node) == "controller" && depth < 64; ++depth) {
      pugi::xml_node source;
      for (const char* kind : {"skin", "morph"}) {
        if (const pugi::xml_node child = node.child(kind)) source = target_of(child, "source");
      }
      node = source;
    }
    if (!node) return 0;
    const auto [known, is_new] = counted_.emplace(node.hash_value(), 0);
    if (!is_new) return known->second;
    std::uint64_t triangles = 0;
    for (const pugi::xml_node& mesh : node.children("mesh")) {
      for (const pugi::xml_node& list : mesh.children()) triangles += triangles_in(list);
    }
    return counted_[node.hash_value()] = triangles;
  }

  [[nodiscard]] std::uint64_t triangles_in(const pugi::xml_node& list) const {
    const std::string_view name = local_name(list);
    std::uint64_t stride = 0, triangles = 0;
    for (const pugi::xml_node& input : list.children("input"))
      stride = std::max<std::uint64_t>(stride, input.attribute("offset").as_ullong() + 1);
    if (name == "polylist") {
      std::string_view counts = list.child("vcount").child_value();
      for (std::string_view word; !(word = take_word(counts)).empty();) {
        const auto count = parse_number<std::uint32_t>(word);
        triangles += count && *count > 2 ? *count - 2 : 0;
      }
      return triangles;
    }
    const bool each_three = name == "triangles";
    if (stride == 0 || !(each_three || name == "polygons" || name == "tristrips" || name == "trifans")) return 0;
    if (const pugi::xml_node hole = list.child("ph")) {
      xml_.fail(hole, "polygons with holes (<ph>) are not supported; triangulate them before exporting");
    }
    for (const pugi::xml_node& p : list.children("p")) {
      const std::uint64_t corners = words_in(p) / stride;
      triangles += each_three ? corners / 3 : corners > 2 ? corners - 2 : 0;
    }
    return triangles;
  }

  const XmlText& xml_;
  std::map<std::string, pugi::xml_node> named_;
  std::map<std::size_t, std::uint64_t> counted_;  ///< by the hash of the geometry
};

}  // namespace

std::uint64_t triangles_of_collada(std::string_view content, const std::string& file) {
  const XmlText xml(content, file);
  return Counter(xml).run();
}

std::string without_leading_blanks(std::string_view content, const std::string& file) {
  struct Trim : pugi::xml_tree_walker {
    bool for_each(pugi::xml_node& node) override {
      if (node.type() != pugi::node_pcdata) return true;
      const std::string_view text = node.value();
      const std::size_t first = std::min(text.find_first_not_of(" \t\r\n"), text.size());
      changes += first > 0 ? 1 : 0;
      if (first > 0) node.set_value(std::string(text.substr(first)).c_str());
      return true;
    }
    std::uint64_t changes = 0;
  } trim;
  pugi::xml_document document;
  document.reset(XmlText(content, file).document());
  document.traverse(trim);
  if (trim.changes == 0) return std::string(content);
  std::ostringstream out;
  document.save(out, "", pugi::format_raw);
  return std::move(out).str();
}

std::string with_named_cameras(std::string content) {
  constexpr std::string_view kTag = "<camera ";
  for (std::size_t at = content.find(kTag); at != std::string::npos; at = content.find(kTag, at + 1)) {
    const std::size_t end = std::min(content.find('>', at), content.size());
    if (std::string_view(content).substr(at, end - at).find(" name=") == std::string_view::npos)
      content.insert(at + kTag.size(), R"(name="camera" )");
  }
  return content;
}

std::string with_plain_material(std::string content) {
  const std::size_t end = content.rfind("</COLLADA>");
  if (end == std::string::npos) return content;
  content.insert(
      end, fmt::format(R"(<library_effects><effect id="{0}"><profile_COMMON><technique sid="common"><lambert><diffuse>)"
                       R"(<color>0.8 0.8 0.8 1</color></diffuse></lambert></technique></profile_COMMON></effect>)"
                       R"(</library_effects><library_materials><material id="{0}" name="{0}"><instance_effect )"
                       R"(url="#{0}"/></material></library_materials>)",
                       kPlainMaterial));
  return content;
}

}  // namespace penumbra::import
