// SPDX-License-Identifier: Apache-2.0
// Tests XML formats, zipped or plain: AMF, 3MF and X3D.
#include "mesh/import.hpp"

#include "tests/unit/mesh/import_files.hpp"

#include <gmock/gmock.h>
#include <minizip/zip.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace penumbra::mesh {
namespace {

using penumbra::test::corner;
using ::testing::Contains;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::Not;

class XmlReaders : public penumbra::test::FileTest {
 protected:
  [[nodiscard]] ImportedMesh read(const std::string& name, std::string_view content) const {
    return import_mesh(write(name, content));
  }
  /// A zip archive of the given entries.
  [[nodiscard]] std::filesystem::path write_zip(const std::string& name,
                                                const std::map<std::string, std::string>& entries) const {
    auto path = folder_ / name;
    const zipFile archive = zipOpen64(path.c_str(), APPEND_STATUS_CREATE);
    for (const auto& [entry, content] : entries) {
      const zip_fileinfo info{};
      EXPECT_EQ(zipOpenNewFileInZip(archive, entry.c_str(), &info, nullptr, 0, nullptr, 0, nullptr, Z_DEFLATED, 6), 0);
      EXPECT_EQ(zipWriteInFileInZip(archive, content.data(), static_cast<unsigned>(content.size())), 0);
      EXPECT_EQ(zipCloseFileInZip(archive), 0);
    }
    EXPECT_EQ(zipClose(archive, nullptr), 0);
    return path;
  }
};

double distance(const glm::dvec3& a, const glm::dvec3& b) {
  return std::max({std::abs(a.x - b.x), std::abs(a.y - b.y), std::abs(a.z - b.z)});
}

// -------------------------------------------------------------------------------------------------------------- AMF

std::string amf_object(const std::string& id, int volumes) {
  std::string object = "<object id=\"" + id + "\"><mesh><vertices>";
  for (const char* p : {"<x>0</x><y>0</y><z>0</z>", "<x>1</x><y>0</y><z>0</z>", "<x>0</x><y>1</y><z>0</z>"}) {
    object += std::string("<vertex><coordinates>") + p + "</coordinates></vertex>";
  }
  object += "</vertices>";
  for (int i = 0; i < volumes; ++i) object += "<volume><triangle><v1>0</v1><v2>1</v2><v3>2</v3></triangle></volume>";
  return object + "</mesh></object>";
}

TEST_F(XmlReaders, AmfWithEveryVolume) {
  EXPECT_EQ(read("volumes.amf", "<?xml version=\"1.0\"?><amf>" + amf_object("1", 3) + "</amf>").soup.triangles.size(),
            3u);
  const auto zipped = write_zip("zipped.amf", {{"model.amf", "<amf>" + amf_object("1", 2) + "</amf>"}});
  EXPECT_EQ(import_mesh(zipped).soup.triangles.size(), 2u);
}

TEST_F(XmlReaders, AmfConstellationsTurnAndMove) {
  const ImportedMesh mesh =
      read("constellation.amf",
           "<amf>" + amf_object("a", 1) + amf_object("alone", 1) +
               "<constellation id=\"c\"><instance objectid=\"a\"><deltax>10</deltax><rx>90</rx><rz>90</rz>"
               "</instance><instance objectid=\"a\"/></constellation></amf>");
  ASSERT_EQ(mesh.soup.triangles.size(),
            3u);  // the object that no constellation places stays where it is; then both copies
  // (0 1 0): turned around x by 90° it is (0 0 1), and turning around z keeps that; then it is moved.
  EXPECT_LT(distance(corner(mesh.soup, 1, 2), {10, 0, 1}), 1e-15);
  EXPECT_LT(distance(corner(mesh.soup, 1, 1), {10, 1, 0}), 1e-15);
  EXPECT_EQ(corner(mesh.soup, 2, 2), glm::dvec3(0, 1, 0));
}

TEST_F(XmlReaders, AmfRefusalsSayTheLine) {
  const std::string object = amf_object("1", 1);
  expect_refused("syntax.amf", "<amf>\n<object>\n</amf>", {"line 3", "malformed XML"});
  expect_refused("other.amf", "<html/>", {"<html>", "expected <amf>"});
  std::string high = object;
  high.replace(high.find("<v3>2"), 5, "<v3>3");
  expect_refused("high.amf", "<amf>\n" + high + "</amf>", {"line 2", "vertex 3", "only 3"});
  std::string wrong = object;
  wrong.replace(wrong.find("<x>1"), 4, "<x>one");
  expect_refused("number.amf", "<amf>\n\n" + wrong + "</amf>", {"line 3", "x is 'one'"});
  expect_refused("unknown.amf",
                 "<amf>" + object + "<constellation id=\"2\"><instance objectid=\"7\"/></constellation></amf>",
                 {"id '7'"});
  expect_refused("circle.amf",
                 "<amf><constellation id=\"1\"><instance objectid=\"2\"/></constellation>"
                 "<constellation id=\"2\"><instance objectid=\"1\"/></constellation></amf>",
                 {"made of itself"});
}

// -------------------------------------------------------------------------------------------------------------- 3MF

std::string model(const std::string& objects, const std::string& items) {
  return "<?xml version=\"1.0\"?>\n<model unit=\"millimeter\" "
         "xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/"
         "2015/02\" xmlns:p=\"http://schemas.microsoft.com/3dmanufacturing/production/2015/06\"><resources>" +
         objects + "</resources><build>" + items + "</build></model>";
}

std::string object(const std::string& id) {
  return "<object id=\"" + id +
         "\" name=\"same name\"><mesh><vertices><vertex x=\"0\" y=\"0\" z=\"0\"/><vertex x=\"1\" y=\"0\" z=\"0\"/>"
         "<vertex x=\"0\" y=\"1\" z=\"0\"/></vertices><triangles><triangle v1=\"0\" v2=\"1\" "
         "v3=\"2\"/></triangles></mesh></object>";
}

TEST_F(XmlReaders, ThreeMfComponentsInSeveralModels) {
  const std::string relationships =
      "<Relationships><Relationship Target=\"/3D/start.model\" "
      "Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/></Relationships>";
  const std::string start =
      model(object("1") + object("2") +
                "<object id=\"3\"><components><component objectid=\"1\"/><component objectid=\"2\" "
                "transform=\"0 1 0 -1 0 0 0 0 1 5 6 7\"/><component p:path=\"/3D/other.model\" "
                "objectid=\"1\"/></components></object>",
            "<item objectid=\"3\" transform=\"2 0 0 0 2 0 0 0 2 0 0 0\"/><item objectid=\"1\" transform=\"1 0 0 0 1 0 "
            "0 0 -1 0 0 0\"/>");
  const ImportedMesh mesh = import_mesh(write_zip("parts.3mf", {{"_rels/.rels", relationships},
                                                                {"3D/a.model", "not this one"},
                                                                {"3D/start.model", start},
                                                                {"3D/other.model", model(object("1"), "")}}));
  ASSERT_EQ(mesh.soup.triangles.size(), 4u);
  // (1 0 0) times the rows of the transform: (0 1 0) + (5 6 7), then doubled.
  EXPECT_EQ(corner(mesh.soup, 1, 1), glm::dvec3(10, 14, 14));
  EXPECT_EQ(corner(mesh.soup, 3, 1), glm::dvec3(0, 1, 0)) << "mirrored, so wound the other way";
  EXPECT_THAT(mesh.notes, Contains(HasSubstr("1 objects mirrored")));
}

TEST_F(XmlReaders, ThreeMfSaysWhatItDoesNotShow) {
  const ImportedMesh mesh = import_mesh(
      write_zip("one.3mf", {{"3D/3dmodel.model", model(object("1") + object("2"), "<item objectid=\"2\"/>")}}));
  EXPECT_EQ(mesh.soup.triangles.size(), 1u);
  EXPECT_THAT(mesh.notes, Contains("1 of 2 objects skipped: nothing places them"));
}

TEST_F(XmlReaders, ThreeMfRefusals) {
  const auto refusal = [&](const std::string& content) {
    const auto path = write_zip("bad.3mf", {{"3D/3dmodel.model", content}});
    return penumbra::test::input_error([&] { import_mesh(path); });
  };
  EXPECT_THAT(refusal(model(object("1"), "<item objectid=\"9\"/>")), HasSubstr("no object with the id '9'"));
  EXPECT_THAT(refusal(model(object("1") + object("1"), "")), HasSubstr("line 2: the id '1' occurs twice"));
  EXPECT_THAT(refusal(model(object("1"), "<item objectid=\"1\" transform=\"1 2 3\"/>")),
              HasSubstr("number 4 of the transform"));
  EXPECT_THAT(refusal(model("", "<item p:path=\"/x.model\" objectid=\"1\"/>")), HasSubstr("x.model: no such entry"));
  EXPECT_THAT(refusal(model("<object id=\"1\"><components><component objectid=\"1\"/></components></object>",
                            "<item objectid=\"1\"/>")),
              HasSubstr("object '1' is made of itself"));
  EXPECT_THAT(refusal(model(object("1") + object("2"), "")),
              HasSubstr("<build> lists no <item>, so that none of its 2"));
  expect_refused("plain.3mf", "<model/>", {"no zip archive"});
  expect_refused("cut.3mf", "PK\x03\x04 and no more", {"truncated or damaged"});
  // Doubling forty times would give a thousand billion triangles: the import must end with a message that says what is
  // too much.
  std::string doubled = object("0");
  for (int i = 1; i <= 40; ++i) {
    doubled += fmt::format(
        "<object id=\"{0}\"><components><component objectid=\"{1}\"/><component "
        "objectid=\"{1}\"/></components></object>",
        i, i - 1);
  }
#if !defined(PENUMBRA_SHADOW_MEMORY)  // under a sanitizer the helper's memory is not limited
  const auto bomb = write_zip("bomb.3mf", {{"3D/3dmodel.model", model(doubled, "<item objectid=\"40\"/>")}});
  ImportLimits limits;
  limits.memory_bytes = std::uint64_t{256} << 20;
  EXPECT_THAT(penumbra::test::input_error([&] { import_mesh(bomb, limits); }),
              HasSubstr("repeats what it holds too often"));
#endif
}

// -------------------------------------------------------------------------------------------------------------- X3D

std::string x3d(const std::string& scene) {
  return "<?xml version=\"1.0\"?>\n<X3D version=\"3.3\"><Scene>\n" + scene + "\n</Scene></X3D>\n";
}

std::string triangle_shape(const std::string& attributes = "") {
  return "<Shape><IndexedFaceSet " + attributes +
         " coordIndex=\"0 1 2\"><Coordinate point=\"1 0 0, 2 0 0, 1 1 0\"/></IndexedFaceSet></Shape>";
}

TEST_F(XmlReaders, X3dTransformsInTheirOrder) {
  const ImportedMesh mesh = read(
      "transform.x3d", x3d("<Transform translation=\"1 2 3\" rotation=\"0 0 1 1.5707963267948966\" scale=\"2 1 1\" "
                           "center=\"1 0 0\">" +
                           triangle_shape() + "<Transform scale=\"-1 1 1\">" + triangle_shape("ccw=\"false\"") +
                           "</Transform></Transform>"));
  ASSERT_EQ(mesh.soup.triangles.size(), 2u);
  // The corners are (0 0), (1 0), (0 1) as seen from the centre; twice as wide and turned by 90° they are (0 0), (0 2),
  // (-1 0).
  EXPECT_LT(distance(corner(mesh.soup, 0, 0), {2, 2, 3}), 1e-15);
  EXPECT_LT(distance(corner(mesh.soup, 0, 1), {2, 4, 3}), 1e-15);
  EXPECT_LT(distance(corner(mesh.soup, 0, 2), {1, 2, 3}), 1e-15);
  // Clockwise, and mirrored: wound as the first triangle's mirror image, then turned over. (-2 0 0) is (-3 0) from the
  // centre.
  EXPECT_LT(distance(corner(mesh.soup, 1, 1), {2, -4, 3}), 1e-15);
  EXPECT_THAT(mesh.notes, Contains(HasSubstr("1 objects mirrored")));
}

TEST_F(XmlReaders, X3dSetsOfTrianglesHaveOneWinding) {
  const std::string points = "<Coordinate point=\"0 0 0 1 0 0 0 1 0 1 1 0 0 2 0 1 2 0\"/>";
  const std::map<std::string, std::size_t> sets = {{"<TriangleStripSet stripCount=\"6\">", 4},
                                                   {"<IndexedTriangleStripSet index=\"0 1 2 3 -1 2 3 4 5 -1\">", 4},
                                                   {"<TriangleFanSet stripCount=\"3\" fanCount=\"3 3\">", 2},
                                                   {"<IndexedTriangleFanSet index=\"0 1 3 2 -1\">", 2},
                                                   {"<TriangleSet>", 2},
                                                   {"<IndexedQuadSet index=\"0 1 3 2, 2 3 5 4\">", 4}};
  for (const auto& [set, count] : sets) {
    const std::string name = set.substr(1, set.find_first_of(" >") - 1);
    const ImportedMesh mesh = read("set.x3d", x3d("<Shape>" + set + points + "</" + name + "></Shape>"));
    ASSERT_EQ(mesh.soup.triangles.size(), count) << set;
    if (name == "TriangleFanSet" || name == "TriangleSet")
      continue;  // the second run of these runs the other way round
    for (std::size_t t = 0; t < count; ++t) {
      const glm::dvec3 a = corner(mesh.soup, t, 0), b = corner(mesh.soup, t, 1), c = corner(mesh.soup, t, 2);
      EXPECT_GT((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x), 0) << set << t;
    }
  }
}

TEST_F(XmlReaders, X3dRefusalsSayTheLine) {
  expect_refused("use.x3d", x3d("<Group USE=\"later\"/>\n<Group DEF=\"later\"/>"),
                 {"line 3", "no node 'later' before"});
  expect_refused("circle.x3d", x3d("<Group DEF=\"A\">" + triangle_shape() + "<Group USE=\"A\"/></Group>"),
                 {"'A' is made of itself"});
  expect_refused("index.x3d",
                 x3d("<Shape><IndexedFaceSet coordIndex=\"0 1 3\"><Coordinate point=\"0 0 0 1 0 0 1 1 "
                     "0\"/></IndexedFaceSet></Shape>"),
                 {"line 3", "vertex 3", "only 3"});
  expect_refused("point.x3d", x3d("<Shape><TriangleSet><Coordinate point=\"0 0 0 1\"/></TriangleSet></Shape>"),
                 {"line 3", "no multiple of 3"});
  expect_refused("proto.x3d", x3d(triangle_shape() + "\n<ProtoInstance name=\"Chair\"/>"),
                 {"line 4", "<ProtoInstance>"});
  expect_refused("human.x3d", x3d("<HAnimHumanoid>" + triangle_shape() + "</HAnimHumanoid>"),
                 {"line 3", "<HAnimHumanoid>"});
  expect_refused("lines.x3d", x3d("<Shape><Text string='\"a\"'/></Shape>"), {"no triangles", "1 Text"});
  expect_refused("other.x3d", "<html/>", {"<html>", "expected <X3D>"});
  expect_refused("coordinates.x3d", x3d("<Shape><IndexedFaceSet><Coordinate USE=\"none\"/></IndexedFaceSet></Shape>"),
                 {"line 3", "no node 'none' before"});
  const auto nothing = write("nothing.x3d", x3d("<Group/>"));
  EXPECT_THAT(penumbra::test::input_error([&] { import_mesh(nothing); }), EndsWith("there are no triangles in it"));
}

TEST_F(XmlReaders, X3dPrototypesHaveNamesOfTheirOwn) {
  // After an inner prototype the outer one's names are valid again, and names inside a prototype are not names of the
  // scene.
  const std::string inner =
      "<ProtoDeclare><ProtoBody><Group DEF=\"A\"><Shape><Box/></Shape></Group></ProtoBody></ProtoDeclare>";
  const std::string outer =
      "<ProtoDeclare><ProtoBody><Group DEF=\"B\"/>" + inner + "<Group USE=\"B\"/></ProtoBody></ProtoDeclare>";
  const ImportedMesh mesh =
      read("scopes.x3d", x3d("<Group DEF=\"A\">" + triangle_shape() + "</Group>" + outer + "<Group USE=\"A\"/>"));
  EXPECT_EQ(mesh.soup.triangles.size(), 2u);
  EXPECT_THAT(mesh.notes, Not(Contains(HasSubstr("USE refer to names"))));
  expect_refused("outside.x3d", x3d(outer + "\n<Group USE=\"B\"/>"), {"line 4", "no node 'B' before"});
}

TEST_F(XmlReaders, VerticesThatAreNotFiniteMatterToTheirFaces) {
  expect_refused("nan.x3d",
                 x3d("<Shape DEF=\"S\"><TriangleSet><Coordinate point=\"0 0 0 1 0 0 0 nan 0\"/></TriangleSet></Shape>"),
                 {"'S': vertex 2 is not finite"});
  std::string amf = "<amf>" + amf_object("1", 1) + "</amf>";
  amf.replace(amf.find("<x>1"), 4, "<x>inf");
  expect_refused("inf.amf", amf, {"object '1': vertex 1 is not finite"});
  std::string nan = model(object("1"), "<item objectid=\"1\"/>");
  nan.replace(nan.find("x=\"1\""), 5, "x=\"nan\"");
  const auto path = write_zip("nan.3mf", {{"3D/3dmodel.model", nan}});
  EXPECT_THAT(penumbra::test::input_error([&] { import_mesh(path); }), HasSubstr("object '1': vertex 1 is not finite"));
}

/// With the product of parts and children as its number of steps, this took a minute. An object without faces is not
/// placed anywhere, though it is used a thousand billion times.
TEST_F(XmlReaders, X3dGroupsTakeTheTimeOfTheirNumber) {
  std::string wide = "<Group DEF=\"A\">" + triangle_shape();
  for (int i = 0; i < 100000; ++i) wide += "<Group/>";
  expect_refused("wide.x3d", x3d(wide + "<Group USE=\"A\"/></Group>"), {"'A' is made of itself"});
  std::string doubled = triangle_shape() + "<Group DEF=\"G0\"><Shape><PointSet/></Shape></Group>";
  for (int i = 1; i <= 40; ++i)
    doubled += fmt::format("<Group DEF=\"G{0}\"><Group USE=\"G{1}\"/><Group USE=\"G{1}\"/></Group>", i, i - 1);
  EXPECT_EQ(read("doubled.x3d", x3d(doubled)).soup.triangles.size(), 1u);
}

}  // namespace
}  // namespace penumbra::mesh
