// SPDX-License-Identifier: Apache-2.0
// Tests emissive glTF meshes that are not flat convex outlines: pictures against sums over points on their triangles.
#include "tests/cli/program.hpp"

#include "base/exr.hpp"
#include "tests/unit/import/gltf_file.hpp"
#include "tests/unit/import/lamp_shapes.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

namespace penumbra::tests {
namespace {

using nlohmann::json;
using test::LampMesh;
using testing::AllOf;
using testing::HasSubstr;

constexpr double kRadiance = 20, kColor = 0.5;

/// Adds the triangles of a glTF primitive, with a vertex for each corner, in single precision.
std::size_t add_triangles(test::Gltf& gltf, const LampMesh& mesh) {
  std::vector<float> values;
  for (const mesh::Triangle& t : mesh.triangles) {
    for (const std::uint32_t point : t) {
      for (int axis = 0; axis < 3; ++axis) values.push_back(static_cast<float>(mesh.points[point][axis]));
    }
  }
  return gltf.add_floats("VEC3", values);
}

LampMesh in_floats(LampMesh mesh) {
  for (glm::dvec3& p : mesh.points) p = glm::dvec3(glm::vec3(p));
  return mesh;
}

bool meets(const std::array<glm::dvec3, 3>& corners, const glm::dvec3& from, const glm::dvec3& direction) {
  const glm::dvec3 u = corners[1] - corners[0], v = corners[2] - corners[0], h = glm::cross(direction, v);
  const double det = glm::dot(u, h);
  if (det == 0) return false;
  const glm::dvec3 s = (from - corners[0]) / det, q = glm::cross(s, u);
  const double a = glm::dot(s, h), b = glm::dot(direction, q), t = glm::dot(v, q);
  return a >= 0 && b >= 0 && a + b <= 1 && t > 0 && t < 1;
}

/// Estimates for one point of the floor, from points on the lamp, with the standard errors of both numbers.
struct Truth {
  double v = 0, v_error = 0, irradiance = 0, irradiance_error = 0;  ///< irradiance / (π · radiance)
  bool lit = false;
};

/// Takes random points, uniform over the area of the triangles that emit toward p. The lamp hides none of its own
/// light; `card` does.
Truth truth_at(const glm::dvec3& p, const LampMesh& lamp, bool two_sided, const LampMesh& card, std::mt19937& random) {
  constexpr int kPoints = 1500;
  std::vector<double> up_to;
  std::vector<mesh::Triangle> facing;
  double area = 0;
  for (const mesh::Triangle& t : lamp.triangles) {
    const glm::dvec3 n = lamp.vector_area(t);
    const double height = glm::dot(n, p - lamp.points[t[0]]);
    if (!(height > 0 || (two_sided && height < 0))) continue;
    facing.push_back(t);
    up_to.push_back(area += glm::length(n));
  }
  Truth truth;
  if (facing.empty()) return truth;
  truth.lit = true;
  std::uniform_real_distribution<double> unit(0, 1);
  double seen = 0, sum = 0, squares = 0, largest = 0;
  for (int i = 0; i < kPoints; ++i) {
    const double place = (i + unit(random)) / kPoints * area;
    const auto at = std::min<std::size_t>(
        static_cast<std::size_t>(std::ranges::upper_bound(up_to, place) - up_to.begin()), facing.size() - 1);
    const mesh::Triangle& t = facing[at];
    const double root = std::sqrt(unit(random)), share = unit(random);
    const glm::dvec3 l =
        (1 - root) * lamp.points[t[0]] + root * (1 - share) * lamp.points[t[1]] + root * share * lamp.points[t[2]];
    const glm::dvec3 direction = l - p;
    const double d2 = glm::dot(direction, direction), d = std::sqrt(d2);
    const double value = area * std::max(direction.y / d, 0.0) *
                         std::abs(glm::dot(glm::normalize(lamp.vector_area(t)), direction)) / d / d2 / std::numbers::pi;
    largest = std::max(largest, value);
    const bool hidden = std::ranges::any_of(card.triangles, [&](const mesh::Triangle& c) {
      return meets({card.points[c[0]], card.points[c[1]], card.points[c[2]]}, p, direction);
    });
    if (hidden) continue;
    seen += 1, sum += value, squares += value * value;
  }
  truth.v = seen / kPoints;
  truth.irradiance = sum / kPoints;
  // Stratification only makes it smaller. If more than 15 / n of the light is visible, all n points are hidden with a
  // probability below exp(−15), and 15 / n is five times this least error.
  truth.v_error = std::sqrt(std::max(truth.v * (1 - truth.v), 9.0 / kPoints) / kPoints);
  truth.irradiance_error = std::sqrt(std::max(squares / kPoints - truth.irradiance * truth.irradiance, 0.0) / kPoints) +
                           3 * largest / kPoints;
  return truth;
}

/// A floor of 8 × 8, a card of 3 × 3 at y = 1.5 over a part of it, and a lamp above both. The camera, between floor and
/// card, looks down at the floor.
class Emitters : public ProgramTest {
 protected:
  Emitters() {
    gltf.at("/meshes/0/primitives/0") = {{"attributes", {{"POSITION", add_triangles(gltf, floor_)}}}, {"material", 0}};
    gltf.at("/nodes/0/name") = "Floor";
    card_.add({{-2.5, 1.5, -1.5}, {-2.5, 1.5, 1.5}, {0.5, 1.5, 1.5}, {0.5, 1.5, -1.5}});
    gltf.at("/meshes").push_back(
        {{"primitives", {{{"attributes", {{"POSITION", add_triangles(gltf, card_)}}}, {"material", 0}}}}});
    gltf.at("/nodes").push_back({{"name", "Card"}, {"mesh", 2}});
    gltf.at("/nodes/2") = {{"name", "Camera"},
                           {"camera", 0},
                           {"translation", {0, 1.25, 0}},
                           {"rotation", {-0.70710678, 0, 0, 0.70710678}}};
    gltf.at("/cameras/0/perspective") = {{"aspectRatio", 1.5}, {"yfov", 2.1}, {"znear", 0.1}};
    gltf.at("/nodes/1") = {{"name", "Lamp"}, {"mesh", 1}};
    gltf.at("/scenes/0/nodes") = {0, 1, 2, 3};
    gltf.at("/materials/0/pbrMetallicRoughness/baseColorFactor") = {kColor, kColor, kColor, 1};
    gltf.at("/materials/1/emissiveFactor") = {1, 1, 1};
  }
  static LampMesh floor() {
    LampMesh mesh;
    mesh.add({{-4, 0, 4}, {4, 0, 4}, {4, 0, -4}, {-4, 0, -4}});
    return mesh;
  }
  void set_lamp(const LampMesh& lamp, bool two_sided) {
    lamp_ = in_floats(lamp);
    gltf.at("/meshes/1/primitives/0") = {{"attributes", {{"POSITION", add_triangles(gltf, lamp)}}}, {"material", 1}};
    gltf.at("/materials/1")["doubleSided"] = two_sided;
    write("scene.glb", gltf.glb());
  }
  /// A lamp whose parts hide one another's light is refused; with --lenient it hides none of its own light.
  void expect_truth_if_lenient(bool both) {
    const Outcome outcome = run({"render", path("scene.glb"), "-o", path("out.exr"), "--size", "24x16"});
    EXPECT_EQ(outcome.code, 3) << outcome.err;
    EXPECT_THAT(outcome.err,
                AllOf(HasSubstr("'Lamp' is an emitter with parts that shadow one another"), HasSubstr("--lenient")));
    expect_truth(both, 0, {"--lenient"});
  }
  /// `both`: triangles that p is behind emit toward it, too. `bias`: the relative error of the light that has a known
  /// reason.
  void expect_truth(bool both, double bias = 0, std::vector<std::string> more = {}) {
    more.insert(more.begin(), {"render", path("scene.glb"), "-o", path("out.exr"), "--size", "24x16"});
    const Outcome outcome = run(more);
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const ExrFile exr = read_exr(path("out.exr"));
    std::mt19937 random(7);
    double sum = 0, truths = 0, variance = 0, partly = 0;
    for (std::size_t i = 0; i < exr.floats.at("V").size(); ++i) {
      const glm::dvec3 p(exr.floats.at("P.X")[i], exr.floats.at("P.Y")[i], exr.floats.at("P.Z")[i]);
      const Truth truth = truth_at(p, lamp_, both, card_, random);
      const double v = exr.floats.at("V")[i], e = exr.floats.at("R")[i] / (kColor * kRadiance);
      partly += truth.v > 0.05 && truth.v < 0.95 ? 1 : 0;
      // V of a sphere light is that of its disk, not that of its surface.
      if (bias == 0) {
        EXPECT_NEAR(v, truth.v, 5 * truth.v_error) << "pixel " << i;
      }
      EXPECT_NEAR(e, truth.irradiance, 5 * truth.irradiance_error + (1e-6 + bias) * truth.irradiance) << "pixel " << i;
      sum += e, truths += truth.irradiance, variance += truth.irradiance_error * truth.irradiance_error;
    }
    EXPECT_GT(partly, 20) << "there is a penumbra to see";
    EXPECT_NEAR(sum / truths, 1, 4 * std::sqrt(variance) / truths + bias);
    EXPECT_LT(4 * std::sqrt(variance) / truths, 0.015) << "what is off by 2 % is found";
  }

