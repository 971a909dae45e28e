// SPDX-License-Identifier: Apache-2.0
// Tests domes in extras, which core glTF cannot express.
#include "scenes/formats/gltf_reader.hpp"

#include "tests/unit/import/gltf_reader.hpp"

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <variant>

namespace penumbra::scenes {
namespace {

using nlohmann::json;
using test::Gltf;
using ::testing::HasSubstr;

/// Makes node 0 a dome with this rotation; node 0 is also a mesh.
Gltf with_dome(const json& dome, const json& rotation = {0, 0, 0, 1}) {
  Gltf gltf;
  gltf.at("/scenes/0/nodes") = {0, 2};
  gltf.at("/nodes/0")["extras"] = {{"dome", dome}};
  gltf.at("/nodes/0")["rotation"] = rotation;
  gltf.at("/nodes/0")["translation"] = {5, 6, 7};  // must not matter for a dome
  gltf.at("/nodes/0")["scale"] = {2, 3, 4};
  return gltf;
}

const Dome& dome_of(const Scene& scene) {
  return std::get<Dome>(scene.lights.at(0).shape);
}

TEST_F(GltfReader, DomesOfExtras) {
  Gltf gltf = with_dome({{"radiance", {1, 2, 3}}, {"half", true}, {"visible", true}, {"sampled", true}});
  const Scene scene = read(gltf);
  ASSERT_EQ(scene.lights.size(), 1u);
  EXPECT_EQ(scene.lights[0].name, "Body");
  EXPECT_EQ(scene.lights[0].radiance, glm::dvec3(1, 2, 3));
  EXPECT_TRUE(scene.lights[0].visible);
  EXPECT_FALSE(scene.lights[0].texture);
  EXPECT_TRUE(dome_of(scene).half);
  EXPECT_TRUE(dome_of(scene).sampled);
  EXPECT_EQ(dome_of(scene).up, glm::dvec3(0, 1, 0));
  EXPECT_EQ(dome_of(scene).rotate, 0);
  Gltf plain = with_dome({{"radiance", {1, 1, 1}}});
  EXPECT_FALSE(dome_of(read(plain)).half);
  EXPECT_FALSE(dome_of(read(plain)).sampled);
  EXPECT_FALSE(read(plain).lights[0].visible);
}

/// A turn about an axis is a quaternion of half the angle. A turn about +Y gives `rotate`; one about +X or +Z turns
/// `up` by the shortest arc and gives no `rotate`; a turn about +Y and then about +X gives both.
TEST_F(GltfReader, DomesAreTurnedByTheirNodes) {
  const double c = std::cos(glm::radians(20.0)), s = std::sin(glm::radians(20.0));  // 40 degrees
  const auto read_turned = [&](const json& rotation) {
    Gltf gltf = with_dome({{"radiance", {1, 1, 1}}}, rotation);
    const Scene scene = read(gltf);
    return dome_of(scene);
  };
  const Dome about_y = read_turned({0, s, 0, c}), about_x = read_turned({s, 0, 0, c}),
             about_z = read_turned({0, 0, s, c});
  EXPECT_NEAR(about_y.rotate, 40, 1e-9);
  EXPECT_NEAR(glm::distance(about_y.up, glm::dvec3(0, 1, 0)), 0, 1e-12);
  EXPECT_NEAR(about_x.rotate, 0, 1e-9);
  EXPECT_NEAR(glm::distance(about_x.up, glm::dvec3(0, std::cos(glm::radians(40.0)), std::sin(glm::radians(40.0)))), 0,
              1e-12);
  EXPECT_NEAR(about_z.rotate, 0, 1e-9);
  EXPECT_NEAR(glm::distance(about_z.up, glm::dvec3(-std::sin(glm::radians(40.0)), std::cos(glm::radians(40.0)), 0)), 0,
              1e-12);
  const Dome both = read_turned({s * c, c * s, s * s, c * c});  // (s, 0, 0, c) times (0, s, 0, c)
  EXPECT_NEAR(both.rotate, 40, 1e-9);
  EXPECT_NEAR(glm::distance(both.up, about_x.up), 0, 1e-12);
  const Dome down = read_turned({1, 0, 0, 0});
  EXPECT_NEAR(glm::distance(down.up, glm::dvec3(0, -1, 0)), 0, 1e-12);
  EXPECT_NEAR(std::remainder(down.rotate, 360), 0, 1e-9);
}

TEST_F(GltfReader, PicturesOfDomesLieBesideTheFile) {
  std::string text = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n";
  text += std::string("\x80\x80\x80\x81", 4) + std::string("\x80\x80\x80\x82", 4);
  write("sky.hdr", text);
  Gltf gltf = with_dome({{"radiance", {1, 1, 1}}, {"image", "sky.hdr"}});
  const Scene scene = read(gltf);
  ASSERT_TRUE(scene.lights.at(0).texture);
  EXPECT_EQ(scene.lights[0].texture->width, 2u);
  EXPECT_EQ(scene.lights[0].texture->texels[1], glm::vec3(2));
  EXPECT_EQ(scene.sources.size(), 2u) << "the picture must be among the sources, so that no output overwrites it";
  gltf.at("/nodes/0/extras/dome/image") = "gone.hdr";
  EXPECT_THAT(refusal(gltf), HasSubstr("no such file \"gone.hdr\""));
  gltf.at("/nodes/0/extras/dome/image") = "/etc/hostname";
  EXPECT_THAT(refusal(gltf), HasSubstr("--allow-outside"));
}

TEST_F(GltfReader, DomesThatAreNoneAreRefused) {
  const auto expect = [&](const json& dome, const std::string& what) {
    Gltf gltf = with_dome(dome);
    EXPECT_THAT(refusal(gltf), HasSubstr("/nodes/0/extras/dome" + what));
  };
  expect({{"radiance", {1, -1, 0}}}, "/radiance: expected 3 numbers from 0 up");
  expect({{"radiance", {1, 1, 1}}, {"half", "yes"}}, "/half: expected true or false");
  expect({{"radiance", {1, 1, 1}}, {"image", 3}}, "/image: expected the name of a file");
  Gltf mirrored = with_dome({{"radiance", {1, 1, 1}}});
  mirrored.at("/nodes/0")["scale"] = {-1, 1, 1};
  EXPECT_THAT(refusal(mirrored), HasSubstr("/nodes/0/extras/dome: its transform mirrors it"));
  Gltf foreign = with_dome("St Paul's");
  EXPECT_TRUE(read(foreign).lights.empty()) << "a property of another tool is no dome";
}

}  // namespace
}  // namespace penumbra::scenes
