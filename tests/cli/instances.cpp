// SPDX-License-Identifier: Apache-2.0
// Tests that a mesh with instances gives the same as the scene in which it is written once per instance, to the last
// bit.
#include "tests/cli/program.hpp"
#include "tests/unit/import/gltf_file.hpp"

#include "base/exr.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
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

  /// Writes scene.json: thirty trees and a pole.
  void write_grove(const std::string& lights) {
    std::vector<json> places;
    for (int i = 0; i < 30; ++i) {
      places.push_back(
          {{"translate", {0.45 * (i % 6) - 1.1, 0.3, 0.5 * (i / 6) - 1.2}},  // NOLINT(bugprone-integer-division)
           {"rotate", {10 * i, 37 * i, 0}},
           {"scale", {i % 4 == 0 ? -0.5 : 0.4, 0.6, 0.5}}});
    }
    json trees = tree();
    trees["instances"] = places;
    const json pole = json::parse(
        R"({"shape": {"type": "box", "center": [0, 0, 0], "halfSize": [0.1, 0.5, 0.1]}, "transform": {"translate": [0, 0.5, 0]}})");
    json whole = scene({trees, pole});
    whole["lights"] = json::parse(lights);
    write("scene.json", whole.dump());
  }

  /// Renders the scene with copies and without, and expects the same picture. Masks are compared, too, if a method is
  /// named.
  void expect_same_picture(const std::vector<std::string>& direction, bool masks = true) {
    SCOPED_TRACE(testing::PrintToString(direction));
    const bool has_bits = masks && direction.size() >= 2 && direction[0] == "--method";
    for (const std::string use : {"copies", "shared"}) {
      std::vector<std::string> words = {"render",      path(file_), "-o",      path(use + ".exr"),       "--quiet",
                                        "--instances", use,         "--stats", path(use + ".stats.json")};
      words.insert(words.end(), direction.begin(), direction.end());
      if (std::ranges::find(direction, "--size") == direction.end()) words.insert(words.end(), {"--size", "48x36"});
      const Outcome outcome = run(words);
      ASSERT_EQ(outcome.code, 0) << outcome.err;
      if (!has_bits) continue;
      words.insert(words.end(), {"--bits", path(use + ".bits")});
      words[3] = path("bits.exr");
      words[8] = path("bits.stats.json");
      ASSERT_EQ(run(words).code, 0);
    }
    const ExrFile one = read_exr(path("shared.exr")), other = read_exr(path("copies.exr"));
    EXPECT_EQ(one.integers.at("id"), other.integers.at("id"));
    ASSERT_EQ(one.floats.size(), other.floats.size());
    for (const auto& [name, values] : other.floats) {
      if (name.ends_with(".R") || name.ends_with(".G") || name.ends_with(".B") || name.size() == 1) {
        ASSERT_EQ(one.floats.at(name).size(), values.size());
        for (std::size_t i = 0; i < values.size(); ++i)
          ASSERT_NEAR(one.floats.at(name)[i], values[i], 1e-6 * (1 + std::abs(values[i]))) << name << " " << i;
      }
      if (name.size() > 1 || name == "V") {
        EXPECT_EQ(one.floats.at(name), values) << name;
      }
    }
    if (has_bits) {
      EXPECT_EQ(read("shared.bits"), read("copies.bits"));
    }
  }

  /// Triangles of the last picture of expect_same_picture(), and of its largest part if nothing was copied.
  [[nodiscard]] std::uint64_t triangles() const {
    return json::parse(read("shared.stats.json")).at("triangles").get<std::uint64_t>();
  }
  [[nodiscard]] std::uint64_t triangles_of_part() const {
    return json::parse(read("shared.stats.json")).at("counters").at("trianglesOfLargestPart").get<std::uint64_t>();
  }
  /// Returns the bytes of the floats of the scene, or of the part that the last picture used.
  [[nodiscard]] std::uint64_t bytes_of_scene(const std::string& use) const {
    return json::parse(read(use + ".stats.json")).at("memory").at("scene").get<std::uint64_t>();
  }

  std::string file_ = "scene.json";
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

