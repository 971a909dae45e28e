// SPDX-License-Identifier: Apache-2.0
// Tests FBX and COLLADA files as scenes: nodes, materials, lamps, cameras; and formats that are not read.
#include "scenes/formats/reader.hpp"

#include "tests/unit/mesh/import_files.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <string_view>
#include <variant>

namespace penumbra::scenes {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

class ForeignScenes : public test::FileTest {
 protected:
  static const AreaLight& light(const Scene& scene, const std::string& name) {
    return *std::ranges::find(scene.lights, name, &AreaLight::name);
  }
};

/// A COLLADA file with a unit square in the XY plane, whose material is `effect`, and the further `nodes` of the scene.
std::string collada(const std::string& effect, const std::string& libraries, const std::string& nodes,
                    const std::string& tool = "Maya") {
  return fmt::format(
      R"(<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><contributor><authoring_tool>{}</authoring_tool></contributor><up_axis>Y_UP</up_axis></asset>
<library_effects><effect id="e"><profile_COMMON><technique sid="c"><lambert>{}</lambert></technique></profile_COMMON></effect></library_effects>
<library_materials><material id="m" name="Paint"><instance_effect url="#e"/></material></library_materials>
<library_geometries><geometry id="g" name="g"><mesh>
<source id="p"><float_array id="pa" count="12">0 0 0 1 0 0 1 1 0 0 1 0</float_array><technique_common><accessor source="#pa" count="4" stride="3"><param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="2" material="m"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2 0 2 3</p></triangles></mesh></geometry></library_geometries>
{}
<library_visual_scenes><visual_scene id="s">
<node id="Card" name="Card"><translate>0 0 -5</translate><instance_geometry url="#g"><bind_material><technique_common><instance_material symbol="m" target="#m"/></technique_common></bind_material></instance_geometry></node>
{}</visual_scene></library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>)",
      tool, effect, libraries, nodes);
}

constexpr const char* kLamps = R"(<library_lights>
<light id="b"><technique_common><point><color>8 4 2</color></point></technique_common></light>
<light id="d"><technique_common><directional><color>3 3 3</color></directional></technique_common></light></library_lights>
<library_cameras><camera id="c"><optics><technique_common><perspective><xfov>90</xfov><aspect_ratio>2</aspect_ratio></perspective></technique_common></optics></camera></library_cameras>)";
constexpr const char* kLampNodes =
    R"(<node id="Bulb" name="Bulb"><translate>1 2 3</translate><instance_light url="#b"/></node>
<node id="Sun" name="Sun"><rotate>1 0 0 -90</rotate><instance_light url="#d"/></node>
<node id="Shot" name="Shot"><translate>0 1 9</translate><instance_camera url="#c"/></node>)";

TEST_F(ForeignScenes, ColladaHasColoursLampsAndCameras) {
  const auto file = write("scene.dae", collada("<diffuse><color>0.5 0.25 1 1</color></diffuse>", kLamps, kLampNodes));
  ReadOptions options;
  options.lamp_radius = 0.5;
  options.sun_angle = 0;
  const Scene scene = read_scene(file, options);
  ASSERT_EQ(scene.objects.size(), 1u);
  EXPECT_EQ(scene.objects[0].name, "Card");
  EXPECT_EQ(scene.objects[0].material, "Paint");
  EXPECT_NEAR(glm::distance(scene.objects[0].color, glm::dvec3(0.5, 0.25, 1)), 0, 1e-6);
  EXPECT_EQ(scene.soup.positions[scene.soup.triangles[0][0]].z, -5);
  ASSERT_EQ(scene.lights.size(), 2u);
  const auto& bulb = std::get<Sphere>(light(scene, "Bulb").shape);
  EXPECT_EQ(bulb.center, glm::dvec3(1, 2, 3));
  EXPECT_EQ(bulb.radius, 0.5);
  // 8 candela from a sphere seen from afar: its radiance times π r².
  EXPECT_NEAR(light(scene, "Bulb").radiance.x * std::numbers::pi * 0.25, 8, 1e-6);
  EXPECT_NEAR(light(scene, "Bulb").radiance.z * std::numbers::pi * 0.25, 2, 1e-6);
  EXPECT_NEAR(glm::distance(std::get<Sun>(light(scene, "Sun").shape).direction, glm::dvec3(0, -1, 0)), 0, 1e-6);
  EXPECT_NEAR(light(scene, "Sun").radiance.x, 3, 1e-6);
  ASSERT_EQ(scene.cameras.size(), 1u);
  EXPECT_EQ(scene.cameras[0].name, "Shot");
  EXPECT_EQ(scene.cameras[0].eye, glm::dvec3(0, 1, 9));
  EXPECT_NEAR(scene.cameras[0].target.z, 8, 1e-6);
  EXPECT_NEAR(*scene.cameras[0].aspect, 2, 1e-6);
  EXPECT_NEAR(scene.cameras[0].vertical_fov, glm::degrees(2 * std::atan(0.5)), 1e-4);
  EXPECT_THAT(scene.warnings, Contains(HasSubstr("2 lamps have no size in such files")));

  std::string vertical = kLamps;
  for (std::size_t at; (at = vertical.find("xfov")) != std::string::npos;) vertical[at] = 'y';
  const Scene upright = read_scene(write("y.dae", collada("", vertical, kLampNodes)), options);
  EXPECT_NEAR(upright.cameras.at(0).vertical_fov, 90, 1e-4);
  EXPECT_NEAR(*upright.cameras[0].aspect, 2, 1e-6);

  // Blender gives watts: a point lamp's candela are its watts / 4π.
  const Scene blenders = read_scene(
      write("b.dae", collada("<diffuse><color>1 1 1 1</color></diffuse>", kLamps, kLampNodes, "Blender 3.4.1")),
      options);
  EXPECT_NEAR(light(blenders, "Bulb").radiance.x * std::numbers::pi * 0.25, 8 / (4 * std::numbers::pi), 1e-6);
  EXPECT_NEAR(light(blenders, "Sun").radiance.x, 3, 1e-6);
}

