// SPDX-License-Identifier: Apache-2.0
#include "tests/agreement/mesh/face_counters.hpp"

#include <iconv.h>
#include <minizip/unzip.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <fstream>
#include <iterator>
#include <set>
#include <stdexcept>

namespace penumbra::test {
namespace {

std::uint64_t number(std::string_view word) {
  return std::stoull(std::string(word));
}

/// An XML element with what counting needs: names and attributes, and the text separately.
struct Element {
  std::string_view name, attributes, text;
  std::vector<Element> children;

  [[nodiscard]] std::string attribute(std::string_view wanted) const {
    const std::string key = " " + std::string(wanted) + "=";
    const std::string spaced = " " + std::string(attributes);
    const std::size_t at = spaced.find(key);
    if (at == std::string::npos) return "";
    const char quote = spaced.at(at + key.size());
    const std::size_t first = at + key.size() + 1;
    return spaced.substr(first, spaced.find(quote, first) - first);
  }
  /// Calls `visit` for every element below this one that has the given name.
  template <typename Visit>
  void each(std::string_view wanted, Visit visit) const {
    for (const Element& child : children) {
      if (child.name == wanted) visit(child);
      child.each(wanted, visit);
    }
  }
};

Element parse_xml(std::string_view& rest, std::string_view name, std::string_view attributes) {
  Element element{name, attributes, {}, {}};
  for (;;) {
    const std::size_t open = rest.find('<');
    if (open == std::string_view::npos) return element;
    if (element.text.empty()) element.text = rest.substr(0, open);
    rest.remove_prefix(open);
    if (rest.starts_with("<!--")) {
      rest.remove_prefix(rest.find("-->") + 3);
      continue;
    }
    const std::size_t close = rest.find('>');
    std::string_view tag = rest.substr(1, close - 1);
    rest.remove_prefix(std::min(close, rest.size() - 1) + 1);
    if (tag.starts_with('/')) return element;
    if (tag.starts_with('?') || tag.starts_with('!')) continue;
    const bool empty = tag.ends_with('/');
    if (empty) tag.remove_suffix(1);
    const std::string_view child = tag.substr(0, tag.find_first_of(" \t\r\n"));
    const std::string_view its = tag.substr(child.size());
    if (empty)
      element.children.push_back({child, its, {}, {}});
    else
      element.children.push_back(parse_xml(rest, child, its));
  }
}

Element parse_xml(std::string_view text) {
  return parse_xml(text, "", "");
}

/// Returns the first entry of a zip archive whose name has this ending.
std::string entry_of_zip(const std::filesystem::path& file, std::string_view ending) {
  const unzFile archive = unzOpen64(file.c_str());
  if (archive == nullptr) throw std::runtime_error("no zip archive");
  std::string content;
  std::array<char, 512> name{};
  for (int status = unzGoToFirstFile(archive); status == UNZ_OK && content.empty(); status = unzGoToNextFile(archive)) {
    unz_file_info64 info{};
    unzGetCurrentFileInfo64(archive, &info, name.data(), name.size() - 1, nullptr, 0, nullptr, 0);
    if (!std::string_view(name.data()).ends_with(ending)) continue;
    content.resize(info.uncompressed_size);
    unzOpenCurrentFile(archive);
    unzReadCurrentFile(archive, content.data(), static_cast<unsigned>(content.size()));
    unzCloseCurrentFile(archive);
  }
  unzClose(archive);
  return content;
}

FaceCount count_obj(const std::filesystem::path& file) {
  std::string text = text_of_file(file);
  for (std::size_t at = 0; (at = text.find('\\', at)) != std::string::npos; ++at) {
    const std::size_t end = text.find_first_not_of('\r', at + 1);
    if (end != std::string::npos && text[end] == '\n')
      std::fill(text.begin() + static_cast<long>(at), text.begin() + static_cast<long>(end) + 1, ' ');
  }
  std::uint64_t faces = 0;
  for (const std::string_view line : lines_of(text)) {
    const auto words = words_of(line.substr(0, line.find('#')));
    faces += words.size() >= 4 && (words[0] == "f" || words[0] == "fo") ? 1 : 0;
  }
  return faces;
}

FaceCount count_off(const std::filesystem::path& file) {
  const std::string text = text_of_file(file);
  std::vector<std::string_view> words;
  std::vector<std::vector<std::string_view>> lines;
  for (std::string_view line : lines_of(text)) {
    line = line.substr(0, line.find('#'));
    auto found = words_of(line);
    if (found.empty()) continue;
    if (lines.empty() && found.size() > 1 && found[0].ends_with("OFF"))
      found.erase(found.begin());  // the counts are in the same line
    lines.push_back(std::move(found));
  }
  const std::size_t header = lines.at(0).at(0).ends_with("OFF") ? 1 : 0;
  const std::uint64_t vertices = number(lines.at(header).at(0)), count = number(lines.at(header).at(1));
  if (lines.size() != header + 1 + vertices + count) return std::nullopt;  // there is not one face per line
  std::uint64_t faces = 0;
  for (std::uint64_t i = 0; i < count; ++i) faces += number(lines[header + 1 + vertices + i][0]) >= 3 ? 1 : 0;
  return faces;
}

FaceCount count_raw(const std::filesystem::path& file) {
  const std::string text = text_of_file(file);
  std::uint64_t faces = 0;
  for (const std::string_view line : lines_of(text)) {
    const auto words = words_of(line);
    const bool numbers = !words.empty() && words[0].find_first_not_of("+-.0123456789eE") == std::string_view::npos;
    faces += numbers && words.size() >= 9 ? 1 : 0;
  }
  return faces;
}

/// AC3D: a surface's kind is in the low four bits of its flags; 0 is a polygon.
FaceCount count_ac(const std::filesystem::path& file) {
  const std::string text = text_of_file(file);
  std::uint64_t faces = 0;
  bool polygon = false;
  for (const std::string_view line : lines_of(text)) {
    const auto words = words_of(line);
    if (words.size() < 2) continue;
    if (words[0] == "subdiv" && words[1] != "0") return std::nullopt;  // the reader refines such a mesh
    if (words[0] == "SURF") {
      const auto flags = std::stoul(std::string(words[1]), nullptr, 16);
      if ((flags & 0xF) > 2) return std::nullopt;  // strips
      polygon = (flags & 0xF) == 0;
    }
    if (words[0] == "refs") faces += polygon && number(words[1]) >= 3 ? 1 : 0;
  }
  return faces;
}

FaceCount count_ase(const std::filesystem::path& file) {
  const std::string text = text_of_file(file);
  const auto words = words_of(text);
  std::uint64_t faces = 0;
  for (std::size_t i = 0; i + 1 < words.size(); ++i) {
    if (words[i] == "*MESH_ANIMATION") return std::nullopt;
    if (words[i] == "*MESH_NUMFACES") faces += number(words[i + 1]);
  }
  return faces;
}

/// DirectX, as text: for each Mesh the vertices, then the faces, each beginning with its number of corners.
FaceCount count_x(const std::filesystem::path& file) {
  std::string text = text_of_file(file);
  if (text.substr(8, 4) != "txt ") return std::nullopt;
  const auto words = words_of(text, " \t\r\n;,");
  std::uint64_t faces = 0;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const bool opens = words[i] == "Mesh" || words[i] == "Mesh{";
    if (!opens || (i > 0 && words[i - 1] == "template")) continue;
    while (!words.at(i).ends_with('{')) ++i;
    std::size_t at = i + 1;
    at += 1 + 3 * number(words.at(at));
    const std::uint64_t count = number(words.at(at++));
    for (std::uint64_t face = 0; face < count; ++face) {
      const std::uint64_t corners = number(words.at(at));
      faces += corners >= 3 ? 1 : 0;
      at += 1 + corners;
    }
  }
  return faces;
}

FaceCount count_smd(const std::filesystem::path& file) {
  const std::string text = text_of_file(file);
  std::uint64_t lines = 0;
  bool inside = false;
  for (const std::string_view line : lines_of(text)) {
    const auto words = words_of(line);
    if (words.empty()) continue;
    if (words[0] == "end") inside = false;
    lines += inside ? 1 : 0;
    if (words[0] == "triangles") inside = true;
  }
  return lines / 4;  // a material and three corners
}

FaceCount count_md5(const std::filesystem::path& file) {
  const std::string text = text_of_file(file);
  const auto words = words_of(text);
  std::uint64_t faces = 0;
  for (std::size_t i = 0; i + 1 < words.size(); ++i) faces += words[i] == "numtris" ? number(words[i + 1]) : 0;
  return faces;
}

FaceCount count_3mf(const std::filesystem::path& file) {
  const std::string text = entry_of_zip(file, ".model");
  const Element model = parse_xml(text);
  std::map<std::string, std::uint64_t> faces;
  bool components = false;
  model.each("object", [&](const Element& object) {
    object.each("triangle", [&](const Element&) { ++faces[object.attribute("id")]; });
    object.each("component", [&](const Element&) { components = true; });
  });
  std::uint64_t sum = 0;
  model.each("item", [&](const Element& item) { sum += faces[item.attribute("objectid")]; });
  return components ? std::nullopt : FaceCount(sum);
}

FaceCount count_amf(const std::filesystem::path& file) {
  const std::string text = text_of_file(file);
  const Element amf = parse_xml(text);
  std::map<std::string, std::uint64_t> faces;
  std::set<std::string> placed;
  amf.each("object", [&](const Element& object) {
    std::uint64_t& own = faces[object.attribute("id")];
    object.each("triangle", [&](const Element&) { ++own; });
  });
  amf.each("constellation", [&](const Element& group) {  // instances of earlier objects and groups
    std::uint64_t& own = faces[group.attribute("id")];
    group.each("instance", [&](const Element& instance) {
      own += faces.at(instance.attribute("objectid"));
      placed.insert(instance.attribute("objectid"));
    });
  });
  std::uint64_t sum = 0;
  for (const auto& [id, count] : faces) sum += placed.contains(id) ? 0 : count;
  return sum;
}

/// Collada: counts the faces in the visual scene, through nodes of the library and skins.
class Collada {
 public:
  explicit Collada(const Element& root) {
    root.each("geometry",
              [&](const Element& geometry) { faces_["#" + geometry.attribute("id")] = faces_in(geometry); });
    root.each("controller", [&](const Element& controller) {
      const auto link = [&](const Element& skin) {
        skins_["#" + controller.attribute("id")] = skin.attribute("source");
      };
      controller.each("skin", link);
      controller.each("morph", link);
    });
    root.each("node", [&](const Element& node) { nodes_["#" + node.attribute("id")] = &node; });
    root.each("instance_visual_scene", [&](const Element& scene) { shown_ = scene.attribute("url"); });
    root.each("visual_scene", [&](const Element& scene) {
      if (shown_.empty() || shown_ == "#" + scene.attribute("id")) sum_ += shown_in(scene, 0);
    });
  }
  [[nodiscard]] std::uint64_t sum() const { return sum_; }

