// SPDX-License-Identifier: Apache-2.0
// Reads Wavefront OBJ files in double precision.

#include "import/obj.hpp"

#include "import/faces.hpp"
#include "import/text.hpp"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace penumbra::import {
namespace {

/// Statements that do not affect surfaces.
constexpr std::array<std::string_view, 20> kSilent = {
    "g",        "o",   "s",          "mg",        "usemtl", "mtllib", "usemap", "maplib", "bevel", "c_interp",
    "d_interp", "lod", "shadow_obj", "trace_obj", "vp",     "vn",     "vt",     "cstype", "deg",   "end"};
/// Parts of free-form curves and surfaces, which are not read.
constexpr std::array<std::string_view, 13> kFreeForm = {"curv", "curv2", "surf", "parm", "trim",  "hole", "scrv",
                                                        "sp",   "con",   "bmat", "step", "ctech", "stech"};

class ObjReader {
 public:
  ObjReader(const std::string& file, bool with_places) : file_(file), with_places_(with_places), faces_(mesh_.soup) {}

  mesh::ImportedMesh read(std::string_view text) {
    std::string_view line;
    std::string joined;  // lines joined by backslashes
    while (take_line(text, line)) {
      ++line_number_;
      std::string_view words = line;
      // A backslash in a comment does not continue the line.
      if (joined.empty() && take_word(words).starts_with('#')) continue;
      if (const auto part = continued(line)) {
        joined.append(*part).append(" ");
      } else if (joined.empty()) {
        statement(line);
      } else {
        statement(joined.append(line));
        joined.clear();
      }
    }
    if (!joined.empty()) statement(joined);
    if (highest_named_ > vertices()) {
      throw InputError("{}: line {}: the face names vertex {}, but there are only {} (numbered from 1)", file_,
                       highest_line_, highest_named_, vertices());
    }
    if (weightless_ > 0 && weightless_ < vertices()) {
      throw InputError("{}: line {}: vertex {} has the weight 0, so it lies at infinity", file_,
                       first_weightless_.second, first_weightless_.first);
    }
    add_faces();
    faces_.require_all(statements_, file_);
    if (!places_.empty()) place_vertices();
    settle_unused_vertices(mesh_, [&](std::uint32_t v) { refuse_vertex(v); });
    if (mesh_.soup.triangles.empty()) {
      throw InputError("{}: there are no triangles in it ({})", file_, faces_.instead_of_surfaces());
    }
    write_notes();
    return std::move(mesh_);
  }

 private:
  template <typename... Args>
  [[noreturn]] void fail(fmt::format_string<Args...> format, Args&&... args) const {
    throw InputError("{}: line {}: {}", file_, line_number_, text_for_people(format, std::forward<Args>(args)...));
  }

  /// Returns the part before a backslash at the end of the line, which may be followed by blanks; nullopt if there is
  /// none.
  static std::optional<std::string_view> continued(std::string_view line) {
    const std::size_t last = line.find_last_not_of(" \t\v\f");
    if (last == std::string_view::npos || line[last] != '\\') return std::nullopt;
    return line.substr(0, last);
  }

  [[noreturn]] void refuse_vertex(std::uint32_t v) const {
    const auto found = std::ranges::find(wild_, v, &std::pair<std::uint32_t, std::size_t>::first);
    const glm::dvec3& p = mesh_.soup.positions[v];
    throw InputError("{}: line {}: vertex {} is not finite: ({}, {}, {})", file_, found->second, v + 1, p.x, p.y, p.z);
  }

  [[nodiscard]] std::uint64_t vertices() const { return mesh_.soup.positions.size(); }

  void statement(std::string_view line) {
    std::string_view rest = line;
    const std::string_view keyword = take_word(rest);
    if (keyword.empty() || keyword.front() == '#') return;
    rest = without_comment(rest);
    if (keyword == "v") return vertex(rest);
    if (keyword == "f" || keyword == "fo") return face(rest);
    if (keyword == "call") {
      fail("'call{}' includes another file, which is not supported; copy its statements to this place",
           rest.substr(0, 80));
    }
    if (keyword == "p" || keyword == "l") return skip(keyword == "p", rest);
    normals_ += keyword == "vn" ? 1 : 0;
    uvs_ += keyword == "vt" ? 1 : 0;
    if (with_places_ && keyword == "vt") return place(rest);
    if (std::ranges::find(kSilent, keyword) != kSilent.end()) return;
    if (std::ranges::find(kFreeForm, keyword) != kFreeForm.end()) {
      ++free_form_;
      return;
    }
    if (unknown_++ == 0) first_unknown_ = fmt::format("line {}: '{}'", line_number_, keyword.substr(0, 40));
  }

