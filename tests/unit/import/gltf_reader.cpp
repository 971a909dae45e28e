// SPDX-License-Identifier: Apache-2.0
#include "scenes/formats/gltf_reader.hpp"

#include "mesh/import.hpp"
#include "scenes/formats/reader.hpp"
#include "tests/unit/import/gltf_reader.hpp"

#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <limits>

namespace penumbra::scenes {
namespace {

using nlohmann::json;
using test::bytes_of;
using test::Gltf;
using ::testing::Contains;
using ::testing::HasSubstr;

TEST_F(GltfReader, ReadsWhatBlenderWrites) {
  Gltf gltf;
  const Scene scene = read(gltf);
  EXPECT_EQ(scene.name, "scene.glb");
  EXPECT_THAT(scene.warnings, ::testing::IsEmpty());
  ASSERT_EQ(scene.objects.size(), 2u);
  EXPECT_EQ(scene.objects[0].name, "Body");
  EXPECT_EQ(scene.objects[0].color, glm::dvec3(0.8, 0.4, 0.2));
  EXPECT_EQ(scene.objects[0].emits, std::nullopt);
  EXPECT_EQ(scene.objects[1].name, "Lamp");
  EXPECT_EQ(scene.objects[1].emits, 0u);
  EXPECT_EQ(scene.soup.object, (std::vector<std::uint32_t>{0, 1, 1}));
  EXPECT_EQ(scene.soup.source_face, (std::vector<std::uint32_t>{0, 0, 1}));
  EXPECT_EQ(corners(scene, 0), (std::vector<glm::dvec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));

  ASSERT_EQ(scene.lights.size(), 1u);
  EXPECT_EQ(scene.lights[0].name, "Lamp");
  EXPECT_EQ(scene.lights[0].radiance, glm::dvec3(20, 10, 0));
  EXPECT_TRUE(scene.lights[0].two_sided);
  const auto& lamp = std::get<Rectangle>(scene.lights[0].shape);
  EXPECT_EQ(lamp.center, glm::dvec3(0, 5, 0));
  EXPECT_EQ(glm::cross(lamp.half_u, lamp.half_v), glm::dvec3(0, 1, 0));  // an unturned plane shines upward

  ASSERT_EQ(scene.cameras.size(), 1u);
  const Camera& camera = scene.cameras[0];
  EXPECT_EQ(camera.name, "Camera");
  EXPECT_EQ(camera.eye, glm::dvec3(1, 2, 8));
  // Turned by 90° about Y, −Z becomes −X.
  EXPECT_LT(glm::distance(camera.target - camera.eye, glm::dvec3(-1, 0, 0)), 1e-15);
  EXPECT_LT(glm::distance(camera.up, glm::dvec3(0, 1, 0)), 1e-15);
  EXPECT_NEAR(camera.vertical_fov, 39.5978, 1e-4);  // Blender's 50 mm lens
}

TEST_F(GltfReader, ComposesTransformsInDouble) {
  Gltf gltf;
  gltf.at("/scenes/0/nodes") = {1, 2, 3};
  gltf.at("/nodes").push_back({{"name", "Parent"}, {"children", {0}}, {"translation", {16777217, 0, 0}}});
  gltf.at("/nodes/0")["matrix"] = {2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 0.5, 0, 0, 1};
  const Scene scene = read(gltf);
  EXPECT_THAT(scene.soup.positions, Contains(glm::dvec3(16777219.5, 0, 0)));
}

TEST_F(GltfReader, AMirrorKeepsTheFrontInFront) {
  for (const double sign : {1.0, -1.0}) {
    Gltf gltf;
    gltf.at("/nodes/1")["scale"] = {sign, 1, 1};
    gltf.at("/materials/1")["doubleSided"] = false;
    const Scene scene = read(gltf);
    const auto& lamp = std::get<Rectangle>(scene.lights[0].shape);
    // glTF 2.0, 3.7.4: a negative determinant turns the winding's sense, so that a mirrored lamp shines up as before.
    EXPECT_EQ(glm::cross(lamp.half_u, lamp.half_v), glm::dvec3(0, 1, 0));
    EXPECT_FALSE(scene.lights[0].two_sided);
    const auto c = corners(scene, 1);
    EXPECT_GT(glm::cross(c[1] - c[0], c[2] - c[0]).y, 0);
  }
}

TEST_F(GltfReader, ReadsStripsFansAndUnindexedTriangles) {
  // A strip and a fan over the lamp's plane; both are two triangles of the same square.
  for (const auto& [mode, indices] :
       {std::pair<int, std::array<std::uint16_t, 4>>{5, {0, 1, 2, 3}}, {6, {0, 1, 3, 2}}}) {
    Gltf gltf;
    const std::size_t view = gltf.add_view(bytes_of(indices[0], indices[1], indices[2], indices[3]));
    gltf.at("/accessors/3") = {{"bufferView", view}, {"componentType", 5123}, {"count", 4}, {"type", "SCALAR"}};
    gltf.at("/meshes/1/primitives/0/mode") = mode;
    const Scene scene = read(gltf);
    ASSERT_EQ(scene.soup.triangles.size(), 3u);
    const auto& lamp = std::get<Rectangle>(scene.lights.at(0).shape);
    EXPECT_EQ(glm::cross(lamp.half_u, lamp.half_v), glm::dvec3(0, 1, 0)) << "mode " << mode;
  }
  Gltf gltf;
  gltf.at("/meshes/0/primitives/0").erase("indices");
  gltf.at("/meshes/0/primitives").push_back({{"attributes", {{"POSITION", 0}}}, {"mode", 1}});
  const Scene scene = read(gltf);
  EXPECT_EQ(corners(scene, 0), (std::vector<glm::dvec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  EXPECT_THAT(scene.warnings, Contains("1 primitives of points or lines skipped"));
}

TEST_F(GltfReader, ReadsEveryKindOfAccessor) {
  Gltf gltf;
  // Normalized shorts at a stride of 8 bytes (KHR_mesh_quantization), one vertex replaced by a sparse entry.
  const std::int16_t o = 0, i = 32767, pad = 99;
  const std::size_t view = gltf.add_view(bytes_of(o, o, o, pad, i, o, o, pad, o, std::int16_t{-32768}, o, pad));
  gltf.at("/bufferViews")[view]["byteStride"] = 8;
  const std::size_t places = gltf.add_view(bytes_of(std::uint8_t{0})), values = gltf.add_view(bytes_of(o, o, i));
  gltf.at("/accessors/0") = {{"bufferView", view},
                             {"componentType", 5122},
                             {"normalized", true},
                             {"count", 3},
                             {"type", "VEC3"},
                             {"sparse",
                              {{"count", 1},
                               {"indices", {{"bufferView", places}, {"componentType", 5121}}},
                               {"values", {{"bufferView", values}}}}}};
  const std::size_t bytes = gltf.add_view(bytes_of(std::uint8_t{2}, std::uint8_t{0}, std::uint8_t{1}));
  gltf.at("/accessors/1") = {{"bufferView", bytes}, {"componentType", 5121}, {"count", 3}, {"type", "SCALAR"}};
  EXPECT_EQ(corners(read(gltf), 0), (std::vector<glm::dvec3>{{0, -1, 0}, {0, 0, 1}, {1, 0, 0}}));  // not below −1
}

TEST_F(GltfReader, EmissiveMeshesThatAreNotFlatAreLightsInPieces) {
  Gltf gltf;
  gltf.at("/meshes/0/primitives/0/material") = 1;  // the triangle becomes a polygon light
  const std::size_t view = gltf.add_view(bytes_of(0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 1.f, 1.f, 0.1f, 0.f, 1.f, 0.f));
  gltf.at("/accessors").push_back({{"bufferView", view}, {"componentType", 5126}, {"count", 4}, {"type", "VEC3"}});
  gltf.at("/meshes").push_back(
      {{"primitives", {{{"attributes", {{"POSITION", 4}}}, {"indices", 3}, {"material", 1}}}}});
  gltf.at("/nodes").push_back({{"name", "Bent"}, {"mesh", 2}});
  gltf.at("/scenes/0/nodes").push_back(3);
  EXPECT_THAT(refusal(gltf), ::testing::AllOf(HasSubstr("'Bent' is an emitter with parts that shadow one another"),
                                              HasSubstr("--lenient")));
  ReadOptions lenient;
  lenient.lenient = true;
  const Scene scene = read_gltf(write("scene.glb", gltf.glb()), lenient);
  EXPECT_EQ(scene.objects.size(), 3u);
  ASSERT_EQ(scene.lights.size(), 3u);
  EXPECT_TRUE(std::holds_alternative<Polygon>(scene.lights[0].shape));
  EXPECT_EQ(scene.objects[2].emits, 2u);
  EXPECT_EQ(scene.lights[2].name, "Bent");
  EXPECT_EQ(std::get<Pieces>(scene.lights[2].shape).pieces.size(), 2u);
  EXPECT_TRUE(scene.lights[2].two_sided);
  EXPECT_THAT(scene.warnings, Contains(HasSubstr("'Bent' is an emitter with parts that shadow one another")));
}

TEST_F(GltfReader, EmissiveMeshesThatAreNoAreaLightStayGeometry) {
  Gltf gltf;
  const std::size_t view = gltf.add_view(bytes_of(0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 2.f, 0.f, 0.f, 3.f, 0.f, 0.f));
  gltf.at("/accessors").push_back({{"bufferView", view}, {"componentType", 5126}, {"count", 4}, {"type", "VEC3"}});
  gltf.at("/meshes").push_back(
      {{"primitives", {{{"attributes", {{"POSITION", 4}}}, {"indices", 3}, {"material", 1}}}}});
  gltf.at("/nodes").push_back({{"name", "Thread"}, {"mesh", 2}});
  gltf.at("/scenes/0/nodes").push_back(3);
  EXPECT_THAT(refusal(gltf),
              ::testing::AllOf(HasSubstr("'Thread'"), HasSubstr("it has no area"), HasSubstr("--lenient")));
  ReadOptions lenient;
  lenient.lenient = true;
  const Scene scene = read_gltf(write("scene.glb", gltf.glb()), lenient);
  EXPECT_EQ(scene.objects.size(), 3u);
  ASSERT_EQ(scene.lights.size(), 1u);
  EXPECT_EQ(scene.objects[2].emits, std::nullopt);
  EXPECT_THAT(scene.warnings,
              Contains("'Thread' is emissive, but no area light, because it has no area; it would be plain geometry"));
}

TEST_F(GltfReader, NamesAreUniqueAndHarmless) {
  Gltf gltf;
  gltf.at("/nodes/0/name") = "Lamp\x1b[31m";
  gltf.at("/nodes").push_back({{"name", "Lamp"}, {"mesh", 1}, {"translation", {0, 7, 0}}});
  gltf.at("/scenes/0/nodes").push_back(3);
  const Scene scene = read(gltf);
  EXPECT_EQ(scene.objects[0].name, "Lamp\\x1b[31m");
  EXPECT_EQ(scene.lights[0].name, "Lamp");
  EXPECT_EQ(scene.lights[1].name, "Lamp.2");
}

TEST_F(GltfReader, WhatHasNoCameraOrLightIsSeenAndLit) {
  Gltf gltf;
  gltf.at("/scenes/0/nodes") = {0, 1};
  const Scene scene = read_scene(write("scene.glb", gltf.glb()));
  EXPECT_EQ(scene.lights.size(), read(gltf).lights.size());
  ASSERT_EQ(scene.cameras.size(), 1u);
  EXPECT_THAT(scene.warnings, Contains(HasSubstr("there is no camera")));
  const Camera& camera = scene.cameras[0];
  const glm::dvec3 forward = glm::normalize(camera.target - camera.eye);
  for (const glm::dvec3& p : scene.soup.positions) {  // all of it is in the picture
    EXPECT_GT(glm::dot(glm::normalize(p - camera.eye), forward), std::cos(camera.vertical_fov / 2 * M_PI / 180));
  }
  gltf.at("/scenes/0/nodes") = {0, 2};
  EXPECT_TRUE(read(gltf).lights.empty());
  const Scene lit = read_scene(write("scene.glb", gltf.glb()));
  ASSERT_EQ(lit.lights.size(), 1U);
  EXPECT_EQ(lit.lights[0].name, "studio");
}

TEST_F(GltfReader, BuffersMayBeExternalButNotOutside) {
  Gltf gltf;
  std::filesystem::create_directory(folder_ / "inner");
  write("outside.bin", gltf.data);
  write("inner/my data.bin", gltf.data);
  const auto with_uri = [&](const std::string& uri) {
    gltf.at("/buffers/0") = {{"byteLength", gltf.data.size()}, {"uri", uri}};
    return write("inner/scene.gltf", gltf.document.dump());
  };
  EXPECT_EQ(read_gltf(with_uri("my%20data.bin")).soup.triangles.size(), 3u);
  const auto path = with_uri("../outside.bin");
  EXPECT_THAT(test::input_error([&] { read_gltf(path); }), HasSubstr("outside its folder"));
  EXPECT_EQ(read_gltf(path, {.allow_outside = true}).soup.triangles.size(), 3u);
  std::filesystem::create_symlink(folder_ / "outside.bin", folder_ / "inner/link.bin");
  const auto link = with_uri("link.bin");
  EXPECT_THAT(test::input_error([&] { read_gltf(link); }), HasSubstr("outside its folder"));
  const auto missing = with_uri("missing.bin");
  EXPECT_THAT(test::input_error([&] { read_gltf(missing); }), HasSubstr("missing.bin"));
}

TEST_F(GltfReader, RefusesWhatDoesNotFitWithItsPlace) {
  const auto expect = [&](auto change, const std::string& what) {
    Gltf gltf;
    change(gltf);
    EXPECT_THAT(refusal(gltf), HasSubstr(what));
  };
  expect([](Gltf& g) { g.at("/accessors/0/count") = 4; }, "/accessors/0: 4 elements of 12 bytes");
  expect([](Gltf& g) { g.at("/accessors/0/count") = 400000000000; }, "/accessors/0: 400000000000 elements");
  expect([](Gltf& g) { g.at("/accessors/0/byteOffset") = 18446744073709551600u; }, "/accessors/0");
  expect([](Gltf& g) { g.at("/accessors/0/type") = "VEC2"; }, "/accessors/0: positions must be of type VEC3");
  expect([](Gltf& g) { g.at("/accessors/1/componentType") = 5126; }, "/accessors/1: indices have componentType 5126");
  expect([](Gltf& g) { g.at("/accessors/0/bufferView") = 9; }, "/accessors/0: bufferView 9 does not exist");
  expect([](Gltf& g) { g.at("/bufferViews/0/byteLength") = 4000; }, "/bufferViews/0: bytes 0 to 4000");
  expect([](Gltf& g) { g.at("/bufferViews/0/byteStride") = 8; }, "/bufferViews/0: byteStride 8");
  expect([](Gltf& g) { g.at("/bufferViews/0/buffer") = 3; }, "/bufferViews/0: buffer 3 does not exist");
  expect([](Gltf& g) { g.at("/meshes/0/primitives/0/attributes/POSITION") = 9; }, "/accessors/9: it does not exist");
  expect([](Gltf& g) { g.at("/meshes/0/primitives/0/indices") = 3; }, "names vertex 3, but there are only 3");
  expect([](Gltf& g) { g.at("/meshes/0/primitives/0/material") = 7; }, "material 7 does not exist");
  expect([](Gltf& g) { g.at("/nodes/0/mesh") = 5; }, "/nodes/0/mesh: mesh 5 does not exist");
  expect([](Gltf& g) { g.at("/nodes/0/children") = {0}; }, "/nodes/0: it has two parents or is its own ancestor");
  expect([](Gltf& g) { g.at("/nodes/0")["skin"] = 7; }, "/skins/7: it does not exist; there are 0");
  expect([](Gltf& g) { g.at("/nodes/0/children") = {77}; }, "/nodes/77: it does not exist");
  expect([](Gltf& g) { g.at("/nodes/0/matrix") = {1, 2, 3}; }, "/nodes/0/matrix: 3 numbers; expected 16");
  expect([](Gltf& g) { g.at("/nodes/0/rotation") = {0, 0, 0, 0}; }, "/nodes/0/rotation");
  expect([](Gltf& g) { g.at("/scene") = 4; }, "/scene: scene 4 does not exist");
  expect([](Gltf& g) { g.at("/cameras/0/perspective/yfov") = 4; }, "/cameras/0/perspective/yfov");
  expect([](Gltf& g) { g.at("/materials/1/emissiveFactor") = {-1, 0, 0}; }, "/materials/1/emissiveFactor");
  expect([](Gltf& g) { g.at("/asset/version") = "1.0"; }, "glTF 1.0 is not supported");
  expect([](Gltf& g) { g.document["extensionsRequired"] = {"EXT_meshopt_compression"}; }, "export without compression");
  expect([](Gltf& g) { g.data.replace(4, 4, bytes_of(std::numeric_limits<float>::infinity())); },
         "/meshes/0/primitives/0/attributes/POSITION: vertex 0 is not finite: (0, inf, 0)");
  expect(
      [](Gltf& g) {
        g.at("/nodes/0")["scale"] = {1e308, 1e308, 1e308}, g.at("/nodes/0")["translation"] = {1e308, 0, 0};
      },
      "not finite after the transform of /nodes/0");
}

/// 3 · 6148914691236517206 is 2 modulo 2⁶⁴, and 4 · 2⁶² is 0: the entries that sparse data then replace must exist.
TEST_F(GltfReader, CountsThatOverflowAreRefused) {
  const auto with_sparse = [](Gltf& gltf, std::size_t accessor, std::uint64_t count, const char* type) {
    const std::size_t places = gltf.add_view(bytes_of(std::uint32_t{100000})),
                      values = gltf.add_view(bytes_of(1.f, 2.f, 3.f, 4.f));
    gltf.at("/accessors")[accessor] = {{"componentType", 5126},
                                       {"count", count},
                                       {"type", type},
                                       {"sparse",
                                        {{"count", 1},
                                         {"indices", {{"bufferView", places}, {"componentType", 5125}}},
                                         {"values", {{"bufferView", values}}}}}};
  };
  Gltf positions;
  with_sparse(positions, 0, 6148914691236517206u, "VEC3");
  EXPECT_THAT(refusal(positions), HasSubstr("/accessors/0/count: 6148914691236517206 elements"));
  Gltf colors;
  with_sparse(colors, 4, 4611686018427387904u, "VEC4");
  colors.at("/meshes/0/primitives/0/attributes")["COLOR_0"] = 4;
  EXPECT_THAT(refusal(colors), HasSubstr("/accessors/4/count: 4611686018427387904 elements"));
}

TEST_F(GltfReader, ExtensionsThatItRequiresAreUnderstoodOrRefused) {
  Gltf gltf;
  gltf.document["extensionsUsed"] = {"KHR_materials_emissive_strength", "EXT_unheard_of", "KHR_materials_variants",
                                     "EXT_other", "EXT_one_more"};
  gltf.document["extensionsRequired"] = {"KHR_materials_emissive_strength", "EXT_unheard_of", "KHR_materials_variants"};
  EXPECT_THAT(refusal(gltf), HasSubstr("'EXT_unheard_of' is an extension that the file requires"));
  ReadOptions lenient;
  lenient.lenient = true;
  const Scene scene = read_gltf(write("scene.glb", gltf.glb()), lenient);
  EXPECT_THAT(scene.warnings,
              ::testing::ElementsAre(HasSubstr("'EXT_unheard_of'"), "extensions ignored: EXT_other, EXT_one_more"));
  gltf.document["extensionsRequired"] = {"KHR_materials_variants", "KHR_materials_unlit", "KHR_audio"};
  EXPECT_THAT(read(gltf).lights, ::testing::SizeIs(1)) << "extensions that do not change the light may be required";
  gltf.document["extensionsUsed"] = {"EXT_lights_ies"};
  gltf.document.erase("extensionsRequired");
  EXPECT_THAT(refusal(gltf), HasSubstr("'EXT_lights_ies' is an extension that shapes the light of lamps"));
  gltf.document["extensionsUsed"] = {"EXT_lights_image_based"};
  gltf.document.erase("extensionsRequired");
  EXPECT_THAT(refusal(gltf), HasSubstr("'EXT_lights_image_based' is an extension that lights the scene"));
}

TEST_F(GltfReader, AMemoryBombCostsAMessage) {
  Gltf gltf;  // an accessor without a buffer view is all zeros: the file is small, the mesh is not
  gltf.at("/accessors/0") = {{"componentType", 5126}, {"count", 3000000000u}, {"type", "VEC3"}};
  const std::string message = refusal(gltf);
#if !defined(PENUMBRA_SHADOW_MEMORY)  // ASan ends the helper before it can report this
  EXPECT_THAT(message, HasSubstr("needs more than 4 GiB of memory"));
#endif
}

TEST_F(GltfReader, ADeepNestCostsAMessage) {
  const std::string deep(1000000, '[');
  const auto open = write("deep.gltf", R"({"asset":{"version":"2.0"},"extras":)" + deep);
  EXPECT_THAT(test::input_error([&] { read_gltf(open); }), HasSubstr(open.string()));
  const auto closed =
      write("deep2.gltf", R"({"asset":{"version":"2.0"},"extras":)" + deep + std::string(deep.size(), ']') + "}");
  EXPECT_THAT(test::input_error([&] { read_gltf(closed); }), HasSubstr(closed.string()));
}

TEST_F(GltfReader, EveryTruncationAndManyFlipsAreRefusedOrRead) {
  Gltf gltf;
  const std::string whole = gltf.glb();
  for (std::size_t length = 0; length < whole.size(); length += 37) {
    const auto path = write("cut.glb", whole.substr(0, length));
    EXPECT_THAT(test::input_error([&] { read_gltf(path); }), HasSubstr(path.string()));
  }
  for (std::size_t at = 0; at < whole.size(); at += 23) {
    std::string flipped = whole;
    flipped[at] = static_cast<char>(flipped[at] ^ 0x14);
    const auto path = write("flip.glb", flipped);
    try {
      read_gltf(path);  // the result may be any scene or message, but nothing else
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr(path.string()));
      EXPECT_THAT(error.what(), ::testing::Not(HasSubstr("crashed"))) << "byte " << at;
    }
  }
}

/// One reader reads glTF files for scenes and for meshes: for every file of a corpus the two results agree.
TEST(GltfCorpus, AsAMeshAndAsASceneAreOne) {
  int files = 0, read = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator("/usr/share/assimp/models")) {
    const auto extension = entry.path().extension();
    if (extension != ".gltf" && extension != ".glb") continue;
    ++files;
    SCOPED_TRACE(entry.path().string());
    std::string as_scene, as_mesh;
    std::vector<mesh::Triangle> of_scene, of_mesh;
    try {
      of_scene = read_gltf(entry.path(), {.needs_light = false}).soup.triangles;
    } catch (const InputError& error) {
      as_scene = error.what();
    }
    try {
      of_mesh = mesh::import_mesh(entry.path()).soup.triangles;
    } catch (const InputError& error) {
      as_mesh = error.what();
    }
    EXPECT_EQ(as_scene, as_mesh);
    EXPECT_EQ(of_scene, of_mesh);
    read += as_scene.empty() ? 1 : 0;
  }
  EXPECT_GT(files, 40);
  EXPECT_GT(read, 20);
}

}  // namespace
}  // namespace penumbra::scenes
