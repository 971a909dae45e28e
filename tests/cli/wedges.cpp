// SPDX-License-Identifier: Apache-2.0
// Tests wedges: what it prints and writes, and its exit codes.
#include "tests/cli/program.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <cstring>

namespace penumbra::tests {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;

using WedgesCommand = ProgramTest;

const std::string kShipped = std::string(PENUMBRA_SCENES) + "/broken.json";

/// Returns a number with the sign of a plane at a point; in these tests it is well away from zero.
double height(const json& plane, const json& point) {
  double sum = plane[3].get<double>();
  for (std::size_t i = 0; i < 3; ++i) sum += plane[i].get<double>() * point[i].get<double>();
  return sum;
}

TEST_F(WedgesCommand, WritesPlanesThatHoldTheirEdges) {
  const Outcome outcome = run({"wedges", tiny_scene(), "--light", "key", "--json", path("w.json")});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("original, from centre"), HasSubstr("wedges")));
  const json wedges = json::parse(read("w.json"));
  EXPECT_EQ(wedges.at("construction"), "original");
  EXPECT_EQ(wedges.at("light").at("name"), "key");
  EXPECT_EQ(wedges.at("origin").size(), 3u);
  EXPECT_TRUE(wedges.at("violations").empty());
  ASSERT_FALSE(wedges.at("wedges").empty());
  for (const json& wedge : wedges.at("wedges")) {
    EXPECT_EQ(wedge.at("outcome"), "wedge");
    EXPECT_EQ(wedge.at("planes").size(), 4u);
    for (const json& plane : wedge.at("planes")) {
      for (const json& end : wedge.at("edge")) EXPECT_GT(height(plane, end), -1e-12);
    }
  }
}

TEST_F(WedgesCommand, ValidatesItself) {
  for (const char* construction : {"original", "tight"}) {
    for (const char* from : {"centre", "anywhere"}) {
      const Outcome outcome =
          run({"wedges", tiny_scene(), "--validate", "--construction", construction, "--from", from});
      EXPECT_EQ(outcome.code, 0) << outcome.out << outcome.err;
      EXPECT_THAT(outcome.out, AllOf(HasSubstr("conservative"), HasSubstr("median")));
    }
  }
}

/// Areas are those of the light itself, whatever the weights of its texture.
TEST_F(WedgesCommand, ValidatesUnderATexturedLight) {
  const std::string scene = PENUMBRA_SCENES "/textured-light.json";
  const Outcome outcome = run({"wedges", scene, "--light", "window", "--validate"});
  EXPECT_EQ(outcome.code, 0) << outcome.out << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("have a single layer"));
}

TEST_F(WedgesCommand, CatchesWhatIsWrongOnPurpose) {
  for (int number = 1; number <= 6; ++number) {
    const std::string name = "broken:" + std::to_string(number);
    const Outcome outcome = run({"wedges", kShipped, "--validate", "--construction", name, "--json", path("w.json")});
    EXPECT_EQ(outcome.code, 1) << name << outcome.err;
    EXPECT_THAT(outcome.out, AllOf(HasSubstr("\nwedge "), HasSubstr("; point "), HasSubstr("by "))) << name;
    const json violations = json::parse(read("w.json")).at("violations");
    ASSERT_FALSE(violations.empty()) << name;
    EXPECT_TRUE(violations[0].at("wedge").is_number()) << name;
    EXPECT_EQ(violations[0].at("point").size(), 3u) << name;
    if (number == 6) continue;  // a piece is missing: no plane is wrong
    const json& first = violations[0];
    EXPECT_LT(height(first.at("plane"), first.at("point")), 0) << name << first;
    EXPECT_GT(first.at("distance").get<double>(), 0) << name;
  }
}

/// Returns the JSON chunk of a GLB.
json gltf_of(const std::string& bytes) {
  EXPECT_EQ(bytes.substr(0, 4), "glTF");
  std::uint32_t length = 0;
  std::memcpy(&length, bytes.data() + 12, 4);
  return json::parse(bytes.substr(20, length));
}

TEST_F(WedgesCommand, ExportsNamedParts) {
  ASSERT_EQ(run({"wedges", kShipped, "--validate", "--construction", "broken:2", "--export", path("w.glb")}).code, 1);
  const json gltf = gltf_of(read("w.glb"));
  std::map<std::string, int> kinds;
  for (const json& node : gltf.at("nodes")) {
    const std::string name = node.at("name");
    ++kinds[name.substr(0, name.find_first_of(" 0"))];
  }
  for (const char* kind : {"wrong", "edge", "light", "violation"}) EXPECT_GT(kinds[kind], 0) << kind;
  for (const json& material : gltf.at("materials")) {
    EXPECT_EQ(material.at("pbrMetallicRoughness").at("baseColorFactor").size(), 4u);
  }
  for (const char* name : {"w.obj", "w.ply"}) {
    ASSERT_EQ(run({"wedges", tiny_scene(), "--export", path(name)}).code, 0);
    EXPECT_GT(read(name).size(), 500u) << name;
  }
  EXPECT_THAT(read("w.obj"), AllOf(HasSubstr("o wedge "), HasSubstr("o edge 0\n"), HasSubstr("\nl ")));
  EXPECT_THAT(read("w.ply"), AllOf(HasSubstr("element edge"), HasSubstr("red")));
}

/// An export is a scene that the program itself can read: a GLB of meshes.
TEST_F(WedgesCommand, AnExportIsAGlb) {
  ASSERT_EQ(run({"wedges", tiny_scene(), "--export", path("w.glb")}).code, 0);
  write("shown.json", R"({"format": "penumbra-scene/1",
    "camera": {"eye": [2, 3, 6], "target": [0, 0.5, 0]}, "meshes": [{"name": "wedges", "file": "w.glb"}],
    "lights": [{"name": "key", "rectangle": {"center": [0, 4, 0], "halfU": [0.5, 0, 0], "halfV": [0, 0, 0.5]}}]})");
  // The scene's wedges are translucent, which a JSON scene cannot keep.
  const Outcome outcome = run({"convert", path("shown.json"), "--lenient", "-o", path("shown.obj")});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
}

TEST_F(WedgesCommand, RefusesWhatItCannotDo) {
  const std::string scene = tiny_scene();
  const auto refused = [&](std::vector<std::string> arguments, const char* message) {
    arguments.insert(arguments.begin(), {"wedges", scene});
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.code, 2) << message;
    EXPECT_THAT(outcome.err, HasSubstr(message));
  };
  refused({"--construction", "loose"}, "broken:1");
  refused({"--construction", "broken:7"}, "broken:1");
  refused({"--from", "center"}, "centre or anywhere");
  refused({"--light", "moon"}, "key");
  refused({"--export", path("w.stl")}, ".glb");
  refused({"--explain", "48,0"}, "48x32");
  refused({"--svg", path("w.svg")}, "--explain");
  EXPECT_EQ(files(), std::vector<std::string>{"scene.json"});
  EXPECT_EQ(run({"wedges", path("nothing.json")}).code, 3);
}

}  // namespace
}  // namespace penumbra::tests