  void vertex(std::string_view line) {
    const std::uint64_t number = vertices() + 1;
    if (number > std::numeric_limits<std::uint32_t>::max()) fail("more than 4,294,967,295 vertices");
    // x y z, x y z w, or a position and a colour. Colours and further words are ignored, and need not be numbers.
    std::array<double, 4> numbers{0, 0, 0, 1};
    std::array<std::string_view, 8> words;
    std::size_t count = 0;
    while (count < words.size() && !(words[count] = take_word(line)).empty()) ++count;
    if (count < 3) fail("vertex {} has {} numbers; expected x y z, x y z w, or x y z and a colour", number, count);
    for (std::size_t i = 0; i < (count == 4 ? 4 : 3); ++i) {
      const auto value = parse_real(words[i]);
      if (!value) fail("vertex {}: '{}' is not a number", number, words[i]);
      numbers[i] = *value;
    }
    colors_ += count == 6 || count == 7 ? 1 : 0;
    longer_ += count == 5 || count == 8 ? 1 : 0;
    if (numbers[3] == 0) {  // weight 0: an error only if not all are 0, which is known at the end
      if (weightless_++ == 0) first_weightless_ = {number, line_number_};
      numbers[3] = 1;
    }
    const glm::dvec3 position = glm::dvec3(numbers[0], numbers[1], numbers[2]) / numbers[3];
    if (!std::isfinite(position.x) || !std::isfinite(position.y) || !std::isfinite(position.z)) {
      // an error only if a face uses the vertex
      wild_.emplace_back(static_cast<std::uint32_t>(vertices()), line_number_);
    }
    mesh_.soup.positions.push_back(position);
  }

  /// Reads texture coordinates; words that are missing or not numbers give kNoPlace.
  void place(std::string_view line) {
    const auto u = parse_real(take_word(line)), v = parse_real(take_word(line));
    const bool is_place = u && v && std::abs(*u) < 1e6 && std::abs(*v) < 1e6;
    places_.push_back(is_place ? glm::dvec2(*u, *v) : mesh::kNoPlace);
  }

  /// Returns the index, from 0, of the texture coordinates that a corner names after its first slash; kPlaceless if it
  /// names none.
  [[nodiscard]] std::int64_t place_of_corner(std::string_view word) const {
    const std::size_t slash = word.find('/');
    if (slash == std::string_view::npos) return kPlaceless;
    const std::string_view rest = word.substr(slash + 1);
    const auto index = parse_number<std::int64_t>(rest.substr(0, rest.find('/')));
    if (!index || *index == 0) return kPlaceless;
    return *index > 0 ? *index - 1 : static_cast<std::int64_t>(places_.size()) + *index;
  }

  /// Gives each position its texture coordinates; if a vertex has several coordinates, each but the first becomes a
  /// new position.
  void place_vertices() {
    mesh::TriangleSoup& soup = mesh_.soup;
    constexpr std::int64_t kNotYet = -2;
    std::vector<std::int64_t> first(soup.positions.size(), kNotYet);
    std::map<std::pair<std::uint32_t, std::int64_t>, std::uint32_t> others;
    mesh_.places.assign(soup.positions.size(), mesh::kNoPlace);
    const auto value = [&](std::int64_t number) {
      const bool is_there = number >= 0 && static_cast<std::uint64_t>(number) < places_.size();
      return is_there ? places_[static_cast<std::size_t>(number)] : mesh::kNoPlace;
    };
    for (std::size_t i = 0; i < soup.triangles.size(); ++i) {
      const std::size_t face = soup.source_face[i], begin = face == 0 ? 0 : face_ends_[face - 1];
      const auto corners = std::span(corners_).subspan(begin, face_ends_[face] - begin);
      for (std::uint32_t& vertex : soup.triangles[i]) {
        const auto corner = std::ranges::find(corners, vertex) - corners.begin();
        const std::int64_t number = corner_places_[begin + static_cast<std::size_t>(corner)];
        if (first[vertex] == kNotYet) {
          first[vertex] = number;
          mesh_.places[vertex] = value(number);
        }
        if (first[vertex] == number) continue;
        const auto [other, is_new] =
            others.try_emplace({vertex, number}, static_cast<std::uint32_t>(soup.positions.size()));
        if (is_new) {
          soup.positions.push_back(glm::dvec3(soup.positions[vertex]));
          mesh_.places.push_back(value(number));
        }
        vertex = other->second;
      }
    }
  }

