// SPDX-License-Identifier: Apache-2.0
// Tests pictures of several view samples per pixel: their mean under a filter, and a pixel's shares in mattes.
#include "tests/cli/program.hpp"

#include "base/exr.hpp"
#include "session/pictures/cryptomatte.hpp"
#include "session/pictures/matte_shares.hpp"
#include "session/pictures/picture_mean.hpp"
#include "session/pictures/pixel_filter.hpp"
#include "session/pictures/surfaces.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <random>

namespace penumbra::tests {
namespace {

using nlohmann::json;
using session::PixelFilter;
using testing::HasSubstr;

/// Compares weights at offsets where Harris's four cosines are 1, 0 or −1.
TEST(PixelFilters, AreTheirFormula) {
  const PixelFilter wide{PixelFilter::Kind::blackman_harris, 0.75};
  EXPECT_NEAR(wide.share(0), 1, 1e-15);
  for (const double side : {-1.0, 1.0}) {
    EXPECT_NEAR(wide.share(side * 0.375), 0.35875 - 0.14128, 1e-15);
    EXPECT_NEAR(wide.share(side * 0.25), 0.35875 + 0.48829 / 2 - 0.14128 / 2 - 0.01168, 1e-15);
    EXPECT_NEAR(wide.share(side * std::nextafter(0.75, 0)), 6e-5, 1e-15);
    EXPECT_EQ(wide.share(side * 0.75), 0);
  }
  const PixelFilter box;
  EXPECT_EQ(box.share(0.49), 1);
  EXPECT_EQ(box.share(0.5), 0);
  // A box takes only a pixel's own view samples; a wider filter takes the same number on both sides, except beyond the
  // ends of the line.
  for (const session::FilterTaps& taps : session::filter_taps(box, 3, 2))
    EXPECT_EQ(taps.shares, (std::vector<double>{1, 1}));
  const auto taps = session::filter_taps(wide, 3, 4);
  EXPECT_EQ(taps[1].first, 3u);
  ASSERT_EQ(taps[1].shares.size(), 6u);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(taps[1].shares[i], taps[1].shares[5 - i]);
  EXPECT_EQ(taps[0].first, 0u);
  EXPECT_EQ(taps[0].shares, std::vector<double>(taps[1].shares.begin() + 1, taps[1].shares.end()));
}

class FilteredPictures : public ProgramTest {
 protected:
  static constexpr std::size_t kSide = 3, kWidth = 24, kHeight = 16;

