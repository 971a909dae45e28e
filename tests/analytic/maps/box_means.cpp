// SPDX-License-Identifier: Apache-2.0
// Tests means of prefiltered texels over boxes, as look-ups read them: against sums over texels in double, and by the
// number of words that each reads, which must not depend on the box's size (Eisemann et al. 2009, sections 5.2.2.3 and
// 5.2.5).

#include "maps/products/prefilter.hpp"
#include "tests/analytic/maps/box_means.comp.spv.hpp"
#include "tests/analytic/maps/box_windows.comp.spv.hpp"
#include "tests/analytic/maps/centre_maps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <map>
#include <random>

namespace penumbra::tests {
namespace {

struct TexelBox {
  glm::dvec2 lower, upper;
  [[nodiscard]] glm::dvec2 extent() const { return upper - lower; }
};

/// A map product of given words.
class Words final : public maps::MapProduct {
 public:
  Words(const render::Device& device, const std::vector<std::uint32_t>& words)
      : words_(render::make_buffer<std::uint32_t>(device, "words", words)) {}
  void record(render::Commands& /*commands*/, const maps::MapSet& /*maps*/) override {}
  [[nodiscard]] const render::Buffer& buffer() const override { return words_; }

 private:
  render::Buffer words_;
};

/// A picture of zeros and ones, and its exact means.
class Picture {
 public:
  Picture(std::uint32_t size, std::uint32_t seed) : size_(size), texels_(std::size_t{size} * size) {
    std::mt19937 random(seed);
    // Zeros and ones are in patches, because a picture of noise would have the same mean everywhere.
    for (std::uint32_t i = 0; i < texels_.size(); ++i) {
      const std::uint32_t x = i % size, y = i / size;
      texels_[i] = random() % 8 < (x * x / 97 + y * y / 53 + x * y / 71) % 9 ? 1 : 0;
    }
  }
  [[nodiscard]] const std::vector<std::uint32_t>& texels() const { return texels_; }
  /// Returns the mean; a texel on the box's border counts by the share of it that is inside.
  [[nodiscard]] double mean(const TexelBox& box) const {
    double sum = 0;
    for (auto y = static_cast<std::uint32_t>(box.lower.y); y < box.upper.y; ++y) {
      for (auto x = static_cast<std::uint32_t>(box.lower.x); x < box.upper.x; ++x) {
        sum += (std::min(x + 1.0, box.upper.x) - std::max(1.0 * x, box.lower.x)) *
               (std::min(y + 1.0, box.upper.y) - std::max(1.0 * y, box.lower.y)) * texels_[std::size_t{y} * size_ + x];
      }
    }
    return sum / (box.extent().x * box.extent().y);
  }
  /// Returns the mean over squares (their side is the largest power of two that fits into the box) spread evenly over
  /// it, at most eight along an axis.
  [[nodiscard]] double of_squares(const TexelBox& box) const {
    const glm::dvec2 extent = glm::max(box.extent(), glm::dvec2(1));
    const double side = std::exp2(std::floor(std::log2(std::min(extent.x, extent.y))));
    const glm::dvec2 count = glm::min(glm::ceil(extent / side), glm::dvec2(8)),
                     step = (extent - side) / glm::max(count - 1.0, glm::dvec2(1));
    double sum = 0;
    for (double j = 0; j < count.y; ++j) {
      for (double i = 0; i < count.x; ++i) {
        const glm::dvec2 at = glm::min(box.lower + glm::dvec2(i, j) * step, glm::dvec2(size_ - side));
        sum += mean({at, at + side});
      }
    }
    return sum / (count.x * count.y);
  }
  /// Returns the mean between the two mip levels whose texels' areas enclose the box's; in each level it interpolates
  /// between the four texels around the box's middle. For sizes that are powers of two.
  [[nodiscard]] double of_levels(const TexelBox& box) const {
    const glm::dvec2 extent = glm::max(box.extent(), glm::dvec2(1)), middle = 0.5 * (box.lower + box.upper);
    const double level = std::min(0.5 * std::log2(extent.x * extent.y), std::log2(size_));
    const auto of_level = [&](double l) {
      const double side = std::exp2(l), last = size_ / side - 1;
      const glm::dvec2 at = middle / side - 0.5, first = glm::floor(at), part = at - first;
      const auto texel = [&](double x, double y) {
        const glm::dvec2 lower = side * glm::clamp(first + glm::dvec2(x, y), glm::dvec2(0), glm::dvec2(last));
        return mean({lower, lower + side});
      };
      return glm::mix(glm::mix(texel(0, 0), texel(1, 0), part.x), glm::mix(texel(0, 1), texel(1, 1), part.x), part.y);
    };
    const double below = std::floor(level), part = level - below;
    return part == 0 ? of_level(below) : glm::mix(of_level(below), of_level(below + 1), part);
  }

