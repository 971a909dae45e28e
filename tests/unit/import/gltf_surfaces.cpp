// SPDX-License-Identifier: Apache-2.0
// Tests the looks of glTF surfaces: colours, pictures, normals, and what lets light through.
#include "scenes/formats/gltf_reader.hpp"

#include "base/image.hpp"
#include "base/png.hpp"
#include "mesh/import.hpp"
#include "scenes/formats/reader.hpp"
#include "tests/unit/import/gltf_file.hpp"
#include "tests/unit/textured_lights_support.hpp"

#include <glm/geometric.hpp>
#include <gmock/gmock.h>

#include <numbers>

namespace penumbra::scenes {
namespace {

using nlohmann::json;
using test::Gltf;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class GltfSurfaces : public test::FileTest {
 protected:
  Scene read(Gltf& gltf, bool lenient = false) const {
    ReadOptions options;
    options.lenient = lenient;
    return read_gltf(write("scene.glb", gltf.glb()), options);
  }
  std::string refusal(Gltf& gltf) const {
    const auto path = write("scene.glb", gltf.glb());
    return test::input_error([&] { read_gltf(path); });
  }
};

/// A picture of 2 x 1 texels, dark red and white, on the body.
Gltf textured() {
  Gltf gltf;
  const auto png = encode_png({2, 1, {{128, 0, 0}, {255, 255, 255}}});
  const std::string bytes(reinterpret_cast<const char*>(png.data()), png.size());
  gltf.document["images"] = {{{"name", "leaf"}, {"mimeType", "image/png"}, {"bufferView", gltf.add_view(bytes)}}};
  gltf.document["samplers"] = {{{"wrapS", 33071}, {"wrapT", 33648}, {"magFilter", 9728}}};
  gltf.document["textures"] = {{{"source", 0}, {"sampler", 0}}};
  gltf.at("/materials/0/pbrMetallicRoughness")["baseColorTexture"] = {{"index", 0}};
  gltf.at("/meshes/0/primitives/0/attributes")["TEXCOORD_0"] = gltf.add_floats("VEC2", {0, 0, 1, 0, 0.5f, 1});
  return gltf;
}

TEST_F(GltfSurfaces, HavePicturesWithPlaces) {
  Gltf gltf = textured();
  const Scene scene = read(gltf);
  EXPECT_THAT(scene.warnings, IsEmpty());
  ASSERT_EQ(scene.pictures.size(), 1u);
  EXPECT_EQ(scene.pictures[0].file, "leaf");
  EXPECT_EQ(scene.pictures[0].width, 2u);
  EXPECT_THAT(scene.pictures[0].texels, ::testing::ElementsAre(std::array<std::uint8_t, 4>{128, 0, 0, 255},
                                                               std::array<std::uint8_t, 4>{255, 255, 255, 255}));
  ASSERT_TRUE(scene.objects[0].picture);
  EXPECT_EQ(scene.objects[0].picture->wrap_s, PictureUse::Wrap::clamp);
  EXPECT_EQ(scene.objects[0].picture->wrap_t, PictureUse::Wrap::mirror);
  EXPECT_TRUE(scene.objects[0].picture->nearest);
  ASSERT_EQ(scene.looks.places.size(), scene.soup.positions.size());
  EXPECT_EQ(scene.looks.places[2], glm::dvec2(0.5, 1));
  gltf.at("/materials/0/pbrMetallicRoughness/baseColorTexture")["extensions"] = {
      {"KHR_texture_transform", {{"offset", {0.25, 0.5}}, {"scale", {2, 3}}}}};
  EXPECT_EQ(read(gltf).looks.places[2], glm::dvec2(1.25, 3.5));
  gltf.at("/materials/0/pbrMetallicRoughness/baseColorTexture/extensions/KHR_texture_transform")["rotation"] =
      std::numbers::pi / 2;
  // (0.5, 1) scaled is (1, 3); turned by a right angle it is (3, -1).
  EXPECT_LT(glm::distance(read(gltf).looks.places[2], glm::dvec2(3.25, -0.5)), 1e-12);
}

TEST_F(GltfSurfaces, HaveMaterialsColoursAndNormals) {
  Gltf gltf;
  auto& attributes = gltf.at("/meshes/0/primitives/0/attributes");
  attributes["COLOR_0"] = gltf.add_floats("VEC3", {1, 0, 0, 0, 1, 0, 0, 0, 0.5f});
  attributes["NORMAL"] = gltf.add_floats("VEC3", {0, 0, 1, 0, 1, 0, 0, 0, 0});
  gltf.at("/nodes/0")["scale"] = {1, 1, -2};
  const Scene scene = read(gltf);
  EXPECT_EQ(scene.objects[0].material, "Grey");
  ASSERT_EQ(scene.looks.colors.size(), scene.soup.positions.size());
  ASSERT_EQ(scene.looks.normals.size(), scene.soup.positions.size());
  // A mirrored triangle's corners are taken in another order.
  EXPECT_EQ(scene.looks.colors[0], glm::vec4(1, 0, 0, 1));
  EXPECT_THAT(scene.looks.colors, Contains(glm::vec4(0, 0, 0.5f, 1)));
  EXPECT_EQ(scene.looks.colors.back(), glm::vec4(1)) << "white: the lamp has no colours";
  EXPECT_EQ(scene.looks.normals[0], glm::vec3(0, 0, -1)) << "the normal is mirrored with its node";
  EXPECT_EQ(scene.looks.normals.back(), glm::vec3(0));
}

/// A surface that stops all light is plain geometry, one that stops none is left out; others keep their alpha.
/// Blender's exporter writes nothing for shaders that it does not support; a material of Emission alone reflects
/// nothing.
TEST_F(GltfSurfaces, OfBlendersOtherShaders) {
  Gltf gltf;
  gltf.at("/materials/0").erase("pbrMetallicRoughness");
  gltf.at("/materials/1/pbrMetallicRoughness") = {{"baseColorFactor", {0, 0, 0, 1}}};
  const Scene scene = read(gltf);
  EXPECT_EQ(scene.objects.at(0).color, glm::dvec3(1));
  EXPECT_THAT(scene.warnings,
              ::testing::ElementsAre(AllOf(HasSubstr("Body"), HasSubstr("no base colour in the file"))));
  gltf.at("/asset/generator") = "somebody else";
  EXPECT_THAT(read(gltf).warnings, ::testing::ElementsAre(AllOf(HasSubstr("Body"), HasSubstr("metallic"))));
}

TEST_F(GltfSurfaces, LetLightThrough) {
  Gltf gltf;
  auto& material = gltf.at("/materials/0");
  material["alphaMode"] = "MASK";
  ASSERT_EQ(read(gltf).objects.size(), 2u);
  EXPECT_EQ(read(gltf).objects[0].alpha, Alpha()) << "an alpha of 1 is solid";
  material["pbrMetallicRoughness"]["baseColorFactor"] = {1, 1, 1, 0.3};
  const Scene gone = read(gltf);
  ASSERT_EQ(gone.objects.size(), 1u) << "a surface with alpha below the cutoff of 0.5 is left out";
  EXPECT_EQ(gone.objects[0].name, "Lamp");
  EXPECT_EQ(mesh::import_mesh(write("scene.glb", gltf.glb())).soup.triangles.size(), 2u)
      << "also if the file is read as a mesh";
  material["alphaCutoff"] = 0.25;
  EXPECT_EQ(read(gltf).objects[0].alpha, Alpha());
  material["alphaMode"] = "BLEND";
  const Scene pane = read(gltf);
  EXPECT_EQ(pane.objects[0].alpha, (Alpha{Alpha::Mode::blend, 0.3, 0.25}));
  EXPECT_THAT(pane.warnings, IsEmpty());
  material["pbrMetallicRoughness"]["baseColorFactor"] = {1, 1, 1, 0};
  EXPECT_EQ(read(gltf).objects.size(), 1u);
  material["alphaMode"] = "DITHER";
  EXPECT_THAT(refusal(gltf), HasSubstr("/materials/0/alphaMode"));
  Gltf glass;
  glass.at("/materials/0")["extensions"]["KHR_materials_transmission"] = {{"transmissionFactor", 1}};
  glass.at("/extensionsUsed").push_back("KHR_materials_transmission");
  EXPECT_THAT(refusal(glass), HasSubstr("'Body' lets light through"));
  Gltf metal;
  metal.at("/materials/0/pbrMetallicRoughness").erase("metallicFactor");
  metal.at("/extensionsUsed").push_back("KHR_materials_specular");
  EXPECT_THAT(read(metal).warnings, ::testing::ElementsAre(HasSubstr("'Body' has a metallic material")));
}

/// The origin is the middle of all vertices of meshes, visible or not, in a triangle or not.
TEST_F(GltfSurfaces, VerticesThatNobodySeesMoveTheOrigin) {
  Gltf gltf;
  const auto box_of = [](const Scene& scene) {
    glm::dvec3 lower = scene.soup.positions.front(), upper = lower;
    for (const glm::dvec3& p : scene.soup.positions) lower = glm::min(lower, p), upper = glm::max(upper, p);
    return 0.5 * lower + 0.5 * upper;
  };
  EXPECT_FALSE(read(gltf).origin) << "no separate origin: it is the middle of the triangles";
  const glm::dvec3 middle = box_of(read(gltf));
  gltf.at("/nodes").push_back({{"name", "Pane"}, {"mesh", gltf.at("/meshes").size()}, {"translation", {0, 50, 0}}});
  gltf.at("/meshes").push_back(gltf.at("/meshes/0"));
  gltf.at("/meshes").back()["primitives"][0]["material"] = gltf.at("/materials").size();
  gltf.at("/scenes/0/nodes").push_back(gltf.at("/nodes").size() - 1);
  gltf.at("/materials").push_back({{"name", "Glass"}});
  const glm::dvec3 with_pane = box_of(read(gltf));
  EXPECT_NE(with_pane, middle);
  gltf.at("/materials").back()["alphaMode"] = "BLEND";
  gltf.at("/materials").back()["pbrMetallicRoughness"] = {{"baseColorFactor", {1, 1, 1, 0}}};
  EXPECT_EQ(box_of(read(gltf)), middle) << "it is left out";
  EXPECT_EQ(read(gltf).origin, std::optional(with_pane));
  gltf.at("/nodes").back()["extras"] = {{"body", false}};
  EXPECT_EQ(read(gltf).origin, std::optional(with_pane)) << "a body without a light is an ordinary mesh";

  Gltf stray;  // a fourth vertex
  const glm::dvec3 open = box_of(read(stray));
  stray.at("/meshes/0/primitives/0/attributes/POSITION") =
      stray.add_floats("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 85, 0});
  const Scene scene = read(stray);
  EXPECT_EQ(box_of(scene), open);
  EXPECT_EQ(scene.origin, std::optional(open + glm::dvec3(0, 40, 0)));
}

/// A picture's own alpha: opaque texels are no holes; a picture that cannot be read might have some.
TEST_F(GltfSurfaces, PicturesMayHaveHoles) {
  Gltf gltf = textured();
  gltf.at("/materials/0")["alphaMode"] = "MASK";
  EXPECT_EQ(read(gltf).objects.size(), 2u);
  gltf.at("/meshes/0/primitives/0/attributes")["COLOR_0"] =
      gltf.add_floats("VEC4", {1, 1, 1, 1, 1, 1, 1, 0, 1, 1, 1, 1});
  EXPECT_EQ(read(gltf).objects[0].alpha, (Alpha{Alpha::Mode::mask, 1, 0.5})) << "one vertex has an alpha of 0";
  gltf.at("/meshes/0/primitives/0/attributes").erase("COLOR_0");
  gltf.at("/images/0")["bufferView"] = 0;
  EXPECT_THAT(refusal(gltf), AllOf(HasSubstr("'Body'"), HasSubstr("PNG")));
  gltf.at("/materials/0").erase("alphaMode");
  EXPECT_THAT(read(gltf).warnings, Contains(HasSubstr("without its picture")));
}

/// Texels are sRGB, and alpha is that of the file, whatever the picture's depth and gAMA chunk; 16 bits are rounded.
TEST_F(GltfSurfaces, PicturesOfAnyDepthAreAsTheyAre) {
  const auto texel_of = [&](const std::string& png) {
    Gltf gltf = textured();
    gltf.at("/images/0")["bufferView"] = gltf.add_view(png);
    return read(gltf).pictures.at(0).texels.at(0);
  };
  const std::string wide = tests::bytes_of({0x80, 0x80, 0x40, 0x00, 0xff, 0xff, 0x3f, 0xd9});
  EXPECT_EQ(texel_of(tests::png_file(1, 1, 16, 6, {wide})), (std::array<std::uint8_t, 4>{128, 64, 255, 64}));
  const std::string linear = tests::png_chunk("gAMA", tests::big_endian(100000));
  EXPECT_EQ(texel_of(tests::png_file(1, 1, 8, 6, {tests::bytes_of({128, 64, 255, 7})}, linear)),
            (std::array<std::uint8_t, 4>{128, 64, 255, 7}));
}

/// Everything that is lost produces a message.
TEST_F(GltfSurfaces, WhatAlphaLacksIsNamed) {
  Gltf gltf = textured();
  gltf.at("/meshes/0/primitives/0/attributes").erase("TEXCOORD_0");
  EXPECT_THAT(read(gltf).warnings, Contains(HasSubstr("'Body' has no TEXCOORD_0")));
  gltf.at("/materials/0")["alphaMode"] = "MASK";
  EXPECT_THAT(refusal(gltf), HasSubstr("'Body' has no TEXCOORD_0"));
  Gltf glossy;
  glossy.at("/materials/0")["alphaMode"] = "MASK";
  glossy.at("/materials/0")["extensions"]["KHR_materials_pbrSpecularGlossiness"] = {{"diffuseFactor", {1, 1, 1, 0}}};
  EXPECT_THAT(read(glossy).warnings, Contains("'Body' is wholly transparent, and left out"))
      << "the alpha of diffuseFactor must count";
  Gltf pane;
  pane.at("/materials/0")["alphaMode"] = "BLEND";
  pane.at("/materials/0/pbrMetallicRoughness")["baseColorFactor"] = {1, 1, 1, 0.5};
  const auto file = write("pane.glb", pane.glb());
  EXPECT_THAT(mesh::import_mesh(file).notes, Contains(HasSubstr("'Body' becomes solid")));
  EXPECT_THAT(test::input_error([&] { mesh::import_mesh(mesh::open_input(file), {}, {.lenient = false}); }),
              AllOf(HasSubstr("'Body' becomes solid"), HasSubstr("--lenient")));
  const auto scene =
      write("scene.json", R"({"format": "penumbra-scene/1", "camera": {"eye": [0, 0, 9], "target": [0, 0, 0]},
      "meshes": [{"file": "pane.glb"}], "lights": [{"polygon": [[0, 5, 0], [1, 5, 0], [0, 5, 1]]}]})");
  EXPECT_THAT([&] { read_scene(scene); },
              ::testing::ThrowsMessage<Error>(AllOf(HasSubstr("/meshes/0/file"), HasSubstr("'Body' becomes solid"))));
  EXPECT_THAT(read_scene(scene, {.lenient = true}).warnings, Contains(HasSubstr("'Body' becomes solid")));
  EXPECT_THAT(read_scene(scene, {.needs_light = false}).warnings, Contains(HasSubstr("'Body' becomes solid")));
  pane.at("/materials/0/pbrMetallicRoughness/baseColorFactor/3") = 0;
  EXPECT_THAT(read(pane).warnings, Contains(HasSubstr("'Body' is wholly transparent")));
}

/// A light of radiance (20, 10, 0) with a picture of dark red and white has the mean over the part of the picture that
/// its mesh covers, in linear light. The lamp's corners are at (−1, 1), (1, 1), (−1, −1) and (1, −1).
TEST_F(GltfSurfaces, ShineWithTheMeanOfTheirPictureWhereItLies) {
  const double dark = linear_of_srgb(128 / 255.0);
  const auto lit = [](const std::vector<float>& places, const json& transform = {}) {
    Gltf gltf = textured();
    gltf.at("/materials/1")["emissiveTexture"] = {{"index", 0}};
    if (!transform.is_null()) {
      gltf.document["extensionsUsed"].push_back("KHR_texture_transform");
      gltf.at("/materials/1/emissiveTexture")["extensions"] = {{"KHR_texture_transform", transform}};
    }
    gltf.at("/meshes/1/primitives/0/attributes")["TEXCOORD_0"] = gltf.add_floats("VEC2", places);
    return gltf;
  };
  const auto radiance = [&](Gltf gltf) { return read(gltf).lights.at(0).radiance; };
  const std::vector<float> whole = {0, 1, 1, 1, 0, 0, 1, 0};
  Gltf all = lit(whole);
  EXPECT_LT(glm::distance(radiance(all), glm::dvec3(20 * (dark + 1) / 2, 10 * 0.5, 0)), 1e-12);
  EXPECT_THAT(read(all).warnings, Contains(AllOf(HasSubstr("'Lamp'"), HasSubstr("mean"))));
  // The mesh covers two thirds of the width: the right texel is a quarter of that.
  EXPECT_LT(glm::distance(radiance(lit({0, 1, 0.6666667f, 1, 0, 0, 0.6666667f, 0})),
                          glm::dvec3(20 * (0.75 * dark + 0.25), 10 * 0.25, 0)),
            1e-6);
  // Only the right half of the picture, by texture coordinates or by KHR_texture_transform.
  EXPECT_EQ(radiance(lit({0.5f, 1, 1, 1, 0.5f, 0, 1, 0})), glm::dvec3(20, 10, 0));
  EXPECT_EQ(radiance(lit(whole, {{"scale", {0.5, 1}}, {"offset", {0.5, 0}}})), glm::dvec3(20, 10, 0));
  // The same place for all corners, as with a palette.
  EXPECT_EQ(radiance(lit({0.25f, 0.5f, 0.25f, 0.5f, 0.25f, 0.5f, 0.25f, 0.5f})), glm::dvec3(20 * dark, 0, 0));
  // Coordinates far out in a repeated picture; at 9.1e15 doubles do not even resolve texels.
  for (const double offset : {1e6, 9.1e15}) {
    Gltf far = lit(whole, {{"scale", {64, 1}}, {"offset", {offset, 0}}});
    far.at("/samplers/0/wrapS") = 10497;
    EXPECT_NEAR(radiance(far).x, 20 * (dark + 1) / 2, offset < 1e7 ? 1e-6 : 10) << offset;
  }
  // Black texels give no light.
  Gltf black = lit({0, 1, 0.5f, 1, 0, 0, 0.5f, 0});
  black.at("/materials/1/emissiveFactor") = {0, 1, 1};
  EXPECT_THAT(refusal(black), HasSubstr("'Lamp' (its emissive picture is black on its surface)"));

  Gltf unreadable = lit(whole);
  unreadable.at("/images/0")["bufferView"] = 0;
  EXPECT_THAT(refusal(unreadable), HasSubstr("'Lamp' would shine without its emissive picture"));
}

/// A pane shines in proportion to its alpha. If alpha varies over the mesh, it is refused, as all of the mesh would
/// shine.
TEST_F(GltfSurfaces, ShineAsFarAsTheyCover) {
  Gltf gltf = textured();
  gltf.at("/materials/1")["alphaMode"] = "BLEND";
  const glm::dvec3 whole = read(gltf).lights.at(0).radiance;
  gltf.at("/materials/1")["pbrMetallicRoughness"]["baseColorFactor"] = {1, 1, 1, 0.75};
  EXPECT_LT(glm::distance(read(gltf).lights.at(0).radiance, 0.75 * whole), 1e-12);
  gltf.at("/materials/1/pbrMetallicRoughness")["baseColorTexture"] = {{"index", 0}};
  gltf.at("/meshes/1/primitives/0/attributes")["TEXCOORD_0"] = gltf.add_floats("VEC2", {0, 1, 1, 1, 0, 0, 1, 0});
  EXPECT_THAT(refusal(gltf), HasSubstr("'Lamp' is emissive and lets light through in places"));
}

/// Custom properties of an object, or of its mesh, hold settings that glTF cannot express.
TEST_F(GltfSurfaces, ExtrasSayWhoCastsAndReceives) {
  Gltf gltf;
  gltf.at("/meshes/0")["extras"] = {{"castsShadow", 0}, {"receivesShadow", false}};
  gltf.at("/nodes/0")["extras"] = {{"receivesShadow", true}, {"unknown", "word"}};
  const Scene scene = read(gltf);
  EXPECT_FALSE(scene.objects[0].casts_shadow);
  EXPECT_TRUE(scene.objects[0].receives_shadow) << "properties of the object override those of its mesh";
  EXPECT_TRUE(scene.objects[1].casts_shadow);
  gltf.at("/nodes/1")["extras"] = {{"body", false}};
  const Scene bodiless = read(gltf);
  ASSERT_EQ(bodiless.objects.size(), 1u);
  EXPECT_EQ(bodiless.lights.size(), 1u);
  EXPECT_EQ(bodiless.soup.triangles.size(), 1u);
  EXPECT_EQ(bodiless.soup.positions.size(), 3u);
  gltf.at("/nodes/1/extras/body") = "human";  // a property of another tool
  const Scene foreign = read(gltf);
  EXPECT_EQ(foreign.objects.size(), 2u);
  EXPECT_THAT(foreign.warnings, Contains(AllOf(HasSubstr("'Lamp'"), HasSubstr("\"body\" of another tool"))));
}

/// Extras of cameras and spot lamps hold settings that glTF cannot express.
TEST_F(GltfSurfaces, ExtrasShiftLensesAndSmoothCones) {
  Gltf gltf;
  gltf.at("/cameras/0")["extras"] = {{"shift", {0.25, -1}}};
  EXPECT_EQ(read(gltf).cameras.at(0).shift, glm::dvec2(0.25, -1));
  gltf.at("/cameras/0/extras/shift") = {0.25};
  EXPECT_THAT(read(gltf).warnings, Contains(HasSubstr("'Camera' has extras \"shift\" of another tool")));
  gltf.at("/cameras/0/extras/shift") = {0.25, 1e9};
  EXPECT_THAT(test::input_error([&] { read_scene(write("scene.glb", gltf.glb())); }), HasSubstr("the shift is"));
  gltf.at("/cameras/0").erase("extras");
  gltf.document["extensions"] = {
      {"KHR_lights_punctual",
       {{"lights",
         {{{"type", "spot"}, {"spot", nlohmann::json::object()}, {"extras", {{"radius", 1}, {"smooth", 1}}}}}}}}};
  gltf.at("/nodes/2")["extensions"] = {{"KHR_lights_punctual", {{"light", 0}}}};
  EXPECT_TRUE(std::get<Sphere>(read(gltf).lights.at(1).shape).cone->smooth);
  gltf.at("/extensions/KHR_lights_punctual/lights/0/extras/smooth") = 0.5;
  EXPECT_THAT(read(gltf).warnings, Contains(HasSubstr("extras \"smooth\" of another tool")));
}

TEST_F(GltfSurfaces, CamerasHaveTheirShape) {
  Gltf gltf;
  EXPECT_EQ(read(gltf).cameras[0].aspect, 1.7777);
  gltf.at("/cameras/0") = {{"type", "orthographic"},
                           {"orthographic", {{"xmag", 4}, {"ymag", 3}, {"znear", 0}, {"zfar", 9}}}};
  const Scene scene = read(gltf);
  ASSERT_EQ(scene.cameras.size(), 1u) << "the orthographic camera must not be replaced";
  EXPECT_EQ(scene.cameras[0].height, 6);
  EXPECT_DOUBLE_EQ(*scene.cameras[0].aspect, 4.0 / 3);
}

}  // namespace
}  // namespace penumbra::scenes
