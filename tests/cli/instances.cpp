// A mesh with instances is the scene in which the mesh is written once for each of them, to the last bit.
#include "tests/cli/program.hpp"

#include "base/exr.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <array>
#include <string>
#include <vector>

namespace penumbra::tests {
namespace {

using nlohmann::json;
using testing::HasSubstr;

class Instances : public ProgramTest {
 protected:
  json scene(std::vector<json> meshes) const {
    json scene = json::parse(scene_text_with("/size", "[24, 16]"));
    scene["meshes"].erase(1);
    for (json& mesh : meshes) scene["meshes"].push_back(std::move(mesh));
    return scene;
  }
  json tree() const {
    return json::parse(R"({"name": "tree", "shape": {"type": "sphere", "radius": 0.4, "segments": 8}})");
  }
};

TEST_F(Instances, AreTheMeshOnceForEach) {
  const std::array transforms = {
      json::parse(R"({"translate": [-1, 0.5, 0], "rotate": [0, 30, 0]})"),
      json::parse("[0.5,0,0,1, 0,2,0,0.8, 0,0,0.5,0.25, 0,0,0,1]"),
      json::parse(R"({"scale": [-1, 1, 0.5], "translate": [0, 0.5, 1]})"),  // mirrored
  };
  json forest = tree();
  forest["instances"] = {{{"transform", transforms[0]}}, transforms[1], transforms[2]};
  std::vector<json> copies;
  for (const json& transform : transforms) {
    copies.push_back(tree());
    copies.back()["transform"] = transform;
  }
  write("instances.json", scene({forest}).dump());
  write("copies.json", scene(copies).dump());
  for (const char* name : {"instances", "copies"}) {
    const std::string file = path(std::string(name) + ".json");
    const Outcome outcome = run({"render", file, "-o", path(std::string(name) + ".exr"), "--quiet"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    ASSERT_EQ(run({"convert", file, "-o", path(std::string(name) + ".obj"), "--quiet"}).code, 0);
  }
  const ExrFile one = read_exr(path("instances.exr")), other = read_exr(path("copies.exr"));
  for (const char* channel : {"V", "R", "G", "B", "P.X", "P.Y", "P.Z", "N.X", "N.Y", "N.Z"})
    EXPECT_EQ(one.floats.at(channel), other.floats.at(channel)) << channel;
  EXPECT_EQ(one.integers.at("id"), other.integers.at("id"));
  const auto lines = [&](const std::string& file, const char* start) {
    std::vector<std::string> found;
    const std::string text = read(file);
    for (std::size_t at = 0; at < text.size();) {
      const std::size_t end = text.find('\n', at);
      if (text.compare(at, 2, start) == 0) found.push_back(text.substr(at, end - at));
      at = end + 1;
    }
    return found;
  };
  EXPECT_EQ(lines("instances.obj", "v "), lines("copies.obj", "v "));
  EXPECT_EQ(lines("instances.obj", "f "), lines("copies.obj", "f "));
  EXPECT_EQ(lines("instances.obj", "o ").size() + 2, lines("copies.obj", "o ").size()) << "instances are one object";
}

TEST_F(Instances, StandOnAFit) {
  json forest = tree();
  forest["fit"] = {{"height", 2}, {"base", {0, 0, 0}}};
  forest["instances"] = {{{"translate", {2, 0, 0}}}, {{"translate", {-2, 0, 0}}}};
  write("scene.json", scene({forest}).dump());
  const json report = json::parse(run({"inspect", path("scene.json"), "--json", "-"}).out).at("objects").at(1);
  EXPECT_EQ(report.at("bounds").at(0).at(1), 0);
  EXPECT_EQ(report.at("bounds").at(1).at(1), 2);
  EXPECT_NEAR(report.at("bounds").at(1).at(0).get<double>(), -report.at("bounds").at(0).at(0).get<double>(), 1e-12);
  EXPECT_EQ(report.at("components"), 2);
}

TEST_F(Instances, WhatCannotBeMeantIsRefused) {
  const auto refused = [&](const json& instances, const json& transform) {
    json forest = tree();
    forest["instances"] = instances;
    if (!transform.is_null()) forest["transform"] = transform;
    write("scene.json", scene({forest}).dump());
    const Outcome outcome = run({"convert", path("scene.json"), "-o", path("out.obj")});
    EXPECT_EQ(outcome.code, 3) << outcome.err;
    return outcome.err;
  };
  const json still = {{"translate", {0, 0, 0}}};
  EXPECT_THAT(refused(json::array({still}), still), HasSubstr("exclude one another"));
  EXPECT_THAT(refused(json::array(), nullptr), HasSubstr("/meshes/1/instances"));
  EXPECT_THAT(refused(json::array({still, {{"scale", 0}}}), nullptr), HasSubstr("/meshes/1/instances/1"));
  EXPECT_THAT(refused(json::array({{{"transform", still}, {"scale", 2}}}), nullptr), HasSubstr("stands alone"));
  EXPECT_THAT(refused(json::array({{{"turn", 2}}}), nullptr), HasSubstr("turn"));
}

}  // namespace
}  // namespace penumbra::tests