  test::Gltf gltf;
  LampMesh floor_ = floor(), card_, lamp_;
};

TEST_F(Emitters, ACubeShinesOutward) {
  set_lamp(test::cube_lamp({0.3, 3.5, -0.2}, 0.5), true);
  expect_truth(false);
}

TEST_F(Emitters, ATube) {
  set_lamp(test::tube_lamp({0.3, 3, -0.2}, 0.2, 1.5, 8, true), true);
  expect_truth(false);
  set_lamp(test::tube_lamp({0.3, 3, -0.2}, 0.2, 1.5, 6, false), true);
  expect_truth_if_lenient(true);
}

TEST_F(Emitters, AStarAndTwoPanels) {
  set_lamp(test::star_lamp({0.2, 3, 0.1}, 1.2, 0.5, 5), false);
  expect_truth(false);
  set_lamp(test::two_panels({0.1, 3, -0.2}), false);
  expect_truth_if_lenient(false);
}

TEST_F(Emitters, BallsCoarseAndFine) {
  set_lamp(test::ball_lamp({0.3, 3, -0.2}, 0.6, 0), true);
  expect_truth(false);
  set_lamp(test::ball_lamp({0.3, 3, -0.2}, 0.6, 2), true);  // recognised as a sphere
  expect_truth(false, 0.0025);                              // see import/gltf/emitters/sphere_light.hpp
}

/// One light of six pieces, and six lights, made of the same floats.
TEST_F(Emitters, SixRectanglesAreTheCubeToTheBit) {
  set_lamp(test::cube_lamp({0.25, 3.5, -0.25}, 0.5), true);
  ASSERT_EQ(run({"convert", path("scene.glb"), "-o", path("one.json")}).code, 0);
  json scene = json::parse(read("one.json"));
  json light = scene.at("lights").at(0);
  ASSERT_EQ(light.at("pieces").size(), 6U);
  std::erase_if(scene["meshes"].get_ref<json::array_t&>(), [](const json& mesh) { return mesh.at("name") == "Lamp"; });
  write("one.json", scene.dump());
  scene["lights"] = json::array();
  for (const json& piece : light.at("pieces")) {
    scene["lights"].push_back(
        {{"name", "face" + std::to_string(scene["lights"].size())}, {"radiance", light.at("radiance")}});
    scene["lights"].back().update(piece);
  }
  write("six.json", scene.dump());
  for (const char* method : {"edge-scatter", "raytrace"}) {
    for (const char* name : {"one", "six"}) {
      const Outcome outcome = run({"render", path(std::string(name) + ".json"), "-o", path(std::string(name) + ".exr"),
                                   "--size", "24x16", "--method", method, "--stats", path("stats.json")});
      ASSERT_EQ(outcome.code, 0) << outcome.err;
      EXPECT_EQ(json::parse(read("stats.json")).at("lights").size(), name == std::string("one") ? 1U : 6U);
    }
    const ExrFile one = read_exr(path("one.exr")), six = read_exr(path("six.exr"));
    for (const char* channel : {"R", "G", "B"}) EXPECT_EQ(one.floats.at(channel), six.floats.at(channel)) << channel;
    EXPECT_EQ(one.floats.at("Lamp.R"), one.floats.at("R"));
    EXPECT_EQ(one.floats.at("Lamp.V"), one.floats.at("V"));
    for (std::size_t i = 0; i < one.floats.at("V").size(); ++i) {
      double seen = 0, faces = 0;  // of equal area; behind a face or below it, its V is 0, and so is its irradiance
      for (int face = 0; face < 6; ++face) {
        const auto& rectangle = light.at("pieces").at(static_cast<std::size_t>(face)).at("rectangle");
        const auto vector = [&](const char* key) {
          return glm::dvec3(rectangle.at(key).at(0), rectangle.at(key).at(1), rectangle.at(key).at(2));
        };
        const glm::dvec3 p(one.floats.at("P.X")[i], one.floats.at("P.Y")[i], one.floats.at("P.Z")[i]);
        if (glm::dot(glm::cross(vector("halfU"), vector("halfV")), p - vector("center")) <= 0) continue;
        faces += 1;
        seen += static_cast<double>(six.floats.at("face" + std::to_string(face) + ".V")[i]);
      }
      EXPECT_NEAR(one.floats.at("V")[i], seen / faces, 1e-7) << "pixel " << i;
    }
  }
}

TEST_F(Emitters, OneLightForEveryCommand) {
  set_lamp(test::star_lamp({0.2, 3, 0.1}, 1.2, 0.5, 5), false);
  EXPECT_THAT(run({"inspect", path("scene.glb")}).out, HasSubstr("light     \"Lamp\": 5 pieces: 5 polygons"));
  const Outcome bits = run({"render", path("scene.glb"), "-o", path("out.exr"), "--bits", path("out.bits")});
  EXPECT_EQ(bits.code, 2);
  EXPECT_THAT(bits.err, HasSubstr("light \"Lamp\" is divided into 5 pieces"));
  const Outcome wedges = run({"wedges", path("scene.glb"), "--light", "Lamp", "--validate"});
  EXPECT_EQ(wedges.code, 3);
  EXPECT_THAT(wedges.err, HasSubstr("light \"Lamp\" consists of 5 pieces"));

  const Outcome compared = run({"compare", path("scene.glb"), "-o", path("out"), "--size", "24x16", "--light", "Lamp",
                                "--methods", "view-sample,edge-scatter:rows=exact", "--light-samples", "16", "--runs",
                                "1", "--reference-samples", "same"});
  ASSERT_EQ(compared.code, 0) << compared.err;
  const json metrics = json::parse(read("out/metrics.json"));
  const json& method = metrics.at("methods").at(0);
  EXPECT_EQ(method.at("lights").size(), 1U);
  EXPECT_EQ(method.at("lightSamples"), 5 * 16);
  EXPECT_EQ(method.at("pairsAll"), 24 * 16 * 5 * 16);
  EXPECT_EQ(method.at("pairsDiffering"), 0);
  EXPECT_EQ(method.at("error").at("max"), 0);
  EXPECT_GT(metrics.at("judgedPixels"), 300);

  // `convert` writes the same light, with its body and without.
  ASSERT_EQ(run({"render", path("scene.glb"), "-o", path("first.exr"), "--size", "24x16"}).code, 0);
  const std::vector<float> v = read_exr(path("first.exr")).floats.at("V");
  ASSERT_EQ(run({"convert", path("scene.glb"), "-o", path("copy.json")}).code, 0);
  json bare = json::parse(read("copy.json"));
  std::erase_if(bare["meshes"].get_ref<json::array_t&>(), [](const json& mesh) { return mesh.at("name") == "Lamp"; });
  write("bare.json", bare.dump());
  ASSERT_EQ(run({"convert", path("bare.json"), "-o", path("bare.glb")}).code, 0);
  for (const char* copy : {"copy.json", "bare.json", "bare.glb"}) {
    ASSERT_EQ(run({"render", path(copy), "-o", path("copy.exr"), "--size", "24x16"}).code, 0) << copy;
    const std::vector<float> again = read_exr(path("copy.exr")).floats.at("V");
    // The scene's centre differs, and so do floats: rounding of 2⁻²⁴ of 8 in corners of edges that are at least 0.1
    // long.
    for (std::size_t i = 0; i < v.size(); ++i) EXPECT_NEAR(again[i], v[i], 1e-4) << copy << " pixel " << i;
  }
}

/// A glowing sign receives the same light as one that does not glow, and its own light is added.
TEST_F(Emitters, AreLitByOtherLights) {
  set_lamp(test::cube_lamp({0.25, 3.5, -0.25}, 0.5), true);
  LampMesh sign;
  sign.add({{-2, 0.01, 1}, {1, 0.01, 1}, {1, 0.01, -1}, {-2, 0.01, -1}});
  gltf.at("/meshes").push_back(
      {{"primitives", {{{"attributes", {{"POSITION", add_triangles(gltf, sign)}}}, {"material", 2}}}}});
  gltf.at("/nodes").push_back({{"name", "Sign"}, {"mesh", 3}});
  gltf.at("/scenes/0/nodes") = {0, 1, 2, 3, 4};
  gltf.at("/materials")
      .push_back({{"name", "Red"},
                  {"pbrMetallicRoughness", {{"baseColorFactor", {0.8, 0.1, 0.1, 1}}, {"metallicFactor", 0}}}});
  write("plain.glb", gltf.glb());
  gltf.at("/materials/2")["emissiveFactor"] = {0.02, 0.01, 0.01};
  write("glowing.glb", gltf.glb());
  for (const std::string method : {"edge-scatter", "view-sample", "raytrace", "soft-volume"}) {
    for (const std::string name : {"plain", "glowing"}) {
      const Outcome outcome =
          run({"render", path(name + ".glb"), "-o", path(name + ".exr"), "--size", "24x16", "--method", method});
      ASSERT_EQ(outcome.code, 0) << outcome.err;
    }
    const ExrFile plain = read_exr(path("plain.exr")), glowing = read_exr(path("glowing.exr"));
    int on_sign = 0, in_shadow = 0;
    for (std::size_t i = 0; i < plain.floats.at("V").size(); ++i) {
      EXPECT_EQ(glowing.floats.at("Lamp.V")[i], plain.floats.at("V")[i]) << method << " pixel " << i;
      EXPECT_EQ(glowing.floats.at("Lamp.R")[i], plain.floats.at("R")[i]) << method << " pixel " << i;
      if (glowing.floats.at("object.X")[i] != 4) continue;
      ++on_sign;
      in_shadow += plain.floats.at("V")[i] < 0.9F ? 1 : 0;
      EXPECT_EQ(glowing.floats.at("Sign.V")[i], 1.0F);
      EXPECT_EQ(glowing.floats.at("Sign.R")[i], 0.02F);
      EXPECT_FLOAT_EQ(glowing.floats.at("R")[i], plain.floats.at("R")[i] + 0.02F);
    }
    EXPECT_GT(on_sign, 50);
    EXPECT_GT(in_shadow, 10);
  }
}

}  // namespace
}  // namespace penumbra::tests
