#include "selftest/mask_checks.hpp"

#include "visibility/pair_truth.hpp"
#include "visibility/receivers.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace penumbra::selftest {

Check check_masks(visibility::Method& method, const Stage& stage, const std::string& name) {
  Check check{.pass = "masks of " + name, .against = "exact predicates, pair by pair", .rule = "every bit"};
  method.prepare_mesh(stage.floats);
  method.prepare_light(stage.light);
  method.prepare_view(stage.samples);
  const std::size_t words = stage.light.words_per_mask(), width = stage.samples.width;
  std::vector<std::uint32_t> masks(stage.samples.size() * words);
  const std::uint32_t rows = std::min(method.max_tile_rows(), stage.samples.height);
  for (std::uint32_t first = 0; first < stage.samples.height; first += rows) {
    const visibility::Tile tile{first, std::min(rows, stage.samples.height - first)};
    method.evaluate(tile);
    method.read_masks(std::span(masks).subspan(first * width * words, tile.row_count * width * words));
  }
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

}  // namespace penumbra::selftest
