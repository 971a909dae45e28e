// What means over windows are taken from: summed areas, mip levels and N-buffers against twins, bit by bit.

#include "maps/products/map_frame.hpp"
#include "maps/products/nearest_caster.hpp"
#include "maps/products/prefilter.hpp"
#include "maps/products/summed_areas.hpp"
#include "tests/analytic/centre_maps.hpp"

#include <array>
#include <numbers>
#include <random>

namespace penumbra::tests {
namespace {

class Prefilters : public MapsTest {};

/// SummedAreas' twin: Crow's sums of one image, modulo 2³².
std::vector<std::uint32_t> sums_of(const std::vector<std::uint32_t>& image, std::uint32_t size) {
  std::vector<std::uint32_t> sums(image.size());
  for (std::uint32_t y = 0; y < size; ++y) {
    std::uint32_t row = 0;
    for (std::uint32_t x = 0; x < size; ++x) {
      row += image[std::size_t{y} * size + x];
      sums[std::size_t{y} * size + x] = row + (y > 0 ? sums[std::size_t{y - 1} * size + x] : 0);
    }
  }
  return sums;
}

TEST_F(Prefilters, SummedAreasAreExactModulo32BitsAtAnySize) {
  std::mt19937 random(1);
  const maps::SummedAreas pass(device());
  for (const std::uint32_t size : {8U, 9U, 100U, 257U}) {
    constexpr std::uint32_t kImages = 3;
    const std::size_t texels = std::size_t{size} * size;
    std::vector<std::uint32_t> words(kImages * texels);
    for (std::uint32_t& word : words) word = static_cast<std::uint32_t>(random());  // most sums wrap around
    const render::Buffer buffer = render::make_buffer<std::uint32_t>(device(), "images", words);
    render::Commands commands(device());
    pass.record(commands, buffer, kImages, size);
    commands.submit();
    std::vector<std::uint32_t> found(words.size());
    buffer.read<std::uint32_t>(found);
    for (std::size_t k = 0; k < kImages; ++k) {
      const auto first = static_cast<std::ptrdiff_t>(k * texels), last = static_cast<std::ptrdiff_t>((k + 1) * texels);
      const std::vector<std::uint32_t> image(words.begin() + first, words.begin() + last);
      EXPECT_EQ(std::vector(found.begin() + first, found.begin() + last), sums_of(image, size)) << size;
    }
  }
}

// S4 5.2.2.3: sums of many values lose precision in float32, so 32-bit integers (fixed point) are used beyond some
// size.
TEST(SummedAreaTables, OfFloatsLoseWhatIntegersKeep) {
  constexpr std::uint32_t kSide = 2048, kBits = 10, kBox = 4;  // 2048² digits of 10 bits: 2³²
  std::mt19937 random(2);
  std::vector<float> floats(std::size_t{kSide} * kSide), float_sums(floats.size());
  std::vector<std::uint32_t> digits(floats.size());
  for (std::size_t i = 0; i < floats.size(); ++i) {
    digits[i] = 512 + static_cast<std::uint32_t>(random() % 512);
    floats[i] = static_cast<float>(digits[i]) / static_cast<float>(1U << kBits);
  }
  for (std::uint32_t y = 0; y < kSide; ++y) {
    float row = 0;
    for (std::uint32_t x = 0; x < kSide; ++x) {
      const std::size_t at = std::size_t{y} * kSide + x;
      row += floats[at];
      float_sums[at] = row + (y > 0 ? float_sums[at - kSide] : 0);
    }
  }
  const std::vector<std::uint32_t> sums = sums_of(digits, kSide);
  double worst_float = 0;
  for (std::uint32_t k = 0; k < 2000; ++k) {
    const std::uint32_t x = 1 + static_cast<std::uint32_t>(random() % (kSide - kBox - 1)),
                        y = 1 + static_cast<std::uint32_t>(random() % (kSide - kBox - 1));
    const auto corner = [&](const auto& table, std::uint32_t i, std::uint32_t j) {
      return table[(std::size_t{y} + j - 1) * kSide + x + i - 1];
    };
    std::uint32_t truth = 0;
    for (std::uint32_t j = 0; j < kBox; ++j) {
      for (std::uint32_t i = 0; i < kBox; ++i) truth += digits[(std::size_t{y} + j) * kSide + x + i];
    }
    const std::uint32_t box =
        corner(sums, kBox, kBox) - corner(sums, 0, kBox) - corner(sums, kBox, 0) + corner(sums, 0, 0);
    EXPECT_EQ(box, truth);
    const float mean = (corner(float_sums, kBox, kBox) - corner(float_sums, 0, kBox) - corner(float_sums, kBox, 0) +
                        corner(float_sums, 0, 0)) /
                       (kBox * kBox);
    worst_float = std::max(worst_float, std::abs(static_cast<double>(mean) - truth / 1024.0 / (kBox * kBox)));
  }
  RecordProperty("worstFloatMean", std::to_string(worst_float));
  EXPECT_GT(worst_float, 1e-3);
}

/// A floor and a sphere under a square light, in a window or, with a wall up to the light, a hemicube.
scenes::Scene scene_of(bool hemicube) {
  scenes::Scene scene;
  add_quad(scene, {0, 0, 0}, {2, 0, 0}, {0, 0, -2}).casts_shadow = false;  // leaves texels where nothing is
  add_object(scene, "sphere", sphere({0.3, 1, 0.2}, 0.6, 8));
  if (hemicube) add_quad(scene, {2, 2, 0}, {0, 2, 0}, {0, 0, 2});
  scene.lights.push_back(ceiling_light(3, 0.5));
  scene.cameras.push_back(camera({0, 3, 8}, {0, 1, 0}));
  return scene;
}

struct Prefiltered {
  Prefiltered(const render::Device& device, const Stage& stage, std::uint32_t size, maps::PrefilterOptions options)
      : maps(device, stage, size),
        nearest(device),
        frame(device),
        product(device, options, {.nearest = &nearest, .frame = &frame}),
        layout(*maps::prefilter_layout(options, size, maps.fitted.faces, device.limits().max_storage_buffer_range)) {
    render::Commands commands(device);
    nearest.record(commands, maps.set(stage));
    frame.record(commands, maps.set(stage));
    product.record(commands, maps.set(stage));
    commands.submit();
    nearest.buffer().read<float>(lowest);
    frame.buffer().read<maps::gpu::MapFrame>(std::span(&found_frame, 1));
  }
  /// The words of block `k`.
  [[nodiscard]] std::vector<std::uint32_t> block(std::uint32_t k) const {
    std::vector<std::uint32_t> words(layout.table.block);
    const render::Buffer& buffer = product.buffers()[1 + k / layout.table.per_buffer];
    buffer.read<std::uint32_t>(words, std::uint64_t{k % layout.table.per_buffer} * layout.table.block * 4);
    return words;
  }
  /// The height of a texel in [0, 1].
  [[nodiscard]] double height(const std::vector<float>& depths, std::size_t texel) const {
    const maps::gpu::LightView& view = maps.fitted.views.front();
    if (depths[texel] == 1) return 1;
    const std::size_t row = texel / maps.size, face = row / maps.size;
    const bool sideways = face != view.side[0].first_face;
    const double along = sideways ? (static_cast<double>(row % maps.size) + 0.5) / maps.size : 1;
    const double low = lowest[0] * (1 - 1.0 / 1024), high = found_frame.deepest[0] * (1 + 1.0 / 1024);
    return std::clamp((depths[texel] * along * view.far - low) / (high - low), 0.0, 1.0);
  }