/// Pictures of instances with copies and without are the same to the last bit.
TEST_F(Instances, GiveTheSamePictureWithoutCopies) {
  write_grove(R"([
    {"name": "area", "rectangle": {"center": [0.5, 3, 1], "halfU": [0.4, 0, 0], "halfV": [0, 0, 0.3]}},
    {"name": "bulb", "sphere": {"center": [-2, 2, 1], "radius": 0.2}},
    {"name": "day", "sun": {"direction": [0.4, -1, 0.3], "angle": 5}}])");
  expect_same_picture({});
  expect_same_picture({"--method", "edge-scatter", "--light-samples", "64"});
  expect_same_picture({"--method", "view-sample"});
  expect_same_picture({"--pixel-samples", "4"});
  expect_same_picture({"--light", "bulb", "--camera", "0.2,0.4,0.3:1,0.2,-1"});
}

/// Pictures through a lens are the same, too; points of the lens see past what hides from its middle.
TEST_F(Instances, GiveTheSamePictureThroughALens) {
  write_grove(R"([
    {"name": "area", "rectangle": {"center": [0.5, 3, 1], "halfU": [0.4, 0, 0], "halfV": [0, 0, 0.3]}},
    {"name": "sky", "dome": {"half": true, "sampled": true}}])");
  const std::vector<std::string> lens = {"--pixel-samples", "4", "--aperture", "0.15", "--focus-distance", "1.5"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.end(), lens.begin(), lens.end());
    return more;
  };
  expect_same_picture(with({"--camera", "0.2,0.4,0.3:1,0.2,-1"}));
  EXPECT_LT(bytes_of_scene("shared"), bytes_of_scene("copies"));
  expect_same_picture(with({"--light", "area", "--pixel-tolerance", "0"}));
  expect_same_picture(with({"--light", "area", "--method", "view-sample"}), false);
}

/// Pictures of several moments are the same, too; each moment has separate instances.
TEST_F(Instances, GiveTheSamePictureInMotion) {
  test::Gltf gltf;
  gltf.at("/nodes/1")["rotation"] = {1, 0, 0, 0};  // faces down
  gltf.at("/nodes/0") = {{"name", "Body"}, {"mesh", 0}, {"translation", {0, 1, 0}}};
  gltf.at("/nodes/2") = {
      {"name", "Camera"}, {"camera", 0}, {"translation", {0, 4, 0}}, {"rotation", {-0.70710678, 0, 0, 0.70710678}}};
  for (int i = 0; i < 80; ++i) {
    const double aside = i < 60 ? 0 : 50;  // out of sight
    gltf.at("/nodes").push_back(
        {{"mesh", 0},
         {"translation",
          {0.4 * (i % 6) - 1 + aside, 0.1 * (i % 5), 0.4 * (i / 6) - 1}},  // NOLINT(bugprone-integer-division)
         {"rotation", {-0.70710678, 0, 0, 0.70710678}},
         {"scale", {0.3, 0.4, 0.3}}});
    gltf.at("/scenes/0/nodes").push_back(i + 3);
  }
  gltf.animate(0, "translation", {0, 1}, {0, 1, 0, 1, 1, 0});
  gltf.animate(1, "translation", {0, 1}, {0, 3, 0, 0.5F, 3, 0});
  gltf.animate(2, "translation", {0, 1}, {0, 4, 0, 0.2F, 3, 0});
  gltf.animate(20, "rotation", {0, 1}, {0, 0, 0, 1, 0, 0.38268343F, 0, 0.92387953F});
  write("scene.glb", gltf.glb());
  file_ = "scene.glb";
  const std::vector<std::string> motion = {"--frame", "12", "--motion-samples", "3", "--shutter", "8"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.end(), motion.begin(), motion.end());
    return more;
  };
  expect_same_picture(with({}));
  EXPECT_LT(bytes_of_scene("shared"), bytes_of_scene("copies"));
  expect_same_picture(with({"--pixel-samples", "4", "--aperture", "0.1", "--focus-distance", "3"}));
  EXPECT_LT(bytes_of_scene("shared"), bytes_of_scene("copies"));
  expect_same_picture(with({"--method", "view-sample", "--light-samples", "16"}), false);
  const Outcome refused = run({"render", path("scene.glb"), "-o", path("out.exr"), "--instances", "shared", "--method",
                               "shadow-map", "--frame", "12", "--motion-samples", "3"});
  EXPECT_EQ(refused.code, 2);
  EXPECT_THAT(refused.err, HasSubstr("shadow-map supports one view sample per pixel with shared meshes"));
}

