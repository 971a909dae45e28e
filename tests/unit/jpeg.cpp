// SPDX-License-Identifier: Apache-2.0
#include "base/jpeg.hpp"

#include "base/error.hpp"

#include <cstdio>  // before jpeglib.h, which does not include it

#include <jpeglib.h>

#include <gtest/gtest.h>

#include <cstdlib>
#include <optional>
#include <vector>

namespace penumbra {
namespace {

/// Encodes eight bright columns of the first component, and dark ones, at full quality without chroma subsampling.
std::vector<std::byte> encoded(std::uint32_t width, std::uint32_t height, J_COLOR_SPACE colors,
                               std::optional<J_COLOR_SPACE> stored = {}, bool adobe = true) {
  jpeg_error_mgr errors{};
  jpeg_compress_struct jpeg{};
  jpeg.err = jpeg_std_error(&errors);
  jpeg_create_compress(&jpeg);
  unsigned char* data = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&jpeg, &data, &size);
  jpeg.image_width = width;
  jpeg.image_height = height;
  jpeg.input_components = colors == JCS_GRAYSCALE ? 1 : colors == JCS_CMYK ? 4 : 3;
  jpeg.in_color_space = colors;
  jpeg_set_defaults(&jpeg);
  if (stored) jpeg_set_colorspace(&jpeg, *stored);
  if (!adobe) jpeg.write_Adobe_marker = FALSE;
  jpeg_set_quality(&jpeg, 100, TRUE);
  for (int i = 0; i < jpeg.num_components; ++i) jpeg.comp_info[i].h_samp_factor = jpeg.comp_info[i].v_samp_factor = 1;
  jpeg_start_compress(&jpeg, TRUE);
  const auto components = static_cast<std::size_t>(jpeg.input_components);
  std::vector<JSAMPLE> row(components * width);
  for (std::size_t x = 0; x < width; ++x) {
    for (std::size_t c = 0; c < components; ++c) row[components * x + c] = c == 0 && x < 8 ? 250 : 20;
  }
  JSAMPROW rows = row.data();
  while (jpeg.next_scanline < jpeg.image_height) jpeg_write_scanlines(&jpeg, &rows, 1);
  jpeg_finish_compress(&jpeg);
  jpeg_destroy_compress(&jpeg);
  const auto* first = reinterpret_cast<const std::byte*>(data);
  std::vector<std::byte> bytes(first, first + size);
  std::free(data);
  return bytes;
}

std::string refusal(std::span<const std::byte> bytes, std::uint32_t largest = 100) {
  try {
    decode_rgba_jpeg(bytes, largest);
  } catch (const InputError& error) {
    return error.what();
  }
  return "none";
}

TEST(Jpeg, DecodesColoursAndGrey) {
  for (const J_COLOR_SPACE colors : {JCS_RGB, JCS_GRAYSCALE}) {
    const RgbaImage image = decode_rgba_jpeg(encoded(16, 9, colors), 16);
    ASSERT_EQ(image.width, 16u);
    ASSERT_EQ(image.height, 9u);
    ASSERT_EQ(image.pixels.size(), 144u);
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
      const bool bright = i % 16 < 8;
      EXPECT_NEAR(image.pixels[i][0], bright ? 250 : 20, 2) << i;
      EXPECT_NEAR(image.pixels[i][1], bright && colors == JCS_GRAYSCALE ? 250 : 20, 2) << i;
      EXPECT_EQ(image.pixels[i][3], 255);
    }
  }
}

/// Cyan is 250 or 20, the other inks are 20. In Adobe's files the numbers are 255 minus the ink: red is 250 · 20 / 255
/// or 20 · 20 / 255. In other files they are inks: red is (255 − 250) · (255 − 20) / 255 or 235² / 255. Each of the two
/// factors has an error of at most 2 (the DCT and, in YCCK, the colours round), times the other factor / 255, up to 235
/// / 255: 2 · 2 · 235 / 255 < 4.
TEST(Jpeg, MixesInks) {
  struct Case {
    std::optional<J_COLOR_SPACE> stored;
    bool adobe;
    int cyan, other;  ///< red in the columns of much cyan; all other values
  };
  for (const Case& inks : {Case{{}, true, 20, 2}, Case{JCS_YCCK, true, 20, 2}, Case{{}, false, 5, 217}}) {
    const RgbaImage image = decode_rgba_jpeg(encoded(16, 9, JCS_CMYK, inks.stored, inks.adobe), 16);
    ASSERT_EQ(image.pixels.size(), 144u);
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
      EXPECT_NEAR(image.pixels[i][0], i % 16 < 8 ? inks.cyan : inks.other, 4) << i;
      EXPECT_NEAR(image.pixels[i][1], inks.other, 4) << i;
      EXPECT_NEAR(image.pixels[i][2], inks.other, 4) << i;
      EXPECT_EQ(image.pixels[i][3], 255);
    }
  }
}

TEST(Jpeg, RefusesWhatItCannotDecode) {
  std::vector<std::byte> bytes = encoded(16, 16, JCS_RGB);
  EXPECT_TRUE(looks_like_jpeg(bytes));
  EXPECT_EQ(refusal(bytes, 15), "16x16 pixels; at most 15 a side");
  EXPECT_NE(refusal(std::span(bytes).first(bytes.size() / 2)).find("damaged"), std::string::npos);
  EXPECT_NE(refusal(std::span(bytes).first(3)).find("damaged"), std::string::npos);
  bytes[0] = std::byte{0};
  EXPECT_EQ(refusal(bytes), "not a JPEG picture");
  EXPECT_FALSE(looks_like_jpeg({}));
}

TEST(Jpeg, WhatIsWrittenIsReadAgainNearlyTheSame) {
  Image8 image{37, 21, {}};
  for (std::uint32_t y = 0; y < image.height; ++y) {
    for (std::uint32_t x = 0; x < image.width; ++x)
      image.pixels.push_back({static_cast<std::uint8_t>(6 * x), static_cast<std::uint8_t>(12 * y), 128});
  }
  const std::vector<std::byte> bytes = encode_jpeg(image, 95);
  ASSERT_TRUE(looks_like_jpeg(bytes));
  const RgbaImage read = decode_rgba_jpeg(bytes, 64);
  ASSERT_EQ(read.width, image.width);
  ASSERT_EQ(read.height, image.height);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(read.pixels[i].at(c), image.pixels[i].at(c), 8) << i;
  }
  EXPECT_LT(encode_jpeg(image, 40).size(), bytes.size());
  EXPECT_THROW(encode_jpeg({}, 90), ResourceError);
  EXPECT_THROW(encode_jpeg({70'000, 1, std::vector<Color8>(70'000)}, 90), ResourceError);
}

}  // namespace
}  // namespace penumbra
