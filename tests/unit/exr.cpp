// SPDX-License-Identifier: Apache-2.0
#include "base/error.hpp"
#include "base/exr.hpp"

#include <gtest/gtest.h>

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfTestFile.h>
#include <OpenEXR/ImfVecAttribute.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <random>
#include <string>
#include <utility>

namespace penumbra {
namespace {

namespace fs = std::filesystem;

/// Each test has its own folder, deleted afterwards.
class Exr : public testing::Test {
 protected:
  Exr() {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::path(testing::TempDir()) / (std::string("penumbra_exr_") + info->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  ~Exr() override { fs::remove_all(folder_); }

  [[nodiscard]] fs::path file(const std::string& name = "out.exr") const { return folder_ / name; }
  [[nodiscard]] std::size_t file_count() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }

  fs::path folder_;
};

std::string bytes_of(const fs::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

/// An image of 37 × 21 pixels (not a multiple of ZIP's 16 lines) with values that a lossy or half-precision writer
/// would change.
struct Sample {
  static constexpr std::uint32_t kWidth = 37, kHeight = 21;
  std::vector<float> v;
  std::vector<glm::vec3> p;
  std::vector<std::uint32_t> id;
  ExrImage image;

  Sample() {
    for (std::uint32_t i = 0; i < kWidth * kHeight; ++i) {
      v.push_back(1.0f / static_cast<float>(i + 1));
      p.emplace_back(static_cast<float>(i) * 1e-3f, -1e30f, std::nextafter(1.0f, 2.0f));
      id.push_back(0xffffffffu - i);
    }
    v[3] = std::numeric_limits<float>::infinity();
    v[4] = -0.0f;
    v[5] = std::numeric_limits<float>::denorm_min();
    image.width = kWidth;
    image.height = kHeight;
    image.channels = {{"V.a light with spaces", std::span<const float>(v)}, {"id", std::span<const std::uint32_t>(id)}};
    add_vector_channels(image, "P", p);
    image.attributes = {
        {"penumbra.method", "view-sample"}, {"penumbra.scene", "b\xc3\xbcnny.json"}, {"penumbra.options", ""}};
    image.vectors = {{"penumbra.origin", {0.1, -1e100, 1.0 / 3}}};
  }
};

/// A scene of a hundred thousand lights has four times as many channels. (OpenEXR's own library looks at all
/// earlier channels whenever one is added, which would take minutes.)
TEST_F(Exr, ManyChannelsTakeLittleTime) {
  constexpr int kMany = 200'000;
  const std::vector<float> value = {0.5F};
  ExrImage image{1, 1, {}, {}, {}};
  for (int i = 0; i < kMany; ++i) image.channels.push_back({"light" + std::to_string(i) + ".V", std::span(value), 1});
  const std::clock_t begin = std::clock();
  write_exr(folder_ / "many.exr", image);
  EXPECT_LT(static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC, 10);
  const ExrFile read = read_exr(folder_ / "many.exr", {.channels = {"light77777.V"}});
  EXPECT_EQ(read.channel_names.size(), std::size_t{kMany});
  EXPECT_EQ(read.floats.at("light77777.V"), value);
}

/// A file that is cut off anywhere, or lacks the attribute, is not taken for a whole one.
TEST_F(Exr, ThatIsWholeCanBeTold) {
  std::vector<float> values(64 * 40);
  std::mt19937 random(7);
  for (float& v : values) v = std::ldexp(static_cast<float>(random()), -32);
  write_exr(folder_ / "a.exr", {64, 40, {{"V", std::span(std::as_const(values)), 1}}, {{"mark", "x"}}, {}});
  EXPECT_TRUE(is_whole_exr(folder_ / "a.exr", "mark"));
  EXPECT_FALSE(is_whole_exr(folder_ / "a.exr", "other"));
  EXPECT_FALSE(is_whole_exr(folder_ / "none.exr", "mark"));
  EXPECT_FALSE(is_whole_exr(folder_, "mark"));
  std::ifstream stream(folder_ / "a.exr", std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
  for (std::size_t size = 0; size < bytes.size(); size += 61) {
    std::ofstream(folder_ / "cut.exr", std::ios::binary) << bytes.substr(0, size);
    EXPECT_FALSE(is_whole_exr(folder_ / "cut.exr", "mark")) << size << " of " << bytes.size();
  }
  std::ofstream(folder_ / "cut.exr", std::ios::binary) << bytes.substr(0, bytes.size() - 1);
  EXPECT_FALSE(is_whole_exr(folder_ / "cut.exr", "mark"));
}

TEST_F(Exr, KeepsEveryBit) {
  const Sample sample;
  write_exr(file(), sample.image);
  EXPECT_EQ(file_count(), 1u);
  ExrFile back = read_exr(file());
  EXPECT_EQ(back.width, Sample::kWidth);
  EXPECT_EQ(back.height, Sample::kHeight);
  ASSERT_EQ(back.floats.size(), 4u);
  ASSERT_EQ(back.integers.size(), 1u);
  EXPECT_EQ(back.integers.at("id"), sample.id);
  for (std::size_t i = 0; i < sample.v.size(); ++i) {
    ASSERT_EQ(std::bit_cast<std::uint32_t>(back.floats.at("V.a light with spaces")[i]),
              std::bit_cast<std::uint32_t>(sample.v[i]));
    ASSERT_EQ(back.floats.at("P.X")[i], sample.p[i].x);
    ASSERT_EQ(back.floats.at("P.Y")[i], sample.p[i].y);
    ASSERT_EQ(back.floats.at("P.Z")[i], sample.p[i].z);
  }
  back.attributes.erase("type");  // OpenEXR's own: "scanlineimage"
  EXPECT_EQ(back.attributes, sample.image.attributes);
  EXPECT_EQ(back.vectors, sample.image.vectors);
}

TEST_F(Exr, ValuesMadeLineByLineAreThoseOfAnArray) {
  Sample sample;
  write_exr(file("array.exr"), sample.image);
  sample.image.channels[0].values = [&sample](std::size_t first, std::span<float> values) {
    std::copy_n(sample.v.begin() + static_cast<std::ptrdiff_t>(first), values.size(), values.begin());
  };
  write_exr(file("lines.exr"), sample.image);
  EXPECT_EQ(bytes_of(file("lines.exr")), bytes_of(file("array.exr")));
}

/// Every other block of 16 lines is noise, which ZIP cannot make smaller: such blocks are stored uncompressed.
TEST_F(Exr, BlocksOfNoiseAndOfNoneComeBack) {
  constexpr std::uint32_t kWidth = 33, kHeight = 16 * 40 + 5;
  std::vector<std::uint32_t> noise, calm;
  std::mt19937 random(7);
  for (std::uint32_t i = 0; i < kWidth * kHeight; ++i) {
    const bool noisy = i / (16 * kWidth) % 2 == 0;
    noise.push_back(noisy ? static_cast<std::uint32_t>(random()) : 3);
    calm.push_back(noisy ? static_cast<std::uint32_t>(random()) : i);
  }
  ExrImage image;
  image.width = kWidth;
  image.height = kHeight;
  image.channels = {{"a", std::span<const std::uint32_t>(noise)}, {"b", std::span<const std::uint32_t>(calm)}};
  write_exr(file(), image);
  write_exr(file("again.exr"), image);
  EXPECT_EQ(bytes_of(file()), bytes_of(file("again.exr")));
  const ExrFile back = read_exr(file());
  EXPECT_EQ(back.integers.at("a"), noise);
  EXPECT_EQ(back.integers.at("b"), calm);
  EXPECT_LT(fs::file_size(file()), noise.size() * 8 * 3 / 4);  // the other half compresses well
}

TEST_F(Exr, IsAPlainScanLineZipImageForOthers) {
  const Sample sample;
  write_exr(file(), sample.image);
  bool tiled = true, deep = true, multi_part = true;
  ASSERT_TRUE(Imf::isOpenExrFile(file().c_str(), tiled, deep, multi_part));
  EXPECT_FALSE(tiled || deep || multi_part);
  const Imf::InputFile input(file().c_str());
  const Imf::Header& header = input.header();
  EXPECT_EQ(header.compression(), Imf::ZIP_COMPRESSION);
  EXPECT_EQ(header.dataWindow(), header.displayWindow());
  EXPECT_EQ(header.dataWindow().max, Imath::V2i(36, 20));
  ASSERT_NE(header.channels().findChannel("id"), nullptr);
  EXPECT_EQ(header.channels().findChannel("id")->type, Imf::UINT);
  EXPECT_EQ(header.channels().findChannel("P.Y")->type, Imf::FLOAT);
  EXPECT_EQ(header.typedAttribute<Imf::StringAttribute>("penumbra.method").value(), "view-sample");
  EXPECT_EQ(header.typedAttribute<Imf::V3dAttribute>("penumbra.origin").value().y, -1e100);
}

TEST_F(Exr, OtherCompressionsKeepEveryBit) {
  Sample sample;
  for (const auto& [compression, code] :
       {std::pair{ExrCompression::zips, Imf::ZIPS_COMPRESSION}, {ExrCompression::none, Imf::NO_COMPRESSION}}) {
    sample.image.compression = compression;
    EXPECT_EQ(write_exr(file(), sample.image), 0u);
    EXPECT_EQ(Imf::InputFile(file().c_str()).header().compression(), code);
    const ExrFile back = read_exr(file());
    EXPECT_EQ(back.integers.at("id"), sample.id);
    for (std::size_t i = 0; i < sample.v.size(); ++i) {
      ASSERT_EQ(std::bit_cast<std::uint32_t>(back.floats.at("V.a light with spaces")[i]),
                std::bit_cast<std::uint32_t>(sample.v[i]));
      ASSERT_EQ(back.floats.at("P.Z")[i], sample.p[i].z);
    }
  }
}

/// Half floats have ten bits after the point, are subnormal below 2^-14, and round to infinity from 65520 on.
TEST_F(Exr, HalfIsTheNearestOfSixteenBits) {
  const std::vector<std::pair<float, float>> pairs = {
      {1.0f / 3, 1365.0f / 4096},
      {2049, 2048},  // half way between two: rounds to the even one
      {2051, 2052},
      {-0.0f, -0.0f},
      {0x1p-24f, 0x1p-24f},
      {0x1p-26f, 0},
      {65519, 65504},
      {65520, 65504},
      {-1e30f, -65504},
      {std::numeric_limits<float>::infinity(), std::numeric_limits<float>::infinity()}};
  std::vector<float> values;
  for (const auto& pair : pairs) values.push_back(pair.first);
  std::vector<std::uint32_t> id(values.size(), 0xfffffffe);
  ExrImage image;
  image.width = 2;
  image.height = static_cast<std::uint32_t>(values.size() / 2);
  image.channels = {{"V", std::span<const float>(values), 1, true},
                    {"Z", std::span<const float>(values)},
                    {"id", std::span<const std::uint32_t>(id)}};
  for (const ExrCompression compression :
       {ExrCompression::zip, ExrCompression::zips, ExrCompression::none, ExrCompression::dwaa}) {
    image.compression = compression;
    EXPECT_EQ(write_exr(file(), image), 2u) << "65520 and -1e30";
    const Imf::InputFile input(file().c_str());
    EXPECT_EQ(input.header().channels().findChannel("V")->type, Imf::HALF);
    EXPECT_EQ(input.header().channels().findChannel("Z")->type, Imf::FLOAT);
    const ExrFile back = read_exr(file());
    EXPECT_EQ(back.floats.at("Z"), values);
    EXPECT_EQ(back.integers.at("id"), id);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      EXPECT_EQ(back.floats.at("V")[i], pairs[i].second) << pairs[i].first;
      EXPECT_EQ(std::signbit(back.floats.at("V")[i]), std::signbit(pairs[i].second)) << pairs[i].first;
    }
  }
}

/// DWAA would treat "P.Y" as a luminance. It rounds colours: they may differ a little, all other channels not at all.
TEST_F(Exr, DwaaIsLossyForColoursAlone) {
  constexpr std::uint32_t kSide = 70;  // more than two blocks of 32 lines
  std::vector<glm::vec3> p, colour;
  std::vector<float> v, bright;
  for (std::uint32_t i = 0; i < kSide * kSide; ++i) {
    const float x = static_cast<float>(i % kSide) / kSide, y = static_cast<float>(i / kSide) / kSide;
    p.emplace_back(x + 1e-6f, y * y, std::nextafter(1.0f, 2.0f));
    colour.emplace_back(x, y, x * y);
    v.push_back(1.0f / static_cast<float>(i + 1));
    bright.push_back(1e6f);
  }
  ExrImage image;
  image.width = image.height = kSide;
  image.compression = ExrCompression::dwaa;
  image.attributes = {{"penumbra.method", "exact"}};
  add_vector_channels(image, "P", p);
  for (ExrChannel& channel : image.channels) channel.exact = true;
  for (std::size_t c = 0; c < 3; ++c)
    image.channels.push_back({std::string(1, "RGB"[c]), std::span(&colour[0].x + c, 3 * colour.size() - c), 3});
  image.channels.push_back({"V", std::span<const float>(v)});
  image.channels.push_back({"key.R", std::span<const float>(bright)});
  EXPECT_EQ(write_exr(file(), image), bright.size()) << "key.R: stored as 16 bits inside";
  write_exr(file("again.exr"), image);
  EXPECT_EQ(bytes_of(file()), bytes_of(file("again.exr")));

  const Imf::MultiPartInputFile parts(file().c_str());
  ASSERT_EQ(parts.parts(), 2);
  EXPECT_EQ(parts.header(0).compression(), Imf::DWAA_COMPRESSION);
  EXPECT_EQ(parts.header(1).compression(), Imf::ZIP_COMPRESSION);
  EXPECT_NE(parts.header(0).channels().findChannel("G"), nullptr);
  EXPECT_NE(parts.header(1).channels().findChannel("P.X"), nullptr);
  for (int i = 0; i < 2; ++i)
    EXPECT_EQ(parts.header(i).typedAttribute<Imf::StringAttribute>("penumbra.method").value(), "exact");

  const ExrFile back = read_exr(file());
  EXPECT_EQ(back.floats.size(), 8u);
  EXPECT_EQ(back.floats.at("V"), v);
  double largest = 0;
  bool same = true;
  for (std::size_t i = 0; i < p.size(); ++i) {
    ASSERT_EQ(back.floats.at("P.X")[i], p[i].x);
    ASSERT_EQ(back.floats.at("P.Y")[i], p[i].y);
    ASSERT_EQ(back.floats.at("P.Z")[i], p[i].z);
    EXPECT_NEAR(back.floats.at("key.R")[i], 65504, 0.05 * 65504);
    largest = std::max(largest, std::abs(double{back.floats.at("R")[i]} - double{colour[i].x}));
    same &= back.floats.at("R")[i] == colour[i].x;
  }
  EXPECT_LT(largest, 0.02);
  EXPECT_FALSE(same);

  std::erase_if(image.channels, [](const ExrChannel& channel) { return channel.exact; });
  write_exr(file(), image);
  EXPECT_EQ(Imf::MultiPartInputFile(file().c_str()).parts(), 1) << "without exact channels, one part is enough";
}

TEST_F(Exr, SameImageGivesSameBytes) {
  const Sample sample;
  write_exr(file("a.exr"), sample.image);
  ExrImage shuffled = sample.image;  // nor may the order in which channels were added show
  std::swap(shuffled.channels.front(), shuffled.channels.back());
  write_exr(file("b.exr"), shuffled);
  EXPECT_EQ(bytes_of(file("a.exr")), bytes_of(file("b.exr")));
}

TEST_F(Exr, FullDiskLeavesTheOldFileAndNoRest) {
  Sample sample;
  for (const ExrCompression compression : {ExrCompression::zip, ExrCompression::dwaa}) {
    sample.image.compression = compression;
    write_exr(file(), sample.image);
    const std::string before = bytes_of(file());
    for (const std::size_t quota : {std::size_t{0}, std::size_t{100}, before.size() - 1}) {
      ::setenv("PENUMBRA_TEST_DISK_QUOTA", std::to_string(quota).c_str(), 1);
      EXPECT_THROW(write_exr(file(), sample.image), ResourceError);
      ::unsetenv("PENUMBRA_TEST_DISK_QUOTA");
      EXPECT_EQ(bytes_of(file()), before);
      EXPECT_EQ(file_count(), 1u);
    }
  }
}

TEST_F(Exr, PlacesThatCannotBeWrittenAreResourceErrors) {
  const Sample sample;
  EXPECT_THROW(write_exr(file("missing") / "out.exr", sample.image), ResourceError);
  EXPECT_THROW(write_exr(folder_, sample.image), ResourceError);
  EXPECT_THROW(write_exr("/dev/null", sample.image), ResourceError);
  EXPECT_EQ(file_count(), 0u);
}

TEST_F(Exr, NamesAndSizesThatTheFormatCannotHoldAreRefused) {
  Sample sample;
  for (const std::string& name : {std::string(), std::string(256, 'x'), std::string("a\0b", 3)}) {
    sample.image.channels[0].name = name;
    EXPECT_THROW(write_exr(file(), sample.image), InputError);
  }
  sample.image.channels[0].name = std::string(255, 'x');
  EXPECT_NO_THROW(write_exr(file(), sample.image));
  ExrImage empty;
  EXPECT_THROW(write_exr(file(), empty), ResourceError);
}

TEST_F(Exr, ReadingRefusesWhatIsNone) {
  EXPECT_THROW(read_exr(file("missing.exr")), InputError);
  std::ofstream(file()) << "not an image";
  EXPECT_THROW(read_exr(file()), InputError);
  write_exr(file("whole.exr"), Sample().image);
  const std::string bytes = bytes_of(file("whole.exr"));
  for (const std::size_t size : {std::size_t{3}, std::size_t{300}, bytes.size() - 50}) {
    std::ofstream(file("cut.exr"), std::ios::binary) << bytes.substr(0, size);
    EXPECT_THROW(read_exr(file("cut.exr")), InputError) << size << " bytes";
  }
}

}  // namespace
}  // namespace penumbra
