// SPDX-License-Identifier: Apache-2.0
// Tests inspect: what it reports about a mesh with known defects, in table, JSON and files, and what it refuses.
#include "tests/cli/program.hpp"

#include "base/png.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <span>
#include <sstream>
#include <tuple>

namespace penumbra::tests {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

/// The unit cube without one of its twelve triangles.
constexpr const char* kHoleyCube =
    "OFF\n8 11 0\n"
    "0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n"
    "3 0 2 1\n3 0 3 2\n3 4 5 6\n3 4 6 7\n3 0 1 5\n3 0 5 4\n3 1 2 6\n3 1 6 5\n3 2 3 7\n3 2 7 6\n3 3 0 4\n";

class Inspect : public ProgramTest {
 protected:
  std::string cube() const { return write("cube.off", kHoleyCube).string(); }
  json report(const std::vector<std::string>& arguments) const {
    std::vector<std::string> all = {"inspect", "--json", "-"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    const Outcome outcome = run(all);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return json::parse(outcome.out);
  }
};

TEST_F(Inspect, TheTableSaysWhatIsWrongAndWhatMethodsMakeOfIt) {
  const Outcome outcome = run({"inspect", cube()});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, testing::ContainsRegex("triangles +11\n"));
  EXPECT_THAT(outcome.out, testing::ContainsRegex("watertight +no\n"));
  EXPECT_THAT(outcome.out, testing::ContainsRegex("boundary edges +3 +loops: 1\n"));
  EXPECT_THAT(outcome.out, HasSubstr("(0, 1, 0) – (0, 1, 1): triangle 8"));
  EXPECT_THAT(outcome.out, testing::ContainsRegex("methods +[0-9]+ exact, .*approximate"));
  EXPECT_EQ(outcome.out.find("raytrace"), std::string::npos) << "methods are listed when asked for";
  EXPECT_TRUE(outcome.err.empty()) << outcome.err;
  const Outcome with = run({"inspect", cube(), "--methods"});
  EXPECT_THAT(with.out, testing::ContainsRegex("view-sample +exact"));
  EXPECT_THAT(with.out, testing::ContainsRegex("raytrace +approximate"));
}

TEST_F(Inspect, JsonHasItsKeys) {
  const json file = report({cube()});
  const std::map<std::string, json> known = {{"triangles", 11},
                                             {"vertices", 8},
                                             {"components", 1},
                                             {"closed", false},
                                             {"boundaryEdges", 3},
                                             {"boundaryLoops", 1},
                                             {"nonManifoldEdges", 0},
                                             {"nonManifoldVertices", 0},
                                             {"inconsistentWindings", 0},
                                             {"duplicateFaces", 0},
                                             {"oppositeFaces", 0},
                                             {"zeroAreaTriangles", 0},
                                             {"needles", 0},
                                             {"tJunctions", 0},
                                             {"selfIntersections", 0}};
  for (const json& object : {file, file.at("total"), file.at("objects").at(0), file.at("files").at(0).at("total")}) {
    for (const auto& [key, value] : known) EXPECT_EQ(object.at(key), value) << key;
    EXPECT_EQ(object.at("bounds"), json::parse("[[0, 0, 0], [1, 1, 1]]"));
    EXPECT_EQ(object.at("verdicts").at("view-sample"), "exact");
    // The pyramid from the bounds' centre over the missing triangle is missing: a twelfth of the volume.
    EXPECT_DOUBLE_EQ(object.at("volume").get<double>(), 11.0 / 12);
    const json& edges = object.at("lists").at("boundaryEdges");
    ASSERT_EQ(edges.size(), 3u);
    EXPECT_EQ(edges[1].at("points"), json::parse("[[0, 1, 0], [0, 1, 1]]"));
    EXPECT_EQ(edges[1].at("triangles"), json::parse("[8]"));
  }
  EXPECT_EQ(file.at("objects").at(0).at("name"), "cube.off");
  const json silent = report({cube(), "--no-self-intersections", "--list", "1"});
  EXPECT_TRUE(silent.at("selfIntersections").is_null());
  EXPECT_EQ(silent.at("lists").at("boundaryEdges").size(), 1u);
}

TEST_F(Inspect, SaysOfEachObjectAndLightOfAScene) {
  tiny_scene();
  const json scene = report({path("scene.json")});
  ASSERT_EQ(scene.at("objects").size(), 2u);
  EXPECT_EQ(scene.at("objects")[0].at("name"), "floor");
  EXPECT_EQ(scene.at("objects")[1].at("name"), "wedge");
  EXPECT_EQ(scene.at("triangles"), 4);
  EXPECT_EQ(scene.at("objects")[1].at("lists").at("boundaryEdges")[0].at("triangles")[0], 2) << "numbers of the file";
  write("sphere.json", scene_text_with("/lights/0", R"({"name": "b", "sphere": {"center": [0,4,0], "radius": 1}})"));
  const json lit = report({path("sphere.json")});
  EXPECT_EQ(lit.at("verdicts").at("view-sample"), "exact");
  EXPECT_EQ(lit.at("verdicts").at("view-sample-planar"), "refused");
  EXPECT_EQ(lit.at("verdicts").at("raytrace"), "approximate");
}

TEST_F(Inspect, SeveralFilesAreAllReportedAndTheUnreadableOneCostsExitCode3) {
  const std::string bad = write("bad.off", "OFF\n3 1 0\n0 0 0\n").string();
  const Outcome outcome = run({"inspect", bad, cube(), "--json", path("out.json")});
  EXPECT_EQ(outcome.code, 3);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("bad.off"), HasSubstr("line 2")));
  EXPECT_THAT(outcome.out, testing::ContainsRegex("- +- +- +- +- +- +unreadable +.*bad.off.*line 2"));
  EXPECT_THAT(outcome.out, testing::ContainsRegex("11 +no +3 +0 +0 +0 +approximate:[0-9]+ +.*cube.off\n"));
  const json files = json::parse(read("out.json"));
  ASSERT_TRUE(files.is_array());
  EXPECT_THAT(files.at(0).at("error").get<std::string>(), HasSubstr("line 2"));
  EXPECT_EQ(files.at(1).at("total").at("triangles"), 11);
  EXPECT_EQ(run({"inspect", path("nowhere.off")}).code, 3);
  std::filesystem::create_directory(path("empty"));
  const Outcome empty = run({"inspect", path("empty")});
  EXPECT_EQ(empty.code, 3);
  EXPECT_THAT(empty.err, HasSubstr("no mesh file"));
}

