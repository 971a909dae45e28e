// SPDX-License-Identifier: Apache-2.0
// Tests frames of meshes that deform, move, fold, vanish and let light through. A sequence keeps meshes from frame to
// frame and updates them; each file must equal that of the frame rendered alone, byte for byte.
#include "tests/cli/program.hpp"

#include "tests/unit/import/gltf_file.hpp"

#include <nlohmann/json.hpp>

#include <cmath>
#include <cstddef>

namespace penumbra::tests {
namespace {

using nlohmann::json;
using test::Gltf;

constexpr std::size_t kBody = 0, kLamp = 1, kCamera = 2;

/// A surface of 6 × 6 quads over a floor, under a lamp that is a mesh, seen obliquely from above.
class Scene {
 public:
  Scene() {
    gltf.at("/nodes/1") = {{"name", "Lamp"}, {"mesh", 1}, {"translation", {0, 3, 0}}, {"rotation", {1, 0, 0, 0}}};
    gltf.at("/nodes/2") = {
        {"name", "Camera"}, {"camera", 0}, {"translation", {0, 4, 3}}, {"rotation", {-0.5, 0, 0, 0.8660254}}};
    gltf.at("/meshes").push_back(
        {{"primitives", {{{"attributes", {{"POSITION", 2}}}, {"indices", 3}, {"material", 0}}}}});
    add_node({{"name", "Floor"}, {"mesh", 2}, {"scale", {4, 1, 4}}});
    std::vector<std::uint16_t> corners;
    for (std::size_t i = 0; i < kSide; ++i) {
      for (std::size_t j = 0; j < kSide; ++j) {
        const std::size_t a = i * (kSide + 1) + j, b = a + kSide + 1;
        for (const std::size_t corner : {a, b, a + 1, a + 1, b, b + 1})
          corners.push_back(static_cast<std::uint16_t>(corner));
      }
    }
    std::string bytes;
    for (const std::uint16_t corner : corners) bytes += test::bytes_of(corner);
    const std::size_t view = gltf.add_view(bytes);
    gltf.at("/accessors")
        .push_back({{"bufferView", view}, {"componentType", 5123}, {"count", corners.size()}, {"type", "SCALAR"}});
    indices_ = gltf.at("/accessors").size() - 1;
    gltf.at("/meshes/0/primitives/0") = surface();
    gltf.at("/nodes/0") = {{"name", "Body"}, {"mesh", 0}, {"translation", {0, 1, 0}}};
  }

  std::size_t add_node(const json& node) {
    gltf.at("/nodes").push_back(node);
    gltf.at("/scenes/0/nodes").push_back(gltf.at("/nodes").size() - 1);
    return gltf.at("/nodes").size() - 1;
  }
  /// Adds the surface's vertices, each at the position that `place` gives, and returns their accessor.
  template <typename Place>
  std::size_t vertices(const Place& place) {
    std::vector<float> all;
    for (std::size_t i = 0; i <= kSide; ++i) {
      for (std::size_t j = 0; j <= kSide; ++j) {
        const auto [x, y, z] = place(static_cast<float>(i) / kSide - 0.5F, static_cast<float>(j) / kSide - 0.5F);
        all.insert(all.end(), {x, y, z});
      }
    }
    return gltf.add_floats("VEC3", all);
  }
  json surface() {
    const std::size_t places = vertices([](float x, float z) { return std::array{x, 0.25F * std::sin(9 * x * z), z}; });
    return {{"attributes", {{"POSITION", places}}}, {"indices", indices_}, {"material", 0}};
  }
  /// Adds a shape key that moves each vertex by `place`; its weight is 0, 1, 0 in frames 0, 1, 2.
  template <typename Place>
  void shape_key(const Place& place) {
    gltf.at("/meshes/0/primitives/0")["targets"] = {{{"POSITION", vertices(place)}}};
    gltf.at("/meshes/0")["weights"] = {0};
    gltf.animate(kBody, "weights", {0, 1, 2}, {0, 1, 0});
  }

  Gltf gltf;