TEST_F(ForeignScenes, EmissiveMeshesAreLights) {
  const Scene scene = read_scene(write("scene.dae", collada("<emission><color>4 2 1 1</color></emission>", "", "")));
  ASSERT_EQ(scene.lights.size(), 1u);
  EXPECT_EQ(scene.lights[0].name, "Card");
  EXPECT_NEAR(glm::distance(scene.lights[0].radiance, glm::dvec3(4, 2, 1)), 0, 1e-6);
  EXPECT_TRUE(std::holds_alternative<Rectangle>(scene.lights[0].shape));
  EXPECT_EQ(scene.objects.at(0).emits, 0u);

  std::string bent = collada("<emission><color>4 2 1 1</color></emission>", "", "");
  bent.replace(bent.find("1 1 0 0 1 0"), 5, "1 1 1");  // into two triangles, each of which shines at the other's back
  const auto file = write("bent.dae", bent);
  EXPECT_THAT(test::input_error([&] { read_scene(file); }),
              HasSubstr("'Card' is an emitter with parts that shadow one another"));
  ReadOptions lenient;
  lenient.lenient = true;
  const Scene bright = read_scene(file, lenient);
  EXPECT_EQ(std::get<Pieces>(bright.lights.at(0).shape).pieces.size(), 2u);
  EXPECT_THAT(bright.warnings, Contains(HasSubstr("'Card' is an emitter with parts")));
}

