// SPDX-License-Identifier: Apache-2.0
// `render` and `compare` of glTF surfaces with holes (alphaMode MASK) and translucent ones (BLEND).
#include "tests/cli/program.hpp"

#include "base/exr.hpp"
#include "tests/unit/import/gltf_file.hpp"
#include "tests/unit/textured_lights_support.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>

namespace penumbra::tests {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/// A floor of 8 × 8 at y = 0 under a light of 2 × 2 at y = 5, with the card or pane "Card" of 4 × 4 at y = 2 between
/// them. The camera looks down, from under the card unless a test moves it.
class AlphaSurfaces : public ProgramTest {
 protected:
  AlphaSurfaces() {
    gltf.at("/nodes/1")["rotation"] = {1, 0, 0, 0};  // faces down
    gltf.at("/meshes").push_back(
        {{"primitives", {{{"attributes", {{"POSITION", 2}}}, {"indices", 3}, {"material", 0}}}}});
    gltf.at("/meshes").push_back(
        {{"primitives",
          {{{"attributes", {{"POSITION", 2}, {"TEXCOORD_0", gltf.add_floats("VEC2", {0, 1, 1, 1, 0, 0, 1, 0})}}},
            {"indices", 3},
            {"material", 2}}}}});
    gltf.at("/nodes/0") = {{"name", "Floor"}, {"mesh", 2}, {"scale", {4, 1, 4}}};
    gltf.at("/nodes").push_back({{"name", "Card"}, {"mesh", 3}, {"translation", {0, 2, 0}}, {"scale", {2, 1, 2}}});
    gltf.at("/scenes/0/nodes") = {0, 1, 2, 3};
    gltf.at("/materials/0/pbrMetallicRoughness/baseColorFactor") = {0.5, 0.5, 0.5, 1};
    gltf.at("/materials").push_back({{"name", "Leaf"}, {"pbrMetallicRoughness", {{"metallicFactor", 0}}}});
    look_from_under_the_card();
  }
  /// Looks straight down from between floor and card, so that the picture shows the floor beneath the card.
  void look_from_under_the_card() {
    gltf.at("/nodes/2") = {
        {"name", "Camera"}, {"camera", 0}, {"translation", {0, 1.5, 0}}, {"rotation", {-0.70710678, 0, 0, 0.70710678}}};
  }
  void look_from_above() { gltf.at("/nodes/2")["translation"] = {0, 4, 0}; }
  void translucent(double alpha) {
    gltf.at("/materials/2")["alphaMode"] = "BLEND";
    gltf.at("/materials/2/pbrMetallicRoughness")["baseColorFactor"] = {0.25, 0.25, 0.25, alpha};
  }
  /// Makes the card opaque only where x > 0.
  void half_a_card() {
    const auto png = png_file(2, 1, 8, 6, {tests::bytes_of({255, 255, 255, 0, 255, 255, 255, 255})});
    gltf.document["images"] = {{{"mimeType", "image/png"}, {"bufferView", gltf.add_view(png)}}};
    gltf.document["textures"] = {{{"source", 0}}};
    gltf.at("/materials/2")["alphaMode"] = "MASK";
    gltf.at("/materials/2/pbrMetallicRoughness")["baseColorTexture"] = {{"index", 0}};
  }
  Outcome render(const std::vector<std::string>& more = {}, const std::string& out = "out.exr") {
    write("scene.glb", gltf.glb());
    std::vector<std::string> arguments = {"render", path("scene.glb"), "-o", path(out), "--size", "33x21"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }
  [[nodiscard]] ExrFile picture(const std::string& name = "out.exr") const { return read_exr(path(name)); }

  test::Gltf gltf;
};

TEST_F(AlphaSurfaces, PanesDimLightAndShadow) {
  gltf.at("/scenes/0/nodes") = {0, 1, 2};
  ASSERT_EQ(render({"--light-samples", "64"}, "open.exr").code, 0);
  gltf.at("/scenes/0/nodes") = {0, 1, 2, 3};
  translucent(0.3);
  const Outcome outcome = render({"--stats", path("stats.json")});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("\"Card\""), HasSubstr("256 light samples")));
  const ExrFile open = picture("open.exr"), dim = picture();
  for (std::size_t i = 0; i < dim.floats.at("V").size(); ++i) {
    EXPECT_NEAR(dim.floats.at("V")[i], 0.7f, 1e-6f);
    EXPECT_EQ(dim.floats.at("A")[i], 1);
    EXPECT_NEAR(dim.floats.at("R")[i] / open.floats.at("R")[i], 0.7f, 1e-6f) << "the whole light, one factor";
  }
  const json stats = json::parse(read("stats.json"));
  EXPECT_EQ(stats.at("lights").at(0).at("quantity"), "count");
  EXPECT_EQ(stats.at("counters").at("blendPairs"), 33 * 21 * 256);
  EXPECT_EQ(stats.at("counters").at("maskPairs"), 0);
}

