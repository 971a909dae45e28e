// SPDX-License-Identifier: Apache-2.0
// Tests wedges --explain, and the coverage that --validate checks: what is printed, written as JSON, drawn, and
// refused.
#include "tests/cli/program.hpp"
#include "tests/unit/textured_lights_support.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <cmath>

namespace penumbra::tests {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

using ExplainCommand = ProgramTest;

/// A floor seen from above, from 4 units up with a field of view of 90°: pixel (x, y) of 8 × 8 shows the floor at
/// (x − 3.5, y − 3.5). A board of half-size 0.25 is at height 1, under the light.
std::string scene_with(const std::string& light, const std::string& meshes = "") {
  return R"({"format": "penumbra-scene/1", "size": [8, 8],
    "camera": {"eye": [0, 4, 0], "target": [0, 0, 0], "up": [0, 0, -1], "verticalFov": 90},
    "meshes": [)" +
         meshes + R"(
      {"name": "floor", "quad": {"center": [0, 0, 0], "halfU": [3.25, 0, 0], "halfV": [0, 0, -3.25]}},
      {"name": "board", "triangles": [[0.25, 1, -0.25, 0.75, 1, -0.25, 0.75, 1, 0.25],
                                      [0.25, 1, -0.25, 0.75, 1, 0.25, 0.25, 1, 0.25]]}],
    "lights": [)" +
         light + "]}";
}

const std::string kSquare =
    R"({"name": "key", "rectangle": {"center": [0, 2, 0], "halfU": [1, 0, 0], "halfV": [0, 0, 1]}})";

TEST_F(ExplainCommand, NamesEveryWedgeAndAddsUpToTheExactArea) {
  const std::string scene = write("scene.json", scene_with(kSquare)).string();
  // The pixel's floor point is (0.5, 0, 0.5). The board appears at s in (0, 1), t in (−1, 0), a quarter of the light:
  // two of its edges are on the light's rim and two pass through its centre.
  const Outcome outcome = run({"wedges", scene, "--explain", "4,4", "--json", path("w.json"), "--svg", path("w.svg")});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("pixel 4,4: floor"), HasSubstr("V = 0.75"), HasSubstr("exact area"),
                                 Not(HasSubstr("none of its wedges"))));
  const json wedges = json::parse(read("w.json"));
  const json& explained = wedges.at("explain");
  double sum = 0;
  for (const json& wedge : explained.at("wedges")) {
    EXPECT_EQ(std::abs(wedge.at("multiplicity").get<int>()), 1);
    EXPECT_LT(wedge.at("wedge").get<std::size_t>(), wedges.at("wedges").size());
    sum += wedge.at("area").get<double>();
  }
  const json& center = explained.at("centre");
  EXPECT_NEAR(sum, center.at("sum").get<double>(), 1e-12);
  EXPECT_NEAR(center.at("constant").get<int>() + sum, 0.25, 1e-12);
  EXPECT_NEAR(center.at("V").get<double>(), 0.75, 1e-12);
  EXPECT_NEAR(explained.at("receiver").at("V").get<double>(), 0.75, 1e-12);
  EXPECT_NEAR(explained.at("exactV").get<double>(), 0.75, 1e-12);
  EXPECT_EQ(explained.at("edgesOutsideTheirWedges"), 0);
  EXPECT_THAT(read("w.svg"), AllOf(testing::StartsWith("<svg"), testing::EndsWith("</svg>\n"),
                                   HasSubstr("exact V = 0.750000"), Not(HasSubstr("nan")), Not(HasSubstr("inf"))));
}