TEST_F(Inspect, ReadsGltfWithoutALight) {
  tiny_scene();
  ASSERT_EQ(run({"convert", path("scene.json"), "-o", path("lit.glb")}).code, 0);
  std::string text = read("lit.glb");
  const auto emissive = text.find("emissiveFactor");
  ASSERT_NE(emissive, std::string::npos);
  text[emissive] = 'E';  // an unknown member: the light's body becomes plain geometry
  write("unlit.glb", text);
  EXPECT_EQ(run({"render", path("unlit.glb"), "-o", path("x.exr"), "--method", "raytrace", "--no-studio"}).code, 3);
  EXPECT_EQ(report({path("lit.glb")}).at("triangles"), 4) << "the light has no body";
  EXPECT_EQ(report({path("unlit.glb")}).at("triangles"), 6);
}

TEST_F(Inspect, CoordinatesBeyondAnySceneAreSaidToBeRefused) {
  write("far.off", "OFF\n4 2 0\n-1.7e308 0 0\n1.7e308 0 0\n0 1.7e308 0\n0 0 1\n3 0 1 2\n3 0 1 3\n");
  const json far = report({path("far.off")});
  for (const auto& [method, verdict] : far.at("verdicts").items()) EXPECT_EQ(verdict, "refused") << method;
  EXPECT_EQ(far.at("triangles"), 2);
  EXPECT_EQ(run({"inspect", path("far.off")}).out.find("nan"), std::string::npos);
}

TEST_F(Inspect, WeldJoinsWhatIsClose) {
  write("gap.off", "OFF\n6 2 0\n0 0 0\n1 0 0\n0 1 0\n1 0.001 0\n1 1 0\n0 1.001 0\n3 0 1 2\n3 3 4 5\n");
  EXPECT_EQ(report({path("gap.off")}).at("boundaryEdges"), 6);
  EXPECT_EQ(report({path("gap.off"), "--weld", "0.01"}).at("boundaryEdges"), 4);
}

TEST_F(Inspect, ExportsTheDefectsInColour) {
  ASSERT_EQ(run({"inspect", cube(), "--export-defects", path("bad.ply")}).code, 0);
  const std::string ply = read("bad.ply");
  EXPECT_THAT(ply, AllOf(HasSubstr("element face 11\n"), HasSubstr("element edge 3\n"), HasSubstr("red")));
  const json back = report({path("bad.ply")});
  EXPECT_EQ(back.at("boundaryEdges"), 3);
  EXPECT_EQ(back.at("triangles"), 11);
}