/// Pixels are exact wherever the pane is certainly not between floor and light: there the picture equals the one
/// without the pane, bit by bit. Elsewhere it equals the one from light samples.
TEST_F(AlphaSurfaces, AreasStayExactBesideWhatAPaneMayDim) {
  const json away = {0, 1, 2}, there = {0, 1, 2, 3};
  gltf.at("/nodes/3") = {{"name", "Card"}, {"mesh", 3}, {"translation", {1.5, 2, 0}}, {"scale", {1, 1, 2}}};
  const std::vector<std::string> four = {"--pixel-samples", "4", "--pixel-tolerance", "0"};
  for (const bool holes : {true, false}) {
    holes ? half_a_card() : translucent(0.3);
    for (const auto& more :
         holes ? std::vector<std::vector<std::string>>{{}} : std::vector<std::vector<std::string>>{{}, four}) {
      const auto with = [&](std::vector<std::string> options) {
        options.insert(options.end(), more.begin(), more.end());
        return options;
      };
      gltf.at("/scenes/0/nodes") = away;
      ASSERT_EQ(render(with({}), "open.exr").code, 0);
      gltf.at("/scenes/0/nodes") = there;
      ASSERT_EQ(render(with({"--light-samples", "256"}), "counted.exr").code, 0);
      const Outcome outcome = render(with({"--stats", path("stats.json")}));
      ASSERT_EQ(outcome.code, 0) << outcome.err;
      EXPECT_THAT(outcome.err,
                  AllOf(HasSubstr("\"Card\""), HasSubstr("256 light samples"), HasSubstr("exact areas elsewhere"),
                        HasSubstr("256 light samples (rows) and exact areas")));
      const ExrFile seen = picture(), open = picture("open.exr"), counted = picture("counted.exr");
      std::size_t pixels_counted = 0;
      for (std::size_t i = 0; i < seen.floats.at("V").size(); ++i) {
        // Segments from x to the light's x in [-1, 1] cross the pane's height at 0.6 x + [-0.4, 0.4]; the pane begins
        // at 0.5. Four view samples cover a pixel's quarters.
        const float border = (0.5f - 0.4f) / 0.6f, pixel = seen.floats.at("P.X")[1] - seen.floats.at("P.X")[0];
        const float beside = (seen.floats.at("P.X")[i] - border) / pixel;
        if (std::abs(beside) < 0.5f && !more.empty()) continue;
        pixels_counted += beside > 0 ? 1 : 0;
        for (const char* channel : {"V", "R", "G", "B"}) {
          const ExrFile& expected = beside < 0 ? open : counted;
          EXPECT_EQ(seen.floats.at(channel)[i], expected.floats.at(channel)[i]) << channel << " " << i;
        }
      }
      EXPECT_GT(pixels_counted, 100);
      EXPECT_LT(pixels_counted, 33 * 21 - 100);
      const json stats = json::parse(read("stats.json"));
      EXPECT_EQ(stats.at("lights").at(0).at("quantity"), "count");
      EXPECT_EQ(stats.at("lights").at(0).at("lightSamples"), 256);
      EXPECT_THAT(stats.at("warnings").dump(), HasSubstr("exact areas elsewhere"));
      if (more.empty()) {
        EXPECT_EQ(stats.at("counters").at("viewSamplesCounted"), pixels_counted);
      }
    }
  }
}