/// Pictures with a dome's light samples are the same, too; every direction needs a blocker. Areas need all triangles.
TEST_F(Instances, GiveTheSamePictureUnderADome) {
  write_grove(R"([
    {"name": "sky", "dome": {"half": true}, "radiance": [0.5, 0.7, 1]},
    {"name": "day", "sun": {"direction": [0.4, -1, 0.3], "angle": 5}}])");
  for (const char* method : {"edge-scatter", "view-sample", "depth-complexity"}) {
    expect_same_picture({"--method", method, "--light-samples", "64"});
    EXPECT_LT(triangles_of_part(), triangles()) << method;
  }
  expect_same_picture({"--light-samples", "36"});  // by rays
  expect_same_picture({"--light-samples", "16", "--pixel-samples", "4"});
  expect_same_picture({"--light", "sky", "--size", "12x9"});
  EXPECT_EQ(triangles_of_part(), triangles());
}

/// A dome that is `sampled` needs no option for light samples, and the sun next to it keeps its exact area.
TEST_F(Instances, GiveTheSamePictureUnderASampledDome) {
  write_grove(R"([
    {"name": "sky", "dome": {"half": true, "sampled": true}, "radiance": [0.5, 0.7, 1]},
    {"name": "day", "sun": {"direction": [0.4, -1, 0.3], "angle": 5}}])");
  expect_same_picture({});
  EXPECT_LT(triangles_of_part(), triangles());
  expect_same_picture({"--method", "view-sample"});
  EXPECT_LT(triangles_of_part(), triangles());
  expect_same_picture({"--method", "edge-scatter:rows=exact", "--size", "12x9"}, false);
  EXPECT_EQ(triangles_of_part(), triangles());
  write_grove(R"([{"name": "sky", "dome": {"half": true, "sampled": true}}, {"name": "other", "dome": {}}])");
  expect_same_picture({"--size", "12x9"});
  EXPECT_EQ(triangles_of_part(), triangles()) << "the other dome's areas are exact";
}

/// A scene with more triangles than are copied unless necessary: under a sampled dome no copies are needed, and a dome
/// that is added is sampled, as one line of output says.
TEST_F(Instances, OfAForestStayUnderASampledDome) {
  json trees = tree();
  trees["shape"]["segments"] = 32;
  for (int i = 0; i < 600; ++i)
    trees["instances"].push_back(
        {{"translate", {0.5 * (i % 20) - 5, 0.3, 0.5 * (i / 20) - 8}}});  // NOLINT(bugprone-integer-division)
  json forest = scene({trees});
  const json suns = json::parse(R"([{"name": "day", "sun": {"direction": [0.4, -1, 0.3], "angle": 2}}])");
  const auto render = [&](const json& lights, std::vector<std::string> more) {
    forest["lights"] = lights;
    write("scene.json", forest.dump());
    more.insert(more.begin(), {"render", path("scene.json"), "-o", path("out.exr"), "--stats", path("stats.json")});
    const Outcome outcome = run(more);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return std::pair(json::parse(read("stats.json")), outcome.err);
  };
  const auto expect_counted_without_copies = [](const json& stats, std::size_t dome) {
    EXPECT_GT(stats.at("triangles"), 500'000);
    EXPECT_EQ(stats.at("lights").at(dome).at("quantity"), "count");
    EXPECT_EQ(stats.at("lights").at(1 - dome).at("quantity"), "area");
    ASSERT_TRUE(stats.at("counters").contains("trianglesOfLargestPart")) << "all became copies";
    EXPECT_LT(stats.at("counters").at("trianglesOfLargestPart"), stats.at("triangles").get<double>() / 2);
  };
  json lights = suns;
  lights.push_back(json::parse(R"({"name": "sky", "dome": {"sampled": true}})"));
  const auto [counted, quiet] = render(lights, {});
  expect_counted_without_copies(counted, 1);
  EXPECT_THAT(quiet, testing::Not(HasSubstr("`sampled`")));
  const auto [added, said] = render(suns, {"--add-light", "dome"});
  expect_counted_without_copies(added, 1);
  EXPECT_THAT(said, HasSubstr("the added dome is `sampled`"));
  trees["instances"].erase(trees["instances"].begin() + 2, trees["instances"].end());
  forest = scene({trees});
  const auto [few, nothing] = render(suns, {"--add-light", "dome"});
  EXPECT_EQ(few.at("lights").at(1).at("quantity"), "area");
  EXPECT_THAT(nothing, testing::Not(HasSubstr("`sampled`")));
}

/// Maps from the light's centre receive all triangles, one instance after another: their windows, depths and pictures
/// are those of the scene with copies.
TEST_F(Instances, GiveTheSamePictureByMaps) {
  write_grove(R"([
    {"name": "area", "rectangle": {"center": [0.5, 3, 1], "halfU": [0.4, 0, 0], "halfV": [0, 0, 0.3]}},
    {"name": "low", "rectangle": {"center": [-3, 0.6, 1], "halfU": [0, 0.3, 0], "halfV": [0, 0, 0.3]}, "twoSided": true},
    {"name": "day", "sun": {"direction": [0.4, -1, 0.3], "angle": 5}}])");
  expect_same_picture({"--method", "shadow-map"}, false);
  expect_same_picture({"--method", "shadow-map", "--method-option", "depth=midpoint", "--method-option", "size=64"},
                      false);
  expect_same_picture({"--method", "pcf", "--method-option", "window=5"}, false);
  expect_same_picture({"--method", "pcss", "--method-option", "size=200"}, false);
}

