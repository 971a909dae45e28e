// SPDX-License-Identifier: Apache-2.0
// Reads STL files, ASCII or binary.

#include "import/stl.hpp"

#include "import/faces.hpp"
#include "import/text.hpp"

#include <glm/vec3.hpp>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstring>
#include <limits>
#include <numeric>

namespace penumbra::import {
namespace {

constexpr std::size_t kHeader = 84, kTriangle = 50;

/// Compares without regard to case; `keyword` must be in lower case.
bool same_keyword(std::string_view word, std::string_view keyword) {
  return std::ranges::equal(word, keyword,
                            [](char a, char b) { return std::tolower(static_cast<unsigned char>(a)) == b; });
}

std::uint32_t count_of_binary(std::string_view content) {
  std::uint32_t count = 0;
  std::memcpy(&count, content.data() + kHeader - sizeof(count), sizeof(count));
  return count;
}

/// Returns whether the file begins with "solid", as ASCII files do; binary files may as well, without meaning.
bool begins_with_solid(std::string_view content) {
  const std::string_view word = take_word(content);
  return word.size() >= 5 && same_keyword(word.substr(0, 5), "solid");
}

/// Returns whether the header and count have no zero byte. The count of a binary file has one, unless it is above
/// sixteen million.
bool begins_with_text(std::string_view content) {
  return content.substr(0, kHeader).find('\0') == std::string_view::npos;
}

void add_corners(mesh::TriangleSoup& soup, FaceCollector& faces, std::uint32_t count) {
  std::vector<std::uint32_t> corners(count);
  std::iota(corners.begin(), corners.end(), static_cast<std::uint32_t>(soup.positions.size()) - count);
  faces.add(corners);
}

mesh::ImportedMesh read_binary(std::string_view content, const std::string& file) {
  const std::size_t told = count_of_binary(content), held = (content.size() - kHeader) / kTriangle;
  const bool whole = (content.size() - kHeader) % kTriangle == 0;
  // Writers that do not know the number in advance leave 0 or all bits set; and data after the promised triangles up to
  // the end of the file, fifty bytes each, are further triangles.
  const bool unknown = told == 0 || told == std::numeric_limits<std::uint32_t>::max();
  const std::size_t count = held > 0 && ((whole && told < held) || unknown) ? held : told;
  const std::size_t wanted = kHeader + kTriangle * count;
  if (content.size() < wanted) {
    throw InputError("{}: a binary STL file of {} triangles takes {} bytes, but it has {}; it is truncated", file,
                     count, wanted, content.size());
  }
  if (count > std::numeric_limits<std::uint32_t>::max() / 3) {
    throw InputError("{}: {} triangles; expected at most 1,431,655,765", file, count);
  }
  mesh::ImportedMesh mesh;
  FaceCollector faces(mesh.soup);
  mesh.soup.positions.reserve(3 * count);
  mesh.soup.triangles.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    std::array<float, 12> numbers{};  // a normal, which is ignored, and three corners
    std::memcpy(numbers.data(), content.data() + kHeader + kTriangle * i, sizeof(numbers));
    for (std::size_t c = 3; c < 12; c += 3) {
      const glm::dvec3 p(numbers[c], numbers[c + 1], numbers[c + 2]);
      if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) {
        throw InputError("{}: vertex {} of triangle {} is not finite: ({}, {}, {}) (numbered from 0)", file, c / 3 - 1,
                         i, p.x, p.y, p.z);
      }
      mesh.soup.positions.push_back(p);
    }
    add_corners(mesh.soup, faces, 3);
  }
  faces.require_all(count, file);
  mesh.notes = faces.notes();
  if (count != told) {
    mesh.notes.push_back(fmt::format("the header says {} triangles, but the file holds {}: all taken", told, count));
  }
  if (content.size() > wanted) {
    mesh.notes.push_back(fmt::format("{} bytes after the last triangle ignored", content.size() - wanted));
  }
  return mesh;
}

class AsciiStl {
 public:
  explicit AsciiStl(const std::string& file) : file_(file), faces_(mesh_.soup) {}

  mesh::ImportedMesh read(std::string_view text) {
    std::string_view line;
    while (take_line(text, line)) {
      ++line_number_;
      for (std::string_view word; !(word = take_word(line)).empty();) {
        if (same_keyword(word, "solid") || same_keyword(word, "endsolid")) {
          open_solid_ = same_keyword(word, "solid");
          skip_name(line);
        } else {
          statement(word, line);
        }
      }
    }
    if (facet_line_ > 0) {
      throw InputError("{}: line {}: the facet that begins here has no end; the file is truncated", file_, facet_line_);
    }
    faces_.require_all(loops_, file_);
    mesh_.notes = faces_.notes();
    if (open_solid_) mesh_.notes.emplace_back("the last solid has no end ('endsolid'): the file may be truncated");
    if (unknown_ > 0) {
      mesh_.notes.push_back(fmt::format("{} unknown statements skipped, the first in {}", unknown_, first_unknown_));
    }
    return std::move(mesh_);
  }

