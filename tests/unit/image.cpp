// SPDX-License-Identifier: Apache-2.0
#include "base/error.hpp"
#include "base/image.hpp"
#include "base/png.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>

namespace penumbra {
namespace {

Image8 small_picture() {
  return {3, 2, {{255, 0, 0}, {0, 255, 0}, {0, 0, 255}, {0, 0, 0}, {128, 128, 128}, {1, 2, 3}}};
}

TEST(Image, SrgbBytesFollowTheStandardsCurve) {
  EXPECT_EQ(srgb_byte(0.0f), 0);
  EXPECT_EQ(srgb_byte(1.0f), 255);
  EXPECT_EQ(srgb_byte(0.5f), 188);       // 1.055 · 0.5^(1/2.4) − 0.055 = 0.73536; · 255 = 187.5
  EXPECT_EQ(srgb_byte(0.18f), 118);      // 0.46136 · 255 = 117.6
  EXPECT_EQ(srgb_byte(0.001f), 3);       // the linear part: 12.92 · 0.001 · 255 = 3.29
  EXPECT_EQ(srgb_byte(0.214041f), 127);  // slightly below 0.5 · 255 = 127.5
  EXPECT_EQ(srgb_byte(-1.0f), 0);
  EXPECT_EQ(srgb_byte(1e30f), 255);
  EXPECT_EQ(srgb_byte(std::numeric_limits<float>::infinity()), 255);
  EXPECT_EQ(srgb_byte(std::numeric_limits<float>::quiet_NaN()), 0);
}

TEST(Image, ExposureMultipliesLinearColours) {
  const std::vector<glm::vec3> linear{{0.25f, 0.0f, 1.0f}};
  EXPECT_EQ(to_srgb(1, 1, linear, 2.0f).pixels[0], (Color8{188, 0, 255}));
}

TEST(Png, KeepsEveryPixel) {
  const Image8 image = small_picture();
  const RgbaImage back = decode_rgba_png(encode_png(image), 3);
  EXPECT_EQ(back.width, 3u);
  EXPECT_EQ(back.height, 2u);
  ASSERT_EQ(back.pixels.size(), image.pixels.size());
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    const auto& [red, green, blue] = image.pixels[i];
    EXPECT_EQ(back.pixels[i], (std::array<std::uint8_t, 4>{red, green, blue, 255}));
  }
}

TEST(Png, IsMarkedAsSrgbAndCarriesNoDate) {
  const std::vector<std::byte> bytes = encode_png(small_picture());
  const std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  EXPECT_EQ(text.substr(0, 8), "\x89PNG\r\n\x1a\n");
  EXPECT_NE(text.find("sRGB"), std::string::npos);
  EXPECT_EQ(text.find("tIME"), std::string::npos);
  EXPECT_EQ(bytes, encode_png(small_picture()));
}

TEST(Png, DataUriIsBase64) {
  // A PNG's first six bytes 89 50 4e 47 0d 0a are "iVBORw0K" in base64, its last chunk ends ae 42 60 82.
  const std::string uri = png_data_uri(small_picture());
  EXPECT_TRUE(uri.starts_with("data:image/png;base64,iVBORw0K")) << uri.substr(0, 40);
  const std::string text = uri.substr(uri.find(',') + 1);
  EXPECT_EQ(text.size() % 4, 0u);
  EXPECT_EQ(text.size(), (encode_png(small_picture()).size() + 2) / 3 * 4);
  EXPECT_EQ(text.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/="),
            std::string::npos);
}

TEST(Png, FileAppearsWhole) {
  const auto path = std::filesystem::path(testing::TempDir()) / "penumbra_image_test.png";
  write_png(path, small_picture());
  EXPECT_EQ(std::filesystem::file_size(path), encode_png(small_picture()).size());
  std::filesystem::remove(path);
}

TEST(Png, RefusesWhatIsNoPicture) {
  EXPECT_THROW(encode_png({}), ResourceError);
  const std::vector<std::byte> nonsense(100, std::byte{7});
  EXPECT_THROW(decode_rgba_png(nonsense, 100), InputError);
  std::vector<std::byte> cut = encode_png(small_picture());
  cut.resize(cut.size() / 2);
  EXPECT_THROW(decode_rgba_png(cut, 100), InputError);
}

}  // namespace
}  // namespace penumbra