TEST_F(Instances, AreCopiedForMapsThatLookTwice) {
  write_grove(R"([{"name": "bulb", "sphere": {"center": [-2, 2, 1], "radius": 0.2}}])");
  const auto refused = [&](std::vector<std::string> more) {
    std::vector<std::string> words = {"render", path("scene.json"), "-o", path("out.exr"), "--instances", "shared"};
    words.insert(words.end(), more.begin(), more.end());
    const Outcome outcome = run(words);
    EXPECT_EQ(outcome.code, 2);
    return outcome.err;
  };
  EXPECT_THAT(refused({"--method", "pcss"}),
              HasSubstr("--instances shared: pcss supports only suns and lights in one plane"));
  EXPECT_THAT(refused({"--method", "vssm"}), HasSubstr("--instances shared: vssm needs more than"));
  EXPECT_THAT(refused({"--method", "shadow-map", "--method-option", "fit=view"}),
              HasSubstr("shadow-map needs more than"));
}

/// Nodes that share a mesh, and EXT_mesh_gpu_instancing, give the same as a file with every copy in world space.
TEST_F(Instances, OfGltfAreTheMeshOnceForEach) {
  test::Gltf gltf;
  gltf.at("/nodes/1")["rotation"] = {1, 0, 0, 0};  // faces down
  gltf.at("/meshes/0/primitives/0/attributes")["NORMAL"] =
      gltf.add_floats("VEC3", {0, 0, 1, 0.6F, 0, 0.8F, 0, 0.3F, 1});
  gltf.at("/nodes/0") = {{"name", "Body"}, {"mesh", 0}, {"translation", {-1, 0.25, 0.5}}, {"scale", {1.3, 2, 1}}};
  gltf.at("/nodes").push_back(
      {{"name", "Mirrored"}, {"mesh", 0}, {"scale", {-1.5, 1, 1}}, {"rotation", {0.1, 0.3, 0, 0.9}}});
  gltf.at("/nodes").push_back(
      {{"name", "Many"},
       {"mesh", 0},
       {"translation", {0, 1, -1}},
       {"extensions",
        {{"EXT_mesh_gpu_instancing",
          {{"attributes", {{"TRANSLATION", gltf.add_floats("VEC3", {-2, 0, 0, 0, 0.3F, 0, 1.7F, 0, -0.1F})}}}}}}}});
  gltf.at("/extensionsUsed").push_back("EXT_mesh_gpu_instancing");
  gltf.at("/nodes/2") = {{"name", "Camera"}, {"camera", 0}, {"translation", {0, 1, 8}}};
  gltf.at("/scenes/0/nodes") = {0, 1, 2, 3, 4};
  write("scene.glb", gltf.glb());
  ASSERT_EQ(run({"convert", path("scene.glb"), "-o", path("world.json"), "--quiet"}).code, 0);
  for (const std::vector<std::string>& direction :
       {std::vector<std::string>{"scene.glb", "shared"}, {"scene.glb", "copies"}, {"world.json", "copies"}}) {
    const Outcome outcome = run({"render", path(direction[0]), "-o", path(direction[0] + direction[1] + ".exr"),
                                 "--quiet", "--size", "64x48", "--instances", direction[1]});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
  }
  EXPECT_EQ(read("scene.glbshared.exr"), read("scene.glbcopies.exr"));
  const ExrFile one = read_exr(path("scene.glbshared.exr")), other = read_exr(path("world.jsoncopies.exr"));
  EXPECT_EQ(one.integers.at("id"), other.integers.at("id"));
  for (const char* channel : {"V", "P.X", "P.Y", "P.Z", "N.X", "N.Y", "N.Z", "object.X"})
    EXPECT_EQ(one.floats.at(channel), other.floats.at(channel)) << channel;
}

