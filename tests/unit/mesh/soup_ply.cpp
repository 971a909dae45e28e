// SPDX-License-Identifier: Apache-2.0
#include "mesh/soup_ply.hpp"

#include "mesh/import.hpp"
#include "tests/unit/mesh/soups.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <unistd.h>

namespace penumbra::mesh {
namespace {

class Folder {
 public:
  Folder() : path_(std::filesystem::path(testing::TempDir()) / ("soup_ply_" + std::to_string(::getpid()))) {
    std::filesystem::create_directories(path_);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  ~Folder() { std::filesystem::remove_all(path_); }
  [[nodiscard]] std::filesystem::path file(const std::string& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

TEST(SoupPly, OurImporterReadsBackWhatWasWritten) {
  const Folder folder;
  const TriangleSoup soup = test::lattice_soup(5, 40, 3);  // doubled points, zero areas: all of them must come back
  PlyMesh ply{soup.positions, soup.triangles, {}, {}};
  for (const bool colored : {false, true}) {
    if (colored) {
      ply.triangle_colors.assign(soup.triangles.size(), {255, 128, 0});
      ply.edges = {{0, 1, {255, 0, 0}}, {3, 5, {0, 0, 255}}};
    }
    write_ply(folder.file("soup.ply"), ply);
    const ImportedMesh back = import_mesh(folder.file("soup.ply"));
    EXPECT_EQ(back.soup.positions, soup.positions) << "lattice points are floats";
    EXPECT_EQ(back.soup.triangles, soup.triangles);
  }
}

TEST(SoupPly, TheBytesAreThoseOfTheFormat) {
  const Folder folder;
  write_ply(folder.file("one.ply"),
            {{{0, 0, 0}, {1, 0, 0}, {0, 0.1, 0}}, {{0, 1, 2}}, {{1, 2, 3}}, {{1, 2, {4, 5, 6}}}});
  std::ifstream stream(folder.file("one.ply"), std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
  const std::string header =
      "ply\nformat binary_little_endian 1.0\ncomment Penumbra\n"
      "element vertex 3\nproperty double x\nproperty double y\nproperty double z\n"
      "element face 1\nproperty list uchar int vertex_indices\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\n"
      "element edge 1\nproperty int vertex1\nproperty int vertex2\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n";
  ASSERT_EQ(bytes.substr(0, header.size()), header);
  ASSERT_EQ(bytes.size(), header.size() + std::size_t{9} * 8 + (1 + 3 * 4 + 3) + (2 * 4 + 3));
  EXPECT_EQ(bytes.substr(header.size() + std::size_t{7} * 8, 8),
            std::string("\x9a\x99\x99\x99\x99\x99\xb9\x3f"));  // 0.1
  EXPECT_EQ(bytes.substr(bytes.size() - 3), "\x04\x05\x06");
}

}  // namespace
}  // namespace penumbra::mesh
