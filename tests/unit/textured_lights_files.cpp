// SPDX-License-Identifier: Apache-2.0
// Tests textures from files: the meaning of each kind of picture, the messages about refused ones, and that nothing is
// lost when they are written and read again.

#include "base/exr.hpp"
#include "scenes/light_texture.hpp"
#include "scenes/formats/writer.hpp"
#include "tests/unit/scenes/support.hpp"
#include "tests/unit/textured_lights_support.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

namespace penumbra::test {
namespace {

using tests::bytes_of;
using tests::png_file;

/// Returns the light of kLight with additional keys.
std::string light_with(const std::string& more) {
  const std::string light = kLight;
  return light.substr(0, light.size() - 1) + ", " + more + "}";
}

class TexturedLightFiles : public testing::Test {
 protected:
  scenes::Scene read(const std::string& texture_bytes, const std::string& name = "t.png") {
    (void)folder_.write(name, texture_bytes);
    return scenes::read_scene(
        folder_.write("scene.json", scene_text(kMesh, light_with("\"texture\": \"" + name + "\""))));
  }
  void refuse(const std::string& texture_bytes, const std::string& fragment) {
    const std::string message = expect_error(ExitCode::input, fragment, [&] { (void)read(texture_bytes); });
    EXPECT_NE(message.find("scene.json: /lights/0/texture: "), std::string::npos) << message;
    EXPECT_NE(message.find("t.png"), std::string::npos) << message;
    EXPECT_EQ(message.find("/proc/"), std::string::npos) << message;
  }
  std::string exr(std::uint32_t width, std::uint32_t height, const std::vector<std::string>& channels,
                  const std::vector<float>& values) {
    ExrImage image{width, height, {}, {}, {}};
    for (const std::string& name : channels) image.channels.push_back({name, std::span<const float>(values), 1});
    write_exr(folder_ / "made.exr", image);
    return read_file(folder_ / "made.exr");
  }