/// Converted scenes keep their instances, and the numbers of their triangles.
TEST_F(Instances, StayInstancesWhenTheyAreConverted) {
  std::vector<json> places;
  for (int i = 0; i < 9; ++i) {
    places.push_back({{"translate", {0.7 * (i % 3) - 1, 0.3, 0.6 * (i / 3)}},  // NOLINT(bugprone-integer-division)
                      {"rotate", {10 * i, 37 * i, 0}},
                      {"scale", {i % 4 == 0 ? -0.5 : 0.4, 0.6, 0.5}}});
  }
  json trees = tree();
  trees["instances"] = places;
  const json pole = json::parse(
      R"({"shape": {"type": "box", "center": [0, 0, 0], "halfSize": [0.1, 0.5, 0.1]}, "transform": {"translate": [0, 0.5, 0]}})");
  write("scene.json", scene({trees, pole}).dump());
  const auto convert = [&](const std::string& from, const std::string& to, const std::string& how) {
    const Outcome outcome = run({"convert", path(from), "-o", path(to), "--quiet", "--instances", how});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
  };
  const auto shown = [&](const std::string& file) {
    EXPECT_EQ(
        run({"render", path(file), "-o", path("out.exr"), "--quiet", "--size", "48x36", "--instances", "shared"}).code,
        0);
    return read_exr(path("out.exr"));
  };
  const auto expect_same = [](const ExrFile& one, const ExrFile& other) {
    EXPECT_EQ(one.integers.at("id"), other.integers.at("id"));
    for (const char* channel : {"V", "P.X", "P.Y", "P.Z", "Z", "N.X"})
      EXPECT_EQ(one.floats.at(channel), other.floats.at(channel)) << channel;
  };
  convert("scene.json", "again.json", "auto");
  const json again = json::parse(read("again.json"));
  EXPECT_EQ(again.at("meshes").size(), 3U);
  EXPECT_EQ(again.at("meshes").at(1).at("instances").size(), 9U);
  convert("scene.json", "copies.json", "copies");
  EXPECT_FALSE(json::parse(read("copies.json")).at("meshes").at(1).contains("instances"));
  const ExrFile first = shown("scene.json");
  expect_same(shown("again.json"), first);
  expect_same(shown("copies.json"), first);

  // glTF has positions in float32, so the first file may round; what is read from it is written unchanged.
  convert("scene.json", "scene.glb", "auto");
  convert("scene.glb", "again.glb", "shared");
  const auto document = [&](const std::string& file) {
    const std::string bytes = read(file);
    const auto byte = [&](std::size_t i) { return static_cast<std::size_t>(static_cast<unsigned char>(bytes.at(i))); };
    return json::parse(bytes.substr(20, byte(12) + (byte(13) << 8) + (byte(14) << 16)));
  };
  for (const char* file : {"scene.glb", "again.glb"}) {
    std::size_t nodes = 0;
    const json gltf = document(file);
    for (const json& node : gltf.at("nodes")) nodes += node.contains("mesh") && node.at("mesh") == 1 ? 1 : 0;
    EXPECT_EQ(nodes, 9U) << file;
    EXPECT_EQ(gltf.at("meshes").at(1).at("name"), "tree");
  }
  const ExrFile glb = shown("scene.glb");
  EXPECT_EQ(glb.integers.at("id"), first.integers.at("id"));
  const ExrFile again_glb = shown("again.glb");
  EXPECT_EQ(again_glb.integers.at("id"), glb.integers.at("id"));
  // Nodes are separate objects; JSON merges them if asked to.
  convert("again.glb", "merged.json", "shared");
  EXPECT_EQ(json::parse(read("merged.json")).at("meshes").at(1).at("instances").size(), 9U);
  convert("again.glb", "apart.json", "auto");
  EXPECT_GE(json::parse(read("apart.json")).at("meshes").size(), 11U);
  EXPECT_EQ(shown("merged.json").integers.at("id"), glb.integers.at("id"));
  EXPECT_EQ(run({"convert", path("scene.json"), "-o", path("no.obj"), "--instances", "shared"}).code, 2);
  EXPECT_EQ(run({"convert", path("scene.json"), "-o", path("no.json"), "--instances", "some"}).code, 2);
}

