// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/soup_methods.hpp"

#include "base/error.hpp"
#include "tests/agreement/volumes/light_span.hpp"
#include "tests/fuzz/soup_judge.hpp"
#include "visibility/pair_truth.hpp"
#include "visibility/receivers.hpp"
#include "volumes/counters/methods.hpp"
#include "volumes/scatter/methods.hpp"
#include "vsm/methods.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>

namespace penumbra::fuzz {
namespace {

std::string text_of(const glm::vec3& x) {
  return fmt::format("({:a}, {:a}, {:a})", x.x, x.y, x.z);
}

std::string describe(const SoupCase& judged, std::size_t pixel, std::uint32_t sample, bool truth) {
  const auto [a, b, c] = judged.floats.corners(static_cast<std::uint32_t>(judged.samples.triangle[pixel]));
  return fmt::format("pixel {} light sample {}: truth {}; p {} on {} {} {} facing {}; l {}; light {} {} {}", pixel,
                     sample, truth ? "visible" : "hidden", text_of(judged.samples.p[pixel]), text_of(a), text_of(b),
                     text_of(c), judged.samples.facing[pixel], text_of(judged.light.points[sample]),
                     text_of(judged.light.center), text_of(judged.light.center_u), text_of(judged.light.center_v));
}

bool can_do(const visibility::Method& method, const visibility::Light& light) {
  try {
    visibility::check_light(method.description(), light);
    return true;
  } catch (const InputError&) {
    return false;
  }
}

std::vector<std::uint32_t> masks_of(visibility::Method& method, const SoupCase& judged) {
  method.prepare_mesh(judged.floats);
  method.prepare_light(judged.light);
  method.prepare_view(judged.samples);
  const std::size_t row_words = std::size_t{judged.samples.width} * judged.light.words_per_mask();
  std::vector<std::uint32_t> masks(judged.samples.height * row_words);
  const std::uint32_t rows = std::min(method.max_tile_rows(), judged.samples.height);
  for (std::uint32_t row = 0; row < judged.samples.height; row += rows) {
    const visibility::Tile tile{row, std::min(rows, judged.samples.height - row)};
    method.evaluate(tile);
    method.read_masks(std::span(masks).subspan(row * row_words, tile.row_count * row_words));
  }
  return masks;
}

}  // namespace

void SoupFindings::operator+=(const SoupFindings& other) {
  cases += other.cases;
  pairs += other.pairs;
  visible += other.visible;
  answers += other.answers;
  refusals += other.refusals;
  if (wrong == 0) first_wrong = other.first_wrong;
  wrong += other.wrong;
}

std::vector<SoupMethods::Variant>& SoupMethods::variants_for(const visibility::Light& light) {
  std::vector<Variant>& variants = variants_[{light.kind, light.rows, light.columns}];
  if (!variants.empty()) return variants;
  const render::Device& device = *device_;
  for (const char* engine : {"native", "vulkan"}) {
    const visibility::MethodOptions options{{"engine", engine}};
    const bool in_rows = light.kind == visibility::LightKind::rectangle && light.rows > 0;
    if (in_rows || std::string_view(engine) == "native") {
      variants.push_back({fmt::format("edge-scatter:engine={}", engine), volumes::make_edge_scatter(device, options)});
    }
    variants.push_back({fmt::format("view-sample:engine={}", engine), vsm::make_view_sample(device, options)});
  }
  for (const auto& [option, value] :
       {std::pair("engine", "native"), std::pair("engine", "vulkan"), std::pair("crop", "off")}) {
    variants.push_back({fmt::format("depth-complexity:{}={}", option, value),
                        volumes::make_depth_complexity(device, {{option, value}})});
  }
  return variants;
}

SoupFindings SoupMethods::check(const SoupCase& judged) {
  const SoupJudge judge(judged);
  const std::uint32_t words = judged.light.words_per_mask();
  SoupFindings found;
  found.cases = 1;
  std::vector<std::uint32_t> truth(judged.samples.size() * words);
  const auto for_each_pair = [&](auto visit) {
    for (std::size_t pixel = 0; pixel < judged.samples.size(); ++pixel) {
      if (judged.samples.triangle[pixel] == visibility::ViewSamples::kBackground) continue;
      for (std::uint32_t j = 0; j < judged.light.sample_count(); ++j) visit(pixel, j);
    }
  };
  const auto bit = [&](const std::vector<std::uint32_t>& masks, std::size_t pixel, std::uint32_t j) {
    return (masks[pixel * words + j / 32] >> (j % 32) & 1U) != 0;
  };
  const auto compare = [&](const std::string& name, std::size_t pixel, std::uint32_t j, bool says) {
    ++found.answers;
    if (says == bit(truth, pixel, j)) return;
    if (found.wrong++ == 0) found.first_wrong = name + ": " + describe(judged, pixel, j, !says);
  };
  for_each_pair([&](std::size_t pixel, std::uint32_t j) {
    const bool sees = judge.sees(pixel, j);
    ++found.pairs;
    found.visible += sees ? 1 : 0;
    if (sees) truth[pixel * words + j / 32] |= 1U << (j % 32);
  });
  for_each_pair([&](std::size_t pixel, std::uint32_t j) {
    const auto decided = visibility::decide_pair(judged.floats, judged.samples, pixel, judged.light, j);
    compare("decide_pair", pixel, j, decided.outcome == visibility::PairOutcome::visible);
  });
  for (Variant& variant : variants_for(judged.light)) {
    if (!can_do(*variant.method, judged.light)) continue;
    const auto masks =
        tests::unless_too_far_apart(judged.floats, judged.light, [&] { return masks_of(*variant.method, judged); });
    found.refusals += masks ? 0 : 1;
    if (!masks) continue;
    for_each_pair([&](std::size_t pixel, std::uint32_t j) {
      if (!visibility::is_receiver(judged.floats, judged.light, judged.samples, pixel))
        return;  // such a surface is lit, whatever the truth
      compare(variant.name, pixel, j, bit(*masks, pixel, j));
    });
  }
  return found;
}

}  // namespace penumbra::fuzz