/// Coordinates are those of the picture that `render` makes with the same options.
TEST_F(ExplainCommand, LooksAtThePictureThatIsRendered) {
  json scene = json::parse(scene_with(kSquare));
  scene["size"] = {4, 4};
  const std::string file = write("scene.json", scene.dump()).string();
  const auto explain = [&](std::vector<std::string> more) {
    std::vector<std::string> arguments = {"wedges", file, "--svg", path("w.svg"), "--json", path("w.json")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  };
  const Outcome outcome = explain({"--size", "8x8", "--explain", "4,4"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NEAR(json::parse(read("w.json")).at("explain").at("exactV").get<double>(), 0.75, 1e-12);
  EXPECT_THAT(explain({"--explain", "4,4"}).err, HasSubstr("outside the image of 4x4"));
  const Outcome nobody = explain({"--camera", "nobody", "--explain", "1,1"});
  EXPECT_EQ(nobody.code, 2);
  EXPECT_THAT(nobody.err, HasSubstr("--camera nobody: scene.json has no such name"));
}

TEST_F(ExplainCommand, ExplainsDisksAndPolygons) {
  for (const char* light : {R"({"name": "key", "disk": {"center": [0, 2, 0], "normal": [0, -1, 0], "radius": 1}})",
                            R"({"name": "key", "polygon": [[-1, 2, -1], [1, 2, -1], [1.5, 2, 0], [0, 2, 1.5]]})"}) {
    const std::string scene = write("scene.json", scene_with(light)).string();
    const Outcome outcome =
        run({"wedges", scene, "--explain", "4,4", "--json", path("w.json"), "--svg", path("w.svg"), "--validate"});
    ASSERT_EQ(outcome.code, 0) << outcome.out << outcome.err;
    const json wedges = json::parse(read("w.json"));
    const json& explained = wedges.at("explain");
    EXPECT_GT(explained.at("exactV").get<double>(), 0.5);
    EXPECT_LT(explained.at("exactV").get<double>(), 1);
    EXPECT_NEAR(explained.at("centre").at("V").get<double>(), explained.at("exactV").get<double>(), 1e-7);
    EXPECT_GT(wedges.at("checks").at("coverage").get<int>(), 0);
    EXPECT_GT(wedges.at("coverage").at("singleLayer").get<int>(), 0);
    EXPECT_THAT(read("w.svg"), Not(HasSubstr("nan")));
  }
}

TEST_F(ExplainCommand, SaysWhyThereIsNothingToAdd) {
  const std::string scene =
      write("scene.json", scene_with(kSquare, R"({"name": "mat", "quad": {"center": [2.5, 0.0625, 2.5],
        "halfU": [0.75, 0, 0], "halfV": [0, 0, -0.75]}, "receivesShadow": false},)"))
          .string();
  const auto said = [&](const char* pixel, const char* what) {
    const Outcome outcome = run({"wedges", scene, "--explain", pixel, "--svg", path("w.svg")});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(outcome.out, HasSubstr(what)) << pixel;
  };
  said("0,0", "background, no surface; V = 1");
  said("6,6", "mat receives no shadow; V = 1");
  EXPECT_EQ(files(), std::vector<std::string>{"scene.json"});  // there is nothing to draw
  const std::string below = write("below.json", scene_with(R"({"name": "key", "rectangle":
      {"center": [0, -2, 0], "halfU": [1, 0, 0], "halfV": [0, 0, 1]}})"))
                                .string();
  EXPECT_THAT(run({"wedges", below, "--explain", "1,4"}).out, HasSubstr("behind the light; V = 0"));
}

/// The board's edge at z = 0.25 appears through the middle of the light, and its other edges beside the light: V is
/// half.
TEST_F(ExplainCommand, ASphereIsTheDiskThatFacesThePixel) {
  for (const char* light :
       {R"({"name": "bulb", "sphere": {"center": [0.5, 2, 0], "radius": 0.25}})",
        R"({"name": "bulb", "disk": {"center": [0.5, 2, 0], "normal": [0, -4, 1], "radius": 0.25}})"}) {
    const std::string scene = write("scene.json", scene_with(light)).string();
    const Outcome outcome =
        run({"wedges", scene, "--explain", "4,4", "--json", path("w.json"), "--svg", path("w.svg"), "--validate"});
    ASSERT_EQ(outcome.code, 0) << outcome.out << outcome.err;
    EXPECT_THAT(read("w.svg"), Not(HasSubstr("nan")));
    const json wedges = json::parse(read("w.json"));
    EXPECT_GT(wedges.at("checks").at("coverage").get<int>(), 0);
    EXPECT_GT(wedges.at("coverage").at("singleLayer").get<int>(), 0);
    EXPECT_NEAR(wedges.at("explain").at("centre").at("V").get<double>(), 0.5, 1e-12) << light;
    EXPECT_NEAR(wedges.at("explain").at("receiver").at("V").get<double>(), 0.5, 1e-12) << light;
    EXPECT_NEAR(wedges.at("explain").at("exactV").get<double>(), 0.5, 1e-7) << light;
  }
}

TEST_F(ExplainCommand, WeighsATexture) {
  // One row of two texels: black where s < 0, white where s > 0. Seen from below the board's middle, the light's half
  // with s > 0 has twice its weight: the board hides the quarter s in (0, 1), t in (−1, 0), half of what shines.
  write("half.png", tests::png_file(2, 1, 8, 0, {std::string("\x00\xff", 2)}));
  const std::string scene = write("scene.json", scene_with(R"({"name": "key", "texture": "half.png",
        "rectangle": {"center": [0, 2, 0], "halfU": [1, 0, 0], "halfV": [0, 0, 1]}})"))
                                .string();
  const Outcome outcome =
      run({"wedges", scene, "--explain", "4,4", "--json", path("w.json"), "--svg", path("w.svg"), "--validate"});
  ASSERT_EQ(outcome.code, 0) << outcome.out << outcome.err;
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("weighted by the light's texture of 2x1 texels"),
                                 HasSubstr("coverage is weighted by the light's texture")));
  const json wedges = json::parse(read("w.json"));
  EXPECT_EQ(wedges.at("explain").at("texture"), json({2, 1}));
  EXPECT_TRUE(wedges.at("coverage").at("textured").get<bool>());
  EXPECT_NEAR(wedges.at("explain").at("centre").at("V").get<double>(), 0.5, 1e-12);
  EXPECT_NEAR(wedges.at("explain").at("receiver").at("V").get<double>(), 0.5, 1e-12);
  EXPECT_NEAR(wedges.at("explain").at("exactV").get<double>(), 0.5, 1e-12);
  double sum = wedges.at("explain").at("centre").at("constant").get<int>();
  for (const json& wedge : wedges.at("explain").at("wedges")) sum += wedge.at("area").get<double>();
  EXPECT_NEAR(sum, 0.5, 1e-12);
  EXPECT_THAT(read("w.svg"), AllOf(HasSubstr("class=\"texels\""), HasSubstr("fill-opacity=\"0.300\""),
                                   HasSubstr("fill-opacity=\"0.000\"")));
}