TEST_F(Inspect, RepairsAndTheResultReadsBack) {
#ifndef PENUMBRA_WITH_CGAL_GPL
  GTEST_SKIP() << "penumbra-repair is not built";
#endif
  const Outcome outcome = run({"inspect", cube(), "--repair", path("repaired.ply"), "--fill-holes", "3"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("done:"));
  const json back = report({path("repaired.ply")});
  EXPECT_EQ(back.at("triangles"), 12);
  EXPECT_EQ(back.at("boundaryEdges"), 0);
  EXPECT_EQ(back.at("closed"), true);
  EXPECT_DOUBLE_EQ(back.at("volume").get<double>(), 1);
  for (const char* name : {"a.obj", "a.stl", "a.off", "a.glb"}) {
    SCOPED_TRACE(name);
    const json told = report({cube(), "--repair", path(name), "--fill-holes", "3"}).at("repair");
    EXPECT_EQ(told.at("readAgain").at("boundaryEdges"), 0);
    const json read_again = report({path(name)});
    EXPECT_EQ(read_again.at("triangles"), 12);
    EXPECT_EQ(read_again.at("closed"), true);
    EXPECT_NEAR(read_again.at("volume").get<double>(), 1, 1e-6);
  }
}

/// Repairs that no reader would accept are not written, nor those that leave no triangle.
TEST_F(Inspect, WritesNoRepairThatIsNoMesh) {
#ifndef PENUMBRA_WITH_CGAL_GPL
  GTEST_SKIP() << "penumbra-repair is not built";
#endif
  write("line.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
  write("huge.obj", "v 0 0 0\nv 1e30 0 0\nv 0 1e30 0\nf 1 2 3\n");
  for (const auto& [mesh, repaired, said] : {std::tuple("line.obj", "line.ply", "nothing is left of the mesh"),
                                             {"huge.obj", "huge.glb", "reading it back fails"}}) {
    const Outcome outcome = run({"inspect", path(mesh), "--repair", path(repaired)});
    EXPECT_EQ(outcome.code, 3);
    EXPECT_THAT(outcome.err, HasSubstr(said));
    EXPECT_FALSE(std::filesystem::exists(path(repaired)));
  }
}

/// Two cubes that share an edge: by indices a repair separates them, by position they stay joined.
TEST_F(Inspect, WhatARepairSaysOfItsFileIsWhatInspectSaysOfIt) {
#ifndef PENUMBRA_WITH_CGAL_GPL
  GTEST_SKIP() << "penumbra-repair is not built";
#endif
  const char* const faces =
      "0 2 1\n3 0 3 2\n3 4 5 6\n3 4 6 7\n3 0 1 5\n3 0 5 4\n3 1 2 6\n3 1 6 5\n3 2 3 7\n3 2 7 6\n3 3 0 4\n3 3 4 7\n";
  std::string text = "OFF\n16 24 0\n";
  for (const int shift : {0, 1}) {
    for (int i = 0; i < 8; ++i) {
      const int x = (i & 3) == 1 || (i & 3) == 2, y = (i & 3) >= 2, z = i >= 4;
      text += std::to_string(x + shift) + ' ' + std::to_string(y + shift) + ' ' + std::to_string(z) + '\n';
    }
  }
  text += std::string("3 ") + faces;
  std::istringstream lines(std::string("3 ") + faces);
  for (int n = 0, a = 0, b = 0, c = 0; lines >> n >> a >> b >> c;)
    text += "3 " + std::to_string(a + 8) + ' ' + std::to_string(b + 8) + ' ' + std::to_string(c + 8) + '\n';
  write("edge.off", text);
  ASSERT_EQ(report({path("edge.off")}).at("nonManifoldEdges"), 1);
  const json told = report({path("edge.off"), "--repair", path("edge.ply")}).at("repair");
  const json again = report({path("edge.ply")});
  EXPECT_EQ(again.at("nonManifoldEdges"), 1);
  for (const auto& [key, value] : told.at("readAgain").items()) EXPECT_EQ(again.at(key), value) << key;
  EXPECT_THAT(told.at("left").dump(), HasSubstr("1 edges and"));
}

TEST_F(Inspect, AFolderIsATableWithARowAFileInOrder) {
  std::filesystem::create_directories(path("meshes/below"));
  std::filesystem::create_directories(path("meshes/.hidden"));
  write("meshes/b.off", kHoleyCube);
  write("meshes/a, 1.off", "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n");
  write("meshes/below/c.OFF", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  write("meshes/.hidden/d.off", kHoleyCube);
  write("meshes/notes.txt", "no mesh");
  write("meshes/settings.json", "{}");
  const Outcome outcome = run({"inspect", path("meshes"), "--csv", path("out.csv"), "--json", path("out.json"), "--png",
                               path("defects.png"), "--fail-on", "boundaryEdges"});
  EXPECT_EQ(outcome.code, 1) << outcome.err;
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("b.off: 3 boundaryEdges"), HasSubstr("c.OFF: 3 boundaryEdges")));
  EXPECT_EQ(outcome.err.find("a, 1.off"), std::string::npos) << "a tetrahedron is closed";
  EXPECT_EQ(std::ranges::count(outcome.out, '\n'), 4);
  const json files = json::parse(read("out.json"));
  ASSERT_EQ(files.size(), 3u);
  EXPECT_EQ(files[0].at("file"), path("meshes/a, 1.off"));
  EXPECT_EQ(files[1].at("file"), path("meshes/b.off"));
  EXPECT_EQ(files[2].at("file"), path("meshes/below/c.OFF"));
  const std::string csv = read("out.csv");
  EXPECT_THAT(csv, testing::StartsWith("file,triangles,vertices,components,closed,closedAsWound,boundaryEdges,"));
  EXPECT_THAT(csv, HasSubstr("\n\"" + path("meshes/a, 1.off") + "\",4,4,1,true,true,0,"));
  EXPECT_THAT(csv, HasSubstr("\n" + path("meshes/b.off") + ",11,8,1,false,false,3,"));
  const auto columns = [](const std::string& line) { return std::ranges::count(line, ','); };
  const std::string header = csv.substr(0, csv.find('\r')), last = csv.substr(csv.find(path("meshes/b")));
  EXPECT_EQ(columns(header), columns(last.substr(0, last.find('\r'))));
  for (const char* picture : {"defects-0001-a__1.png", "defects-0002-b.png", "defects-0003-c.png"})
    EXPECT_TRUE(std::filesystem::exists(path(picture))) << picture;
  EXPECT_EQ(run({"inspect", path("meshes/a, 1.off"), "--fail-on", "open,non-manifold,selfIntersections"}).code, 0);
  EXPECT_EQ(run({"inspect", path("meshes/b.off"), "--fail-on", "open"}).code, 1);
  EXPECT_EQ(run({"inspect", path("meshes/b.off"), "--fail-on", "needles,duplicateFaces"}).code, 0);
  EXPECT_EQ(run({"inspect", path("meshes/b.off"), "--fail-on", "closed"}).code, 2);
  EXPECT_EQ(run({"inspect", path("meshes/b.off"), "--fail-on", "selfIntersections", "--no-self-intersections"}).code,
            2);
}

TEST_F(Inspect, NamesOfFilesStayOnTheirRow) {
  std::filesystem::create_directories(path("odd"));
  constexpr const char* kTetrahedron = "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n";
  write("odd/a\nb\tc.off", kTetrahedron);
  write("odd/caf\xe9.off", kTetrahedron);
  write("odd/d\ne.off", "no mesh");
  const Outcome outcome = run({"inspect", path("odd"), "--csv", path("out.csv"), "--json", path("out.json")});
  EXPECT_EQ(outcome.code, 3);
  EXPECT_EQ(std::ranges::count(outcome.out, '\n'), 4) << outcome.out;
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("/a\\nb\\tc.off\n"), HasSubstr("/caf\\xe9.off\n"), HasSubstr("e.off: ")));
  EXPECT_EQ(outcome.out.find_first_of("\t\xe9"), std::string::npos);
  const json files = json::parse(read("out.json"));  // throws at what is not UTF-8
  EXPECT_EQ(files[0].at("file"), path("odd/a\nb\tc.off"));
  EXPECT_EQ(files[1].at("file"), path("odd/caf\\xe9.off"));
  EXPECT_TRUE(files[2].contains("error"));
  const std::string csv = read("out.csv");
  EXPECT_THAT(csv, HasSubstr("\n\"" + path("odd/a\nb\tc.off") + "\",4,4,1,"));
  EXPECT_THAT(csv, HasSubstr("\n" + path("odd/caf\\xe9.off") + ",4,4,1,"));
  EXPECT_EQ(csv.find('\xe9'), std::string::npos);
  EXPECT_THAT(run({"inspect", path("odd/a\nb\tc.off")}).out, testing::StartsWith(path("odd/a\\nb\\tc.off") + "\n"));
}

