// SPDX-License-Identifier: Apache-2.0
// Tests the reader of Radiance pictures: headers, the three encodings of scan lines, and files that are refused.

#include "base/error.hpp"
#include "base/rgbe.hpp"

#include <gtest/gtest.h>

#include <string>
#include <string_view>

namespace penumbra {
namespace {

LinearImage decode(std::string_view text, std::uint32_t largest_side = 64) {
  return decode_rgbe(std::as_bytes(std::span(text)), largest_side);
}

std::string with_header(const std::string& size, const std::string& lines = "FORMAT=32-bit_rle_rgbe\n") {
  return "#?RADIANCE\n# a comment\n" + lines + "\n" + size + "\n";
}

/// Mantissas 128, 64, 32 with the exponent 129: 1, 1/2, 1/4.
const std::string kPixel("\x80\x40\x20\x81", 4);

TEST(Rgbe, AMantissaTimesTheSharedPowerOfTwo) {
  const LinearImage image = decode(with_header("-Y 1 +X 2") + kPixel + std::string("\xff\xff\xff\x00", 4));
  ASSERT_EQ(image.pixels.size(), 2U);
  EXPECT_EQ(image.pixels[0], glm::vec3(1, 0.5, 0.25));
  EXPECT_EQ(image.pixels[1], glm::vec3(0)) << "exponent 0 is black";
}

TEST(Rgbe, ExposuresAreTakenBack) {
  const LinearImage image = decode(with_header("-Y 1 +X 1", "EXPOSURE=2\nEXPOSURE= 4.0\n") + kPixel);
  EXPECT_EQ(image.pixels.front(), glm::vec3(0.125, 0.0625, 0.03125));
}

TEST(Rgbe, RowsAndPixelsRunAsTheSizeSays) {
  const std::string dark("\x80\x80\x80\x80", 4);  // 1/2
  const LinearImage upward = decode(with_header("+Y 2 +X 1") + kPixel + dark);
  EXPECT_EQ(upward.pixels[0], glm::vec3(0.5));
  const LinearImage leftward = decode(with_header("-Y 1 -X 2") + kPixel + dark);
  EXPECT_EQ(leftward.pixels[0], glm::vec3(0.5));
}

/// Decodes nine pixels: a run of eight and one literal in each channel.
TEST(Rgbe, PlanesAreInRuns) {
  std::string text = with_header("-Y 1 +X 9") + std::string("\x02\x02\x00\x09", 4);
  for (const char* const pair : {"\x80\x40", "\x40\x20", "\x20\x10", "\x81\x81"})
    text += std::string("\x88", 1) + pair[0] + std::string("\x01", 1) + pair[1];
  const LinearImage image = decode(text);
  for (std::size_t x = 0; x < 8; ++x) EXPECT_EQ(image.pixels[x], glm::vec3(1, 0.5, 0.25));
  EXPECT_EQ(image.pixels[8], glm::vec3(0.5, 0.25, 0.125));
}

/// Decodes one pixel and two old runs, which repeat it 3 and 256 times.
TEST(Rgbe, OldRunsRepeatTheLastPixel) {
  const LinearImage image = decode(
      with_header("-Y 1 +X 260") + kPixel + std::string("\x01\x01\x01\x03", 4) + std::string("\x01\x01\x01\x01", 4),
      512);
  for (const glm::vec3& pixel : image.pixels) EXPECT_EQ(pixel, glm::vec3(1, 0.5, 0.25));
}

TEST(Rgbe, WhatIsNoneIsRefused) {
  EXPECT_FALSE(is_rgbe(std::as_bytes(std::span(std::string_view("#?OTHER\n")))));
  for (const std::string& text :
       {std::string("#?RADIANCE\n"), with_header("-Y 1 +X 1"), with_header("+X 1 -Y 1") + kPixel,
        with_header("-Y 0 +X 1") + kPixel, with_header("-Y 1 +X 65") + kPixel,
        with_header("-Y 1 +X 1", "FORMAT=32-bit_rle_xyze\n") + kPixel,
        with_header("-Y 1 +X 1", "EXPOSURE=0\n") + kPixel,
        with_header("-Y 1 +X 9") + std::string("\x02\x02\x00\x08\x88\x01", 6),   // another width
        with_header("-Y 1 +X 9") + std::string("\x02\x02\x00\x09\xff\x01", 6),   // a run beyond the line
        with_header("-Y 1 +X 9") + std::string("\x02\x02\x00\x09\x00\x01", 6),   // a run of nothing
        with_header("-Y 1 +X 4") + std::string("\x01\x01\x01\x01", 4) + kPixel,  // a run before any pixel
        with_header("-Y 1 +X 4") + kPixel + std::string("\x01\x01\x01\x09", 4)}) {
    EXPECT_THROW(decode(text), InputError) << text;
  }
}

}  // namespace
}  // namespace penumbra