using InstancesFull = Instances;

/// Ten million triangles: instances are kept without any option.
TEST_F(InstancesFull, GiveTheSamePictureOfAForest) {
  json trees = tree();
  trees["shape"]["segments"] = 32;
  for (int i = 0; i < 10'200; ++i) {
    trees["instances"].push_back(
        {{"translate",
          {0.35 * (i % 100) - 17, 0.2 + 0.01 * (i % 7), 0.35 * (i / 100) - 30}},  // NOLINT(bugprone-integer-division)
         {"rotate", {3 * i, 37 * i, 0}},
         {"scale", {0.4, 0.5 + 0.01 * (i % 13), 0.5}}});
  }
  write("scene.json", scene({trees}).dump());
  const std::vector<std::vector<std::string>> directions = {{},
                                                            {"--bits", "FILE"},
                                                            {"--method", "view-sample", "--bits", "FILE"},
                                                            {"--add-light", "dome", "--light-samples", "36"},
                                                            {"--method", "pcss"}};
  for (const std::vector<std::string>& direction : directions) {
    for (const std::string use : {"copies", "auto"}) {
      std::vector<std::string> words = {
          "render", path("scene.json"), "-o", path(use + ".exr"), "--quiet", "--instances", use, "--size", "320x240"};
      for (const std::string& word : direction) words.push_back(word == "FILE" ? path(use + ".bits") : word);
      const Outcome outcome = run(words);
      ASSERT_EQ(outcome.code, 0) << outcome.err;
    }
    EXPECT_EQ(read("auto.exr"), read("copies.exr"));
    if (std::ranges::find(direction, "--bits") != direction.end()) {
      EXPECT_EQ(read("auto.bits"), read("copies.bits"));
    }
  }
}

TEST_F(Instances, AreCopiedWhereAMethodLooksAtAllOfThem) {
  json trees = tree();
  trees["instances"] = {{{"translate", {-1, 0.4, 0}}}, {{"translate", {1, 0.4, 0}}}};
  write("scene.json", scene({trees}).dump());
  const Outcome outcome =
      run({"render", path("scene.json"), "-o", path("out.exr"), "--instances", "shared", "--method", "alias-free"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("--instances shared: alias-free"));
  EXPECT_EQ(run({"render", path("scene.json"), "-o", path("out.exr"), "--instances", "some"}).code, 2);
  EXPECT_EQ(run({"render", path("scene.json"), "-o", path("out.exr"), "--method", "alias-free", "--quiet"}).code, 0);
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

/// A studio is put around the scene at rest, whose instances must not appear in addition to the frame's.
TEST_F(Instances, OfAnAnimationInAStudioAreThereOnce) {
  test::Gltf gltf;
  gltf.at("/nodes").push_back({{"name", "Other"}, {"mesh", 0}, {"translation", {2, 0, 0}}});
  gltf.at("/scenes/0/nodes") = {0, 2, 3};
  const std::size_t times = gltf.add_floats("SCALAR", {0, 1}), places = gltf.add_floats("VEC3", {0, 0, 0, 0, 1, 0});
  json move =
      json::parse(R"({"channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}], "samplers": [{}]})");
  move["samplers"][0] = {{"input", times}, {"output", places}};
  gltf.document["animations"] = json::array({move});
  write("scene.glb", gltf.glb());
  for (const char* use : {"copies", "shared"}) {
    const Outcome outcome = run({"render", path("scene.glb"), "-o", path("out.exr"), "--frame", "12", "--size", "24x16",
                                 "--stats", path("stats.json"), "--instances", use});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(json::parse(read("stats.json")).at("triangles"), 2 + 2) << "two bodies and a floor";
  }
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
  EXPECT_THAT(refused(json::array({{{"transform", still}, {"scale", 2}}}), nullptr),
              HasSubstr("expected only the key"));
  EXPECT_THAT(refused(json::array({{{"turn", 2}}}), nullptr), HasSubstr("turn"));
}

}  // namespace
}  // namespace penumbra::tests
