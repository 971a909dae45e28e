// SPDX-License-Identifier: Apache-2.0
#include "visibility/masks/bits_file.hpp"

#include "base/error.hpp"
#include "tests/unit/bits_reader.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace penumbra::visibility {
namespace {

namespace fs = std::filesystem;
using tests::BitsFile, tests::read_bits;

/// Writes the whole file at once.
void write_bits(const fs::path& path, const glm::dvec3& origin, const ViewSamples& samples, const Light& light,
                std::span<const std::uint32_t> masks) {
  BitsWriter writer(path, origin, samples, light);
  writer.append(masks);
  writer.commit();
}

/// Pictures of 2 × 2 pixels, 33 light samples: two words for each pixel; the second word has one bit.
struct Sample {
  ViewSamples samples;
  Light light;
  std::vector<std::uint32_t> masks{0xffffffffu, 1, 0, 0, 0x80000001u, 1, 5, 0};
  glm::dvec3 origin{0.1, 2, -3e10};

  Sample() {
    samples.width = samples.height = 2;
    samples.triangle = {-1, 7, 0, 1 << 20};
    samples.p = {{0, 0, 0}, {1, 2, 3}, {-1, 0.5f, 1e-30f}, {4, 5, 6}};
    light.name = "key";
    for (int j = 0; j < 33; ++j) light.points.emplace_back(static_cast<float>(j), 5.0f, -static_cast<float>(j));
    light.coordinates.resize(33);
  }
};

class BitsFileTest : public testing::Test {
 protected:
  fs::path path_ = fs::path(testing::TempDir()) /
                   (std::string("penumbra_bits_") + testing::UnitTest::GetInstance()->current_test_info()->name());
  ~BitsFileTest() override { fs::remove(path_); }

  [[nodiscard]] std::string bytes() const {
    std::ifstream stream(path_, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  }
};

template <typename Value>
Value value_at(const std::string& bytes, std::size_t offset) {
  Value value;
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

TEST_F(BitsFileTest, HasTheLayoutOfItsDescription) {
  const Sample sample;
  write_bits(path_, sample.origin, sample.samples, sample.light, sample.masks);
  const std::string text = bytes();
  ASSERT_EQ(text.substr(0, 23), "penumbra-bits/1 2 2 33\n");
  // Header of 23 bytes, origin 3·8, 33·12 of points, 4 pixels of 12 + 4 + 2·4.
  ASSERT_EQ(text.size(), 23u + 24 + 396 + 4 * 24);
  EXPECT_EQ(value_at<double>(text, 23), 0.1);
  EXPECT_EQ(value_at<double>(text, 39), -3e10);
  EXPECT_EQ(value_at<float>(text, 47 + 12 * 32), 32.0f);  // the last light point's x
  EXPECT_EQ(value_at<std::int32_t>(text, 443 + 12), -1);  // pixel 0 is background
  EXPECT_EQ(value_at<float>(text, 443 + 24 + 8), 3.0f);   // pixel 1's z
  EXPECT_EQ(value_at<std::int32_t>(text, 443 + 24 + 12), 7);
  EXPECT_EQ(static_cast<unsigned char>(text[443 + 48 + 16]),
            0x01);  // pixel 2, sample 0 in the lowest bit of the first byte
  EXPECT_EQ(static_cast<unsigned char>(text[443 + 48 + 19]), 0x80);  // and sample 31 in the highest of the fourth
  EXPECT_EQ(static_cast<unsigned char>(text[443 + 48 + 20]), 0x01);  // sample 32 in the next word
}

TEST_F(BitsFileTest, ReadsBackWhatBandsWrote) {
  const Sample sample;
  {
    BitsWriter writer(path_, sample.origin, sample.samples, sample.light);
    writer.append(std::span(sample.masks).first(4));
    EXPECT_FALSE(fs::exists(path_));  // whole or not at all
    writer.append(std::span(sample.masks).subspan(4));
    writer.commit();
  }
  const BitsFile file = read_bits(path_);
  EXPECT_EQ(file.width, 2u);
  EXPECT_EQ(file.height, 2u);
  EXPECT_EQ(file.sample_count, 33u);
  EXPECT_EQ(file.words_per_mask(), 2u);
  EXPECT_EQ(file.origin, sample.origin);
  EXPECT_EQ(file.light_points, sample.light.points);
  EXPECT_EQ(file.p, sample.samples.p);
  EXPECT_EQ(file.triangle, sample.samples.triangle);
  EXPECT_EQ(file.masks, sample.masks);
}

TEST_F(BitsFileTest, AnUnfinishedFileNeverAppears) {
  const Sample sample;
  { BitsWriter writer(path_, sample.origin, sample.samples, sample.light); }
  EXPECT_FALSE(fs::exists(path_));
}

TEST_F(BitsFileTest, ASphereIsWrongUsage) {
  Sample sample;
  sample.light.kind = LightKind::sphere;
  sample.light.points.clear();
  try {
    write_bits(path_, sample.origin, sample.samples, sample.light, sample.masks);
    FAIL() << "a sphere was written";
  } catch (const UsageError& error) {
    EXPECT_EQ(error.code(), ExitCode::usage);
    EXPECT_NE(std::string(error.what()).find("\"key\""), std::string::npos) << error.what();
  }
  EXPECT_FALSE(fs::exists(path_));
}

TEST_F(BitsFileTest, ReadingRefusesDamagedFiles) {
  const Sample sample;
  write_bits(path_, sample.origin, sample.samples, sample.light, sample.masks);
  const std::string whole = bytes();
  const auto refused = [&](const std::string& text) {
    std::ofstream(path_, std::ios::binary) << text;
    EXPECT_THROW(read_bits(path_), InputError) << text.substr(0, 30);
  };
  refused(whole.substr(0, whole.size() - 1));
  refused(whole + "x");
  refused("penumbra-bits/2" + whole.substr(15));
  refused("penumbra-bits/1 2 2 0\n");
  refused("penumbra-bits/1 999999999 999999999 4096\n");
  refused("");
  fs::remove(path_);
  EXPECT_THROW(read_bits(path_), InputError);
}

}  // namespace
}  // namespace penumbra::visibility