 private:
  std::uint32_t size_;
  std::vector<std::uint32_t> texels_;
};

class BoxMeans : public MapsTest {
 protected:
  static constexpr std::uint32_t kSize = 128, kFunctions = 7;
  struct Found {
    double mean;
    std::uint32_t fetches;
  };
  /// Returns means of a picture's bits, which are function number `function` of several, in buffers of `buffer_bytes`
  /// (0: as large as possible).
  static std::vector<Found> means(const Picture& picture, maps::PrefilterKind kind, const std::vector<TexelBox>& boxes,
                                  std::uint32_t function = 0, std::uint64_t buffer_bytes = 0) {
    scenes::Scene scene;
    add_quad(scene, {0, 0, 0}, {2, 0, 0}, {0, 0, -2});
    scene.lights.push_back(ceiling_light(3, 0.5));
    scene.cameras.push_back(camera({0, 3, 8}, {0, 1, 0}));
    const Stage stage(scene, 4, 4, light_samples(1));
    const CentreMaps maps(device(), stage, kSize);
    EXPECT_EQ(maps.fitted.faces, 1U);
    std::vector<std::uint32_t> bits = picture.texels();  // the other functions are 0
    for (std::uint32_t& bit : bits) bit <<= function;
    const Words words(device(), bits), none(device(), {0, 0, 0, 0, 0, 0, 0, 0});
    maps::PrefilterOptions options{.kind = kind, .of_bits = true, .buffer_bytes = buffer_bytes};
    for (std::uint32_t k = 0; k < kFunctions; ++k)
      options.functions.push_back({.kind = maps::gpu::kBit, .a = static_cast<float>(k), .digits = 0});
    maps::Prefilter product(device(), options, {.nearest = &none, .frame = &none, .bits = &words});
    const render::ComputePass pass(device(), {.name = "box means",
                                              .spirv = shaders::kBoxMeansComp,
                                              .push_bytes = sizeof(maps::gpu::LookupPush),
                                              .constants = product.constants(kSize, 1)});
    std::vector<maps::gpu::Receiver> asked;
    for (const TexelBox& box : boxes) asked.push_back({glm::vec3(box.lower, 1), glm::vec3(box.upper, 0), 0, 0});
    const render::Buffer receivers = render::make_buffer<maps::gpu::Receiver>(device(), "boxes", asked);
    const render::Buffer results(device(), "means", 2 * boxes.size() * sizeof(std::uint32_t));
    maps::gpu::LookupPush push{};
    push.size = kSize;
    push.receiver_count = static_cast<std::uint32_t>(boxes.size());
    push.first_point = function;
    render::Commands commands(device());
    product.record(commands, maps.set(stage));
    std::vector<render::BufferReference> buffers{receivers, maps.views, maps.depths, results};
    for (const render::BufferReference& buffer : product.buffers()) buffers.push_back(buffer);
    pass.record(commands, std::as_bytes(std::span(&push, 1)), buffers, (boxes.size() + 63) / 64);
    commands.submit();
    std::vector<std::uint32_t> read(2 * boxes.size());
    results.read<std::uint32_t>(read);
    std::vector<Found> found;
    for (std::size_t i = 0; i < boxes.size(); ++i)
      found.push_back({std::bit_cast<float>(read[2 * i]), read[2 * i + 1]});
    return found;
  }
  /// Returns boxes of random places and sizes, alternately `aspect` times as wide as high and as high as wide.
  static std::vector<TexelBox> boxes(double aspect, std::uint32_t count) {
    std::mt19937 random(11);
    const auto number = [&](double to) { return std::uniform_real_distribution<double>(0, to)(random); };
    std::vector<TexelBox> boxes;
    while (boxes.size() < count) {
      const double octaves = number(std::floor(std::log2(kSize / aspect))), high = std::exp2(octaves);
      if (std::abs(octaves - std::round(octaves)) < 1e-4) continue;  // a device's logarithm may round either way
      const glm::dvec2 extent =
          boxes.size() % 2 == 0 ? glm::dvec2(aspect * high, high) : glm::dvec2(high, aspect * high);
      const glm::dvec2 lower(number(kSize - extent.x), number(kSize - extent.y));
      boxes.push_back({glm::vec2(lower), glm::vec2(lower + extent)});
    }
    return boxes;
  }
};

// Coordinates of a box in 128 texels are floats of 2^-17; its mean is off by that over its extent, and by rounded sums.
TEST_F(BoxMeans, AreSumsOverTexelsInEachScheme) {
  const Picture picture(kSize, 3);
  for (const double aspect : {1.0, 3.0, 11.0}) {
    const std::vector<TexelBox> asked = boxes(aspect, 400);
    const auto expect = [&](maps::PrefilterKind kind, const std::function<double(const TexelBox&)>& truth,
                            const char* name) {
      const std::vector<Found> found = means(picture, kind, asked);
      double worst = 0, spread = 0;
      for (std::size_t i = 0; i < asked.size(); ++i) {
        const double off = std::abs(found[i].mean - truth(asked[i]));
        worst = std::max(worst, off);
        spread += std::pow(found[i].mean - 0.5, 2);
      }
      EXPECT_LT(worst, 1e-4) << name << ", aspect " << aspect;
      EXPECT_GT(std::sqrt(spread / static_cast<double>(asked.size())), 0.02) << "the picture is the same everywhere";
    };
    expect(
        maps::PrefilterKind::table, [&](const TexelBox& box) { return picture.mean(box); }, "summed areas");
    expect(
        maps::PrefilterKind::windows, [&](const TexelBox& box) { return picture.of_squares(box); }, "N-buffer");
    expect(
        maps::PrefilterKind::pyramid, [&](const TexelBox& box) { return picture.of_levels(box); }, "mip levels");
  }
}

// Row I24 of docs/predicates.md: the cost of a mean does not depend on the box's size, and so not on the light's.
// Summed areas take 16 words, less those beyond the map's border; mip levels take four in each of two levels; an
// N-buffer takes four for each of two by two squares, or more squares in proportion to the box's aspect.
TEST_F(BoxMeans, TakeAsManyFetchesWhateverTheBoxesSize) {
  const Picture picture(kSize, 3);
  for (const double aspect : {1.0, 3.0}) {
    const std::vector<TexelBox> asked = boxes(aspect, 2000);
    for (const auto& [kind, most, name] : {std::tuple(maps::PrefilterKind::table, 16U, "summed areas"),
                                           {maps::PrefilterKind::pyramid, 8U, "mip levels"},
                                           {maps::PrefilterKind::windows, aspect == 1 ? 16U : 48U, "N-buffer"}}) {
      const std::vector<Found> found = means(picture, kind, asked);
      std::map<int, std::uint32_t> mosts;  // of each octave of sizes
      for (std::size_t i = 0; i < asked.size(); ++i) {
        const glm::dvec2 extent = asked[i].extent();
        std::uint32_t& of_octave = mosts[static_cast<int>(std::log2(std::min(extent.x, extent.y)))];
        of_octave = std::max(of_octave, found[i].fetches);
      }
      EXPECT_GE(mosts.size(), 5U);
      for (const auto& [octave, fetches] : mosts) {
        EXPECT_EQ(fetches, most) << name << ", boxes of 2^" << octave << " texels, " << aspect << " times as long";
      }
    }
  }
}

// Look-ups in one buffer and in four are different code.
TEST_F(BoxMeans, AreTheSameInOneBufferAndInFour) {
  const Picture picture(kSize, 3);
  const std::vector<TexelBox> asked = boxes(1, 200);
  for (const auto& [kind, words] : {std::pair(maps::PrefilterKind::table, kSize * kSize),
                                    {maps::PrefilterKind::pyramid, kSize * kSize * 4 / 3 + 1},
                                    {maps::PrefilterKind::windows, kSize * kSize * 8}}) {
    const std::uint64_t two_functions = std::uint64_t{2} * words * sizeof(std::uint32_t);
    const std::vector<Found> truth = means(picture, kind, asked);
    EXPECT_GT(std::ranges::max(truth, {}, &Found::mean).mean, 0.5);
    for (std::uint32_t function = 0; function < kFunctions; ++function) {  // functions per buffer: 2, 2, 2 and 1
      for (const std::uint64_t buffer_bytes : {std::uint64_t{0}, two_functions}) {
        const std::vector<Found> found = means(picture, kind, asked, function, buffer_bytes);
        for (std::size_t i = 0; i < asked.size(); ++i)
          ASSERT_EQ(found[i].mean, truth[i].mean) << "function " << function << ", buffers of " << buffer_bytes;
      }
    }
  }
}

// For a receiver on a wall, whose map is a sideways face of a hemicube, the window is the box around the four corners
// of the light's box. The formula is of first order: for boxes this small it is off by less than 1 %.
TEST_F(BoxMeans, WindowsOnSidewaysFacesHoldTheCornersOfTheLightsBox) {
  constexpr std::uint32_t kTexels = 8192;
  maps::gpu::LightView view{};
  view.far = 10;
  view.side[0].face_count = 5;
  const maps::gpu::PrefilterTable table{
      .scheme = 0, .size = kTexels, .faces = 5, .levels = 1, .block = 1, .per_buffer = 1, .value_count = 0};
  std::vector<maps::gpu::Receiver> asked;
  constexpr double kThrough = 0.999;  // share of the receiver's height
  for (const glm::vec3& d :
       {glm::vec3(2, 0.3, 1), {-2, 1.8, 0.8}, {1.5, -1.4, 1}, {0.3, 2, 1}, {1.9, -2, 0.9}, {-1, 1.4, 1.2}}) {
    for (const glm::vec2& half : {glm::vec2(6, 6), {6, 0}, {0, 6}})
      asked.push_back({d, glm::vec3(half, kThrough * d.z), 0, 0});
  }
  const render::Buffer receivers = render::make_buffer<maps::gpu::Receiver>(device(), "receivers", asked),
                       views = render::make_buffer<maps::gpu::LightView>(device(), "views", std::span(&view, 1)),
                       head = render::make_buffer<maps::gpu::PrefilterTable>(device(), "table", std::span(&table, 1)),
                       results(device(), "boxes", 5 * asked.size() * sizeof(std::uint32_t));
  const render::ComputePass pass(device(), {.name = "box windows",
                                            .spirv = shaders::kBoxWindowsComp,
                                            .push_bytes = sizeof(maps::gpu::LookupPush),
                                            .constants = {0}});
  maps::gpu::LookupPush push{};
  push.size = kTexels;
  push.receiver_count = static_cast<std::uint32_t>(asked.size());
  render::Commands commands(device());
  pass.record(commands, std::as_bytes(std::span(&push, 1)),
              std::vector<render::BufferReference>{receivers, views, head, results, head, head, head, head, head}, 1);
  commands.submit();
  std::vector<std::uint32_t> words(5 * asked.size());
  results.read<std::uint32_t>(words);
  for (std::size_t i = 0; i < asked.size(); ++i) {
    const glm::dvec3 d(asked[i].p);
    const bool along_x = std::abs(d.x) >= std::abs(d.y);
    EXPECT_EQ(words[5 * i], along_x ? (d.x > 0 ? 1U : 2U) : (d.y > 0 ? 3U : 4U)) << i;
    const glm::dvec2 at(d.x / d.z, d.y / d.z),
        reach = glm::dvec2(asked[i].n) * (1 / static_cast<double>(asked[i].n.z) - 1 / d.z);
    glm::dvec2 lower(1e30), upper(-1e30);
    for (const double x : {-1.0, 1.0}) {
      for (const double y : {-1.0, 1.0}) {
        const glm::dvec2 corner = at + glm::dvec2(x, y) * reach;
        const double side = std::abs(along_x ? corner.x : corner.y), other = along_x ? corner.y : corner.x;
        const glm::dvec2 place =
            (glm::dvec2(other / side, 1 / side) - glm::dvec2(-1, 0)) / glm::dvec2(2, 1) * (1.0 * kTexels);
        lower = glm::min(lower, place);
        upper = glm::max(upper, place);
      }
    }
    for (int axis = 0; axis < 2; ++axis) {
      const auto number = [&](std::size_t k) { return static_cast<double>(std::bit_cast<float>(words[5 * i + k])); };
      const double found = number(3 + static_cast<std::size_t>(axis)) - number(1 + static_cast<std::size_t>(axis)),
                   extent = upper[axis] - lower[axis];
      if (extent < 0.5) continue;  // no window is narrower than a texel
      EXPECT_GT(extent, 2) << "no wider than a texel";
      EXPECT_NEAR(found, extent, 0.01 * extent) << i << ", axis " << axis;
      EXPECT_NEAR(number(1 + static_cast<std::size_t>(axis)), lower[axis], 0.01 * extent + 0.02)
          << i << ", axis " << axis;
    }
  }
}

}  // namespace
}  // namespace penumbra::tests