 private:
  static std::uint64_t faces_in(const Element& geometry) {
    std::uint64_t faces = 0;
    geometry.each("triangles", [&](const Element& list) { faces += number(list.attribute("count")); });
    geometry.each("polylist", [&](const Element& list) {
      list.each("vcount", [&](const Element& counts) {
        for (const std::string_view count : words_of(counts.text)) faces += number(count) >= 3 ? 1 : 0;
      });
    });
    geometry.each("polygons", [&](const Element& list) { list.each("p", [&](const Element&) { ++faces; }); });
    for (const char* kind : {"trifans", "tristrips"}) {
      geometry.each(kind, [&](const Element& list) {
        std::set<std::string> inputs;
        list.each("input", [&](const Element& input) { inputs.insert(input.attribute("offset")); });
        list.each("p", [&](const Element& p) { faces += words_of(p.text).size() / inputs.size() - 2; });
      });
    }
    return faces;
  }

  std::uint64_t shown_in(const Element& node, int depth) {
    if (depth > 100) throw std::runtime_error("nodes in a circle");
    std::uint64_t faces = 0;
    for (const Element& child : node.children) {
      if (child.name == "node") faces += shown_in(child, depth + 1);
      if (child.name == "instance_node" && nodes_.contains(child.attribute("url")))
        faces += shown_in(*nodes_[child.attribute("url")], depth + 1);
      if (child.name == "instance_geometry") faces += faces_[child.attribute("url")];
      if (child.name == "instance_controller") {
        std::string target = child.attribute("url");
        while (skins_.contains(target)) target = skins_[target];
        faces += faces_[target];
      }
    }
    return faces;
  }

