// SPDX-License-Identifier: Apache-2.0
#include "mesh/import.hpp"

#include "tests/unit/mesh/import_files.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>

namespace penumbra::mesh {
namespace {

using penumbra::test::bytes_of;
using ::testing::Contains;
using ::testing::HasSubstr;

using FileCorners = std::array<std::array<double, 3>, 3>;

/// Returns the triangles as corner coordinates, each starting at its smallest corner: they must not depend on the
/// format.
std::multiset<FileCorners> triangles_of(const TriangleSoup& soup) {
  std::multiset<FileCorners> all;
  for (const Triangle& t : soup.triangles) {
    FileCorners corners;
    for (std::size_t i = 0; i < 3; ++i) {
      const glm::dvec3& p = soup.positions[t[i]];
      corners[i] = {p.x, p.y, p.z};
    }
    std::rotate(corners.begin(), std::ranges::min_element(corners), corners.end());
    all.insert(corners);
  }
  return all;
}

/// A tetrahedron: (0 0 0) (2 0 0) (0 3 0) (0 0 5).
constexpr std::string_view kVertices = "0 0 0\n2 0 0\n0 3 0\n0 0 5\n";
const std::multiset<FileCorners> kTetrahedron = [] {
  const std::array<double, 3> o{0, 0, 0}, x{2, 0, 0}, y{0, 3, 0}, z{0, 0, 5};
  return std::multiset<FileCorners>{{o, y, x}, {o, x, z}, {o, z, y}, {z, x, y}};
}();
// Triangles in this form start at their smallest corner; so does {z, x, y}, as (0 0 5) is the smallest of the three.

class MeshImport : public penumbra::test::FileTest {
 protected:
  void expect_tetrahedron(const std::string& name, std::string_view content) const {
    SCOPED_TRACE(name);
    const ImportedMesh mesh = import_mesh(write(name, content));
    EXPECT_EQ(triangles_of(mesh.soup), kTetrahedron);
    EXPECT_EQ(mesh.soup.object, std::vector<std::uint32_t>(4, 0));
    EXPECT_EQ(mesh.soup.source_face, (std::vector<std::uint32_t>{0, 1, 2, 3}));
  }
};

/// PLY with doubles, an unused property before and one after, and a list of unusual types; big-endian if Swap.
template <bool Swap>
std::string binary_ply() {
  std::string ply = std::string("ply\nformat binary_") + (Swap ? "big" : "little") +
                    "_endian 1.0\ncomment made by hand\nelement vertex 4\nproperty uchar quality\nproperty double x\n"
                    "property double y\nproperty double z\nproperty short flag\nelement face 4\n"
                    "property list uchar uint vertex_index\nend_header\n";
  const auto vertex = [](double x, double y, double z) {
    return bytes_of<Swap>(std::uint8_t{7}, x, y, z, std::int16_t{-1});
  };
  ply += vertex(0, 0, 0) + vertex(2, 0, 0) + vertex(0, 3, 0) + vertex(0, 0, 5);
  const auto face = [](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    return bytes_of<Swap>(std::uint8_t{3}, a, b, c);
  };
  return ply + face(0, 2, 1) + face(0, 1, 3) + face(0, 3, 2) + face(3, 1, 2);
}

std::string binary_stl(std::string header) {
  header.resize(80, ' ');
  const std::array<std::array<float, 3>, 4> v{{{0, 0, 0}, {2, 0, 0}, {0, 3, 0}, {0, 0, 5}}};
  std::string stl = header + bytes_of(std::uint32_t{4});
  for (const auto& t : std::array<std::array<std::size_t, 3>, 4>{{{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {3, 1, 2}}}) {
    stl += bytes_of(0.f, 0.f, 0.f);
    for (const std::size_t i : t) stl += bytes_of(v[i][0], v[i][1], v[i][2]);
    stl += bytes_of(std::uint16_t{0});
  }
  return stl;
}

TEST_F(MeshImport, EveryFormatGivesTheSameTriangles) {
  const std::string v(kVertices);
  const std::string faces = "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 3 1 2\n";
  expect_tetrahedron("a.off", "OFF\n4 4 6\n" + v + faces);
  expect_tetrahedron("comments.off", "# first\nOFF # a comment\n\n4 4 # no edges\n" + v +
                                         "# faces\n3 0 2 1 # red\n3  0 1 3 255 0 0\n\n3 0 3 2\r\n3 3 1 2");
  expect_tetrahedron("one_line.off", "OFF 4 4 6 \n0 0 0 2 0 0\n0 3 0 0 0 5\n" + faces);
  expect_tetrahedron("headless.off", "4 4 6\n" + v + faces);
  expect_tetrahedron("color.off", "COFF\n4 4 6\n0 0 0 255 0 0 255\n2 0 0 1 0 0\n0 3 0 7\n0 0 5 .1 .2 .3 1\n" + faces);
  expect_tetrahedron("normal.off", "NOFF\n4 4 6\n0 0 0 0 0 1\n2 0 0 0 0 1\n0 3 0 0 0 1\n0 0 5 0 0 1\n" + faces);
  expect_tetrahedron("four.off", "4OFF\n4 4 6\n0 0 0 1\n4 0 0 2\n0 3 0 1\n0 0 2.5 0.5\n" + faces);

  std::string obj;
  for (std::size_t at = 0, end = 0; (end = kVertices.find('\n', at)) != std::string_view::npos; at = end + 1) {
    obj += "v " + std::string(kVertices.substr(at, end - at)) + "\n";
  }
  expect_tetrahedron("a.obj", obj + "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 4 2 3\n");
  expect_tetrahedron("negative.obj", obj + "f -4 -2 -3\nf -4 -3 -1\nf -4 -1 -2\nf -1 -3 -2\n");
  expect_tetrahedron("slashes.obj", "vn 0 0 1\nvt 0 0\n" + obj +
                                        "f 1/1/1 3/1/1 2/1/1\nf 1//1 2//1 4//1\nf 1/1 4/1 3/1\nf 4 \\\n2 3 # end\n");

  const std::string header =
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 4\nproperty list uchar int vertex_indices\nend_header\n";
  expect_tetrahedron("ascii.ply", header + v + faces);
  expect_tetrahedron("little.ply", binary_ply<false>());
  expect_tetrahedron("big.ply", binary_ply<true>());

  std::string stl = "solid tetrahedron\n";
  for (const std::string_view t :
       {"0 0 0|0 3 0|2 0 0", "0 0 0|2 0 0|0 0 5", "0 0 0|0 0 5|0 3 0", "0 0 5|2 0 0|0 3 0"}) {
    stl += "facet normal 0 0 0\nouter loop\n";
    for (const std::size_t at : {0u, 6u, 12u}) stl += "vertex " + std::string(t.substr(at, 5)) + "\n";
    stl += "endloop\nendfacet\n";
  }
  expect_tetrahedron("ascii.stl", stl + "endsolid\n");
  expect_tetrahedron("binary.stl", binary_stl("made by hand"));
  expect_tetrahedron("solid.stl", binary_stl("solid, but binary"));  // as SolidWorks writes it
}

TEST_F(MeshImport, DropsNothing) {
  const ImportedMesh mesh =
      import_mesh(write("odd.obj",
                        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvn 0 0 1\n"
                        "f 1 2 3\nf 1 2 3\nf 3 2 1\nf 1 1 2\nf 1 2 2\nf 1//1 2//1 3//1 4//1\nl 1 2\np 3\n"));
  // Two equal triangles, one turned over, two without area, and a square: 5 + 2.
  EXPECT_EQ(mesh.soup.triangles.size(), 7u);
  EXPECT_THAT(mesh.notes, Contains(HasSubstr("1 polygons became 2 triangles (1 convex")));
  EXPECT_THAT(mesh.notes, Contains(HasSubstr("2 triangles with two equal corners kept")));
  EXPECT_THAT(mesh.notes, Contains(HasSubstr("1 points skipped")));
  EXPECT_THAT(mesh.notes, Contains(HasSubstr("1 lines skipped")));
  EXPECT_THAT(mesh.notes, Contains(HasSubstr("vertex normals")));
}

TEST_F(MeshImport, CutsConcaveAndLargePolygons) {
  // An L of area 3, which a fan from corner 0 would leave, and a regular dodecagon (Assimp's own OFF reader drops it).
  std::string off = "OFF\n18 2 0\n0 2 0\n0 0 0\n2 0 0\n2 1 0\n1 1 0\n1 2 0\n";
  for (int i = 0; i < 12; ++i) off += fmt::format("{} {} 1\n", std::cos(i * M_PI / 6), std::sin(i * M_PI / 6));
  off += "6 0 1 2 3 4 5\n12 6 7 8 9 10 11 12 13 14 15 16 17\n";
  const ImportedMesh mesh = import_mesh(write("polygons.off", off));
  ASSERT_EQ(mesh.soup.triangles.size(), 4u + 10u);
  std::array<double, 2> area{};
  for (std::size_t i = 0; i < mesh.soup.triangles.size(); ++i) {
    const auto& [a, b, c] = mesh.soup.triangles[i];
    const auto& p = mesh.soup.positions;
    const double part = ((p[b].x - p[a].x) * (p[c].y - p[a].y) - (p[b].y - p[a].y) * (p[c].x - p[a].x)) / 2;
    EXPECT_GT(part, 0);
    area[mesh.soup.source_face[i]] += part;
  }
  EXPECT_DOUBLE_EQ(area[0], 3);
  EXPECT_NEAR(area[1], 3, 1e-5);  // 12 · sin(30°) / 2, from coordinates printed with six digits
  EXPECT_THAT(mesh.notes, Contains(HasSubstr("2 polygons became 14 triangles (1 convex, 1 concave")));
}

TEST_F(MeshImport, AppliesNodeTransformsInDouble) {
  // One triangle under two nodes: a translation by 2^24 + 1 (not a float) and a mirroring, for which the winding is
  // turned back.
  const std::string gltf = R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],
    "nodes":[{"translation":[16777217,0,0],"children":[1]},{"scale":[-1,1,1],"mesh":0}],
    "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
    "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}],
    "bufferViews":[{"buffer":0,"byteLength":36}],
    "buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})";
  const ImportedMesh mesh = import_mesh(write("nodes.gltf", gltf));
  ASSERT_EQ(mesh.soup.triangles.size(), 1u);
  std::set<double> x;
  for (const glm::dvec3& p : mesh.soup.positions) x.insert(p.x);
  EXPECT_EQ(x, (std::set<double>{16777216, 16777217}));
  const auto& [a, b, c] = mesh.soup.triangles[0];
  const auto& p = mesh.soup.positions;
  EXPECT_GT((p[b].x - p[a].x) * (p[c].y - p[a].y) - (p[b].y - p[a].y) * (p[c].x - p[a].x), 0);
}

TEST_F(MeshImport, SaysWhereACoordinateWasRounded) {
  const ImportedMesh mesh = import_mesh(
      write("far.ac",
            "AC3Db\nMATERIAL \"\" rgb 1 1 1  amb 0.2 0.2 0.2  emis 0 0 0  spec 0.5 0.5 0.5  shi 10  trans 0\nOBJECT "
            "world\nkids 1\nOBJECT poly\nnumvert 3\n1000000 0 0\n1000001 0 0\n1000000 1 0\nnumsurf 1\nSURF 0x20\nmat "
            "0\nrefs 3\n0 0 0\n1 0 0\n2 0 0\nkids 0\n"));
  EXPECT_THAT(mesh.notes, Contains(HasSubstr("rounded to single precision")));
  const ImportedMesh obj = import_mesh(write("far.obj", "v 1000000.1 0 0\nv 1000001 0 0\nv 1000000 1 0\nf 1 2 3\n"));
  EXPECT_EQ(obj.soup.positions[0].x, 1000000.1);
  EXPECT_THAT(obj.notes, ::testing::IsEmpty());
}

TEST_F(MeshImport, RefusesBadFilesWithTheirPlace) {
  expect_refused("empty.obj", "", {"empty (0 bytes)"});
  expect_refused("blank.obj", "\n\n# nothing here\n\n\n", {"no triangles"});
  expect_refused("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\np 1 2 3\n", {"no triangles", "3 points"});
  expect_refused("high.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n\nf 1 2 4\n", {"line 5", "vertex 4", "only 3"});
  expect_refused("low.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf -1 -2 -4\n", {"line 4", "-4", "only 3"});
  expect_refused("zero.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 0 1 2\n", {"line 4", "start at 1"});
  expect_refused("huge.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 99999999999999999999\n",
                 {"line 4", "not a vertex number"});
  expect_refused("nan.obj", "v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n", {"line 2", "vertex 2", "not finite"});
  expect_refused("infinite.obj", "v 0 0 0\nv 1 0 0\nv 0 1e399 0\nf 1 2 3\n", {"line 3", "vertex 3", "not finite"});
  expect_refused("two.obj", "v 0 0 0\nv 1 0\nv 0 1 0\nf 1 2 3\n", {"line 2", "2 numbers"});
  expect_refused("word.obj", "v 0 0 0\nv 1 zero 0\nv 0 1 0\nf 1 2 3\n", {"line 2", "'zero'"});

  expect_refused("high.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", {"line 6", "vertex 3", "only 3"});
  expect_refused("nan.off", "OFF\n3 1 0\n0 0 0\n1 NaN 0\n0 1 0\n3 0 1 2\n", {"line 4", "vertex 1 is not finite"});
  expect_refused("short.off", "OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", {"truncated"});
  expect_refused("lies.off", "OFF\n4000000000 4000000000 0\n0 0 0\n", {"4000000000", "truncated"});
  expect_refused("no.off", "this is a letter", {"no OFF file"});

  const std::string header =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
  expect_refused("high.ply", header + "0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n", {"vertex 7", "only 3"});
  expect_refused("nan.ply", header + "0 0 0\n1 nan 0\n0 1 0\n3 0 1 2\n", {"vertex 1 is not finite"});
  expect_refused("lies.ply",
                 "ply\nformat binary_little_endian 1.0\nelement vertex 4000000000\nproperty float x\nend_header\n",
                 {"4000000000", "truncated"});
  expect_refused("digits.ply", "ply\nformat ascii 1.0\nelement 99999999vertex 2\nproperty float x\nend_header\n",
                 {"99999999vertex", "truncated"});
  expect_refused("nothing.ply", "ply\nformat ascii 1.0\nelement nothing 4000000000\nend_header\n", {"4000000000"});
  expect_refused("headless.ply", "ply\nformat ascii 1.0\nelement vertex 3\n", {"end_header", "truncated"});
  expect_refused("short.ply", binary_ply<true>().substr(0, 300), {"truncated"});

  const std::string stl = binary_stl("binary");
  expect_refused("short.stl", stl.substr(0, stl.size() - 1), {"4 triangles", "truncated"});
  expect_refused("short2.stl", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\n", {"truncated"});
  expect_refused("no.stl", "this is a letter", {"neither ASCII STL"});
  expect_refused("nan.stl",
                 [&] {
                   std::string copy = stl;
                   copy.replace(84 + 12, 4, bytes_of(std::numeric_limits<float>::quiet_NaN()));
                   return copy;
                 }(),
                 {"vertex 0 of triangle 0 is not finite"});

  expect_refused("name.obj", binary_ply<false>(), {".ply", "name wrong"});
  expect_refused("letter.doc", "Dear reader", {"no importer for '.doc'", "export the mesh as OBJ"});
  expect_refused("old.wrl", "#VRML V1.0 ascii\n", {"VRML is not read; export the mesh as X3D, OBJ or glTF 2.0"});
  EXPECT_THAT(penumbra::test::input_error([&] { import_mesh(folder_ / "missing.obj"); }), HasSubstr("No such file"));
  EXPECT_THAT(penumbra::test::input_error([&] { import_mesh(folder_); }), HasSubstr("folder"));
  EXPECT_THAT(penumbra::test::input_error([&] { import_mesh("/dev/zero"); }), HasSubstr("not a regular file"));
}

TEST_F(MeshImport, OpensNoFilesOutsideTheFolder) {
  std::filesystem::create_directory(folder_ / "inner");
  write("outside.bin", std::string(36, '\0'));
  const std::string gltf = R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
    "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
    "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],
    "bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"byteLength":36,"uri":"../outside.bin"}]})";
  expect_refused("inner/reach.gltf", gltf, {"outside.bin"});
}

TEST_F(MeshImport, EveryTruncationLoadsOrIsRefused) {
  const std::string ply = binary_ply<false>(), stl = binary_stl("binary");
  std::size_t loaded = 0;
  for (const auto& [name, whole] : {std::pair{"cut.ply", ply}, {"cut.stl", stl}}) {
    for (std::size_t length = 0; length < whole.size(); length += 7) {
      const auto path = write(name, whole.substr(0, length));
      try {
        import_mesh(path);
        ++loaded;
      } catch (const InputError& error) {
        EXPECT_THAT(error.what(), HasSubstr(path.string()));
      }
    }
  }
  EXPECT_EQ(loaded, 0u);  // both formats state the number of their elements
}

}  // namespace
}  // namespace penumbra::mesh
