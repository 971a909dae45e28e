// SPDX-License-Identifier: Apache-2.0
// Tests the packing of the report's data: each packing is undone here in a few lines of C++, as the report's script
// does.
#include "base/packed.hpp"
#include "compare/report_data.hpp"

#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <string>
#include <vector>

namespace penumbra::compare {
namespace {

std::vector<std::uint8_t> from_base64(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<std::uint8_t> bytes;
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    if (c == '=') break;
    bits = bits << 6 | static_cast<std::uint32_t>(digits.find(c));
    count += 6;
    if (count >= 8) {
      count -= 8;
      bytes.push_back(static_cast<std::uint8_t>(bits >> count & 0xff));
    }
  }
  return bytes;
}

std::vector<std::uint8_t> unpack(const std::string& text, std::size_t size) {
  const std::vector<std::uint8_t> packed = from_base64(text);
  std::vector<std::uint8_t> bytes(size + 1);
  uLongf length = bytes.size();
  EXPECT_EQ(uncompress(bytes.data(), &length, packed.data(), packed.size()), Z_OK);
  EXPECT_EQ(length, size);
  bytes.resize(length);
  return bytes;
}

/// Returns number i of `count` numbers whose bytes are stored in planes, the most significant first.
std::uint32_t number_at(const std::vector<std::uint8_t>& planes, std::size_t count, std::size_t i) {
  std::uint32_t number = 0;
  for (std::size_t plane = 0; plane < planes.size() / count; ++plane) number = number << 8 | planes[plane * count + i];
  return number;
}

TEST(ReportData, Base64IsThatOfTheStandard) {
  // RFC 4648, section 10.
  const std::vector<std::string> expected{"", "Zg==", "Zm8=", "Zm9v", "Zm9vYg==", "Zm9vYmE=", "Zm9vYmFy"};
  const std::string text = "foobar";
  for (std::size_t i = 0; i <= text.size(); ++i)
    EXPECT_EQ(base64(std::as_bytes(std::span(text).first(i))), expected[i]);
}

TEST(ReportData, DeflatedInPartsIsDeflatedAtOnce) {
  std::vector<std::byte> bytes(300000);
  std::mt19937 random(7);  // a quarter of the bytes is noise, so that there is more than one block
  for (std::size_t i = 0; i < bytes.size(); i += 4) bytes[i] = static_cast<std::byte>(random());
  Deflated whole, parts;
  whole.add(bytes);
  for (std::size_t i = 0; i < bytes.size(); i += 7777)
    parts.add(std::span(bytes).subspan(i, std::min<std::size_t>(7777, bytes.size() - i)));
  const auto result = whole.finish();
  EXPECT_EQ(result, parts.finish());
  const auto back = unpack(base64(result), bytes.size());
  EXPECT_EQ(std::memcmp(back.data(), bytes.data(), bytes.size()), 0);
  Deflated nothing;
  EXPECT_TRUE(unpack(base64(nothing.finish()), 0).empty());
}

TEST(ReportData, FloatsComeBackBitByBit) {
  using Limits = std::numeric_limits<float>;
  const std::vector<float> values{0.0f, 1.0f, 1.0f / 3, -0.0f, Limits::quiet_NaN(), Limits::denorm_min(), 143.0f / 256};
  const auto planes = unpack(pack_floats(values), 4 * values.size());
  for (std::size_t i = 0; i < values.size(); ++i)
    EXPECT_EQ(number_at(planes, values.size(), i), std::bit_cast<std::uint32_t>(values[i])) << i;
}

TEST(ReportData, RadianceComesBackWithinHalfAStepOfItsCode) {
  // Five pixels in a row: neighbours that differ by the whole range, black pixels, a negative one, one that is not a
  // number.
  const std::vector<glm::vec3> pixels{{0, 0, 0},       {1, 2, 3},          {1e-19f, 1e18f, 0.25f}, {0, 1e18f, 1e-19f},
                                      {0.3f, 0.3f, 0}, {10, 10, 10},       {9.9f, 0.001f, 5},      {-1, 0.5f, 0.5f},
                                      {NAN, 1, 1},     {0.5f, 0.25f, 1.0f}};
  const std::size_t count = pixels.size();
  const auto planes = unpack(pack_radiance(5, pixels), 6 * count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto sum = [&](std::size_t plane) {  // adds the steps from the row's first pixel to this one
      std::uint32_t code = 0;
      for (std::size_t k = i / 5 * 5; k <= i; ++k) code += number_at(planes, 3 * count, plane * count + k);
      return code & 0xffff;
    };
    const std::uint32_t green = sum(0), red = (green + sum(1)) & 0xffff, blue = (green + sum(2)) & 0xffff;
    const std::uint32_t codes[3] = {red, green, blue};
    for (int c = 0; c < 3; ++c) {
      const float wanted = pixels[i][c];
      if (!(wanted > 0)) {
        EXPECT_EQ(codes[c], 0u) << i << ' ' << c;
        continue;
      }
      const double got = std::exp2((static_cast<double>(codes[c]) - 1) / 256 - 64);
      // Half a step is 1/512 of a stop; 1e-9 is room for the rounding of log2 and exp2 at 64 stops.
      EXPECT_LE(std::abs(std::log2(got / static_cast<double>(wanted))), 1.0 / 512 + 1e-9) << i << ' ' << c;
    }
  }
}

/// The radiance unpacked here is within two codes, 1/128 of a stop, of the original, and black where that is black.
TEST(ReportData, RadianceOverTheReferencesComesBackWithinTwoCodes) {
  const std::vector<glm::vec3> reference{{1, 2, 3}, {0, 0, 0}, {1e-19f, 1e18f, 0.25f}, {0.3f, 0.3f, 0.3f}, {1, 1, 1}};
  const std::vector<glm::vec3> pixels{{1, 2, 3}, {1, 2, 3}, {0.5f, 0.25f, 1.0f}, {0.31f, 0.29f, 0.3f}, {0, -1, 1e-30f}};
  const std::size_t count = pixels.size();
  const auto code = [](float linear) {
    return linear > 0 ? std::lround(std::clamp(1 + 256 * (std::log2(static_cast<double>(linear)) + 64), 1.0, 32767.0))
                      : 0;
  };
  const auto planes = unpack(pack_radiance_over(reference, pixels), 6 * count);
  const auto steps = [&](std::size_t plane, std::size_t i) {
    const auto folded = static_cast<long>(number_at(planes, 3 * count, plane * count + i));
    return folded % 2 == 0 ? folded / 2 : -(folded + 1) / 2;
  };
  for (std::size_t i = 0; i < count; ++i) {
    const long green = steps(0, i);
    const long all[3] = {green + steps(1, i), green, green + steps(2, i)};
    for (int c = 0; c < 3; ++c) {
      const long got = std::clamp(code(reference[i][c]) + 4 * all[c], 0L, 32767L);
      EXPECT_LE(std::abs(got - code(pixels[i][c])), 2) << i << ' ' << c;
    }
  }
  // A picture of equal pixels takes almost no bytes.
  const std::vector<glm::vec3> large(10000, {0.2f, 0.4f, 0.1f});
  EXPECT_LT(pack_radiance_over(large, large).size(), 200u);
}

}  // namespace
}  // namespace penumbra::compare
