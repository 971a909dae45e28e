// What compositors take from OUT.exr: layers of each light, mattes, matrices, names.
#include "tests/cli/program.hpp"

#include "app/pictures/cryptomatte.hpp"
#include "base/exr.hpp"

#include <fmt/format.h>
#include <glm/matrix.hpp>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <set>

namespace penumbra::tests {
namespace {

using nlohmann::json;
using testing::HasSubstr;

/// Hashes that others give: Appleby's function on Wikipedia's examples, numbers of the Cryptomatte specification's own
/// test.
TEST(CryptomatteNames, AreThoseOfOthers) {
  EXPECT_EQ(app::murmur3(""), 0u);
  EXPECT_EQ(app::murmur3("test"), 0xba6bd213u);
  EXPECT_EQ(app::murmur3("Hello, world!"), 0xc0363e43u);
  EXPECT_EQ(app::murmur3("The quick brown fox jumps over the lazy dog"), 0x2e4ff723u);
  EXPECT_FLOAT_EQ(app::cryptomatte_id("hello"), 6.0705627e-17f);
  EXPECT_FLOAT_EQ(app::cryptomatte_id("cube"), -4.0846191e+15f);
  EXPECT_FLOAT_EQ(app::cryptomatte_id("sphere"), 2.7901860e+15f);
  EXPECT_FLOAT_EQ(app::cryptomatte_id("plane"), 3.6655762e-11f);
  for (const char* name : {"a", "b", "Plane.001", ""}) EXPECT_TRUE(std::isnormal(app::cryptomatte_id(name))) << name;
}

class Layers : public ProgramTest {
 protected:
  /// The tiny scene with lights of these names, each weaker and farther than the last.
  void scene_with(const std::vector<std::string>& names) const {
    json scene = json::parse(scene_text_with("/lights/0/name", R"("key")"));
    scene["lights"] = json::array();
    for (std::size_t i = 0; i < names.size(); ++i) {
      const double x = 2.0 * static_cast<double>(i);
      scene["lights"].push_back({{"name", names[i]},
                                 {"rectangle", {{"center", {x, 4, 0}}, {"halfU", {0.5, 0, 0}}, {"halfV", {0, 0, 0.5}}}},
                                 {"radiance", {10 - x, 9, 8}}});
    }
    write("scene.json", scene.dump());
  }
  [[nodiscard]] ExrFile render(std::vector<std::string> more = {}) const {
    std::vector<std::string> arguments = {"render", path("scene.json"), "-o", path("out.exr")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return outcome.code == 0 ? read_exr(path("out.exr")) : ExrFile{};
  }
};

TEST_F(Layers, EachLightHasItsOwn) {
  scene_with({"Plane.001", "a/b", "a_b", "N", "N_2_V"});
  const ExrFile all = render();
  const json lights = json::parse(all.attributes.at("penumbra.lights"));
  const std::vector<std::string> layers = {"Plane_001", "a_b", "a_b_2", "N_2", "N_2_V_2"};
  ASSERT_EQ(lights.size(), layers.size());
  for (const std::string& name : all.channel_names) {
    EXPECT_LE(std::ranges::count(name, '.'), 1) << name << ": Blender drops it";
    EXPECT_TRUE(name == "id" || name.find('.') == std::string::npos || name.size() - name.find('.') == 2) << name;
  }
  for (std::size_t light = 0; light < layers.size(); ++light) {
    EXPECT_EQ(lights[light]["layer"], layers[light]);
    EXPECT_EQ(lights[light]["kind"], "rectangle");
    EXPECT_EQ(lights[light]["radiance"], json::array({10 - 2.0 * static_cast<double>(light), 9.0, 8.0}));
    const ExrFile alone = render({"--light", lights[light]["name"]});
    EXPECT_EQ(alone.floats.at("V"), all.floats.at(layers[light] + ".V"));
    for (const char* channel : {"R", "G", "B"}) {
      EXPECT_EQ(alone.floats.at(channel), all.floats.at(layers[light] + "." + channel)) << layers[light];
      EXPECT_EQ(alone.floats.at(channel), all.floats.at(layers[light] + "_light." + channel)) << layers[light];
    }
    EXPECT_EQ(alone.floats.at("V"), all.floats.at(layers[light] + "_V.V"));
    EXPECT_EQ(json::parse(alone.attributes.at("penumbra.lights")).size(), 1u);
  }
  for (std::size_t i = 0; i < all.floats.at("R").size(); ++i) {
    float sum = 0;
    for (const std::string& layer : layers) sum += all.floats.at(layer + ".R")[i];
    ASSERT_EQ(all.floats.at("R")[i], sum);
  }
  EXPECT_EQ(all.floats.at("V"), all.floats.at("Plane_001.V"));
  const Outcome twice = run({"render", path("scene.json"), "-o", path("x.exr"), "--light", "N", "--light", "N"});
  EXPECT_EQ(twice.code, 2);
  EXPECT_THAT(twice.err, HasSubstr("twice"));
}

TEST_F(Layers, ALightThatLightsNothingIsNamed) {
  scene_with({"key", "fill"});
  json scene = json::parse(read("scene.json"));
  scene["lights"][1]["rectangle"]["halfU"] = {-0.5, 0, 0};  // it shines up
  write("scene.json", scene.dump());
  const Outcome outcome = run({"render", path("scene.json"), "-o", path("out.exr")});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(outcome.err, HasSubstr("no visible point is before light \"fill\""));
  EXPECT_THAT(outcome.err, testing::Not(HasSubstr("\"key\"")));
}

/// World positions times the header's matrices are pixels and depths.
TEST_F(Layers, MatricesLeadFromTheWorldToThePicture) {
  scene_with({"key"});
  json scene = json::parse(read("scene.json"));
  scene.at("camera")["shift"] = {0.13, -0.07};
  write("scene.json", scene.dump());
  const ExrFile image = render();
  const glm::dmat4 to_camera(image.matrices.at("worldToCamera")), to_picture(image.matrices.at("worldToNDC"));
  std::size_t seen = 0;
  for (std::size_t i = 0; i < image.floats.at("Z").size(); ++i) {
    if (image.floats.at("A")[i] == 0) continue;
    ++seen;
    const glm::dvec4 world(image.floats.at("P.X")[i], image.floats.at("P.Y")[i], image.floats.at("P.Z")[i], 1);
    const glm::dvec4 camera = to_camera * world, picture = to_picture * world;
    // Coordinates and matrices are rounded to float32: a dozen units of 2^-24 of numbers up to ten.
    constexpr double kRounding = 12 * 0x1p-24 * 10;
    EXPECT_NEAR(-camera.z, image.floats.at("Z")[i], kRounding);
    const std::size_t x = i % 48, y = i / 48;
    EXPECT_NEAR(picture.x / picture.w, 2 * (static_cast<double>(x) + 0.5) / 48 - 1, kRounding);
    EXPECT_NEAR(picture.y / picture.w, 1 - 2 * (static_cast<double>(y) + 0.5) / 32, kRounding);
  }
  EXPECT_GT(seen, 100u);
  EXPECT_THAT(image.attributes.at("penumbra.axes"), HasSubstr("Y up"));
  EXPECT_TRUE(image.attributes.contains("penumbra.camera"));
}

TEST_F(Layers, ObjectsAreNamedAndCutOut) {
  scene_with({"key"});
  const ExrFile image = render();
  const json names = json::parse(image.attributes.at("penumbra.objects"));
  const std::string key = "cryptomatte/" + fmt::format("{:08x}", app::murmur3("CryptoObject")).substr(0, 7) + "/";
  EXPECT_EQ(image.attributes.at(key + "name"), "CryptoObject");
  EXPECT_EQ(image.attributes.at(key + "conversion"), "uint32_to_float32");
  const json manifest = json::parse(image.attributes.at(key + "manifest"));
  ASSERT_EQ(names.size(), 2u);
  for (const json& name : names)
    EXPECT_EQ(manifest.at(name.get<std::string>()).get<std::string>().size(), 8u) << "eight digits";
  std::set<float> numbers;
  for (std::size_t i = 0; i < image.floats.at("object.X").size(); ++i) {
    const float number = image.floats.at("object.X")[i], coverage = image.floats.at("CryptoObject00.G")[i];
    numbers.insert(number);
    EXPECT_EQ(coverage, image.floats.at("A")[i]);
    const float id =
        number == 0 ? 0 : app::cryptomatte_id(names.at(static_cast<std::size_t>(number) - 1).get<std::string>());
    EXPECT_EQ(image.floats.at("CryptoObject00.R")[i], id);
    EXPECT_EQ(image.floats.at("material.X")[i], 0) << "a scene of JSON has no materials";
  }
  EXPECT_EQ(numbers, (std::set<float>{0, 1, 2}));
}

}  // namespace
}  // namespace penumbra::tests