  std::map<std::string, std::uint64_t> faces_;
  std::map<std::string, std::string> skins_;
  std::map<std::string, const Element*> nodes_;
  std::string shown_;
  std::uint64_t sum_ = 0;
};

FaceCount count_dae(const std::filesystem::path& file) {
  const std::string text = text_of_file(file);
  const Element root = parse_xml(text);
  return Collada(root).sum();
}

FaceCount count_zae(const std::filesystem::path& file) {
  const std::string text = entry_of_zip(file, ".dae");
  const Element root = parse_xml(text);
  return Collada(root).sum();
}

}  // namespace

std::string bytes_of_file(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::string text_of_file(const std::filesystem::path& file) {
  std::string bytes = bytes_of_file(file);
  if (bytes.starts_with("\xEF\xBB\xBF")) return bytes.substr(3);
  if (!bytes.starts_with("\xFF\xFE") && !bytes.starts_with("\xFE\xFF")) return bytes;
  const iconv_t conversion = iconv_open("UTF-8", "UTF-16");  // also removes the byte order mark
  std::string text(2 * bytes.size(), '\0');
  char *from = bytes.data(), *to = text.data();
  std::size_t left = bytes.size(), room = text.size();
  iconv(conversion, &from, &left, &to, &room);
  iconv_close(conversion);
  text.resize(text.size() - room);
  return text;
}

std::vector<std::string_view> lines_of(std::string_view text) {
  return words_of(text, "\r\n");
}

std::vector<std::string_view> words_of(std::string_view text, std::string_view blanks) {
  std::vector<std::string_view> words;
  const auto is_blank = [&](char c) { return blanks.find(c) != std::string_view::npos; };
  for (auto at = text.begin(); (at = std::find_if_not(at, text.end(), is_blank)) != text.end();) {
    const auto end = std::find_if(at, text.end(), is_blank);
    words.emplace_back(at, end);
    at = end;
  }
  return words;
}

const std::map<std::string, FaceCounter>& face_counters() {
  static const std::map<std::string, FaceCounter> counters = {
      {".3ds", count_3ds}, {".3mf", count_3mf}, {".ac", count_ac},       {".acc", count_ac},    {".amf", count_amf},
      {".ase", count_ase}, {".dae", count_dae}, {".glb", count_gltf},    {".gltf", count_gltf}, {".lwo", count_lwo},
      {".lxo", count_lwo}, {".md2", count_md2}, {".md5mesh", count_md5}, {".ms3d", count_ms3d}, {".obj", count_obj},
      {".off", count_off}, {".ply", count_ply}, {".raw", count_raw},     {".smd", count_smd},   {".stl", count_stl},
      {".x", count_x},     {".zae", count_zae}};
  return counters;
}

}  // namespace penumbra::test