  /// Returns the corner's vertex, numbered from 0; texture coordinates and normals after a slash are ignored.
  std::uint32_t corner(std::string_view word) {
    const auto index = parse_number<std::int64_t>(word.substr(0, word.find('/')));
    if (!index) fail("'{}' is not a vertex number", word);
    if (*index == 0) fail("vertex numbers start at 1, but the face names vertex 0");
    if (*index < 0) {
      if (*index < -static_cast<std::int64_t>(vertices())) {
        fail("the face names vertex {} from the end, but only {} come before it", *index, vertices());
      }
      return static_cast<std::uint32_t>(static_cast<std::int64_t>(vertices()) + *index);
    }
    // A positive number may refer to a later vertex: the highest one is checked at the end.
    const auto named = static_cast<std::uint64_t>(*index);
    if (named > vertices() && named > highest_named_) {
      highest_named_ = named;
      highest_line_ = line_number_;
    }
    return static_cast<std::uint32_t>(named - 1);  // a number too high for the type is refused at the end
  }

  void face(std::string_view line) {
    const std::size_t first = corners_.size();
    ++statements_;
    for (std::string_view word; !(word = take_word(line)).empty();) {
      corners_.push_back(corner(word));
      if (with_places_) corner_places_.push_back(place_of_corner(word));
    }
    face_ends_.push_back(corners_.size());
    if (corners_.size() - first > std::numeric_limits<std::uint32_t>::max()) fail("too many corners");
  }

  void skip(bool points, std::string_view line) {
    std::uint64_t corners = 0;
    while (!take_word(line).empty()) ++corners;
    if (points)
      faces_.skip_points(corners);
    else
      faces_.skip_lines(std::max<std::uint64_t>(corners, 1) - 1);
  }

  /// Faces are added at the end, because they may refer to later vertices.
  void add_faces() {
    std::size_t first = 0;
    mesh_.soup.triangles.reserve(face_ends_.size());
    for (const std::size_t end : face_ends_) {
      faces_.add(std::span(corners_).subspan(first, end - first));
      first = end;
    }
  }

  void write_notes() {
    const auto notes = faces_.notes();
    mesh_.notes.insert(mesh_.notes.begin(), notes.begin(), notes.end());
    std::string ignored;
    const auto mention = [&](std::uint64_t count, std::string_view what) {
      if (count > 0) ignored += fmt::format("{}{} {}", ignored.empty() ? "" : ", ", count, what);
    };
    mention(normals_, "vertex normals");
    if (!with_places_) mention(uvs_, "texture coordinates");
    mention(colors_, "vertex colours");
    if (!ignored.empty()) mesh_.notes.push_back("ignored: " + ignored);
    if (longer_ > 0)
      mesh_.notes.push_back(fmt::format("{} vertices have 5, 8 or more numbers: the first three are taken", longer_));
    if (weightless_ > 0) {
      mesh_.notes.push_back(
          fmt::format("all {} vertices have the weight 0, which is ignored, as if they had no weight", weightless_));
    }
    if (free_form_ > 0) {
      mesh_.notes.push_back(fmt::format("{} free-form statements (curves, surfaces) skipped", free_form_));
    }
    if (unknown_ > 0) {
      mesh_.notes.push_back(fmt::format("{} unknown statements skipped, the first in {}", unknown_, first_unknown_));
    }
  }

  static constexpr std::int64_t kPlaceless = -1;

  const std::string& file_;
  bool with_places_;
  mesh::ImportedMesh mesh_;
  FaceCollector faces_;
  std::vector<std::uint32_t> corners_;                       ///< corners of all faces, one face after the other
  std::vector<std::size_t> face_ends_;                       ///< into `corners_`
  std::vector<glm::dvec2> places_;                           ///< texture coordinates, if requested
  std::vector<std::int64_t> corner_places_;                  ///< for each of `corners_`, the index of its texture
                                                             ///< coordinates, or none
  std::vector<std::pair<std::uint32_t, std::size_t>> wild_;  ///< vertices that are not finite, and their lines
  std::uint64_t statements_ = 0;                             ///< number of face statements
  std::size_t line_number_ = 0, highest_line_ = 0;
  std::uint64_t highest_named_ = 0;  ///< largest vertex number, from 1, that a face names before the vertex exists; 0
                                     ///< if there is none
  std::uint64_t normals_ = 0, uvs_ = 0, colors_ = 0, free_form_ = 0, unknown_ = 0;
  std::uint64_t longer_ = 0, weightless_ = 0;  ///< counts of vertices: with numbers of unknown meaning; with weight 0
  std::pair<std::uint64_t, std::size_t> first_weightless_;  ///< vertex number from 1, and line
  std::string first_unknown_;
};

}  // namespace

mesh::ImportedMesh read_obj_text(std::string_view text, const std::string& file, bool with_places) {
  return ObjReader(file, with_places).read(text);
}

}  // namespace penumbra::import