  CentreMaps maps;
  maps::NearestCaster nearest;
  maps::MapFrame frame;
  maps::Prefilter product;
  maps::PrefilterLayout layout;
  std::array<float, 2> lowest{};
  maps::gpu::MapFrame found_frame{};
};

/// Each kind of function once, with its value and how far float32 may be off it.
struct Case {
  maps::PrefilterFunction function;
  std::function<double(double)> value;
};
std::vector<Case> cases() {
  using namespace maps::gpu;
  const auto layer = [](double t) { return std::clamp(4 * t - 1, 0.0, 1.0); };
  const float c = 3 * std::numbers::pi_v<float>;
  return {
      {{.kind = kLayer}, [](double t) { return t; }},
      {{.kind = kLayer, .power = kSquared}, [](double t) { return (t - 0.5) * (t - 0.5); }},
      {{.kind = kLayer, .a = 4, .b = 1}, layer},
      {{.kind = kLayer, .power = kSquared, .a = 4, .b = 1}, [=](double t) { return std::pow(layer(t) - 0.5, 2); }},
      {{.kind = kRising, .a = 20, .digits = 60}, [](double t) { return std::exp(20 * (t - 1)); }},
      {{.kind = kRising, .power = kSquared, .a = 20, .digits = 90}, [](double t) { return std::exp(40 * (t - 1)); }},
      {{.kind = kFalling, .a = 20, .digits = 60}, [](double t) { return std::exp(-20 * t); }},
      {{.kind = kFalling, .power = kSquared, .a = 20, .digits = 90}, [](double t) { return std::exp(-40 * t); }},
      {{.kind = kSine, .a = c}, [=](double t) { return 0.5 + 0.5 * std::sin(c * t); }},
      {{.kind = kCosine, .a = c}, [=](double t) { return 0.5 + 0.5 * std::cos(c * t); }},
      {{.kind = kSine, .power = kTimesHeight, .a = c}, [=](double t) { return 0.5 + 0.5 * t * std::sin(c * t); }},
      {{.kind = kCosine, .power = kTimesHeight, .a = c}, [=](double t) { return 0.5 + 0.5 * t * std::cos(c * t); }}};
}
/// Heights are right to a few units of float32's last place, exponents multiply that by up to 40; exp and sin of a
/// device are right to 2⁻²⁰ of their argument's range.
constexpr double kFloatError = 128 * 0x1p-23;

TEST_F(Prefilters, TablesAreSumsOfTheValuesDigits) {
  for (const bool hemicube : {false, true}) {
    const Stage stage(scene_of(hemicube), 4, 4, light_samples(1));
    for (const std::uint32_t size : {32U, 51U}) {
      maps::PrefilterOptions options{.kind = maps::PrefilterKind::table, .functions = {}};
      for (const Case& one : cases()) options.functions.push_back(one.function);
      const Prefiltered found(device(), stage, size, options);
      ASSERT_EQ(found.maps.fitted.faces, hemicube ? 5U : 1U);
      const std::vector<float> depths = found.maps.read();
      const std::size_t texels = std::size_t{size} * size;
      for (std::size_t f = 0; f < options.functions.size(); ++f) {
        const maps::gpu::PrefilterValue& value = found.layout.values[f];
        ASSERT_LE(std::uint64_t{texels} << value.bits, std::uint64_t{1} << 32);
        ASSERT_GE(value.bits * value.limbs, options.functions[f].digits);
        std::vector<double> sums(depths.size(), 0.0);
        for (std::uint32_t limb = 0; limb < value.limbs; ++limb) {
          const std::vector<std::uint32_t> table = found.block(value.first_block + limb);
          std::vector<std::uint32_t> digits(table.size());
          for (std::size_t i = 0; i < table.size(); ++i) {
            const std::size_t x = i % size, y = i / size % size;
            digits[i] = table[i] - (x > 0 ? table[i - 1] : 0) - (y > 0 ? table[i - size] : 0) +
                        (x > 0 && y > 0 ? table[i - size - 1] : 0);
            ASSERT_LT(digits[i], 1U << value.bits) << "a digit of its own, not a carry";
            sums[i] += std::ldexp(digits[i], -static_cast<int>(value.bits * (limb + 1)));
          }
        }
        for (std::size_t i = 0; i < depths.size(); ++i) {
          const double truth = cases()[f].value(found.height(depths, i));
          const bool exponential = value.kind == maps::gpu::kRising || value.kind == maps::gpu::kFalling;
          const double last = std::ldexp(1.0, -static_cast<int>(value.bits * value.limbs));
          EXPECT_NEAR(sums[i], truth, kFloatError * (exponential ? truth : 1) + last)
              << "function " << f << " texel " << i;
        }
      }
    }
  }
}

// Mip levels and N-buffers, from their finest level up: the same sums of four in the same order.
TEST_F(Prefilters, LevelsAreMeansOfTheLevelBefore) {
  for (const bool hemicube : {false, true}) {
    const Stage stage(scene_of(hemicube), 4, 4, light_samples(1));
    for (const maps::PrefilterKind kind : {maps::PrefilterKind::pyramid, maps::PrefilterKind::windows}) {
      for (const std::uint32_t size : {8U, 32U, 51U}) {
        maps::PrefilterOptions options{.kind = kind, .functions = {}};
        for (const Case& one : cases()) options.functions.push_back(one.function);
        const Prefiltered found(device(), stage, size, options);
        const std::uint32_t faces = found.maps.fitted.faces, levels = found.layout.table.levels;
        const bool pyramid = kind == maps::PrefilterKind::pyramid;
        EXPECT_EQ(levels, size == 8 ? 4U : size == 32 ? 6U : pyramid ? 7U : 6U);
        const std::vector<float> depths = found.maps.read();
        for (std::size_t f = 0; f < options.functions.size(); ++f) {
          const std::vector<std::uint32_t> words = found.block(found.layout.values[f].first_block);
          std::vector<float> before(depths.size());
          for (std::size_t i = 0; i < depths.size(); ++i) {
            before[i] = std::bit_cast<float>(words[i]);
            EXPECT_NEAR(before[i], cases()[f].value(found.height(depths, i)), kFloatError);
          }
          std::size_t at = before.size();
          std::uint32_t side = size;
          for (std::uint32_t level = 1; level < levels; ++level) {
            const std::uint32_t next = pyramid ? (side + 1) / 2 : size, step = pyramid ? 1 : 1U << (level - 1);
            std::vector<float> now(std::size_t{faces} * next * next);
            for (std::size_t i = 0; i < now.size(); ++i, ++at) {
              const auto x = static_cast<std::uint32_t>(i % next), y = static_cast<std::uint32_t>(i / next % next);
              const std::size_t face = i / (std::size_t{next} * next);
              const std::uint32_t x0 = pyramid ? 2 * x : x, y0 = pyramid ? 2 * y : y;
              const std::uint32_t x1 = std::min(x0 + step, side - 1), y1 = std::min(y0 + step, side - 1);
              const auto of = [&](std::uint32_t a, std::uint32_t b) { return before[(face * side + b) * side + a]; };
              now[i] = 0.25F * ((of(x0, y0) + of(x1, y0)) + (of(x0, y1) + of(x1, y1)));
              ASSERT_EQ(std::bit_cast<float>(words[at]), now[i]) << "level " << level << " of " << size;
            }
            before = std::move(now);
            side = next;
          }
          EXPECT_EQ(at, words.size());
          if (pyramid) {
            EXPECT_EQ(side, 1U);
          }
        }
      }
    }
  }
}

TEST_F(Prefilters, WhatNoBuffersHoldIsRefusedWithTheSizeThatDoes) {
  const std::uint64_t most = device().limits().max_storage_buffer_range;
  maps::PrefilterOptions options{.kind = maps::PrefilterKind::table,
                                 .functions = std::vector<maps::PrefilterFunction>(300)};
  std::uint32_t size = 16;
  while (size < 16384 && maps::prefilter_layout(options, size, 1, most)) size *= 2;
  ASSERT_FALSE(maps::prefilter_layout(options, size, 1, most));
  const Stage stage(scene_of(false), 4, 4, light_samples(1));
  maps::NearestCaster nearest(device());
  maps::MapFrame frame(device());
  maps::Prefilter product(device(), options, {.nearest = &nearest, .frame = &frame});
  const CentreMaps maps(device(), stage, 16);
  maps::MapSet set = maps.set(stage);
  set.size = size;
  try {
    render::Commands commands(device());
    product.record(commands, set);
    ADD_FAILURE() << size << " is too large";
  } catch (const ResourceError& error) {
    const std::string message = error.what();
    const auto named = static_cast<std::uint32_t>(std::stoul(message.substr(message.rfind("size=") + 5)));
    EXPECT_TRUE(maps::prefilter_layout(options, named, 1, most)) << message;
    EXPECT_FALSE(maps::prefilter_layout(options, named + 1, 1, most)) << message;
  }
}

// A disk's and a polygon's box have their second moments; a rectangle's is itself.
TEST(LightBox, HasTheLightsOwnMoments) {
  scenes::Scene scene = scene_of(false);
  struct Shape {
    decltype(scenes::AreaLight::shape) shape;
    glm::dvec2 half;
  };
  // A right triangle with legs 2 along its axes: variance of x is 2²/18.
  for (const Shape& one :
       {Shape{scenes::Rectangle{{0, 3, 0}, {0.7, 0, 0}, {0, 0, 0.2}}, {0.7, 0.2}},
        Shape{scenes::Disk{{0, 3, 0}, {0, -1, 0}, 0.5}, glm::dvec2(std::sqrt(0.75) * 0.5)},
        Shape{scenes::Ellipse{{0, 3, 0}, {0.4, 0, 0}, {0.3, 0, 0.2}}, std::sqrt(0.75) * glm::dvec2(0.5, 0.2)},
        Shape{scenes::Polygon{{{0, 3, 0}, {2, 3, 0}, {0, 3, 2}}}, glm::dvec2(std::sqrt(3 * 4.0 / 18))}}) {
    scene.lights.front().shape = one.shape;
    const Stage stage(scene, 4, 4, light_samples(1));
    const glm::dvec2 half = maps::half_box(stage.light, maps::light_basis(stage.light));
    EXPECT_NEAR(half.x, one.half.x, 1e-6);
    EXPECT_NEAR(half.y, one.half.y, 1e-6);
  }
}

}  // namespace
}  // namespace penumbra::tests
