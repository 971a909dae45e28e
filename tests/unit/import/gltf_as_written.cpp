// SPDX-License-Identifier: Apache-2.0
// Tests files as exporters write them: not strictly valid, or with extensions of the core, but read all the same.
#include "tests/unit/import/gltf_reader.hpp"

#include <glm/geometric.hpp>

#include <cmath>
#include <limits>
#include <numbers>

namespace penumbra::scenes {
namespace {

using nlohmann::json;
using test::bytes_of;
using test::Gltf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

std::string base64(const std::string& bytes) {
  constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t at = 0; at < bytes.size(); at += 3) {
    std::uint32_t group = 0;
    for (std::size_t i = 0; i < 3; ++i)
      group = group << 8 | (at + i < bytes.size() ? static_cast<unsigned char>(bytes[at + i]) : 0);
    for (std::size_t i = 0; i < 4; ++i) text += at + i <= bytes.size() ? kDigits[group >> (18 - 6 * i) & 63] : '=';
  }
  return text;
}

class GltfAsWritten : public GltfReader {
 protected:
  Scene read_text(Gltf& gltf) const { return read_gltf(write("scene.gltf", gltf.document.dump())); }
  std::string refusal_of_text(Gltf& gltf) const {
    const auto path = write("scene.gltf", gltf.document.dump());
    return test::input_error([&] { read_gltf(path); });
  }
};

/// A buffer may be longer than its byteLength, but not shorter.
TEST_F(GltfAsWritten, BuffersMayBeLongerThanTheySay) {
  Gltf gltf;
  const std::size_t size = gltf.data.size();
  write("long.bin", gltf.data + "and more");
  gltf.at("/buffers/0") = {{"byteLength", size}, {"uri", "long.bin"}};
  EXPECT_EQ(read_text(gltf).soup.triangles.size(), 3u);
  for (const char* type : {"application/octet-stream", "application/gltf-buffer", "", "application/x;charset=utf-8"}) {
    gltf.at("/buffers/0/uri") = fmt::format("data:{};base64,{}", type, base64(gltf.data + "and more"));
    EXPECT_EQ(read_text(gltf).soup.triangles.size(), 3u) << type;
  }
  // base64 broken into lines, as Python's encodebytes writes it, and with percent escapes.
  std::string lines = base64(gltf.data), percent = lines;
  lines.insert(20, "\n");
  for (std::size_t at = percent.find('A'); at < 60; at = percent.find('A', at + 1)) percent.replace(at, 1, "%41");
  for (const std::string& text : {lines, percent}) {
    gltf.at("/buffers/0/uri") = "data:application/octet-stream;base64," + text;
    EXPECT_EQ(read_text(gltf).soup.triangles.size(), 3u) << text;
  }
  // A plus sign does not stand for a space.
  write("a+b.bin", gltf.data);
  write("a b.bin", std::string(gltf.data.size(), '\0'));
  gltf.at("/buffers/0/uri") = "a+b.bin";
  EXPECT_EQ(read_text(gltf).soup.positions[1], glm::dvec3(1, 0, 0));
  write("short.bin", gltf.data.substr(0, size - 1));
  gltf.at("/buffers/0/uri") = "short.bin";
  EXPECT_THAT(refusal_of_text(gltf), HasSubstr("short.bin"));
}

/// A percent sign may begin no escape, or be part of the file's own name.
TEST_F(GltfAsWritten, PercentSignsOfNames) {
  Gltf gltf;
  Gltf moved;  // different content: the triangle's second vertex
  moved.data.replace(12, 4, bytes_of(2.f));
  const auto second = [&](const std::string& uri) {
    gltf.at("/buffers/0") = {{"byteLength", gltf.data.size()}, {"uri", uri}};
    return read_text(gltf).soup.positions[1].x;
  };
  write("100%.bin", gltf.data);
  EXPECT_EQ(second("100%.bin"), 1);
  EXPECT_EQ(second("100%25.bin"), 1);
  write("a+b 5%z.bin", gltf.data);
  EXPECT_EQ(second("a+b%205%z.bin"), 1) << "escapes next to a percent sign that begins none";
  write("50%20.bin", gltf.data);
  EXPECT_EQ(second("50%20.bin"), 1) << "the only file that the name can mean";
  write("50 .bin", moved.data);
  EXPECT_EQ(second("50%20.bin"), 2) << "the decoded name takes precedence over the literal one";
  EXPECT_EQ(second("50%2520.bin"), 1);
  gltf.at("/buffers/0/uri") = "none%.bin";
  EXPECT_THAT(refusal_of_text(gltf), HasSubstr("none%.bin"));
  write("100%.bin%00", gltf.data);
  gltf.at("/buffers/0/uri") = "50 .bin%00x";
  EXPECT_THAT(refusal_of_text(gltf), HasSubstr("50 .bin%00x"));
  // The same for pictures.
  write("75%.png", "no picture");
  Gltf painted;
  painted.document["images"] = {{{"uri", "75%.png"}}};
  painted.document["textures"] = {{{"source", 0}}};
  painted.at("/materials/0/pbrMetallicRoughness")["baseColorTexture"] = {{"index", 0}};
  EXPECT_THAT(read(painted).warnings, Contains(AllOf(HasSubstr("75%.png"), HasSubstr("Not a PNG file"))));
}

TEST_F(GltfAsWritten, LeastVersions) {
  Gltf gltf;
  gltf.at("/asset")["minVersion"] = "2.0";
  EXPECT_EQ(read(gltf).soup.triangles.size(), 3u);
  for (const json& least : {json("2.1"), json("3.0"), json("20"), json(3.0)}) {
    gltf.at("/asset")["minVersion"] = least;
    EXPECT_THAT(refusal(gltf), HasSubstr("/asset/minVersion: a reader of glTF ")) << least;
  }
  gltf.at("/asset")["version"] = "2.1";
  gltf.at("/asset").erase("minVersion");
  EXPECT_EQ(read(gltf).soup.triangles.size(), 3u) << "a file of version 2.1 without minVersion must be read";
}

/// A node with a matrix and separate parts is not valid; the matrix counts, as in three.js and Blender.
TEST_F(GltfAsWritten, MatricesBesideParts) {
  Gltf gltf;
  gltf.at("/nodes/0")["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 0, 0, 1};
  EXPECT_THAT(read(gltf).warnings, Not(Contains(HasSubstr("matrix"))));
  gltf.at("/nodes/0")["translation"] = {0, 7, 0};
  gltf.at("/nodes/2")["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  const Scene scene = read(gltf);
  EXPECT_EQ(scene.soup.positions[1], glm::dvec3(6, 0, 0));
  EXPECT_THAT(scene.warnings, Contains("'Body', 'Camera' has a matrix together with translation, rotation or scale, "
                                       "of which only the matrix is used"));
}

TEST_F(GltfAsWritten, NoMessageRepeatsADataUri) {
  Gltf gltf;
  const std::string secret(64, 'Q');
  gltf.at("/buffers/0") = {{"byteLength", gltf.data.size()}, {"uri", "data:application/octet-stream;base64," + secret}};
  EXPECT_THAT(refusal_of_text(gltf), Not(HasSubstr("QQQQQQQQ")));
  EXPECT_THAT(refusal_of_text(gltf), HasSubstr("/buffers/0/uri: 48 bytes; byteLength says"));
  gltf.at("/buffers/0/uri") = "data:text/plain," + secret;
  EXPECT_THAT(refusal_of_text(gltf), Not(HasSubstr("QQQQQQQQ")));
  const std::string text = gltf.document.dump();
  const auto cut_off = write("scene.gltf", text.substr(0, text.find(secret) + 60));
  EXPECT_THAT(test::input_error([&] { read_gltf(cut_off); }), Not(HasSubstr("QQQQQQQQ")));
  // A picture of a format that is not read is just not shown.
  for (const char* type : {"data:image/webp;base64,", "data:image/svg+xml,%3Csvg%3E"}) {
    Gltf painted;
    painted.document["images"] = {{{"uri", type + secret}}};
    painted.document["textures"] = {{{"source", 0}}};
    painted.at("/materials/0/pbrMetallicRoughness")["baseColorTexture"] = {{"index", 0}};
    const Scene scene = read(painted);
    EXPECT_THAT(scene.warnings, Contains(HasSubstr("is shown without its picture"))) << type;
    EXPECT_THAT(scene.warnings, Not(Contains(HasSubstr("QQQQQQQQ"))));
  }
}

/// Chunks that are not padded, padded without counting the padding, empty, or of an unknown type.
TEST_F(GltfAsWritten, ChunksOfGlbs) {
  Gltf gltf;
  gltf.data += "x";  // the size is not a multiple of four
  const std::size_t views = gltf.document["bufferViews"].size();
  gltf.at("/buffers/0")["byteLength"] = gltf.data.size();
  const std::string text = gltf.document.dump();
  const auto chunk = [](const std::string& type, const std::string& content) {
    return bytes_of(static_cast<std::uint32_t>(content.size())) + type + content;
  };
  const auto glb = [](const std::string& chunks) {
    return "glTF" + bytes_of(std::uint32_t{2}, static_cast<std::uint32_t>(12 + chunks.size())) + chunks;
  };
  const std::string binary("BIN\0", 4), padding(3, '\0');
  const auto triangles = [&](const std::string& bytes) {
    return read_gltf(write("scene.glb", bytes)).soup.triangles.size();
  };
  for (std::size_t spaces = 0; spaces < 4; ++spaces) {
    const std::string json_chunk = chunk("JSON", text + std::string(spaces, ' '));
    EXPECT_EQ(triangles(glb(json_chunk + chunk(binary, gltf.data))), 3u) << spaces;
    EXPECT_EQ(triangles(glb(json_chunk + chunk(binary, gltf.data) + padding)), 3u) << spaces;
    EXPECT_EQ(triangles(glb(json_chunk + chunk(binary, gltf.data + padding) + chunk("ABCD", "1234"))), 3u) << spaces;
  }
  std::string uncounted = chunk("JSON", text);
  uncounted.resize((uncounted.size() + 3) / 4 * 4, ' ');
  EXPECT_EQ(triangles(glb(uncounted + chunk(binary, gltf.data))), 3u);
  write("own.bin", gltf.data);
  gltf.at("/buffers/0")["uri"] = "own.bin";
  EXPECT_EQ(triangles(glb(chunk("JSON", gltf.document.dump()) + chunk(binary, ""))), 3u) << views;
  EXPECT_EQ(triangles(glb(chunk("JSON", gltf.document.dump()) + chunk("ABCD", "1234"))), 3u);
  EXPECT_EQ(triangles(glb(chunk("JSON", text + std::string((4 - text.size() % 4) % 4, ' ')) + chunk("ABCD", "1234") +
                          chunk(binary, gltf.data + padding))),
            3u)
      << "chunks of unknown types may be anywhere";
  const auto path = write("scene.glb", glb(chunk("BLOB", text)));
  EXPECT_THAT(test::input_error([&] { read_gltf(path); }), HasSubstr("first chunk is not its JSON"));
}

/// Exporters compute products in single precision: small deviations are no errors.
TEST_F(GltfAsWritten, SinglePrecisionIsNoFault) {
  Gltf gltf;
  gltf.at("/nodes/0")["matrix"] = {1, 0, 0, 0, 0, 1, 0, -1e-7, 0, 0, 1, 0, 5, 0, 0, 0.9999999};
  gltf.at("/materials/0/pbrMetallicRoughness/baseColorFactor") = {0.5, 0.5, 0.5, 1.0000001};
  gltf.at("/materials/0")["alphaMode"] = "BLEND";
  gltf.at("/nodes/2/rotation") = {0, 0.70711, 0, 0.70711};
  const Scene scene = read(gltf);
  EXPECT_EQ(scene.soup.positions[1], glm::dvec3(6, 0, 0));
  EXPECT_EQ(scene.objects[0].alpha.mode, Alpha::Mode::opaque);
  EXPECT_LT(std::abs(glm::length(scene.cameras[0].target - scene.cameras[0].eye) - 1), 1e-12);
  gltf.at("/nodes/0/matrix/15") = 0.5;
  EXPECT_THAT(refusal(gltf), HasSubstr("/nodes/0/matrix: its last row must be 0 0 0 1"));
}

/// Numbers that are not used may be anything; those of a triangle must be finite.
TEST_F(GltfAsWritten, NumbersThatAreNotFinite) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  Gltf gltf;
  auto& attributes = gltf.at("/meshes/0/primitives/0/attributes");
  attributes["NORMAL"] = gltf.add_floats("VEC3", {0, 0, 1, kNan, kNan, kNan, 0, 0, 1});
  attributes["POSITION"] = gltf.add_floats("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0, kNan, 0, 0});
  EXPECT_THAT(refusal(gltf), HasSubstr("NORMAL: 3 of them for 4 vertices"));
  attributes["NORMAL"] = gltf.add_floats("VEC3", {0, 0, 1, kNan, kNan, kNan, 0, 0, 1, 0, 0, 1});
  const Scene scene = read(gltf);
  ASSERT_EQ(scene.objects.size(), 2u);
  EXPECT_EQ(scene.looks.normals[1], glm::vec3(0)) << "no normal: the triangle is shaded flat";
  EXPECT_THAT(scene.warnings, Contains(HasSubstr("'Body' has normals that are not finite")));
  // Normals of a morph target do nothing if the mesh has none.
  Gltf morphing;
  morphing.at("/meshes/0/primitives/0")["targets"] = {{{"NORMAL", morphing.add_floats("VEC3", std::vector<float>(9))}}};
  morphing.at("/meshes/0")["weights"] = {1};
  EXPECT_EQ(read(morphing).soup.triangles.size(), 3u);
  attributes["POSITION"] = gltf.add_floats("VEC3", {0, 0, 0, kNan, 0, 0, 0, 1, 0, 0, 0, 0});
  EXPECT_THAT(refusal(gltf), HasSubstr("POSITION: vertex 1 is not finite: (nan, 0, 0)"));
}

/// An index of 2³² or more must not wrap around modulo 2³².
TEST_F(GltfAsWritten, IndicesBeyondThirtyTwoBits) {
  constexpr std::uint64_t kWhole = std::uint64_t{1} << 32;
  const auto expect = [&](auto change, const std::string& what) {
    Gltf gltf;
    gltf.document["textures"] = {{{"source", 0}}};
    gltf.at("/nodes/0")["extensions"] = {{"KHR_lights_punctual", {{"light", 0}}}};
    gltf.document["skins"] = {{{"joints", {0}}}};
    gltf.animate(0, "translation", {0, 1}, {0, 0, 0, 1, 1, 1});
    change(gltf);
    EXPECT_THAT(refusal(gltf), HasSubstr(what + ": 4294967296; expected a whole number"));
  };
  for (const char* place : {"/textures/0/source", "/skins/0/joints/0", "/animations/0/channels/0/target/node",
                            "/animations/0/samplers/0/input", "/nodes/0/extensions/KHR_lights_punctual/light"})
    expect([&](Gltf& gltf) { gltf.at(place) = kWhole; }, place);
}

TEST_F(GltfAsWritten, DracoWithACopyIsThatCopy) {
  Gltf gltf;
  gltf.at("/meshes/0/primitives/0")["extensions"] = {{"KHR_draco_mesh_compression", {{"bufferView", 0}}}};
  gltf.document["extensionsUsed"].push_back("KHR_draco_mesh_compression");
  EXPECT_EQ(read(gltf).soup.triangles.size(), 3u);
  gltf.at("/accessors/1").erase("bufferView");
  EXPECT_THAT(refusal(gltf), HasSubstr("/meshes/0/primitives/0: its vertices are compressed with KHR_draco"));
  ReadOptions lenient;
  lenient.lenient = true;
  const Scene scene = read_gltf(write("scene.glb", gltf.glb()), lenient);
  EXPECT_EQ(scene.soup.triangles.size(), 2u);
  EXPECT_THAT(scene.warnings, Contains(HasSubstr("'/meshes/0/primitives/0' is compressed")));
}

/// EXT_mesh_gpu_instancing: the node's mesh appears once for each element, and not at the node itself.
TEST_F(GltfAsWritten, InstancesOfANode) {
  Gltf gltf;
  gltf.at("/nodes/0")["translation"] = {10, 0, 0};
  gltf.at("/nodes/0")["extensions"] = {
      {"EXT_mesh_gpu_instancing",
       {{"attributes",
         {{"TRANSLATION", gltf.add_floats("VEC3", {0, 1, 0, 0, 2, 0})},
          {"ROTATION", gltf.add_floats("VEC4", {0, 0, 0, 1, 0, 0, 1, 0})},  // half a turn about z
          {"SCALE", gltf.add_floats("VEC3", {3, 3, 3, 1, 1, 1})}}}}}};
  gltf.document["extensionsUsed"].push_back("EXT_mesh_gpu_instancing");
  gltf.document["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
  const Scene scene = read(gltf);
  EXPECT_THAT(scene.warnings, IsEmpty());
  ASSERT_EQ(scene.objects.size(), 3u);
  EXPECT_EQ(scene.objects[0].name, "Body.0");
  EXPECT_EQ(scene.objects[1].name, "Body.1");
  EXPECT_THAT(corners(scene, 0),
              ::testing::ElementsAre(glm::dvec3(10, 1, 0), glm::dvec3(13, 1, 0), glm::dvec3(10, 4, 0)));
  const auto second = corners(scene, 1);
  EXPECT_LT(glm::distance(second[1], glm::dvec3(9, 2, 0)), 1e-12);
  gltf.at("/nodes/0/extensions/EXT_mesh_gpu_instancing/attributes/SCALE") = gltf.add_floats("VEC3", {1, 1, 1});
  EXPECT_THAT(refusal(gltf), HasSubstr("/nodes/0/extensions/EXT_mesh_gpu_instancing/attributes/SCALE: 1 instances"));
  gltf.at("/nodes/0/extensions/EXT_mesh_gpu_instancing/attributes") = {{"_ID", gltf.add_floats("SCALAR", {7, 8, 9})}};
  EXPECT_EQ(read(gltf).objects.size(), 4u) << "all three instances are at the node's place";
  gltf.at("/nodes/0/extensions/EXT_mesh_gpu_instancing") = json::object();
  EXPECT_THAT(read(gltf).warnings, Contains(HasSubstr("'Body' has an empty list of instances")));
}

/// KHR_node_visibility hides the node and its children; joints and cameras stay where they are.
TEST_F(GltfAsWritten, NodesThatAreNotVisible) {
  Gltf gltf;
  gltf.at("/scenes/0/nodes") = {0, 1};
  gltf.at("/nodes").push_back({{"name", "Child"}, {"mesh", 0}});
  gltf.at("/nodes/0")["children"] = {2, 3};
  gltf.at("/nodes/0")["extensions"] = {{"KHR_node_visibility", {{"visible", false}}}};
  gltf.document["extensionsUsed"].push_back("KHR_node_visibility");
  const Scene scene = read(gltf);
  EXPECT_THAT(scene.warnings, IsEmpty());
  ASSERT_EQ(scene.objects.size(), 1u);
  EXPECT_EQ(scene.objects[0].name, "Lamp");
  EXPECT_EQ(scene.cameras[0].name, "Camera");
  gltf.at("/nodes/0/extensions/KHR_node_visibility/visible") = true;
  EXPECT_EQ(read(gltf).objects.size(), 3u);
}

/// Names in a Windows code page, backslashes between folders, a byte order mark.
TEST_F(GltfAsWritten, TextOfWindows) {
  Gltf gltf;
  std::filesystem::create_directory(folder_ / "parts");
  write("parts/own.bin", gltf.data);
  gltf.at("/buffers/0") = {{"byteLength", gltf.data.size()}, {"uri", "parts\\own.bin"}};
  gltf.at("/nodes/0/name") = "W_rfel";
  std::string text = gltf.document.dump();
  text[text.find("W_rfel") + 1] = '\xFC';
  const Scene scene = read_gltf(write("scene.gltf", "\xEF\xBB\xBF" + text));
  EXPECT_EQ(scene.objects[0].name, "W\\xfcrfel");
  EXPECT_THAT(scene.warnings, Contains(HasSubstr("no UTF-8")));
  const auto path = write("scene.gltf", text.substr(0, text.size() - 1));
  EXPECT_THAT(test::input_error([&] { read_gltf(path); }), HasSubstr("parse error"));
}

/// Files before 2021 often have their colours in KHR_materials_pbrSpecularGlossiness.
TEST_F(GltfAsWritten, SpecularGlossinessHasADiffuseColour) {
  Gltf gltf;
  gltf.at("/materials/0")["extensions"] = {
      {"KHR_materials_pbrSpecularGlossiness", {{"diffuseFactor", {0.1, 0.2, 0.3, 1}}}}};
  gltf.document["extensionsUsed"].push_back("KHR_materials_pbrSpecularGlossiness");
  gltf.document["extensionsRequired"] = {"KHR_materials_pbrSpecularGlossiness"};
  const Scene scene = read(gltf);
  EXPECT_EQ(scene.objects[0].color, glm::dvec3(0.1, 0.2, 0.3));
  EXPECT_THAT(scene.warnings, IsEmpty());
}

}  // namespace
}  // namespace penumbra::scenes