  FilteredPictures() { (void)moving_scene(); }
  Outcome render(const std::string& size, const std::string& out, std::vector<std::string> more = {}) const {
    std::vector<std::string> arguments = {"render", path("scene.glb"), "--size", size, "--frame",
                                          "7",      "--fps",           "10",     "-o", path(out)};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }
  [[nodiscard]] ExrFile picture(const std::string& size, std::vector<std::string> more = {}) const {
    const Outcome outcome = render(size, "out.exr", std::move(more));
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return read_exr(path("out.exr"));
  }
};

/// Returns the weight of view sample k of the large picture for pixel i, by the formula in degrees.
double share_of(std::size_t k, std::size_t i) {
  constexpr std::size_t kSide = 3, kWidth = 24;
  const auto along = [](std::size_t sample, std::size_t pixel) {
    const double off = (static_cast<double>(sample) + 0.5) / kSide - (static_cast<double>(pixel) + 0.5);
    if (std::abs(off) >= 1.5) return 0.0;  // the default half-width, as in Cycles
    const auto cosine = [&](double times) { return std::cos(times * (180 + 360 * off / 3) * std::numbers::pi / 180); };
    return 0.35875 - 0.48829 * cosine(1) + 0.14128 * cosine(2) - 0.01168 * cosine(3);
  };
  return along(k % (kSide * kWidth), i % kWidth) * along(k / (kSide * kWidth), i / kWidth);
}

/// Compares with means computed independently: every view sample of a large picture, each with its weight.
TEST_F(FilteredPictures, AreWeighedMeans) {
  const ExrFile filtered =
      picture("24x16", {"--pixel-samples", "9", "--pixel-tolerance", "0", "--pixel-filter", "blackman-harris"});
  const ExrFile box = picture("24x16", {"--pixel-samples", "9", "--pixel-tolerance", "0", "--pixel-filter", "box"});
  const ExrFile large = picture("72x48"), one = picture("24x16");
  std::size_t different = 0;
  for (const char* name : {"R", "G", "B", "A", "V", "Lamp.V", "Lamp.R"}) {
    const std::vector<float>& values = large.floats.at(name);
    for (std::size_t i = 0; i < kWidth * kHeight; ++i) {
      double sum = 0, shares = 0;
      for (std::size_t k = 0; k < values.size(); ++k) {
        const double here = share_of(k, i);
        sum += here * double{values[k]};
        shares += here;
      }
      // Double sums of some tens of terms, rounded once.
      ASSERT_FLOAT_EQ(filtered.floats.at(name)[i], static_cast<float>(sum / shares)) << name << " " << i;
      different += filtered.floats.at(name)[i] != box.floats.at(name)[i] ? 1 : 0;
    }
  }
  EXPECT_GT(different, 100u);
  for (const char* name : {"Z", "N.X", "P.X", "object.X"}) EXPECT_EQ(filtered.floats.at(name), one.floats.at(name));
  EXPECT_EQ(filtered.integers.at("id"), one.integers.at("id"));
}

/// Cryptomatte's coverage is each name's share of the view samples; ranks are ordered by it.
TEST_F(FilteredPictures, MattesAreShares) {
  const ExrFile box = picture("24x16", {"--pixel-samples", "9", "--pixel-tolerance", "0"}), large = picture("72x48");
  const json names = json::parse(large.attributes.at("penumbra.objects"));
  const std::vector<float>& object = large.floats.at("object.X");
  std::size_t mixed = 0;
  for (std::size_t i = 0; i < kWidth * kHeight; ++i) {
    std::map<float, std::size_t> counts;  // by the name's number in Cryptomatte
    for (std::size_t k = 0; k < kSide * kSide; ++k) {
      const std::size_t from = (i / kWidth * kSide + k / kSide) * kWidth * kSide + i % kWidth * kSide + k % kSide;
      if (object[from] == 0) continue;
      const std::string name = names.at(static_cast<std::size_t>(object[from]) - 1).get<std::string>();
      ++counts[session::cryptomatte_id(name)];
    }
    float before = 1;
    for (std::size_t rank = 0; rank < session::Cryptomatte::kRanks; ++rank) {
      const std::string group = fmt::format("CryptoObject{:02}.", rank / 2);
      const float id = box.floats.at(group + "RB"[rank % 2])[i], part = box.floats.at(group + "GA"[rank % 2])[i];
      if (rank >= counts.size()) {
        ASSERT_EQ(part, 0) << i;
        ASSERT_EQ(id, 0) << i;
        continue;
      }
      ASSERT_TRUE(counts.contains(id)) << i;
      ASSERT_EQ(part, static_cast<float>(counts.at(id)) / 9.0f) << i;
      ASSERT_LE(part, before) << i;
      before = part;
    }
    mixed += counts.size() > 1 ? 1 : 0;
  }
  EXPECT_GT(mixed, 5u);
  const ExrFile filtered =
      picture("24x16", {"--pixel-samples", "9", "--pixel-tolerance", "0", "--pixel-filter", "blackman-harris"});
  for (std::size_t i = 0; i < kWidth * kHeight; ++i) {
    float sum = 0;
    for (const char* group : {"CryptoObject00.", "CryptoObject01.", "CryptoObject02."})
      sum += filtered.floats.at(group + std::string("G"))[i] + filtered.floats.at(group + std::string("A"))[i];
    ASSERT_NEAR(sum, filtered.floats.at("A")[i], 25 * 0x1p-24) << i << ": 25 shares, each rounded to a float";
    const float first = filtered.floats.at("CryptoObject00.R")[i];  // the name with the largest share
    double part = 0, shares = 0;
    for (std::size_t k = 0; k < object.size(); ++k) {
      const double share = share_of(k, i);
      shares += share;
      if (object[k] != 0 &&
          session::cryptomatte_id(names.at(static_cast<std::size_t>(object[k]) - 1).get<std::string>()) == first)
        part += share;
    }
    ASSERT_NEAR(filtered.floats.at("CryptoObject00.G")[i], part / shares, 25 * 0x1p-24) << i;
  }
}

TEST(MatteShares, KnowNamesOfAllPictures) {
  const std::uint32_t nothing = session::Surfaces::kNothing;
  session::MatteShares shares(1, 1, {});
  shares.add(std::vector<std::string>{"a", "b", "a"}, std::vector<std::uint32_t>{0, 1, 2, 1}, 2, {{0, 1}, 0});
  shares.add(std::vector<std::string>{"b", "c"}, std::vector<std::uint32_t>{0, 0, 1, nothing}, 2, {{0, 1}, 0});
  EXPECT_THAT(shares.names(), testing::ElementsAre("a", "b", "c"));
  shares.settle();
  const auto here = shares.of_pixel(0, 0);
  ASSERT_EQ(here.size(), 3u);
  EXPECT_EQ(here[0].name, 1u);
  EXPECT_FLOAT_EQ(here[0].part, 4.0f / 8);
  EXPECT_EQ(here[1].name, 0u);
  EXPECT_FLOAT_EQ(here[1].part, 2.0f / 8);
  EXPECT_FLOAT_EQ(here[2].part, 1.0f / 8);
}

/// A filter that reaches beyond a pixel, with unequal weights.
session::PixelFilter wide_filter() {
  session::PixelFilter filter;
  filter.kind = session::PixelFilter::Kind::blackman_harris;
  filter.width = 1.5;
  return filter;
}

/// A pixel with a single name gets the sum of its taps in the same order as any other pixel: the same float.
TEST(MatteShares, OfOneNameAreSumsOfTaps) {
  constexpr std::uint32_t kSide = 3, kAcross = 9, kDown = 7, kSamples = kSide * kAcross;
  const session::PixelFilter filter = wide_filter();
  std::mt19937 random(5);
  std::vector<std::uint32_t> of_sample(std::size_t{kSamples} * kSide * kDown);
  for (std::size_t i = 0; i < of_sample.size(); ++i) {  // one name on the left, two and the background on the right
    const std::uint32_t name = i % kSamples < kSamples / 2 ? 0 : static_cast<std::uint32_t>(random() % 3);
    of_sample[i] = name == 2 ? session::Surfaces::kNothing : name;
  }
  session::MatteShares shares(kAcross, kDown, filter);
  shares.add(std::vector<std::string>{"a", "b"}, of_sample, kSide, {{0, kDown}, 0});
  shares.settle();
  const auto across = session::filter_taps(filter, kAcross, kSide), down = session::filter_taps(filter, kDown, kSide);
  std::size_t alone = 0, mixed = 0;
  for (std::size_t y = 0; y < kDown; ++y) {
    for (std::size_t x = 0; x < kAcross; ++x) {
      std::map<std::uint32_t, float> sums;
      std::vector<std::uint32_t> in_order;
      for (std::size_t i = 0; i < down[y].shares.size(); ++i) {
        for (std::size_t k = 0; k < across[x].shares.size(); ++k) {
          const std::uint32_t name = of_sample[(down[y].first + i) * kSamples + across[x].first + k];
          if (!sums.contains(name)) in_order.push_back(name);
          sums[name] += static_cast<float>(down[y].shares[i] * across[x].shares[k]);
        }
      }
      float all = 0;
      for (const std::uint32_t name : in_order) all += sums[name];
      const auto here = shares.of_pixel(x, y);
      ASSERT_EQ(here.size(), sums.size() - sums.count(session::Surfaces::kNothing)) << x << " " << y;
      for (const auto& share : here) ASSERT_EQ(share.part, sums.at(share.name) / all) << x << " " << y;
      ++(sums.size() == 1 ? alone : mixed);
    }
  }
  EXPECT_GT(alone, 10u);
  EXPECT_GT(mixed, 10u);
}

/// Rows that are added only once give the same bits as sums kept in double.
TEST(PictureMean, OfRowsAddedOnceIsTheSame) {
  constexpr std::uint32_t kSide = 2, kAcross = 6, kDown = 8, kSamples = kSide * kAcross;
  const session::PixelFilter filter = wide_filter();
  std::mt19937 random(6);
  std::uniform_real_distribution<float> real(0, 1);
  const std::size_t samples = std::size_t{kSamples} * kSide * kDown;
  std::vector<float> alpha(samples);
  std::vector<std::vector<float>> seen(2, std::vector<float>(samples));
  std::vector<std::vector<glm::vec3>> lit(2);
  lit[0].resize(samples);  // the second light has no results
  for (std::size_t i = 0; i < samples; ++i) {
    alpha[i] = real(random);
    for (auto& of_light : seen) of_light[i] = real(random);
    lit[0][i] = {real(random), real(random), real(random)};
  }
  const std::vector<std::string> names = {"A", "B"};
  using Adds = session::PictureMean::Adds;
  session::PictureMean often(kAcross, kDown, filter), once(kAcross, kDown, filter, Adds::once);
  often.add(alpha, names, seen, lit, kSide, {{0, kDown}, 0});
  for (std::uint32_t row = 0; row < kDown; row += 4) once.add(alpha, names, seen, lit, kSide, {{row, 4}, 0});
  EXPECT_EQ(once.take_visibility(names), often.take_visibility(names));
  EXPECT_EQ(once.take_beauty(names), often.take_beauty(names));
  EXPECT_EQ(once.take_alpha(), often.take_alpha());
}

TEST_F(FilteredPictures, AreRefusedWhereThereIsNothingToWeigh) {
  const std::vector<std::pair<std::vector<std::string>, std::string>> refused = {
      {{"--pixel-filter", "blackman-harris"},
       "--pixel-filter blackman-harris needs several view samples a pixel: --pixel-samples 4"},
      {{"--pixel-samples", "4", "--pixel-filter", "gauss"}, "box or blackman-harris"},
      {{"--pixel-samples", "4", "--filter-width", "2"}, "a box is one pixel wide"},
      {{"--pixel-samples", "4", "--pixel-filter", "blackman-harris", "--filter-width", "0.5"}, "from 1 to 10"},
  };
  for (const auto& [options, why] : refused) {
    const Outcome outcome = render("24x16", "no.exr", options);
    EXPECT_EQ(outcome.code, 2) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr(why));
  }
}

}  // namespace
}  // namespace penumbra::tests
