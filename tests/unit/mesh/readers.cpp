// SPDX-License-Identifier: Apache-2.0
// Tests files that Assimp reads wrongly or not at all, and that our own readers read.
#include "mesh/import.hpp"

#include "tests/unit/mesh/import_files.hpp"

#include <gmock/gmock.h>

namespace penumbra::mesh {
namespace {

using namespace std::string_literals;
using penumbra::test::bytes_of;
using penumbra::test::corner;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class MeshReaders : public penumbra::test::FileTest {
 protected:
  [[nodiscard]] ImportedMesh read(const std::string& name, std::string_view content) const {
    return import_mesh(write(name, content));
  }
};

// -------------------------------------------------------------------------------------------------------------- OBJ

constexpr const char* kSquare = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

TEST_F(MeshReaders, ObjFacesWithTextureCoordinatesThatDoNotExistAreWhole) {
  const std::string square = kSquare;
  for (const std::string face :
       {"f 1/1/1 2/1/1 3/1/1\n", "f 1/9 2/9 3/9\n", "f 1//7 2//7 3//7\n", "f 1/-5 2/-5 3/-5\n"}) {
    const ImportedMesh mesh = read("missing.obj", square + face + "f 1 3 4\nl 1 2\nl 2 3\np 4\n");
    EXPECT_EQ(mesh.soup.triangles.size(), 2u) << face;
    EXPECT_EQ(mesh.soup.source_face, (std::vector<std::uint32_t>{0, 1})) << face;
    EXPECT_THAT(mesh.notes, Contains("2 lines skipped: faces with two corners"));
    EXPECT_THAT(mesh.notes, Contains("1 points skipped: faces with one corner"));
  }
  // Lines do not count in place of missing faces.
  const ImportedMesh mesh = read("lines.obj", square + "vt 0 0\nf 1/1 2/1 3/2\nf 1/1 3/1 4/1\nl 1 2 3 4 1\n");
  EXPECT_EQ(mesh.soup.triangles.size(), 2u);
}

TEST_F(MeshReaders, ObjColoursAreNoMatter) {
  const ImportedMesh mesh = read("colours.obj", "v 0 0 0 nan 0 0\nv 1 0 0 1 inf 0\nv 0 1 0 1 1 1 0.5\nf 1 2 3\n");
  ASSERT_EQ(mesh.soup.triangles.size(), 1u);
  EXPECT_EQ(mesh.soup.positions[1], glm::dvec3(1, 0, 0));
  EXPECT_THAT(mesh.notes, Contains("ignored: 3 vertex colours"));
}

TEST_F(MeshReaders, ObjInDoubleWithWeightsAndForwardReferences) {
  const ImportedMesh mesh =
      read("double.obj", "f 1 2 3 # before its vertices\nv 0.1 0.2 0.3\nv 2 4 6 2\nv 1e300 0 0\n");
  EXPECT_EQ(mesh.soup.positions[0], glm::dvec3(0.1, 0.2, 0.3));
  EXPECT_EQ(mesh.soup.positions[1], glm::dvec3(1, 2, 3));
  EXPECT_EQ(mesh.soup.positions[2], glm::dvec3(1e300, 0, 0));
  expect_refused("weight.obj", "v 0 0 0\nv 1 0 0 0\nv 0 1 0 0\nf 1 2 3\n", {"line 2", "vertex 2 has the weight 0"});
  expect_refused("weight2.obj", "v 0 0 0\nv 1e300 0 0 1e-300\nv 0 1 0\nf 1 2 3\n", {"line 2", "not finite"});
  expect_refused("two.obj", "v 0 0\n", {"line 1", "2 numbers"});
  expect_refused("far.obj", "v 0 0 0\nf 1 1 4294967297\n", {"line 2", "vertex 4294967297", "only 1"});
  expect_refused("none.obj", "f 1 1 1\n", {"line 1", "vertex 1", "only 0"});
}

TEST_F(MeshReaders, ObjOfManyGroups) {
  std::string text = kSquare;
  for (int i = 0; i < 100000; ++i) text += fmt::format("o part{}\ng group{}\nusemtl m{}\nf 1 2 3\n", i, i, i);
  EXPECT_EQ(read("groups.obj", text).soup.triangles.size(), 100000u);
}

TEST_F(MeshReaders, ObjSaysWhatItSkips) {
  const ImportedMesh mesh =
      read("skips.obj", std::string(kSquare) + "f 1 2 3\ncurv 0 1 1 2\nsurf 0 1 0 1 1 2 3\nwhat 1\nwhat 2\n");
  EXPECT_THAT(mesh.notes, Contains(HasSubstr("2 free-form statements")));
  EXPECT_THAT(mesh.notes, Contains("2 unknown statements skipped, the first in line 8: 'what'"));
}

// -------------------------------------------------------------------------------------------------------------- STL

std::string binary_stl(std::string header, std::uint32_t count, const std::string& after) {
  header.resize(80, ' ');
  std::string stl = header + bytes_of(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    stl += bytes_of(0.f, 0.f, 1.f, 0.f, 0.f, static_cast<float>(i), 1.f, 0.f, 0.f, 0.f, 1.f, 0.f, std::uint16_t{0});
  }
  return stl + after;
}

TEST_F(MeshReaders, StlInCapitals) {
  const ImportedMesh mesh =
      read("capitals.stl",
           "SOLID BOX\r\n  FACET NORMAL 0 0 1\r\n    OUTER LOOP\r\n      VERTEX 0 0 0\r\n      VERTEX 1 0 0\r\n"
           "      VERTEX 0 1 0\r\n    ENDLOOP\r\n  ENDFACET\r\nENDSOLID BOX\r\n");
  ASSERT_EQ(mesh.soup.triangles.size(), 1u);
  EXPECT_EQ(corner(mesh.soup, 0, 2), glm::dvec3(0, 1, 0));
  EXPECT_THAT(mesh.notes, IsEmpty());
}

TEST_F(MeshReaders, StlBinaryWithMoreThanItSays) {
  for (const std::string header : {"solid thing", "made by hand", "SOLID"}) {
    const ImportedMesh mesh = read("trailing.stl", binary_stl(header, 3, "more"));
    EXPECT_EQ(mesh.soup.triangles.size(), 3u) << header;
    EXPECT_EQ(corner(mesh.soup, 2, 0), glm::dvec3(0, 0, 2)) << header;
    EXPECT_THAT(mesh.notes, Contains("4 bytes after the last triangle ignored")) << header;
  }
  expect_refused("short.stl", binary_stl("solid", 3, "").substr(0, 200), {"3 triangles", "truncated"});
}

TEST_F(MeshReaders, StlFacetsThatAreNone) {
  const std::string facet = "facet normal 0 0 1 outer loop vertex 0 0 0 vertex 1 0 0 vertex 0 1 0 endloop endfacet\n";
  EXPECT_EQ(read("lines.stl", "solid a\n" + facet + facet + "endsolid\nsolid b\n" + facet).soup.triangles.size(), 3u);
  expect_refused("open.stl", "solid a\n" + facet + "facet normal 0 0 1\nvertex 0 0 0\n", {"line 3", "no end"});
  expect_refused("twice.stl", "solid a\nfacet\nfacet\n", {"line 3", "that of line 2 has no end"});
  expect_refused("loose.stl", "solid a\nvertex 0 0 0\n", {"line 2", "outside of a facet"});
  expect_refused("word.stl", "solid a\nfacet\nvertex 0 zero 0\n", {"line 3", "'zero'"});
  expect_refused("zero.stl", "solid a\nfacet\0endfacet\n"s, {"no triangles"});
  expect_refused("nothing.stl", "solid a\nendsolid a\n", {"no triangles"});
}

TEST_F(MeshReaders, StlThatOtherReadersCutShort) {
  const std::string corners = "outer loop vertex 0 0 0 vertex 1 0 0 vertex 0 1 0 endloop ";
  const std::string facet = "facet normal 0 0 1 " + corners + "endfacet ";
  EXPECT_EQ(read("one_line.stl", "solid a name " + facet + facet + "endsolid a\n").soup.triangles.size(), 2u);
  EXPECT_EQ(
      read("glued.stl", "solid a\n" + facet + "\nendsolid a solid b " + facet + "endsolid b").soup.triangles.size(),
      2u);
  EXPECT_EQ(read("loops.stl", "solid a\nfacet normal 0 0 1 " + corners + corners + "endfacet\nendsolid")
                .soup.triangles.size(),
            2u)
      << "two loops are two faces, not a hexagon";
  EXPECT_THAT(read("whole.stl", "solid a\n" + facet + "\nendsolid a\n").notes, IsEmpty());
  EXPECT_THAT(read("cut.stl", "solid a\n" + facet + "\n").notes, Contains(HasSubstr("may be truncated")));
}

TEST_F(MeshReaders, ObjCommentsContinueNothing) {
  const std::string mesh = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  const ImportedMesh imported = read("comment.obj", "# made in C:\\\n" + mesh + "  # D:\\\nf 1 2 3\nf 1 \\\n2 3\n");
  EXPECT_EQ(imported.soup.positions.size(), 3u);
  EXPECT_EQ(imported.soup.triangles.size(), 2u);
}

// -------------------------------------------------------------------------------------------------------------- PLY

std::string ply_header(const std::string& format, const std::string& faces) {
  return "ply\nformat " + format +
         " 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement " + faces +
         "\nend_header\n";
}

TEST_F(MeshReaders, PlyListsThatPromiseMoreThanThereIs) {
  const std::string faces = "face 1\nproperty list uint int vertex_indices";
  const std::string positions = bytes_of(0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 1.f, 1.f, 0.f, 0.f, 1.f, 0.f);
  for (const std::uint32_t length : {4294967295u, 3000u, 4u}) {
    expect_refused("list.ply", ply_header("binary_little_endian", faces) + positions + bytes_of(length, 0, 1, 2),
                   {fmt::format("a list 'vertex_indices' of {} numbers, but only 12 bytes follow", length)});
  }
  expect_refused("ascii.ply", ply_header("ascii", faces) + "0 0 0\n1 0 0\n1 1 0\n0 1 0\n4294967295 0 1 2\n",
                 {"line 14", "a list 'vertex_indices' of 4294967295 numbers"});
  expect_refused(
      "negative.ply",
      ply_header("ascii", "face 1\nproperty list int int vertex_index") + "0 0 0\n1 0 0\n1 1 0\n0 1 0\n-1 0 1 2\n",
      {"line 14", "of -1 numbers"});
}

TEST_F(MeshReaders, PlyWithWhatIsNotOurs) {
  // Lists before and between, faces before vertices, an extra column, an element of another kind.
  const ImportedMesh mesh =
      read("odd.ply",
           "ply\nformat ascii 1.0\ncomment faces first\nelement face 2\nproperty list uchar float weights\n"
           "property list uchar uint vertex_index\nproperty uchar red\nelement edge 1\nproperty int a\n"
           "property int b\nelement vertex 4\nproperty double z\nproperty double y\nproperty list char "
           "int more\nproperty double x\nend_header\n2 0.5 0.5 4 0 1 2 3 255\n0 3 0 2\n3 9\n0 1\n"
           "0 0 0 0.1\n0 0 2 7 8 1\n0 1 0 1 99\n0 1 0 0\n");
  ASSERT_EQ(mesh.soup.triangles.size(), 3u);
  EXPECT_EQ(mesh.soup.positions[0], glm::dvec3(0.1, 0, 0)) << "in double";
  EXPECT_EQ(mesh.soup.positions[1], glm::dvec3(1, 0, 0));
  EXPECT_EQ(mesh.soup.source_face, (std::vector<std::uint32_t>{0, 0, 1}));
  EXPECT_THAT(mesh.notes, Contains("1 elements 'edge' skipped"));
  EXPECT_THAT(mesh.notes, Contains("ignored properties of 'face': weights red"));
  EXPECT_THAT(mesh.notes, Contains("1 lines have more numbers than the header declares"));
}

TEST_F(MeshReaders, PlyStripsHaveOneWinding) {
  const ImportedMesh mesh =
      read("strips.ply", ply_header("ascii", "tristrips 1\nproperty list int int vertex_indices") +
                             "0 0 0\n1 0 0\n0 1 0\n1 1 0\n8 0 1 2 3 -1 1 3 2\n");
  ASSERT_EQ(mesh.soup.triangles.size(), 3u);
  for (std::size_t t = 0; t < 3; ++t) {
    const glm::dvec3 a = corner(mesh.soup, t, 0), b = corner(mesh.soup, t, 1), c = corner(mesh.soup, t, 2);
    EXPECT_GT((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x), 0) << t;
  }
}

TEST_F(MeshReaders, PlyLinesThatEndInReturnsAlone) {
  // The first byte of the body is a line feed, which must not be taken for part of the line end of the header's last
  // line.
  const std::string body = bytes_of(std::uint8_t{10}, std::uint8_t{10}) +
                           bytes_of(0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f, std::uint8_t{3}, 0, 1, 2);
  for (const std::string end : {"\n", "\r\n", "\r"}) {
    std::string header;
    for (const char* line : {"ply", "format binary_little_endian 1.0", "element extra 2", "property uchar value",
                             "element vertex 3", "property float x", "property float y", "property float z",
                             "element face 1", "property list uchar int vertex_indices", "end_header"}) {
      header += line + end;
    }
    SCOPED_TRACE(testing::PrintToString(end));
    const ImportedMesh mesh = read("ends.ply", header + body);
    ASSERT_EQ(mesh.soup.triangles.size(), 1u);
    EXPECT_EQ(corner(mesh.soup, 0, 1), glm::dvec3(1, 0, 0));
  }
}

TEST_F(MeshReaders, AZeroByteDoesNotEndAMessage) {
  const auto with_zero = [](std::string text) {
    std::ranges::replace(text, '@', '\0');
    return text;
  };
  expect_refused("zero.obj", with_zero("v 0 0 0\nv 1 0@7 0\n"), {"'0\\x007' is not a number"});
  expect_refused("zero.off", with_zero("OFF\n3@1 1 0\n"), {"'3\\x001' is no number of vertices"});
  expect_refused("zero.stl", with_zero("solid a\nfacet\nvertex 0 1@2 0\n"), {"'1\\x002' is not a coordinate"});
  expect_refused("zero.ply", with_zero("ply\nformat as@cii 1.0\nend_header\n"), {"'as\\x00cii' is no format"});
  expect_refused("zeros.ply",
                 ply_header("ascii", "face 1\nproperty list int int vertex_index") +
                     with_zero("0 0@1 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n"),
                 {"line 10", "'0\\x001' is not a number"});
}

TEST_F(MeshReaders, PlyHeadersThatDoNotSay) {
  expect_refused("format.ply", "ply\nformat binary_middle_endian 1.0\nend_header\n",
                 {"line 2", "binary_middle_endian"});
  expect_refused("none.ply", "ply\nelement vertex 0\nend_header\n", {"no format"});
  expect_refused("type.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty half x\nend_header\n",
                 {"line 4", "'half'"});
  expect_refused("flat.ply",
                 "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nend_header\n0 0\n",
                 {"'vertex' needs one property z"});
  expect_refused("index.ply",
                 ply_header("ascii", "face 1\nproperty list uchar float vertex_indices") +
                     "0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 1.5\n",
                 {"line 14", "vertex 1.5"});
}

// ------------------------------------------------------------------------------------------------------- other texts

std::string utf16(std::string_view text, bool big_endian) {
  std::string wide = big_endian ? "\xFE\xFF" : "\xFF\xFE";
  for (const char c : text) {
    if (big_endian) wide += '\0';
    wide += c;
    if (!big_endian) wide += '\0';
  }
  return wide;
}

TEST_F(MeshReaders, TextOfAnyUnicode) {
  const std::string obj = std::string("# \x41\n") + kSquare + "f 1 2 3\n";
  const std::string ac =
      "AC3Db\nMATERIAL \"\" rgb 1 1 1  amb 0.2 0.2 0.2  emis 0 0 0  spec 0.5 0.5 0.5  shi 10  trans 0\nOBJECT "
      "world\nkids "
      "1\nOBJECT poly\nnumvert 3\n0 0 0\n1 0 0\n0 1 0\nnumsurf 1\nSURF 0x20\nmat 0\nrefs 3\n0 0 0\n1 0 0\n2 0 0\nkids "
      "0\n";
  const std::string amf =
      "<amf><object id=\"1\"><mesh><vertices><vertex><coordinates><x>0</x><y>0</y><z>0</z></coordinates></vertex>"
      "<vertex><coordinates><x>1</x><y>0</y><z>0</z></coordinates></vertex><vertex><coordinates><x>0</x><y>1</y>"
      "<z>0</z></coordinates></vertex></vertices><volume><triangle><v1>0</v1><v2>1</v2><v3>2</v3></triangle></volume>"
      "</mesh></object></amf>";
  for (const auto& [name, text] : {std::pair{"text.obj", obj}, {"text.ac", ac}, {"text.amf", amf}}) {
    for (const bool big_endian : {false, true})
      EXPECT_EQ(read(name, utf16(text, big_endian)).soup.triangles.size(), 1u) << name;
    EXPECT_EQ(read(name, "\xEF\xBB\xBF" + text).soup.triangles.size(), 1u) << name;
  }
  expect_refused("odd.obj", utf16(obj, false) + "x", {"byte order mark says UTF-16"});
  expect_refused("half.obj", std::string("\xFF\xFE\x00\xDC", 4), {"byte order mark says UTF-16", "byte 2"});
}

std::string chunk_3ds(std::uint16_t number, const std::string& content) {
  return bytes_of(number, static_cast<std::uint32_t>(content.size() + 6)) + content;
}

TEST_F(MeshReaders, ThreeDsChunksThatPromiseMoreThanThereIs) {
  const auto file = [](std::uint16_t vertices, std::uint32_t more) {
    const std::string positions = bytes_of(vertices, 0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f);
    const std::string faces =
        bytes_of(std::uint16_t{1}, std::uint16_t{0}, std::uint16_t{1}, std::uint16_t{2}, std::uint16_t{0});
    std::string mesh = chunk_3ds(0x4110, positions) + chunk_3ds(0x4120, faces);
    mesh.replace(2, 4, bytes_of(static_cast<std::uint32_t>(6 + positions.size()) + more));
    return chunk_3ds(0x4D4D, chunk_3ds(0x3D3D, chunk_3ds(0x4000, std::string("a\0", 2) + chunk_3ds(0x4100, mesh))));
  };
  EXPECT_EQ(read("whole.3ds", file(3, 0)).soup.triangles.size(), 1u);
  expect_refused("count.3ds", file(60000, 0), {"chunk 0x4110 at byte 26", "60000 entries"});
  expect_refused("length.3ds", file(3, 4000000000u), {"chunk 0x4110 at byte 26", "says that it has 4000000044 bytes"});
}

/// A 3D Studio lamp is an object with a position, and with another chunk if it is a spot.
TEST_F(MeshReaders, ThreeDsLampsAreNamed) {
  const std::string positions = bytes_of(std::uint16_t{3}, 0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f);
  const std::string faces =
      bytes_of(std::uint16_t{1}, std::uint16_t{0}, std::uint16_t{1}, std::uint16_t{2}, std::uint16_t{0});
  const std::string mesh = chunk_3ds(0x4100, chunk_3ds(0x4110, positions) + chunk_3ds(0x4120, faces));
  const std::string shape = chunk_3ds(0x4000, std::string("a\0", 2) + mesh);
  const std::string lamp = chunk_3ds(0x4000, std::string("Key\0", 4) + chunk_3ds(0x4600, bytes_of(0.f, 3.f, 0.f)));
  const std::string spot = chunk_3ds(0x4610, bytes_of(0.f, 0.f, 0.f, 40.f, 45.f));
  const std::string rim =
      chunk_3ds(0x4000, std::string("Rim\0", 4) + chunk_3ds(0x4600, bytes_of(2.f, 3.f, 0.f) + spot));
  const auto file = [](const std::string& objects) { return chunk_3ds(0x4D4D, chunk_3ds(0x3D3D, objects)); };
  EXPECT_THAT(read("lit.3ds", file(shape + lamp + rim)).notes,
              testing::Contains(HasSubstr("lamps, which a mesh does not have: 'Key', 'Rim'; left out")));
  EXPECT_THAT(read("unlit.3ds", file(shape)).notes, testing::Not(testing::Contains(HasSubstr("lamps"))));
}

/// 3D Studio stores opacity as a percentage of transparency.
TEST_F(MeshReaders, ThreeDsMaterialsThatLetLightThroughAreNamed) {
  const auto file = [](std::uint16_t percent, bool used) {
    const std::string name("glass\0", 6);
    const std::string material =
        chunk_3ds(0xAFFF, chunk_3ds(0xA000, name) + chunk_3ds(0xA050, chunk_3ds(0x0030, bytes_of(percent))));
    const std::string positions = bytes_of(std::uint16_t{3}, 0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f);
    std::string faces =
        bytes_of(std::uint16_t{1}, std::uint16_t{0}, std::uint16_t{1}, std::uint16_t{2}, std::uint16_t{0});
    if (used) faces += chunk_3ds(0x4130, name + bytes_of(std::uint16_t{1}, std::uint16_t{0}));
    const std::string mesh = chunk_3ds(0x4100, chunk_3ds(0x4110, positions) + chunk_3ds(0x4120, faces));
    return chunk_3ds(0x4D4D, chunk_3ds(0x3D3D, material + chunk_3ds(0x4000, std::string("a\0", 2) + mesh)));
  };
  const auto named = testing::Contains(
      HasSubstr("materials that let light through, which is not supported for this format: 'glass';"));
  EXPECT_THAT(read("half.3ds", file(50, true)).notes, named);
  EXPECT_THAT(read("clear.3ds", file(100, true)).notes, named);
  EXPECT_THAT(read("solid.3ds", file(0, true)).notes, testing::Not(named));
  EXPECT_THAT(read("unused.3ds", file(50, false)).notes, testing::Not(named));
}

TEST_F(MeshReaders, LightWaveOfOldIsRefusedByName) {
  expect_refused("old.lwo", std::string("FORM\0\0\0\x04LWOB", 12), {"LWOB", "not supported"});
}

TEST_F(MeshReaders, GltfNumbersThatLibrariesDrop) {
  const auto gltf = [](const std::string& view, const std::string& accessor) {
    return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
      "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
      "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3")" +
           accessor + R"(}],"bufferViews":[{"buffer":0,"byteLength":36)" + view +
           R"(}],"buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})";
  };
  EXPECT_EQ(read("good.gltf", gltf("", "")).soup.triangles.size(), 1u);
  expect_refused("offset.gltf", gltf(R"(,"byteOffset":-8)", ""), {"/bufferViews/0/byteOffset: -8"});
  expect_refused("stride.gltf", gltf(R"(,"byteStride":-12)", ""), {"/bufferViews/0/byteStride: -12"});
  expect_refused("half.gltf", gltf(R"(,"byteOffset":0.5)", ""), {"/bufferViews/0/byteOffset: 0.5"});
  expect_refused("accessor.gltf", gltf("", R"(,"byteOffset":"4")"), {"/accessors/0/byteOffset: \"4\""});
  expect_refused("old.gltf", R"({"scene":"first"})", {"/asset/version"});
}

}  // namespace
}  // namespace penumbra::mesh