TEST_F(ExplainCommand, RefusesABadName) {
  const std::string scene = write("scene.json", scene_with(kSquare)).string();
  EXPECT_EQ(run({"wedges", scene, "--explain", "4,4", "--svg", path("w.png")}).code, 2);
}

TEST_F(ExplainCommand, DrawsWhereItIsAskedToAlone) {
  const std::string scene = write("scene.json", scene_with(kSquare)).string();
  const Outcome outcome = run({"wedges", scene, "--explain", "4,4", "--export", path("w.ply")});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(files(), testing::ElementsAre("scene.json", "w.ply"));
  EXPECT_THAT(outcome.out, Not(HasSubstr("picture")));
}

/// A ball on the floor, seen from all sides. Edges of the face that a pixel shows are silhouettes only without that
/// face, and have no wedges. A construction that is too narrow is still named.
TEST_F(ExplainCommand, NamesEdgesOutsideTheirWedgesOfWrongConstructionsAlone) {
  const std::string box = R"({"name": "ball", "shape": {"type": "sphere", "center": [-0.5, 0.5, 0], "radius": 0.5,
    "segments": 12}},)";
  const std::string scene = write("scene.json", scene_with(kSquare, box)).string();
  const auto alarms = [&](const std::string& construction, const std::string& pixel) {
    const Outcome outcome = run({"wedges", scene, "--size", "24x24", "--construction", construction, "--explain", pixel,
                                 "--json", path("w.json")});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    const int count = json::parse(read("w.json")).at("explain").value("edgesOutsideTheirWedges", 0);
    EXPECT_EQ(count > 0, outcome.out.find("none of its wedges") != std::string::npos);
    return count;
  };
  int of_wrong = 0;
  for (const int y : {9, 11, 12, 14}) {
    for (const int x : {6, 8, 9, 10, 11, 13}) {
      const std::string pixel = std::to_string(x) + "," + std::to_string(y);
      EXPECT_EQ(alarms("original", pixel), 0) << pixel;
    }
  }
  // Pixels of shipped scenes where edges of the receiver's own triangle appear.
  for (const auto& [shipped, pixel] : {std::pair{"/self-shadow.json", "45,40"}, {"/thin.json", "32,72"}}) {
    const Outcome outcome =
        run({"wedges", std::string(PENUMBRA_SCENES) + shipped, "--size", "128x128", "--explain", pixel});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(outcome.out, Not(HasSubstr("none of its wedges"))) << shipped;
  }
  for (const char* const wrong : {"broken:1", "broken:2", "broken:3", "broken:4", "broken:5", "broken:6"})
    of_wrong += alarms(wrong, "13,13") + alarms(wrong, "8,14");
  EXPECT_GT(of_wrong, 0);
}

}  // namespace
}  // namespace penumbra::tests