 private:
  static constexpr std::size_t kSide = 6;
  std::size_t indices_ = 0;
};

class AnimatedMeshes : public ProgramTest {
 protected:
  Outcome render(std::vector<std::string> more) const {
    std::vector<std::string> arguments = {"render", path("scene.glb"), "--size", "32x24", "--fps", "1"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }
  [[nodiscard]] std::uint64_t counter(int frame, const std::string& name) const {
    return json::parse(read(fmt::format("s.{}.json", frame))).at("counters").value(name, std::uint64_t{0});
  }
  /// Renders frames 0 to 2 in a sequence and each one alone, and expects the same bytes.
  void expect_same_bytes(Scene& scene) {
    write("scene.glb", scene.gltf.glb());
    const std::vector<std::vector<std::string>> directions = {
        {"--light-samples", "16"},
        {"--method", "view-sample", "--light-samples", "16"},
        {}};  // the last: exact areas, whose stats the tests look at
    for (const std::vector<std::string>& direction : directions) {
      std::vector<std::string> sequence = {"--frames", "0-2", "-o", path("s.#.exr"), "--stats", path("s.#.json")};
      sequence.insert(sequence.end(), direction.begin(), direction.end());
      if (!direction.empty()) sequence.insert(sequence.end(), {"--bits", path("s.#.bits")});
      const Outcome outcome = render(sequence);
      ASSERT_EQ(outcome.code, 0) << outcome.err;
      for (int frame = 0; frame < 3; ++frame) {
        std::vector<std::string> one = {"--frame", std::to_string(frame), "-o", path("one.exr")};
        one.insert(one.end(), direction.begin(), direction.end());
        if (!direction.empty()) one.insert(one.end(), {"--bits", path("one.bits")});
        ASSERT_EQ(render(one).code, 0);
        EXPECT_EQ(read("one.exr"), read(fmt::format("s.{}.exr", frame)))
            << frame << fmt::format(" {}", direction.size());
        if (!direction.empty()) {
          EXPECT_EQ(read("one.bits"), read(fmt::format("s.{}.bits", frame))) << frame;
        }
      }
    }
    EXPECT_NE(read("s.0.exr"), read("s.1.exr")) << "it moves";
  }
};

TEST_F(AnimatedMeshes, ThatBend) {
  Scene scene;
  scene.shape_key([](float x, float z) { return std::array{0.1F * z, 0.3F * std::sin(5 * x + 3 * z), 0.05F * x}; });
  expect_same_bytes(scene);
  EXPECT_EQ(counter(0, "edgesBuilt"), 1U);
  for (const int frame : {1, 2}) {
    EXPECT_EQ(counter(frame, "treesRefit"), 1U) << frame;
    EXPECT_EQ(counter(frame, "edgesRefit"), 1U) << frame;
    EXPECT_EQ(counter(frame, "edgesBuilt"), 0U) << frame;
  }
}

/// In frame 1 one half lies exactly on the other: vertices meet, and separate again.
TEST_F(AnimatedMeshes, ThatFold) {
  Scene scene;
  const std::size_t flat = scene.vertices([](float x, float z) { return std::array{x, 0.0F, z}; });
  scene.gltf.at("/meshes/0/primitives/0/attributes/POSITION") = flat;
  scene.shape_key([](float x, float) { return std::array{x > 0 ? -2 * x : 0.0F, 0.0F, 0.0F}; });
  expect_same_bytes(scene);
  for (const int frame : {1, 2}) EXPECT_EQ(counter(frame, "edgesBuilt"), 1U) << frame;
}

TEST_F(AnimatedMeshes, WithBones) {
  Scene scene;
  const std::size_t bone = scene.add_node({{"name", "Bone"}}), other = scene.add_node({{"name", "Other"}});
  const std::vector<float> bind = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1,
                                   1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  scene.gltf.document["skins"] = {
      {{"joints", {bone, other}}, {"inverseBindMatrices", scene.gltf.add_floats("MAT4", bind)}}};
  scene.gltf.at("/nodes/0")["skin"] = 0;
  json& attributes = scene.gltf.at("/meshes/0/primitives/0/attributes");
  std::vector<float> joints, weights;
  for (int i = 0; i < 49; ++i) {
    const int row = i / 7;
    const float share = static_cast<float>(row) / 6.0F;
    joints.insert(joints.end(), {0, 1, 0, 0});
    weights.insert(weights.end(), {1 - share, share, 0, 0});
  }
  attributes["JOINTS_0"] = scene.gltf.add_floats("VEC4", joints);
  scene.gltf.at("/accessors").back()["componentType"] = 5126;
  attributes["WEIGHTS_0"] = scene.gltf.add_floats("VEC4", weights);
  scene.gltf.animate(bone, "translation", {0, 2}, {0, 1, 0, 0, 1.5F, 0});
  scene.gltf.animate(other, "rotation", {0, 2}, {0, 0, 0, 1, 0, 0.38268343F, 0, 0.92387953F});
  scene.gltf.animate(other, "translation", {0, 2}, {0, 1, 0, 0.25F, 1, 0});
  expect_same_bytes(scene);
}

/// One mesh moves and turns, one vanishes; nothing else moves.
TEST_F(AnimatedMeshes, ThatMoveAndVanish) {
  Scene scene;
  scene.gltf.animate(kBody, "translation", {0, 2}, {0, 1, 0, 0.3F, 1.2F, 0.1F});
  scene.gltf.animate(kBody, "rotation", {0, 2}, {0, 0, 0, 1, 0, 0.38268343F, 0, 0.92387953F});
  scene.gltf.at("/meshes").push_back({{"primitives", {scene.surface()}}});
  const std::size_t vanishing =
      scene.add_node({{"name", "Gone"}, {"mesh", 3}, {"translation", {-0.5F, 1.5F, 0.2F}}, {"scale", {0.5, 0.5, 0.5}}});
  scene.gltf.animate(vanishing, "scale", {0, 1, 2}, {0.5F, 0.5F, 0.5F, 0, 0, 0, 0.5F, 0.5F, 0.5F});
  expect_same_bytes(scene);
  EXPECT_EQ(counter(1, "treesBuilt"), 1U) << "other triangles cast";
}

TEST_F(AnimatedMeshes, UnderALampThatMoves) {
  Scene scene;
  scene.gltf.animate(kLamp, "translation", {0, 2}, {0, 3, 0, 0.5F, 3, 0.25F});
  expect_same_bytes(scene);
  EXPECT_EQ(counter(2, "edgesRefit"), 1U) << "its body is a mesh";
}

TEST_F(AnimatedMeshes, BeforeACameraThatMoves) {
  Scene scene;
  scene.gltf.animate(kCamera, "translation", {0, 2}, {0, 4, 3, 0.5F, 4, 3});
  expect_same_bytes(scene);
  for (const int frame : {1, 2}) {
    EXPECT_EQ(counter(frame, "meshesKept"), 1U) << frame;
    EXPECT_EQ(counter(frame, "treesBuilt") + counter(frame, "treesRefit"), 0U) << frame;
  }
}

/// A pane and a surface with an alpha cut-off, which methods do not count among the casters.
TEST_F(AnimatedMeshes, ThatLetLightThrough) {
  Scene scene;
  scene.shape_key([](float x, float z) { return std::array{0.1F * z, 0.3F * x, 0.05F * x}; });
  for (const char* mode : {"BLEND", "MASK"}) {
    json material = {{"name", mode}, {"alphaMode", mode}, {"doubleSided", true}};
    material["pbrMetallicRoughness"] = {{"baseColorFactor", {0.5, 0.5, 0.5, 0.6}}, {"metallicFactor", 0}};
    scene.gltf.at("/materials").push_back(material);
    json surface = scene.surface();
    surface["material"] = scene.gltf.at("/materials").size() - 1;
    scene.gltf.at("/meshes").push_back({{"primitives", {surface}}});
    const std::size_t node = scene.add_node(
        {{"name", mode}, {"mesh", scene.gltf.at("/meshes").size() - 1}, {"translation", {0.4F, 1.4F, 0.3F}}});
    scene.gltf.animate(node, "translation", {0, 2}, {0.4F, 1.4F, 0.3F, -0.4F, 1.6F, 0.1F});
  }
  expect_same_bytes(scene);
}

/// The meshes of several moments follow one another, too; the mean is that of the frame rendered alone.
TEST_F(AnimatedMeshes, OfAnOpenShutter) {
  Scene scene;
  scene.shape_key([](float x, float z) { return std::array{0.1F * z, 0.3F * std::sin(5 * x + 3 * z), 0.05F * x}; });
  write("scene.glb", scene.gltf.glb());
  ASSERT_EQ(
      render({"--frames", "0-2", "--motion-samples", "3", "-o", path("s.#.exr"), "--stats", path("s.#.json")}).code, 0);
  ASSERT_EQ(render({"--frame", "2", "--motion-samples", "3", "-o", path("one.exr")}).code, 0);
  EXPECT_EQ(read("one.exr"), read("s.2.exr"));
  EXPECT_GE(counter(1, "edgesRefit"), 3U) << "each moment is another mesh";
}

}  // namespace
}  // namespace penumbra::tests
