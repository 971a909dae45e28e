// SPDX-License-Identifier: Apache-2.0
// Binary PLY of the usual kind is read many numbers at once. The soup, notes and messages must be the same as when it
// is read number by number: for whole files, for files cut off at any byte, and for files with any one byte changed.
#include "import/ply.hpp"

#include "base/error.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <limits>
#include <string>
#include <vector>

namespace penumbra::mesh {
namespace {

/// A file written number by number.
class PlyText {
 public:
  PlyText(bool big_endian, const std::string& header)
      : swap_(big_endian == (std::endian::native == std::endian::little)) {
    text_ = fmt::format("ply\nformat binary_{}_endian 1.0\n{}end_header\n", big_endian ? "big" : "little", header);
  }
  template <typename Number>
  PlyText& put(std::initializer_list<Number> numbers) {
    for (const Number number : numbers) {
      std::string raw(sizeof(Number), '\0');
      std::memcpy(raw.data(), &number, raw.size());
      if (swap_) std::ranges::reverse(raw);
      text_ += raw;
    }
    return *this;
  }
  [[nodiscard]] const std::string& str() const { return text_; }

 private:
  std::string text_;
  bool swap_;
};

/// Returns everything that reading gives, as text: the mesh and its notes, or the error.
template <typename Read>
std::string told(Read read, const std::string& content) {
  try {
    const ImportedMesh mesh = read(content, "mesh.ply");
    std::string text;
    for (const glm::dvec3& p : mesh.soup.positions) text += fmt::format("v {} {} {}\n", p.x, p.y, p.z);
    for (std::size_t i = 0; i < mesh.soup.triangles.size(); ++i) {
      const Triangle& t = mesh.soup.triangles[i];
      text +=
          fmt::format("f {} {} {} of {}, {}\n", t[0], t[1], t[2], mesh.soup.object.at(i), mesh.soup.source_face.at(i));
    }
    for (const std::string& note : mesh.notes) text += note + "\n";
    return text;
  } catch (const InputError& error) {
    return error.what();
  }
}

void expect_alike(const std::string& content, const std::string& what) {
  EXPECT_EQ(told(import::read_ply, content), told(import::read_ply_slowly, content)) << what;
}

std::vector<std::string> files() {
  std::vector<std::string> all;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const bool big : {false, true}) {
    const std::string places = "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n";
    const auto vertices = [&](PlyText& ply, float odd) -> PlyText& {
      return ply.put<float>({0, 0, 0, 1, -0.0F, 0, 1, 1, odd, 0, 1, 0});
    };
    const std::string triangles = "element face 2\nproperty list uchar int vertex_indices\n";
    PlyText usual(big, places + triangles);
    vertices(usual, 0.5F).put<std::uint8_t>({3}).put<std::int32_t>({0, 1, 2}).put<std::uint8_t>({3});
    all.push_back(usual.put<std::int32_t>({0, 2, 3}).str());

    PlyText not_finite(big, places + triangles);
    vertices(not_finite, nan).put<std::uint8_t>({3}).put<std::int32_t>({0, 1, 2}).put<std::uint8_t>({3});
    all.push_back(not_finite.put<std::int32_t>({0, 2, 3}).str());

    for (const std::int32_t bad : {-1, 4}) {
      PlyText out_of_range(big, places + triangles);
      vertices(out_of_range, 0.5F).put<std::uint8_t>({3}).put<std::int32_t>({0, 1, 2}).put<std::uint8_t>({3});
      all.push_back(out_of_range.put<std::int32_t>({0, bad, 3}).str());
    }

    // A quad, a line and an empty face, with other properties around them; lengths are signed.
    PlyText mixed(big,
                  "element vertex 4\nproperty uchar red\nproperty double z\nproperty short s\nproperty double x\n"
                  "property double y\nelement face 4\nproperty ushort flags\nproperty list char uint vertex_index\n"
                  "property float quality\n");
    for (int i = 0; i < 4; ++i) {
      mixed.put<std::uint8_t>({7}).put<double>({0.1 * i}).put<std::int16_t>({-5}).put<double>(
          {i % 2 + 0.0, i / 2 + 0.0});
    }
    mixed.put<std::uint16_t>({1}).put<std::int8_t>({4}).put<std::uint32_t>({0, 1, 3, 2}).put<float>({1});
    mixed.put<std::uint16_t>({1}).put<std::int8_t>({2}).put<std::uint32_t>({0, 1}).put<float>({1});
    mixed.put<std::uint16_t>({1}).put<std::int8_t>({0}).put<float>({1});
    all.push_back(
        mixed.put<std::uint16_t>({1}).put<std::int8_t>({3}).put<std::uint32_t>({1, 3, 1}).put<float>({1}).str());

    // A face with more corners than are read at once, between two triangles; and faces stored before their vertices.
    PlyText large(big, "element face 3\nproperty list int uint vertex_index\n" + places);
    large.put<std::int32_t>({3}).put<std::uint32_t>({0, 1, 2}).put<std::int32_t>({40});
    for (std::uint32_t i = 0; i < 40; ++i) large.put<std::uint32_t>({i % 4});
    large.put<std::int32_t>({3}).put<std::uint32_t>({1, 2, 3});
    all.push_back(vertices(large, 0.5F).str());

    // Vertices in two parts with faces in between, lists among the properties, coordinates of two types.
    PlyText parts(big,
                  "element vertex 2\nproperty float x\nproperty float y\nproperty double z\n" + triangles +
                      "element vertex 2\nproperty float x\nproperty float y\nproperty float z\n"
                      "property list uchar uchar ring\nelement face 1\nproperty list uchar short vertex_indices\n");
    parts.put<float>({0, 0}).put<double>({0}).put<float>({1, 0}).put<double>({0.1});
    parts.put<std::uint8_t>({3}).put<std::int32_t>({0, 1, 2}).put<std::uint8_t>({3}).put<std::int32_t>({0, 2, 3});
    parts.put<float>({1, 1, 0}).put<std::uint8_t>({2, 9, 9}).put<float>({0, 1, 0}).put<std::uint8_t>({0});
    all.push_back(parts.put<std::uint8_t>({3}).put<std::int16_t>({3, 2, 1}).str());
  }
  return all;
}

TEST(PlyBinary, WholeFilesAreReadAsNumberByNumber) {
  const std::vector<std::string> all = files();
  for (std::size_t i = 0; i < all.size(); ++i) expect_alike(all[i], fmt::format("file {}", i));
  EXPECT_EQ(told(import::read_ply, all[0]),
            "v 0 0 0\nv 1 -0 0\nv 1 1 0.5\nv 0 1 0\nf 0 1 2 of 0, 0\nf 0 2 3 of 0, 1\n");
  EXPECT_EQ(told(import::read_ply, all[2]),
            "mesh.ply: byte 74 after the header: face 1 names vertex -1, but there are only 4 (numbered from 0)");
}

TEST(PlyBinary, FilesThatEndAtAnyByteAreRefusedInTheSameWords) {
  const std::vector<std::string> all = files();
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t size = all[i].find("end_header") + 11; size < all[i].size(); ++size)
      expect_alike(all[i].substr(0, size), fmt::format("file {}, {} bytes", i, size));
  }
}

TEST(PlyBinary, FilesWithAnyByteChangedAreReadAsNumberByNumber) {
  const std::vector<std::string> all = files();
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t at = all[i].find("end_header") + 11; at < all[i].size(); ++at) {
      for (const int value : {0, 1, 3, 0x7f, 0x80, 0xff}) {
        std::string changed = all[i];
        changed[at] = static_cast<char>(value);
        expect_alike(changed, fmt::format("file {}, byte {} is {}", i, at, value));
      }
    }
  }
}

}  // namespace
}  // namespace penumbra::mesh