 private:
  template <typename... Args>
  [[noreturn]] void fail(fmt::format_string<Args...> format, Args&&... args) const {
    throw InputError("{}: line {}: {}", file_, line_number_, text_for_people(format, std::forward<Args>(args)...));
  }

  /// Skips a solid's name, which extends to the end of its line, except if a writer puts a whole solid on one line.
  static void skip_name(std::string_view& line) {
    for (std::string_view rest = line; !rest.empty();) {
      const std::string_view from = rest, word = take_word(rest);
      std::string_view after = rest;
      const std::string_view next = take_word(after);
      if (word.empty() || (same_keyword(word, "facet") && same_keyword(next, "normal")) ||
          same_keyword(word, "endsolid")) {
        line = word.empty() ? std::string_view() : from;
        return;
      }
    }
    line = {};
  }

  void statement(std::string_view word, std::string_view& line) {
    if (same_keyword(word, "facet")) {
      if (facet_line_ > 0) fail("a facet begins, but that of line {} has no end", facet_line_);
      facet_line_ = line_number_;
      corners_ = 0;
      had_loop_ = false;
    } else if (same_keyword(word, "normal")) {
      for (int i = 0; i < 3; ++i) take_word(line);  // skips the normal
    } else if (same_keyword(word, "vertex")) {
      vertex(line);
    } else if (same_keyword(word, "endfacet")) {
      if (facet_line_ == 0) fail("a facet ends that has not begun");
      facet_line_ = 0;
      if (corners_ > 0 || !had_loop_) ++loops_, add_corners(mesh_.soup, faces_, corners_);
    } else if (same_keyword(word, "endloop") && facet_line_ > 0 && corners_ > 0) {
      had_loop_ = true;
      ++loops_;
      add_corners(mesh_.soup, faces_, corners_);
      corners_ = 0;
    } else if (!same_keyword(word, "outer") && !same_keyword(word, "loop") && !same_keyword(word, "endloop")) {
      if (unknown_++ == 0) first_unknown_ = fmt::format("line {}: '{}'", line_number_, word.substr(0, 40));
      line = {};
    }
  }

  void vertex(std::string_view& line) {
    if (facet_line_ == 0) fail("a vertex outside of a facet");
    glm::dvec3 position;
    for (glm::length_t axis = 0; axis < 3; ++axis) {
      const std::string_view word = take_word(line);
      const auto value = parse_real(word);
      if (!value) fail("'{}' is not a coordinate", word);
      if (!std::isfinite(*value)) fail("a vertex is not finite: '{}'", word);
      position[axis] = *value;
    }
    if (mesh_.soup.positions.size() == std::numeric_limits<std::uint32_t>::max())
      fail("more than 4,294,967,295 vertices");
    mesh_.soup.positions.push_back(position);
    ++corners_;
  }

  const std::string& file_;
  mesh::ImportedMesh mesh_;
  FaceCollector faces_;
  std::size_t line_number_ = 0, facet_line_ = 0;  ///< line on which the open facet begins; 0 if none is open
  std::uint32_t corners_ = 0;                     ///< corners of the current loop
  std::uint64_t loops_ = 0;                       ///< number of finished loops
  bool had_loop_ = false;                         ///< the open facet already has a face
  bool open_solid_ = false;
  std::uint64_t unknown_ = 0;
  std::string first_unknown_;
};

}  // namespace

mesh::ImportedMesh read_stl(std::string_view content, const std::string& file) {
  const bool solid = begins_with_solid(content);
  const bool long_enough = content.size() >= kHeader;
  if (!solid && !long_enough) {
    throw InputError("{}: neither ASCII STL ('solid …') nor long enough for binary STL", file);
  }
  // An exactly fitting length means binary; otherwise a header of text means ASCII.
  const bool fits = long_enough && content.size() == kHeader + kTriangle * std::size_t{count_of_binary(content)};
  const bool ascii = solid && (!long_enough || (!fits && begins_with_text(content)));
  mesh::ImportedMesh mesh = ascii ? AsciiStl(file).read(content) : read_binary(content, file);
  if (mesh.soup.triangles.empty()) throw InputError("{}: there are no triangles in it", file);
  return mesh;
}

}  // namespace penumbra::import
