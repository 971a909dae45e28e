// SPDX-License-Identifier: Apache-2.0
// Tests contents of OUT.exr that compositors use: layers of each light, mattes, matrices, names.
#include "tests/cli/program.hpp"

#include "base/exr.hpp"
#include "session/pictures/cryptomatte.hpp"
#include "session/pictures/picture_format.hpp"

#include <fmt/format.h>
#include <glm/matrix.hpp>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

namespace penumbra::tests {
namespace {

using nlohmann::json;
using testing::HasSubstr;

/// Compares with published hashes: Appleby's function on Wikipedia's examples, and numbers of the Cryptomatte
/// specification's own test.
TEST(CryptomatteNames, AreThoseOfOthers) {
  EXPECT_EQ(session::murmur3(""), 0u);
  EXPECT_EQ(session::murmur3("test"), 0xba6bd213u);
  EXPECT_EQ(session::murmur3("Hello, world!"), 0xc0363e43u);
  EXPECT_EQ(session::murmur3("The quick brown fox jumps over the lazy dog"), 0x2e4ff723u);
  EXPECT_FLOAT_EQ(session::cryptomatte_id("hello"), 6.0705627e-17f);
  EXPECT_FLOAT_EQ(session::cryptomatte_id("cube"), -4.0846191e+15f);
  EXPECT_FLOAT_EQ(session::cryptomatte_id("sphere"), 2.7901860e+15f);
  EXPECT_FLOAT_EQ(session::cryptomatte_id("plane"), 3.6655762e-11f);
  for (const char* name : {"a", "b", "Plane.001", ""})
    EXPECT_TRUE(std::isnormal(session::cryptomatte_id(name))) << name;
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
  const std::vector<std::string> layers = {"Plane_001", "a_b_2", "a_b", "N_3", "N_2_V"};
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
      EXPECT_FALSE(all.floats.contains(layers[light] + "_light." + channel)) << "once";
    }
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

TEST_F(Layers, NamesCanBeForetold) {
  const auto layers_of = [&](const std::vector<std::string>& names) {
    std::vector<visibility::Light> lights(names.size());
    for (std::size_t i = 0; i < names.size(); ++i) lights[i].name = names[i];
    return session::layer_names(lights);
  };
  using Names = std::vector<std::string>;
  // Names that are valid layers stay as they are, whatever comes before them.
  EXPECT_EQ(layers_of({"N", "N_2", "a.b", "a_b", "V", "Z", "id", "R"}),
            (Names{"N_3", "N_2", "a_b_2", "a_b", "V", "Z", "id", "R"}));
  EXPECT_EQ(layers_of({"a_b", "a.b", "a/b", "N_2", "N"}), (Names{"a_b", "a_b_2", "a_b_3", "N_2", "N_3"}));
  for (const char* name : {"P", "Prel", "N", "object", "material", "triangle", "CryptoObject00", "Combined", "rgba"})
    EXPECT_EQ(layers_of({name}), (Names{std::string(name) + "_2"}));
  EXPECT_EQ(layers_of({"key", "key_V", "key_light"}), (Names{"key", "key_V_2", "key_light_2"}));
  EXPECT_EQ(layers_of({std::string(60, 'x'), std::string(44, 'x')}),
            (Names{std::string(42, 'x') + "_2", std::string(44, 'x')}));
  EXPECT_EQ(layers_of({"", "."}), (Names{"_2", "_"}));
}

TEST_F(Layers, ThoseAskedForAreWritten) {
  scene_with({"key", "Plane.001", "beauty"});
  const ExrFile all = render();
  const auto names_of = [](const ExrFile& image) {
    return std::set<std::string>(image.channel_names.begin(), image.channel_names.end());
  };
  const std::set<std::string> beauty = {"A", "B", "G", "R"};
  EXPECT_EQ(names_of(render({"--layers", "beauty"})),
            (std::set<std::string>{"A", "B", "G", "R", "beauty.B", "beauty.G", "beauty.R", "beauty.V"}))
      << "a light may be called so";
  scene_with({"key", "Plane.001"});
  const ExrFile both = render();
  const ExrFile plain = render({"--layers", "beauty"});
  EXPECT_EQ(names_of(plain), beauty);
  for (const auto& [name, value] : plain.attributes) EXPECT_FALSE(name.starts_with("cryptomatte/")) << name;
  EXPECT_EQ(names_of(render({"--layers", "key.?, P.Y,id,CryptoObject*"})),
            (std::set<std::string>{"CryptoObject00.A", "CryptoObject00.B", "CryptoObject00.G", "CryptoObject00.R",
                                   "P.Y", "id", "key.B", "key.G", "key.R", "key.V"}));
  EXPECT_EQ(names_of(render({"--layers", "Plane.001"})),
            (std::set<std::string>{"Plane_001.B", "Plane_001.G", "Plane_001.R", "Plane_001.V"}))
      << "the light's own name";
  EXPECT_EQ(names_of(render({"--layers", "*"})), names_of(both)) << "none of what repeats others";
  // Blender's compositor takes the lights' two parts separately.
  const ExrFile parts = render({"--layers", "*_light,*_V"});
  EXPECT_EQ(names_of(parts),
            (std::set<std::string>{"Plane_001_V.V", "Plane_001_light.B", "Plane_001_light.G", "Plane_001_light.R",
                                   "key_V.V", "key_light.B", "key_light.G", "key_light.R"}));
  for (const std::string light : {"key", "Plane_001"}) {
    EXPECT_EQ(parts.floats.at(light + "_V.V"), both.floats.at(light + ".V"));
    for (const char* channel : {"R", "G", "B"})
      EXPECT_EQ(parts.floats.at(light + "_light." + channel), both.floats.at(light + "." + channel));
  }
  for (const auto& [wish, said] : {std::pair{"kay", "did you mean key?"}, {"Q,V", "--layers Q:"}, {"V,,Z", "commas"}}) {
    const Outcome outcome = run({"render", path("scene.json"), "-o", path("no.exr"), "--layers", wish});
    EXPECT_EQ(outcome.code, 2) << wish;
    EXPECT_THAT(outcome.err, HasSubstr(said));
    EXPECT_FALSE(std::filesystem::exists(path("no.exr")));
  }
  const Outcome unknown = run({"render", path("scene.json"), "-o", path("no.exr"), "--layers", "Q"});
  for (const char* const there : {"beauty", "key", "Plane_001", "CryptoMaterial00", "key_light"})
    EXPECT_THAT(unknown.err, HasSubstr(there));
}

TEST_F(Layers, HalfAndCompressionChangeColoursAlone) {
  scene_with({"key"});
  const ExrFile whole = render();
  const auto check = [&](const ExrFile& other, double colours) {
    ASSERT_EQ(other.channel_names.size(), whole.channel_names.size());
    EXPECT_EQ(other.integers.at("id"), whole.integers.at("id"));
    for (const auto& [name, values] : whole.floats) {
      const std::string layer = name.substr(0, name.find('.'));
      const bool keeps =
          std::set<std::string>{
              "P", "Prel", "Z", "triangle", "object", "material", "CryptoObject00", "CryptoMaterial00"}
              .contains(layer);
      for (std::size_t i = 0; i < values.size(); ++i) {
        if (keeps) {
          ASSERT_EQ(other.floats.at(name)[i], values[i]) << name;
        } else {
          ASSERT_NEAR(other.floats.at(name)[i], values[i], colours * std::max(1.0f, std::abs(values[i]))) << name;
        }
      }
    }
  };
  check(render({"--half"}), 0x1p-11);
  const auto half_size = std::filesystem::file_size(path("out.exr"));
  check(render({"--compression", "dwaa"}), 0.02);
  check(render({"--compression", "dwaa", "--half"}), 0.02);
  for (const char* const exact : {"zip", "zips", "none"}) check(render({"--compression", exact}), 0);
  EXPECT_LT(half_size, std::filesystem::file_size(path("out.exr")));
  const Outcome outcome = run({"render", path("scene.json"), "-o", path("no.exr"), "--compression", "piz"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("zip, zips, dwaa or none"));
  json scene = json::parse(read("scene.json"));
  scene["lights"][0]["radiance"] = {1e7, 1, 1};
  write("scene.json", scene.dump());
  const Outcome bright = run({"render", path("scene.json"), "-o", path("out.exr"), "--half"});
  EXPECT_EQ(bright.code, 0);
  EXPECT_THAT(bright.err, HasSubstr("above 65504"));
}

/// Blender has room for 63 bytes of "layer.channel"; Nuke and Blender give channels without a layer names of their own.
TEST_F(Layers, NamesFitIntoHosts) {
  const std::string letters = "\xd0\x96";  // one letter, two bytes
  std::string cyrillic;
  for (int i = 0; i < 40; ++i) cyrillic += letters;
  const std::vector<std::string> names = {
      std::string(60, 'a') + "1", std::string(60, 'a') + "2", cyrillic, "Combined", "Lampe \xc3\xbc", "a/b.c"};
  scene_with(names);
  const json lights = json::parse(render().attributes.at("penumbra.lights"));
  std::vector<std::string> layers;
  for (const json& light : lights) layers.push_back(light["layer"]);
  EXPECT_EQ(layers, (std::vector<std::string>{std::string(44, 'a'), std::string(42, 'a') + "_2", cyrillic.substr(0, 44),
                                              "Combined_2", "Lampe \xc3\xbc", "a_b_c"}));
}

/// Floats hold whole numbers up to 2^24; 2^24 + 1 is not a float.
TEST(TriangleNumbers, AreExactAsFloats) {
  for (const std::int64_t triangle :
       {std::int64_t{-1}, std::int64_t{0}, std::int64_t{1} << 20, (std::int64_t{1} << 24) - 2,
        (std::int64_t{1} << 24) - 1, std::int64_t{1} << 24, (std::int64_t{1} << 24) + 1, (std::int64_t{1} << 31) - 2}) {
    const double whole = double{session::low_number(triangle)} + 0x1p24 * double{session::high_number(triangle)};
    EXPECT_EQ(whole, static_cast<double>(triangle + 1));
  }
  std::vector<std::string> names;
  for (const session::PictureChannel& channel : session::picture_channels({}, false, (std::uint64_t{1} << 24) - 1))
    names.push_back(channel.name);
  EXPECT_THAT(names, testing::Contains("triangle.X"));
  EXPECT_THAT(names, testing::Not(testing::Contains("triangle_high.X")));
  names.clear();
  for (const session::PictureChannel& channel : session::picture_channels({}, false, std::uint64_t{1} << 24))
    names.push_back(channel.name);
  EXPECT_THAT(names, testing::Contains("triangle_high.X"));
}

TEST_F(Layers, TrianglesHaveNumbersThatCompositorsTake) {
  scene_with({"key"});
  const ExrFile image = render();
  for (std::size_t i = 0; i < image.floats.at("triangle.X").size(); ++i) {
    const std::uint32_t id = image.integers.at("id")[i];
    ASSERT_EQ(image.floats.at("triangle.X")[i], id == 0xffffffffu ? 0.0f : static_cast<float>(id + 1));
  }
}

TEST_F(Layers, ALightThatLightsNothingIsNamed) {
  scene_with({"key", "fill"});
  json scene = json::parse(read("scene.json"));
  scene["lights"][1]["rectangle"]["halfU"] = {-0.5, 0, 0};  // the light shines up
  write("scene.json", scene.dump());
  const Outcome outcome = run({"render", path("scene.json"), "-o", path("out.exr")});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(outcome.err, HasSubstr("no visible point is in front of light \"fill\""));
  EXPECT_THAT(outcome.err, testing::Not(HasSubstr("\"key\"")));
}

/// World positions times the header's matrices give pixels and depths.
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
  const std::string key = "cryptomatte/" + fmt::format("{:08x}", session::murmur3("CryptoObject")).substr(0, 7) + "/";
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
        number == 0 ? 0 : session::cryptomatte_id(names.at(static_cast<std::size_t>(number) - 1).get<std::string>());
    EXPECT_EQ(image.floats.at("CryptoObject00.R")[i], id);
    EXPECT_EQ(image.floats.at("material.X")[i], 0) << "a scene of JSON has no materials";
  }
  EXPECT_EQ(numbers, (std::set<float>{0, 1, 2}));
}

}  // namespace
}  // namespace penumbra::tests