/// The surface is grey, its surroundings are white; the three edges of the missing triangle are red in one view or
/// both.
TEST_F(Inspect, ThePictureShowsDefectsInTheirColours) {
  ASSERT_EQ(run({"inspect", cube(), "--png", path("cube.png")}).code, 0);
  const std::string bytes = read("cube.png");
  const RgbaImage picture = decode_rgba_png(std::as_bytes(std::span(bytes)), 4096);
  ASSERT_EQ(picture.width, 1024u);
  ASSERT_EQ(picture.height, 512u);
  std::size_t red = 0, white = 0, grey = 0;
  for (const auto& [r, g, b, a] : picture.pixels) {
    red += r == 255 && g == 0 && b == 0 ? 1 : 0;
    white += r == 255 && g == 255 && b == 255 ? 1 : 0;
    grey += r == g && g == b && r < 201 ? 1 : 0;
  }
  EXPECT_GT(red, 200u);
  EXPECT_LT(red, 6000u);
  EXPECT_GT(white, 1024u * 512 / 4);
  EXPECT_GT(grey, 1024u * 512 / 8);
}

TEST_F(Inspect, RepairWithoutItsProgramSaysWhichIsMissing) {
  const std::string mesh = cube();
  const Outcome outcome =
      run({"inspect", mesh, "--repair", path("repaired.ply")}, {{"PENUMBRA_REPAIR_HELPER", path("nowhere")}});
  EXPECT_EQ(outcome.code, 4);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("repair helper"), HasSubstr(path("nowhere"))));
  EXPECT_EQ(outcome.out, "") << "this is said before long work begins";
}

