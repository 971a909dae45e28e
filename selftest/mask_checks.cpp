// SPDX-License-Identifier: Apache-2.0
// Compares masks and counters with exact predicates.

#include "selftest/mask_checks.hpp"

#include "visibility/pair_truth.hpp"
#include "visibility/receivers.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace penumbra::selftest {
namespace {

/// Evaluates the stage tile by tile; calls `read` for each tile.
template <typename Read>
void evaluate(visibility::Method& method, const Stage& stage, const Read& read) {
  method.prepare_mesh(stage.floats);
  method.prepare_light(stage.light);
  method.prepare_view(stage.samples);
  const std::uint32_t rows = std::min(method.max_tile_rows(), stage.samples.height);
  for (std::uint32_t first = 0; first < stage.samples.height; first += rows) {
    const visibility::Tile tile{first, std::min(rows, stage.samples.height - first)};
    method.evaluate(tile);
    read(tile);
  }
}

int layers(const Stage& stage, std::size_t pixel, std::uint32_t j) {
  const auto carrier = static_cast<std::uint32_t>(stage.samples.triangle[pixel]);
  const glm::vec3 &p = stage.samples.p[pixel], &l = stage.light.points[j];
  int met = 0;
  for (std::uint32_t i = 0; i < stage.floats.triangles.size(); ++i) {
    if (!visibility::may_occlude(stage.floats, stage.light, carrier, i)) continue;
    met += visibility::segment_meets_triangle(p, l, stage.floats.corners(i), stage.light).meets ? 1 : 0;
  }
  return met;
}

}  // namespace

Check check_masks(visibility::Method& method, const Stage& stage, const std::string& name) {
  Check check{.pass = "masks of " + name, .against = "exact predicates, pair by pair", .rule = "every bit"};
  const std::size_t words = stage.light.words_per_mask(), width = stage.samples.width;
  std::vector<std::uint32_t> masks(stage.samples.size() * words);
  evaluate(method, stage, [&](const visibility::Tile& tile) {
    method.read_masks(std::span(masks).subspan(tile.first_row * width * words, tile.row_count * width * words));
  });
  std::vector<Check> pixels(stage.samples.size());
  tbb::parallel_for(std::size_t{0}, pixels.size(), [&](std::size_t pixel) {
    if (!visibility::is_receiver(stage.floats, stage.light, stage.samples, pixel)) return;
    for (std::uint32_t j = 0; j < stage.light.sample_count(); ++j) {
      const bool found = (masks[pixel * words + j / 32] >> (j % 32) & 1) != 0;
      const auto truth = visibility::decide_pair(stage.floats, stage.samples, pixel, stage.light, j);
      pixels[pixel].same(found, truth.outcome == visibility::PairOutcome::visible,
                         [&] { return fmt::format("pixel {}, {}, light sample {}", pixel % width, pixel / width, j); });
    }
  });
  for (const Check& pixel : pixels) check.add(pixel);
  return check;
}

Check check_counters(volumes::DepthCounters& method, const Stage& stage, std::size_t step, CounterTally& tally) {
  Check check{.pass = "counters of depth-complexity",
              .against = "triangles met, by exact predicates",
              .rule = "equal, where there is a counter"};
  const std::size_t n = stage.light.sample_count(), width = stage.samples.width;
  std::vector<std::int32_t> counters(stage.samples.size() * n);
  evaluate(method, stage, [&](const visibility::Tile& tile) {
    method.read_counters(std::span(counters).subspan(tile.first_row * width * n, tile.row_count * width * n));
  });
  struct Pixel {
    Check check;
    CounterTally tally;
  };
  std::vector<Pixel> pixels(stage.samples.size() / step);
  tbb::parallel_for(std::size_t{0}, pixels.size(), [&](std::size_t i) {
    const std::size_t pixel = i * step;
    if (stage.samples.triangle[pixel] == visibility::ViewSamples::kBackground) return;
    auto& [found, seen] = pixels[i];
    for (std::uint32_t j = 0; j < n; ++j) {
      const std::int32_t counter = counters[pixel * n + j];
      ++seen.pairs;
      if (counter == volumes::DepthCounters::kNoCounter) {
        ++seen.open;
        continue;
      }
      const int met = layers(stage, pixel, j);
      seen.met += met > 0 ? 1 : 0;
      seen.several += met > 1 ? 1 : 0;
      found.same(counter, met, [&] {
        return fmt::format("{}, not {}, at pixel {}, {}, light sample {}", counter, met, pixel % width, pixel / width,
                           j);
      });
    }
  });
  for (const auto& [found, seen] : pixels) {
    check.add(found);
    tally.pairs += seen.pairs;
    tally.open += seen.open;
    tally.met += seen.met;
    tally.several += seen.several;
  }
  return check;
}

}  // namespace penumbra::selftest
