// SPDX-License-Identifier: Apache-2.0
// Compares prefiltered tables and levels with functions in double.

#include "selftest/prefilter_checks.hpp"

#include "maps/products/map_frame.hpp"
#include "maps/products/nearest_caster.hpp"
#include "selftest/centre_maps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <functional>
#include <numbers>
#include <utility>
#include <vector>

namespace penumbra::selftest {
namespace {

struct Prefiltered {
  Prefiltered(const render::Device& device, const Stage& stage, std::uint32_t size,
              const maps::PrefilterOptions& options)
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
  /// Returns the words of block `k`.
  [[nodiscard]] std::vector<std::uint32_t> block(std::uint32_t k) const {
    std::vector<std::uint32_t> words(layout.table.block);
    const render::Buffer& buffer = product.buffers()[1 + k / layout.table.per_buffer];
    buffer.read<std::uint32_t>(words, std::uint64_t{k % layout.table.per_buffer} * layout.table.block * 4);
    return words;
  }
  /// Returns the height of a texel in [0, 1].
  [[nodiscard]] double height(const std::vector<float>& depths, std::size_t texel) const {
    const maps::gpu::LightView& view = maps.fitted.views.front();
    if (depths[texel] == 1) return 1;
    const std::size_t row = texel / maps.size, face = row / maps.size;
    const std::size_t side = face >= view.side[0].first_face + view.side[0].face_count ? 1 : 0;
    const bool sideways = face != view.side[side].first_face;
    const double along = sideways ? (static_cast<double>(row % maps.size) + 0.5) / maps.size : 1;
    const double low = lowest.at(side) * (1 - 1.0 / 1024), high = std::max(found_frame.deepest[side], lowest.at(side));
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

/// One kind of function, with its value.
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
/// Heights are accurate to a few units of float32's last place, and exponents multiply this error by up to 40; exp and
/// sin of a device are accurate to 2⁻²⁰ of their argument's range.
constexpr double kFloatError = 128 * 0x1p-23;

maps::PrefilterOptions options_of(maps::PrefilterKind kind) {
  maps::PrefilterOptions options{.kind = kind, .functions = {}};
  for (const Case& one : cases()) options.functions.push_back(one.function);
  return options;
}

}  // namespace

Check check_prefilter_tables(const render::Device& device, const Stage& stage, std::uint32_t size) {
  Check check{.pass = "prefiltered tables",
              .against = "the functions in double",
              .rule = "digits whose sums equal the functions within float's error"};
  const maps::PrefilterOptions options = options_of(maps::PrefilterKind::table);
  const Prefiltered found(device, stage, size, options);
  const std::vector<float> depths = found.maps.read();
  const std::uint64_t texels = std::uint64_t{size} * size;
  const std::vector<Case> all = cases();
  for (std::size_t f = 0; f < all.size(); ++f) {
    const maps::gpu::PrefilterValue& value = found.layout.values[f];
    const auto place = [&](std::size_t i) { return [=] { return fmt::format("function {}, texel {}", f, i); }; };
    check.same(texels << value.bits <= std::uint64_t{1} << 32, true, place(0));
    check.same(value.bits * value.limbs >= options.functions[f].digits, true, place(0));
    std::vector<double> sums(depths.size(), 0.0);
    for (std::uint32_t limb = 0; limb < value.limbs; ++limb) {
      const std::vector<std::uint32_t> table = found.block(value.first_block + limb);
      for (std::size_t i = 0; i < std::min(table.size(), sums.size()); ++i) {
        const std::size_t x = i % size, y = i / size % size;
        const std::uint32_t digit = table[i] - (x > 0 ? table[i - 1] : 0) - (y > 0 ? table[i - size] : 0) +
                                    (x > 0 && y > 0 ? table[i - size - 1] : 0);
        check.same(digit < 1U << value.bits, true, place(i));
        sums[i] += std::ldexp(digit, -static_cast<int>(value.bits * (limb + 1)));
      }
    }
    const bool exponential = value.kind == maps::gpu::kRising || value.kind == maps::gpu::kFalling;
    const double last = std::ldexp(1.0, -static_cast<int>(value.bits * value.limbs));
    for (std::size_t i = 0; i < depths.size(); ++i) {
      const double truth = all[f].value(found.height(depths, i));
      check.within(std::abs(sums[i] - truth), kFloatError * (exponential ? truth : 1) + last, place(i));
    }
  }
  return check;
}

Check check_prefilter_levels(const render::Device& device, const Stage& stage, std::uint32_t size,
                             maps::PrefilterKind kind) {
  const bool pyramid = kind == maps::PrefilterKind::pyramid;
  Check check{.pass = "prefiltered levels",
              .against = "the functions in double, and the level before",
              .rule = "the finest within float's error; the others bit by bit"};
  const Prefiltered found(device, stage, size, options_of(kind));
  const std::uint32_t faces = found.maps.fitted.faces, levels = found.layout.table.levels;
  // Levels down to one texel, or up to the largest window that fits.
  const auto expected = static_cast<std::uint32_t>(pyramid ? std::bit_width(size - 1) + 1 : std::bit_width(size));
  check.same(levels, expected, [&] { return fmt::format("{} levels of {} texels", levels, size); });
  const std::vector<float> depths = found.maps.read();
  const std::vector<Case> all = cases();
  for (std::size_t f = 0; f < all.size(); ++f) {
    const std::vector<std::uint32_t> words = found.block(found.layout.values[f].first_block);
    std::vector<float> before(depths.size());
    for (std::size_t i = 0; i < depths.size(); ++i) {
      before[i] = std::bit_cast<float>(words[i]);
      check.within(std::abs(static_cast<double>(before[i]) - all[f].value(found.height(depths, i))), kFloatError,
                   [&] { return fmt::format("function {}, texel {}", f, i); });
    }
    std::size_t at = before.size();
    std::uint32_t side = size;
    for (std::uint32_t level = 1; level < levels; ++level) {
      const std::uint32_t next = pyramid ? (side + 1) / 2 : size, step = pyramid ? 1 : 1U << (level - 1);
      std::vector<float> now(std::size_t{faces} * next * next);
      for (std::size_t i = 0; i < now.size() && at < words.size(); ++i, ++at) {
        const auto x = static_cast<std::uint32_t>(i % next), y = static_cast<std::uint32_t>(i / next % next);
        const std::size_t face = i / (std::size_t{next} * next);
        const std::uint32_t x0 = pyramid ? 2 * x : x, y0 = pyramid ? 2 * y : y;
        const std::uint32_t x1 = std::min(x0 + step, side - 1), y1 = std::min(y0 + step, side - 1);
        const auto of = [&](std::uint32_t a, std::uint32_t b) { return before[(face * side + b) * side + a]; };
        now[i] = 0.25F * ((of(x0, y0) + of(x1, y0)) + (of(x0, y1) + of(x1, y1)));
        check.same(std::bit_cast<float>(words[at]), now[i],
                   [&] { return fmt::format("function {}, level {} of {}, node {}", f, level, size, i); });
      }
      before = std::move(now);
      side = next;
    }
    check.same(at, words.size(), [&] { return fmt::format("function {}: words", f); });
  }
  return check;
}

}  // namespace penumbra::selftest