TEST_F(Inspect, NeverOverwritesItsInput) {
  const std::string mesh = write("cube.ply",
                                 "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                                 "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
                                 "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")
                               .string();
  const std::string before = read("cube.ply");
  std::filesystem::create_symlink("cube.ply", path("link.ply"));
  std::filesystem::create_hard_link(mesh, path("hard.ply"));
  for (const char* name : {"cube.ply", "./cube.ply", "link.ply", "hard.ply"}) {
    for (const char* option : {"--json", "--export-defects", "--repair"}) {
      const Outcome outcome = run({"inspect", mesh, option, path(name)});
      EXPECT_EQ(outcome.code, 2) << option << ' ' << name << ": " << outcome.err;
    }
  }
  // A scene's meshes are inputs, too.
  write("scene.json", scene_text_with("/meshes/1", R"({"name": "m", "file": "cube.ply"})"));
  const Outcome outcome = run({"inspect", path("scene.json"), "--export-defects", mesh});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("cube.ply"));
  EXPECT_EQ(read("cube.ply"), before);
}

TEST_F(Inspect, AnInterruptEndsIt) {
  // Two million triangles: seconds of work anywhere.
  write("large.json", scene_text_with("/meshes/1", R"({"shape": {"type": "sphere", "segments": 1448}})"));
  const Outcome outcome = run_program({.arguments = {"inspect", path("large.json"), "--json", path("out.json")},
                                       .environment = {},
                                       .interrupt_after = 0.4});
  EXPECT_EQ(outcome.code, 130) << outcome.err;
  EXPECT_THAT(files(), ElementsAre("large.json"));
}

TEST_F(Inspect, RefusesWhatCannotBeMeant) {
  const std::string mesh = cube();
  const std::vector<std::vector<std::string>> wrong = {
      {"--weld", "-1"},
      {"--weld", "nan"},
      {"--list", "-3"},
      {"--repair", path("out.3ds")},
      {"--png", path("out.jpg")},
      {"--json", "-", "--csv", "-"},
      {"--export-defects", path("out.off")},
      {"--fill-holes", "5"},
      {"--resolve-self-intersections"},
      {"--json", path("a.ply"), "--export-defects", path("a.ply")},
      {mesh, "--export-defects", path("a.ply")},
  };
  for (const auto& options : wrong) {
    std::vector<std::string> all = {"inspect", mesh};
    all.insert(all.end(), options.begin(), options.end());
    const Outcome outcome = run(all);
    EXPECT_EQ(outcome.code, 2) << testing::PrintToString(options) << outcome.err;
    EXPECT_TRUE(outcome.out.empty());
  }
  EXPECT_THAT(files(), ElementsAre("cube.off"));
  EXPECT_EQ(run({"inspect", mesh, "--json", "/nowhere/at/all.json"}).code, 4);
}

}  // namespace
}  // namespace penumbra::tests