/// Assimp gives a mesh without a material the file's first one. Only a symbol that is the id of a material counts as
/// one.
TEST_F(ForeignScenes, MeshesWithoutMaterialsAreGreyAndDark) {
  std::string text =
      collada("<emission><color>4 2 1 1</color></emission><diffuse><color>1 0 0 1</color></diffuse>", "",
              R"(<node id="Bare" name="Bare"><translate>0 0 3</translate><instance_geometry url="#g"/></node>)");
  for (const char* word : {R"(material id="m")", R"(target="#m")"}) {
    const std::size_t at = text.find(word) + std::string_view(word).size() - 2;
    ASSERT_EQ(text.at(at), 'm');
    text[at] = 'z';
  }
  const Scene scene = read_scene(write("scene.dae", text));
  ASSERT_EQ(scene.lights.size(), 1u);
  EXPECT_EQ(scene.lights[0].name, "Card");
  const Object& bare = *std::ranges::find(scene.objects, "Bare", &Object::name);
  EXPECT_EQ(bare.emits, std::nullopt);
  EXPECT_NEAR(glm::distance(bare.color, glm::dvec3(0.8)), 0, 1e-6);
}

TEST_F(ForeignScenes, WhatCannotBeDoneIsRefusedByName) {
  const auto glass = write("glass.dae", collada("<diffuse><color>1 1 1 1</color></diffuse><transparent "
                                                "opaque=\"A_ONE\"><color>0 0 0 0.5</color></transparent>"
                                                "<transparency><float>1</float></transparency>",
                                                kLamps, kLampNodes));
  EXPECT_THAT(test::input_error([&] { read_scene(glass); }), HasSubstr("'Card' lets light through"));
  ReadOptions lenient;
  lenient.lenient = true;
  EXPECT_THAT(read_scene(glass, lenient).warnings, Contains(HasSubstr("'Card' lets light through")));
  const std::string flat =
      R"(<library_cameras><camera id="c"><optics><technique_common><orthographic><xmag>3</xmag></orthographic></technique_common></optics></camera></library_cameras>)";
  const auto orthographic = write("flat.dae", collada("<emission><color>1 1 1 1</color></emission>", flat,
                                                      R"(<node id="Shot"><instance_camera url="#c"/></node>)"));
  EXPECT_THAT(test::input_error([&] { read_scene(orthographic); }), HasSubstr("has an orthographic camera"));
}

TEST_F(ForeignScenes, WhatCannotBeDoneIsNamedWhereAStudioLights) {
  const std::string libraries = R"(<library_lights>
<light id="a"><technique_common><ambient><color>1 1 1</color></ambient></technique_common></light></library_lights>
<library_cameras><camera id="c"><optics><technique_common><orthographic><xmag>3</xmag></orthographic></technique_common></optics></camera></library_cameras>)";
  const std::string nodes = R"(<node id="Panel" name="Panel"><instance_light url="#a"/></node>
<node id="Shot" name="Shot"><translate>0 1 9</translate><instance_camera url="#c"/></node>)";
  const Scene scene = read_scene(write("dark.dae", collada("<diffuse><color>1 1 1 1</color></diffuse><transparent "
                                                           "opaque=\"A_ONE\"><color>0 0 0 0.5</color></transparent>"
                                                           "<transparency><float>1</float></transparency>",
                                                           libraries, nodes)));
  ASSERT_EQ(scene.lights.size(), 1u);
  EXPECT_TRUE(std::holds_alternative<Rectangle>(scene.lights[0].shape));
  EXPECT_EQ(scene.objects.size(), 2u);  // the card, and the floor
  EXPECT_EQ(scene.cameras.size(), 1u);
  EXPECT_THAT(scene.warnings, Contains(HasSubstr("'Card' lets light through")));
  EXPECT_THAT(scene.warnings, Contains(HasSubstr("'Panel' is an area lamp")));
  EXPECT_THAT(scene.warnings, Contains(HasSubstr("'dark.dae' has an orthographic camera")));
  EXPECT_THAT(scene.warnings, Contains(HasSubstr("a studio was put around it")));
}

/// Formats of which only meshes are read report materials that let light through.
TEST_F(ForeignScenes, SolidMaterialsOfMeshesAreNamed) {
  write("some library.mtl",
        "newmtl Glass\nKd 1 1 1\nd 0.3\nnewmtl Leaf\n map_d leaf.png\nnewmtl Wood\nd 1.0\nnewmtl Ghost\nTr 0.5\n");
  const std::string corners = "mtllib some library.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\n";
  const auto notes = [&](const char* name, const std::string& text) {
    return mesh::import_mesh(write(name, text)).notes;
  };
  EXPECT_THAT(notes("a.obj", corners + "usemtl Glass\nf 1 2 3\nusemtl Leaf\nf 3 2 1\nusemtl Wood\nf 1 3 2\n"),
              Contains(HasSubstr(
                  "materials that let light through, which is not supported for this format: 'Glass', 'Leaf';")));
  EXPECT_THAT(notes("c.obj", "mtllib .\nmtllib nowhere.mtl\n" + corners + "usemtl Glass\nf 1 2 3\n"),
              Contains(HasSubstr("'Glass'")))
      << "folders and missing files are ignored as libraries";
  EXPECT_THAT(notes("b.obj", corners + "usemtl Wood\nf 1 2 3\n"), Not(Contains(HasSubstr("light through"))));
  const std::string shape = R"(<X3D><Scene><Shape><Appearance><Material DEF="Pane" transparency="{}"/></Appearance>
<IndexedFaceSet coordIndex="0 1 2 -1"><Coordinate point="0 0 0 1 0 0 0 1 0"/></IndexedFaceSet></Shape></Scene></X3D>)";
  EXPECT_THAT(notes("a.x3d", fmt::format(fmt::runtime(shape), 0.5)),
              Contains(HasSubstr("'Pane'; their surfaces are taken as solid")));
  EXPECT_THAT(notes("b.x3d", fmt::format(fmt::runtime(shape), 0)), Not(Contains(HasSubstr("light through"))));
}

TEST_F(ForeignScenes, LampsOfX3dMeshesAreNamed) {
  const auto notes = [&](const char* name, const std::string& lamps) {
    return mesh::import_mesh(write(name, "<X3D><Scene>" + lamps + R"(<Shape><IndexedFaceSet coordIndex="0 1 2 -1">
<Coordinate point="0 0 0 1 0 0 0 1 0"/></IndexedFaceSet></Shape></Scene></X3D>)"))
        .notes;
  };
  EXPECT_THAT(notes("lit.x3d", R"(<PointLight DEF="Key" location="0 3 0"/><Transform translation="1 0 0"><SpotLight/>
<DirectionalLight DEF="Off" on="false"/></Transform>)"),
              Contains(HasSubstr("lamps, which a mesh does not have: 'Key', 'SpotLight'; left out")));
  EXPECT_THAT(notes("unlit.x3d", R"(<DirectionalLight DEF="Off" on="false"/>)"), Not(Contains(HasSubstr("lamps"))));
}

TEST_F(ForeignScenes, UsdAndAlembicAreRefusedInOneLine) {
  for (const char* name : {"a.usd", "a.usda", "a.usdc", "a.USDZ", "a.abc"}) {
    const std::string said = test::input_error([&] { read_scene(write(name, "#usda 1.0")); });
    EXPECT_THAT(said, HasSubstr("is not read; export the scene as glTF 2.0 (.glb)"));
    EXPECT_EQ(said.find('\n'), std::string::npos);
  }
}

}  // namespace
}  // namespace penumbra::scenes