  TemporaryFolder folder_;
};

/// Decodes sRGB by IEC 61966-2-1, independently of the program.
double srgb(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

TEST_F(TexturedLightFiles, EightBitsOfColourAreSrgb) {
  const scenes::Scene scene = read(png_file(2, 1, 8, 2, {bytes_of({255, 128, 1, 0, 10, 11})}));
  const scenes::Texture& texture = scene.lights[0].texture.value();
  ASSERT_EQ(texture.texels.size(), 2u);
  EXPECT_EQ(texture.file, "t.png");
  EXPECT_EQ(texture.texels[0].r, 1.0f);
  EXPECT_FLOAT_EQ(texture.texels[0].g, static_cast<float>(srgb(128 / 255.0)));
  EXPECT_FLOAT_EQ(texture.texels[0].b, static_cast<float>(1 / 255.0 / 12.92));
  EXPECT_EQ(texture.texels[1].r, 0.0f);
  EXPECT_FLOAT_EQ(texture.texels[1].b, static_cast<float>(srgb(11 / 255.0)));
  EXPECT_EQ(scene.sources, std::vector<std::filesystem::path>{std::filesystem::canonical(folder_ / "t.png")});
}

TEST_F(TexturedLightFiles, SixteenBitsOfGreyAreSrgbToo) {
  // 0x0101 is 1 in 8 bits; 0x0001 is 257 times darker, too dark for 8 bits.
  const auto texture = read(png_file(3, 1, 16, 0, {bytes_of({1, 1, 0, 1, 0x80, 0})})).lights[0].texture.value();
  EXPECT_FLOAT_EQ(texture.texels[0].r, static_cast<float>(1 / 255.0 / 12.92));
  EXPECT_FLOAT_EQ(texture.texels[1].g, static_cast<float>(1 / 65535.0 / 12.92));
  EXPECT_FLOAT_EQ(texture.texels[2].b, static_cast<float>(srgb(32768 / 65535.0)));
}

TEST_F(TexturedLightFiles, AlphaPutsTexelsOnBlackInLinearLight) {
  const auto texture = read(png_file(2, 1, 8, 6, {bytes_of({255, 255, 255, 51, 200, 0, 0, 0})})).lights[0].texture;
  EXPECT_FLOAT_EQ(texture->texels[0].r, 0.2f);
  EXPECT_EQ(texture->texels[1], glm::vec3(0));
  const auto grey = read(png_file(1, 1, 16, 4, {bytes_of({0xff, 0xff, 0x80, 0})})).lights[0].texture;
  EXPECT_FLOAT_EQ(grey->texels[0].g, static_cast<float>(32768 / 65535.0));
}

TEST_F(TexturedLightFiles, PalettesBitsAndTransparentColoursAreUnderstood) {
  const std::string palette = tests::png_chunk("PLTE", bytes_of({0, 0, 0, 255, 0, 0, 0, 255, 0, 0, 0, 255})) +
                              tests::png_chunk("tRNS", bytes_of({255, 255, 0}));
  const auto indexed = read(png_file(4, 1, 2, 3, {bytes_of({0b00'01'10'11})}, palette)).lights[0].texture;
  EXPECT_EQ(indexed->texels, (std::vector<glm::vec3>{{0, 0, 0}, {1, 0, 0}, {0, 0, 0}, {0, 0, 1}}));
  const auto bits = read(png_file(3, 2, 1, 0, {bytes_of({0b101'00000}), bytes_of({0b010'00000})})).lights[0].texture;
  const glm::vec3 black(0), white(1);
  EXPECT_EQ(bits->texels, (std::vector<glm::vec3>{white, black, white, black, white, black}));
}

TEST_F(TexturedLightFiles, AGammaChunkChangesNothing) {
  const std::string gamma = tests::png_chunk("gAMA", bytes_of({0, 1, 0x86, 0xa0}));  // 100000 declares linear values
  const std::vector<std::string> rows = {bytes_of({128, 64, 32})};
  EXPECT_EQ(read(png_file(1, 1, 8, 2, rows, gamma)).lights[0].texture->texels,
            read(png_file(1, 1, 8, 2, rows)).lights[0].texture->texels);
}

TEST_F(TexturedLightFiles, OpenExrIsLinearAndMayBeBrighterThanOne) {
  const std::vector<float> values = {0, 1e-6f, 7, 1e30f};
  const auto color = read(exr(2, 2, {"R", "G", "B", "A"}, values), "t.exr").lights[0].texture;
  EXPECT_EQ(color->texels, (std::vector<glm::vec3>{glm::vec3(0), glm::vec3(1e-6f), glm::vec3(7), glm::vec3(1e30f)}));
  EXPECT_EQ(color->width, 2u);
  const auto grey = read(exr(4, 1, {"Y"}, values), "t.exr").lights[0].texture;
  EXPECT_EQ(grey->texels, color->texels);
  // The first bytes of a file, not its name, decide its format.
  EXPECT_EQ(read(exr(2, 2, {"R", "G", "B"}, values), "t.png").lights[0].texture->texels, color->texels);
}

/// Lossy compression and resampling leave small negative values: they become 0, with a warning.
TEST_F(TexturedLightFiles, NegativeValuesAreNoneAndAreNamed) {
  const scenes::Scene scene = read(exr(3, 1, {"R", "G", "B"}, {1, -0.5f, -1e-6f}), "t.exr");
  EXPECT_EQ(scene.lights[0].texture->texels, (std::vector<glm::vec3>{glm::vec3(1), glm::vec3(0), glm::vec3(0)}));
  EXPECT_THAT(scene.warnings,
              testing::Contains(testing::HasSubstr("negative values in 2 of its texels (down to -0.5)")));
}

TEST_F(TexturedLightFiles, BadPicturesAreRefusedWithTheReason) {
  const std::string good = png_file(1, 1, 8, 0, {bytes_of({9})});
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  refuse("", "the file is empty (0 bytes)");
  refuse("GIF89a", "neither a PNG nor an OpenEXR picture");
  refuse(good.substr(0, 40), "the file ends too early");
  refuse(std::string(good).replace(45, 1, "\x7f"), "no readable PNG picture");
  refuse(png_file(2, 2, 8, 0, {bytes_of({0, 0}), bytes_of({0, 0})}), "every texel is black");
  refuse(png_file(2, 1, 8, 6, {bytes_of({9, 9, 9, 0, 9, 9, 9, 0})}), "every texel is black");
  refuse(png_file(2049, 1, 8, 0, {std::string(2049, 'x')}), "2049x1 pixels; at most 2048 a side");
  refuse(png_file(900'000, 900'000, 8, 0, {}), "900000x900000 pixels; at most 2048 a side");
  refuse(exr(2049, 1, {"R", "G", "B"}, std::vector<float>(2049, 1)), "2049x1 pixels; at most 2048 a side");
  refuse(exr(1, 2, {"R", "G", "B"}, {0, -0.5f}), "every texel is black");
  refuse(exr(1, 2, {"R", "G", "B"}, {1, -std::numeric_limits<float>::infinity()}),
         "texel (0, 1) from the top left is (-inf");
  refuse(exr(2, 1, {"R", "G", "B"}, {1, kNan}), "texel (1, 0) from the top left is (nan, nan, nan)");
  refuse(exr(1, 1, {"R", "G", "B"}, {std::numeric_limits<float>::infinity()}), "expected finite numbers");
  refuse(exr(1, 1, {"diffuse.R", "G"}, {1}), "this file has: G, diffuse.R");
  refuse(exr(64, 64, {"R", "G", "B"}, std::vector<float>(4096, 1)).substr(0, 400), "no readable OpenEXR image");
  expect_error(ExitCode::input, "; expected a product of at most 1e+36", [&] {
    (void)read(exr(1, 1, {"R", "G", "B"}, {3e37f}));
  });
}

TEST_F(TexturedLightFiles, OnlyRectanglesHaveOneAndOnlyInsideTheFolder) {
  (void)folder_.write("t.png", png_file(1, 1, 8, 0, {bytes_of({9})}));
  const auto refused = [&](const std::string& light, const std::string& fragment) {
    const std::filesystem::path scene = folder_.write("inside/scene.json", scene_text(kMesh, light));
    return expect_error(ExitCode::input, fragment, [&] { (void)scenes::read_scene(scene); });
  };
  const std::string disk = R"({"disk": {"center": [0,4,0], "normal": [0,-1,0], "radius": 1}, "texture": "t.png"})";
  EXPECT_NE(refused(disk, "only a \"rectangle\" light can have a texture").find("/lights/0/texture"),
            std::string::npos);
  refused(light_with(R"("texture": "../t.png")"), "--allow-outside");
  refused(light_with(R"("texture": "nowhere.png")"), "no such file \"nowhere.png\"");
  refused(light_with(R"("texture": "")"), "/lights/0/texture: expected a string of at least 1 character");
  refused(light_with(R"("texture": 3)"), "/lights/0/texture: expected a string");
  refused(light_with(R"("texture": ".")"), "it is a folder, not a file");
  const auto scene = folder_.write("inside/scene.json", scene_text(kMesh, light_with(R"("texture": "../t.png")")));
  EXPECT_TRUE(scenes::read_scene(scene, {.allow_outside = true}).lights[0].texture.has_value());
}

TEST_F(TexturedLightFiles, WrittenScenesReadBackToTheLastBit) {
  const scenes::Scene before = read(exr(2, 2, {"R", "G", "B"}, {0, 1e-30f, 0.1f, 1e30f}), "t.exr");
  std::filesystem::create_directory(folder_ / "moved");
  EXPECT_TRUE(scenes::write_scene(before, folder_ / "moved/copy.json").empty());
  std::filesystem::remove(folder_ / "t.exr");  // the copy must not depend on the original
  const scenes::Scene after = scenes::read_scene(folder_ / "moved/copy.json");
  EXPECT_EQ(after.lights[0].texture->file, "copy-light0.exr");
  EXPECT_EQ(after.lights[0].texture->texels, before.lights[0].texture->texels);
  EXPECT_EQ(after.lights[0].texture->width, 2u);
}

TEST_F(TexturedLightFiles, GlbKeepsTheMeanColourAndSaysSo) {
  const scenes::Scene before = read(exr(2, 1, {"R", "G", "B"}, {0, 0.5f}), "t.exr");
  const std::vector<std::string> losses = scenes::write_scene(before, folder_ / "copy.glb");
  ASSERT_EQ(losses.size(), 1u);
  EXPECT_EQ(losses[0], "light \"key\": its texture is replaced by its mean colour");
  const scenes::Scene after = scenes::read_scene(folder_ / "copy.glb");
  ASSERT_EQ(after.lights.size(), 1u);
  EXPECT_FALSE(after.lights[0].texture.has_value());
  EXPECT_EQ(after.lights[0].radiance, glm::dvec3(2.5));  // 10 times the mean of 0 and 1/2
}

TEST_F(TexturedLightFiles, TheShippedWindowIsWhatItsSceneSays) {
  // Bars at every fifth texel; panes cool, white and warm from left to right, and full, 3/4 and 1/2 bright from top to
  // bottom.
  const scenes::Scene scene = scenes::read_scene(std::filesystem::path(PENUMBRA_SCENES) / "textured-light.json");
  const scenes::Texture& texture = scene.lights[0].texture.value();
  ASSERT_EQ(texture.width, 16u);
  ASSERT_EQ(texture.height, 16u);
  constexpr int kPanes[3][3] = {{120, 170, 255}, {255, 255, 255}, {255, 190, 110}};
  for (std::uint32_t y = 0; y < 16; ++y) {
    for (std::uint32_t x = 0; x < 16; ++x) {
      for (int c = 0; c < 3; ++c) {
        const bool bar = x % 5 == 0 || y % 5 == 0;
        const int byte = bar ? 0 : kPanes[x / 5][c] * (4 - static_cast<int>(y / 5)) / 4;
        ASSERT_FLOAT_EQ(texture.texels[y * 16 + x][c], static_cast<float>(srgb(byte / 255.0))) << x << ", " << y;
      }
    }
  }
}

}  // namespace
}  // namespace penumbra::test