TEST_F(AlphaSurfaces, LightsOfWhichTheSameIsSaidShareALine) {
  translucent(0.3);
  json second = gltf.at("/nodes/1");
  second["name"] = "Second";
  second["translation"] = {0.5, 5, 0};
  gltf.at("/nodes").push_back(second);
  gltf.at("/scenes/0/nodes") = {0, 1, 2, 3, 4};
  const Outcome outcome = render({"--stats", path("stats.json")});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("lights \"Lamp\", \"Second\" (rectangle): no method gives its exact area"));
  const json warnings = json::parse(read("stats.json")).at("warnings");
  for (const char* light : {"light \"Lamp\" (rectangle)", "light \"Second\" (rectangle)"})
    EXPECT_TRUE(std::ranges::any_of(warnings, [&](const json& one) {
      return one.get<std::string>().starts_with(light);
    })) << light;
}

/// Panes behind the light, below the floor, far beside it, or without a shadow change nothing: areas stay exact.
TEST_F(AlphaSurfaces, APaneThatDimsNothingLeavesAreas) {
  translucent(0.3);
  // These meshes hide nothing; they keep the scene's origin where it is.
  gltf.at("/nodes").push_back({{"name", "Far"}, {"mesh", 2}, {"translation", {0, 7, 0}}});
  gltf.at("/nodes").push_back({{"name", "Deep"}, {"mesh", 2}, {"translation", {0, -3, 0}}});
  gltf.at("/scenes/0/nodes") = {0, 1, 2, 4, 5};
  ASSERT_EQ(render({}, "open.exr").code, 0);
  const ExrFile open = picture("open.exr");
  gltf.at("/scenes/0/nodes") = {0, 1, 2, 4, 5, 3};
  for (const std::vector<double>& place : {std::vector<double>{0, 6, 0}, {0, -1, 0}, {3, 4.5, 0}, {0, 2, 0}}) {
    gltf.at("/nodes/3") = {{"name", "Card"}, {"mesh", 3}, {"translation", place}, {"scale", {0.5, 1, 0.5}}};
    if (place[1] == 2) gltf.at("/nodes/3")["extras"] = {{"castsShadow", false}};
    for (const std::vector<std::string>& method : {std::vector<std::string>{}, {"--method", "exact"}}) {
      if (!method.empty() && place[1] != 6) continue;
      std::vector<std::string> options = {"--stats", path("stats.json")};
      options.insert(options.end(), method.begin(), method.end());
      const Outcome outcome = render(options);
      ASSERT_EQ(outcome.code, 0) << outcome.err;
      EXPECT_THAT(outcome.err, Not(HasSubstr("\"Card\"")));
      const json stats = json::parse(read("stats.json"));
      EXPECT_EQ(stats.at("lights").at(0).at("quantity"), "area");
      EXPECT_EQ(stats.at("warnings").size(), 0) << stats.at("warnings");
      EXPECT_FALSE(stats.at("counters").contains("viewSamplesCounted"));
      if (method.empty()) {
        for (const char* channel : {"V", "R", "G", "B", "Z", "N.Y"})
          EXPECT_EQ(picture().floats.at(channel), open.floats.at(channel)) << channel << ", pane at " << place[1];
      }
    }
  }
  const Outcome outcome = run({"compare", path("scene.glb"), "-o", path("dir"), "--size", "8x6", "--methods",
                               "edge-scatter:rows=exact", "--reference", "exact", "--runs", "1"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
}

/// A pane seen from above is composited over what it dims: α times its own light + (1 − α) times the floor's. All other
/// channels are the floor's.
TEST_F(AlphaSurfaces, PanesAreCompositedAndCarryNothingElse) {
  look_from_above();
  gltf.at("/scenes/0/nodes") = {1, 2, 3};
  ASSERT_EQ(render({"--light-samples", "64"}, "card.exr").code, 0) << "a solid card";
  gltf.at("/scenes/0/nodes") = {0, 1, 2, 3};
  translucent(0.4);
  gltf.at("/materials/2/pbrMetallicRoughness/baseColorFactor") = {1, 1, 1, 0.4};
  ASSERT_EQ(render({"--light-samples", "64", "--method", "raytrace"}).code, 0);
  ASSERT_EQ(render({"--light-samples", "64"}, "default.exr").code, 0);
  gltf.at("/nodes/3/translation") = {0, -1, 0};  // below the floor
  ASSERT_EQ(render({"--light-samples", "64"}, "floor.exr").code, 0);
  const ExrFile card = picture("card.exr"), floor = picture("floor.exr"), both = picture();
  for (const char* name : {"Z", "P.Y", "N.Y"}) {
    EXPECT_EQ(both.floats.at(name), floor.floats.at(name)) << name;
  }
  for (std::size_t i = 0; i < both.floats.at("R").size(); ++i) {
    EXPECT_EQ(both.floats.at("A")[i], 1);
    EXPECT_NEAR(both.floats.at("V")[i], 0.6f, 1e-6f) << "of the floor";
    const float expected = 0.4f * card.floats.at("R")[i] + 0.6f * 0.6f * floor.floats.at("R")[i];
    EXPECT_NEAR(both.floats.at("R")[i], expected, 1e-5f * expected);
  }
  EXPECT_EQ(picture("default.exr").floats.at("R"), both.floats.at("R")) << "the same masks, by another method";
  gltf.at("/nodes/3/translation") = {0, 2, 0};
  ASSERT_EQ(render({"--stats", path("stats.json")}, "areas.exr").code, 0);
  for (std::size_t i = 0; i < both.floats.at("R").size(); ++i)
    EXPECT_NEAR(picture("areas.exr").floats.at("R")[i], both.floats.at("R")[i], 1e-5f) << "the pane by its area";
  EXPECT_EQ(json::parse(read("stats.json")).at("counters").at("viewSamplesCounted"), 33 * 21) << "of the floor";
}

/// A light that shines only on a pane lights something in the picture.
TEST_F(AlphaSurfaces, PanesAreLitToo) {
  look_from_above();
  translucent(0.4);
  gltf.at("/nodes").push_back({{"name", "Low"}, {"mesh", 1}, {"translation", {0, 0.5, 0}}, {"rotation", {0, 0, 0, 1}}});
  gltf.at("/scenes/0/nodes") = {0, 1, 2, 3, 4};  // over the floor, shining up at the pane only
  gltf.at("/nodes/4")["extras"] = {{"body", false}};
  gltf.at("/materials/1")["doubleSided"] = false;
  const Outcome outcome = render({"--light-samples", "16"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, Not(HasSubstr("no visible point")));
  translucent(1);
  gltf.at("/nodes/3/translation") = {0, 0.25, 0};  // below the light "Low"
  EXPECT_THAT(render({"--light-samples", "16"}).err, HasSubstr("no visible point is in front of light \"Low\""));
}

/// Exposure ignores surfaces that emit light, translucent or not.
TEST_F(AlphaSurfaces, PanesThatShineAreNotExposedFor) {
  look_from_above();
  gltf.at("/materials/2")["emissiveFactor"] = {1, 1, 1};
  gltf.at("/materials/2")["extensions"]["KHR_materials_emissive_strength"] = {{"emissiveStrength", 1000.0}};
  gltf.at("/nodes/3") = {{"name", "Card"}, {"mesh", 3}, {"translation", {-1.2, 2, 0}}, {"scale", {0.2, 1, 0.2}}};
  const auto exposure = [&](double alpha, const std::vector<std::string>& more) {
    translucent(alpha);
    std::vector<std::string> options = {"--light-samples", "16"};
    options.insert(options.end(), more.begin(), more.end());
    const Outcome outcome = render(options);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return std::stod(picture().attributes.at("penumbra.exposure"));
  };
  for (const std::vector<std::string>& more : {std::vector<std::string>{}, {"--pixel-samples", "4"}}) {
    const double solid = exposure(1, more), pane = exposure(0.9, more);
    EXPECT_NEAR(pane, solid, 0.5);
  }
}

/// The half of a card that its texels leave is a rectangle: its shadow must be that of a rectangle made of triangles.
TEST_F(AlphaSurfaces, TexelsDecideOfHoles) {
  half_a_card();
  const std::vector<std::string> samples = {"--light-samples", "256", "--bits", path("mask.bits")};
  const Outcome outcome = render(samples);
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  gltf.at("/materials/2").erase("alphaMode");
  gltf.at("/materials/2/pbrMetallicRoughness").erase("baseColorTexture");
  gltf.at("/nodes/3") = {{"name", "Card"}, {"mesh", 3}, {"translation", {1, 2, 0}}, {"scale", {1, 1, 2}}};
  ASSERT_EQ(render({"--light-samples", "256", "--bits", path("half.bits")}, "half.exr").code, 0);
  const auto mask = picture().floats.at("V"), half = picture("half.exr").floats.at("V");
  std::size_t penumbra = 0;
  for (std::size_t i = 0; i < mask.size(); ++i) penumbra += half[i] > 0 && half[i] < 1 ? 1 : 0;
  EXPECT_GT(penumbra, mask.size() / 4);
  // They may differ where an edge passes exactly through a light sample: a texel's border and an edge have different
  // rules there.
  std::size_t different = 0;
  for (std::size_t i = 0; i < mask.size(); ++i) different += mask[i] != half[i] ? 1 : 0;
  EXPECT_LE(different, mask.size() / 100);
  // The floor is seen through the hole, and only there.
  look_from_above();
  half_a_card();
  gltf.at("/nodes/3") = {{"name", "Card"}, {"mesh", 3}, {"translation", {0, 2, 0}}, {"scale", {2, 1, 2}}};
  ASSERT_EQ(render({"--light-samples", "16"}).code, 0);
  const ExrFile seen = picture();
  for (std::size_t x = 0; x < 33; ++x) {
    if (x == 16) continue;
    EXPECT_FLOAT_EQ(seen.floats.at("P.Y")[std::size_t{10} * 33 + x], x > 16 ? 2.0f : 0.0f) << x;
  }
}

/// Every method whose output is a mask gives the same bits; the others are refused by name.
TEST_F(AlphaSurfaces, MethodsDoItOrAreRefused) {
  half_a_card();
  ASSERT_EQ(render({"--light-samples", "64", "--method", "raytrace", "--bits", path("raytrace.bits")}).code, 0);
  for (const char* method : {"edge-scatter", "view-sample", "depth-complexity"}) {
    ASSERT_EQ(render({"--light-samples", "64", "--method", method, "--bits", path("other.bits")}).code, 0) << method;
    EXPECT_EQ(read("other.bits"), read("raytrace.bits")) << method;
  }
  for (const std::vector<std::string>& refused : {std::vector<std::string>{"--method", "exact"},
                                                  {"--method", "soft-volume"},
                                                  {"--method", "edge-scatter", "--method-option", "rows=exact"}}) {
    const Outcome outcome = render(refused);
    EXPECT_EQ(outcome.code, 3) << refused[1];
    EXPECT_THAT(outcome.err, AllOf(HasSubstr("\"Card\""), HasSubstr(refused[1]), HasSubstr("raytrace")));
  }
  const Outcome outcome = run({"compare", path("scene.glb"), "-o", path("dir"), "--size", "16x12", "--methods",
                               "geometry", "--reference-samples", "same", "--light-samples", "64", "--runs", "1"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  const json metrics = json::parse(read("dir/metrics.json"));
  EXPECT_THAT(metrics.at("methods").dump(), Not(HasSubstr("soft-volume")));
  for (const json& method : metrics.at("methods")) EXPECT_EQ(method.at("pairsDiffering"), 0) << method.at("method");
}

/// Methods that make penumbrae along triangles' edges cannot handle other edges; the methods that the refusal names
/// draw the hole.
TEST_F(AlphaSurfaces, MethodsOfEdgesSayWhyTheyRefuseHoles) {
  half_a_card();
  for (const char* method : {"smoothies", "penumbra-map", "silhouette-map", "plateaus"}) {
    const Outcome outcome = render({"--method", method});
    EXPECT_EQ(outcome.code, 3) << method;
    EXPECT_THAT(outcome.err, AllOf(HasSubstr("\"Card\""), HasSubstr(method), HasSubstr("edges of triangles"),
                                   HasSubstr("shadow-map, pcss, backproject"), HasSubstr("edge-scatter")));
  }
  for (const char* method : {"shadow-map", "pcss", "backproject", "brabec-seidel", "kirsch-doellner", "pcf"}) {
    EXPECT_EQ(render({"--method", method}).code, 0) << method;
  }
}

/// The card's texels leave the rectangle of x in [0, 2] at height 2. Of the light at height 5, x in [-1, 1], the floor
/// at x sees the part that appears outside x = 0 and x = 2 there. Maps hold the texels themselves, and no pair is
/// tested again.
TEST_F(AlphaSurfaces, MapMethodsDrawHoles) {
  half_a_card();
  const auto hidden = [](double x) {
    // The range of the light's points whose segments pass between x = 0 and x = 2 at height 2.
    const double from = (0 - 0.6 * x) / 0.4, to = (2 - 0.6 * x) / 0.4;
    return std::max(0.0, std::min(to, 1.0) - std::max(from, -1.0)) / 2;
  };
  const std::vector<std::pair<std::string, double>> methods = {
      {"pcss", 0.08}, {"contour", 0.02}, {"backproject", 0.02}, {"accumulate", 0.06}, {"bitmask", 0.06}};
  for (const auto& [method, bound] : methods) {
    const Outcome outcome = render(
        {"--method", method, "--method-option", "size=512", "--light-samples", "64", "--stats", path("stats.json")});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const ExrFile seen = picture();
    for (std::size_t i = 0; i < seen.floats.at("V").size(); ++i)
      EXPECT_NEAR(seen.floats.at("V")[i], 1 - hidden(seen.floats.at("P.X")[i]), bound) << method << " " << i;
    EXPECT_FALSE(json::parse(read("stats.json")).at("counters").contains("maskPairs")) << method;
  }
  // With a pane whose light the host dims, masks are still not tested for holes.
  gltf.at("/meshes").push_back(json(gltf.at("/meshes/3")));
  gltf.at("/meshes/4/primitives/0")["material"] = 3;
  gltf.at("/materials").push_back({{"name", "Glass"}, {"alphaMode", "BLEND"}});
  gltf.at("/materials/3/pbrMetallicRoughness") = {{"metallicFactor", 0}, {"baseColorFactor", {1, 1, 1, 0.25}}};
  gltf.at("/nodes").push_back({{"name", "Pane"}, {"mesh", 4}, {"translation", {0, 1.75, 0}}, {"scale", {3, 1, 3}}});
  gltf.at("/scenes/0/nodes") = {0, 1, 2, 3, 4};
  const Outcome refused = render({"--method", "pcss"});
  EXPECT_EQ(refused.code, 3);
  EXPECT_THAT(refused.err, AllOf(HasSubstr("through \"Pane\" (alphaMode BLEND)"), Not(HasSubstr("MASK"))));
  ASSERT_EQ(render({"--method", "accumulate", "--method-option", "size=512", "--light-samples", "64", "--stats",
                    path("stats.json")})
                .code,
            0);
  const ExrFile dimmed = picture();
  for (std::size_t i = 0; i < dimmed.floats.at("V").size(); ++i)
    EXPECT_NEAR(dimmed.floats.at("V")[i], 0.75 * (1 - hidden(dimmed.floats.at("P.X")[i])), 0.05) << i;
  const json counters = json::parse(read("stats.json")).at("counters");
  EXPECT_EQ(counters.at("maskPairs"), 0);
  EXPECT_GT(counters.at("blendPairs"), 1000);
}

TEST_F(AlphaSurfaces, OrthographicCamerasRender) {
  gltf.at("/cameras/0") = {{"type", "orthographic"},
                           {"orthographic", {{"xmag", 3.3}, {"ymag", 2.1}, {"znear", 0}, {"zfar", 9}}}};
  look_from_above();
  const Outcome outcome = render({"--light-samples", "16"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const ExrFile seen = picture();
  for (std::size_t x = 0; x < 33; ++x) {
    const float at = 0.2f * (static_cast<float>(x) + 0.5f) - 3.3f;
    EXPECT_NEAR(seen.floats.at("P.X")[std::size_t{10} * 33 + x], at, 1e-5f);
    if (std::abs(std::abs(at) - 2) < 0.01f) continue;  // on the card's edge
    EXPECT_FLOAT_EQ(seen.floats.at("Z")[std::size_t{10} * 33 + x], std::abs(at) < 2 ? 2.0f : 4.0f) << "a solid card";
  }
  EXPECT_NEAR(seen.matrices.at("worldToNDC")[0][0], 1 / 3.3, 1e-6);
  const Outcome volume = render({"--method", "soft-volume"});
  EXPECT_EQ(volume.code, 3);
  EXPECT_THAT(volume.err, HasSubstr("orthographic"));
  ASSERT_EQ(run({"convert", path("scene.glb"), "-o", path("copy.json")}).code, 0);
  ASSERT_EQ(run({"convert", path("copy.json"), "-o", path("again.glb")}).code, 0);
  for (const char* copy : {"copy.json", "again.glb"}) {
    ASSERT_EQ(run({"render", path(copy), "-o", path("copy.exr"), "--size", "33x21", "--light-samples", "16"}).code, 0);
    EXPECT_EQ(picture("copy.exr").floats.at("Z"), seen.floats.at("Z")) << copy;
  }
}

TEST_F(AlphaSurfaces, InspectListsWhatTheSceneHas) {
  half_a_card();
  gltf.animate(3, "translation", {0, 2}, {0, 2, 0, 1, 2, 0});
  gltf.at("/nodes").push_back({{"name", "Star"}, {"mesh", 4}});
  gltf.at("/meshes").push_back(json(gltf.at("/meshes/1")));
  gltf.at("/meshes/4/primitives/0/attributes/POSITION") =
      gltf.add_floats("VEC3", {-1, 0, 1, 1, 0, 1, -1, 0, -1, 1, 1, -1});  // not flat
  gltf.at("/meshes").push_back(json(gltf.at("/meshes/1")));
  gltf.at("/meshes/5/primitives/0/attributes/POSITION") = gltf.add_floats("VEC3", {0, 0, 0, 1, 0, 0, 2, 0, 0, 3, 0, 0});
  gltf.at("/nodes").push_back({{"name", "Thread"}, {"mesh", 5}});
  gltf.at("/scenes/0/nodes") = {0, 1, 2, 3, 4, 5};
  write("scene.glb", gltf.glb());
  const Outcome outcome = run({"inspect", path("scene.glb"), "--methods"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out,
              AllOf(HasSubstr("light     \"Lamp\": a rectangle of 2 × 2"), HasSubstr("its body is \"Lamp\""),
                    HasSubstr("camera    \"Camera\""), HasSubstr("material  \"Leaf\": picture"),
                    HasSubstr("holes where alpha is below 0.5"), HasSubstr("animation from 0 s to 2 s")));
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("light     \"Star\": 2 pieces: 2 polygons"),
                                 HasSubstr("'Thread' is emissive, but no area light"), HasSubstr("it has no area")));
  EXPECT_THAT(outcome.out, testing::ContainsRegex("hard-volume +refused +light passes through \"Card\""));
  EXPECT_THAT(outcome.out, Not(testing::ContainsRegex("pcss +refused +light passes")));
  // A light's own body dims none of its light.
  gltf.at("/scenes/0/nodes") = {0, 1, 2};
  gltf.at("/materials/1")["alphaMode"] = "BLEND";
  gltf.at("/materials/1/pbrMetallicRoughness")["baseColorFactor"] = {1, 1, 1, 0.5};
  write("own.glb", gltf.glb());
  EXPECT_THAT(run({"inspect", path("own.glb"), "--methods"}).out, Not(HasSubstr("light passes through")));
  const json scene = json::parse(run({"inspect", path("scene.glb"), "--json", "-"}).out).at("scene");
  EXPECT_EQ(scene.at("lights").at(0).at("name"), "Lamp");
  EXPECT_EQ(scene.at("materials").at(2).at("alpha"), "mask");
  EXPECT_EQ(scene.at("animation").at("last"), 2);
}

/// A card with holes and a pane that only its vertices make translucent, of another colour in each corner.
TEST_F(AlphaSurfaces, ConversionKeepsAlphaOrRefuses) {
  half_a_card();
  gltf.document["textures"][0]["sampler"] = 0;
  gltf.document["samplers"] = {{{"magFilter", 9728}, {"wrapS", 33071}, {"wrapT", 33648}}};
  json pane = gltf.at("/meshes/3");
  pane["primitives"][0]["material"] = 3;
  pane["primitives"][0]["attributes"]["COLOR_0"] =
      gltf.add_floats("VEC4", {1, 0.5, 0, 0.25, 0, 1, 0, 0.5, 0, 0.25, 1, 0.75, 1, 1, 1, 1});
  gltf.at("/meshes").push_back(pane);
  gltf.at("/materials")
      .push_back({{"name", "Glass"}, {"alphaMode", "BLEND"}, {"pbrMetallicRoughness", {{"metallicFactor", 0}}}});
  gltf.at("/nodes").push_back({{"name", "Pane"}, {"mesh", 4}, {"translation", {0.5, 1, 0.5}}});
  gltf.at("/scenes/0/nodes") = {0, 1, 2, 3, 4};
  const std::vector<std::string> few = {"--light-samples", "16"};
  ASSERT_EQ(render(few).code, 0);
  const Outcome kept = run({"convert", path("scene.glb"), "-o", path("copy.glb")});
  ASSERT_EQ(kept.code, 0) << kept.err;
  EXPECT_THAT(kept.err, AllOf(Not(HasSubstr("Card")), Not(HasSubstr("Pane"))));
  ASSERT_EQ(run({"render", path("copy.glb"), "-o", path("copy.exr"), "--size", "33x21", "--light-samples", "16"}).code,
            0);
  const ExrFile seen = picture(), copy = picture("copy.exr");
  for (const char* channel : {"R", "G", "B", "A", "V", "Z"})
    EXPECT_EQ(copy.floats.at(channel), seen.floats.at(channel)) << channel;

  for (const char* name : {"copy.json", "copy.obj"}) {
    const Outcome refused = run({"convert", path("scene.glb"), "-o", path(name)});
    EXPECT_EQ(refused.code, 3);
    EXPECT_THAT(refused.err, AllOf(HasSubstr("'Card', 'Pane' lets light through"), HasSubstr("--lenient writes")));
    EXPECT_FALSE(std::filesystem::exists(path(name)));
    const Outcome lenient = run({"convert", path("scene.glb"), "--lenient", "-o", path(name)});
    EXPECT_EQ(lenient.code, 0);
    EXPECT_THAT(lenient.err, AllOf(HasSubstr("'Card', 'Pane' lets light through"), HasSubstr("'Card' has a picture"),
                                   HasSubstr("'Pane' has colours of vertices")));
    EXPECT_TRUE(std::filesystem::exists(path(name)));
  }
}

}  // namespace
}  // namespace penumbra::tests
