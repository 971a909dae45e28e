// SPDX-License-Identifier: Apache-2.0
// Judges methods light by light: errors, pairs, classes.

#include "session/comparison/light_judge.hpp"

#include "compare/metrics.hpp"
#include "session/sample_pixels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <utility>

namespace penumbra::session {

std::vector<LightTruth> choose_pixels(const Session& session, const std::string& sample_pixels) {
  std::vector<LightTruth> truths;
  for (const WholeLight& whole : whole_lights(session.lights)) {
    const std::vector<visibility::PixelClass> classes = whole_classes(whole, session.classes);
    const auto chosen = [&](visibility::PixelClass wanted) {
      return session::sample_pixels(compare::pixels_of_class(classes, wanted), sample_pixels, session.width,
                                    session.height);
    };
    LightTruth& truth = truths.emplace_back();
    truth.judged = chosen(visibility::PixelClass::judged);
    truth.horizon = chosen(visibility::PixelClass::horizon);
  }
  return truths;
}

std::vector<std::uint32_t> all_pixels(std::span<const LightTruth> truths) {
  std::vector<std::uint32_t> pixels;
  for (const LightTruth& truth : truths) {
    pixels.insert(pixels.end(), truth.judged.begin(), truth.judged.end());
    pixels.insert(pixels.end(), truth.horizon.begin(), truth.horizon.end());
  }
  std::ranges::sort(pixels);
  pixels.erase(std::unique(pixels.begin(), pixels.end()), pixels.end());
  return pixels;
}

LightJudge::LightJudge(const Session& session, std::span<const LightTruth> truths, std::size_t most_decided)
    : session_(session), truths_(truths), wholes_(whole_lights(session.lights)), masks_(session.lights.size()) {
  for (std::size_t whole = 0; whole < wholes_.size(); ++whole) {
    const auto& [first, count] = wholes_[whole];
    for (std::size_t piece = 0; piece < truths[whole].ray_masks.size(); ++piece) {
      masks_[first + piece].emplace(
          session, MaskQuestion{first + piece, truths[whole].ray_masks[piece], std::max(most_decided / count, 1UL)});
    }
  }
}

void LightJudge::add(const TileResult& tile) {
  if (tile.masks.empty() || !masks_[tile.light]) return;
  has_masks_ = true;
  masks_[tile.light]->add(tile);
}

std::vector<compare::LightResult> LightJudge::judge(const MethodRun& run, Progress& progress) {
  std::vector<compare::LightResult> results;
  for (std::size_t light = 0; light < truths_.size(); ++light) {
    const LightTruth& truth = truths_[light];
    compare::LightResult& result = results.emplace_back();
    const auto& [first, count] = wholes_[light];
    result.name = session_.lights[first].name;
    result.judged_pixels = truth.judged.size();
    result.horizon_pixels = truth.horizon.size();
    result.error = compare::visibility_error(run.visibility[light], truth.reference, truth.judged);
    result.horizon_error = compare::visibility_error(run.visibility[light], truth.reference, truth.horizon);
    const std::vector<float>& v = run.visibility[light];
    result.classes = compare::class_errors(v, truth.reference, truth.classes);
    result.eye = compare::eye_error({v, truth.reference, truth.judged}, truth.classes.penumbra, session_.width);
    if (!truth.sizes.width.empty()) {
      std::vector<std::uint32_t> shadowed;
      std::ranges::set_union(truth.classes.penumbra, truth.classes.umbra, std::back_inserter(shadowed));
      result.by_width = compare::range_errors(v, truth.reference, truth.classes.penumbra, truth.sizes.width_pixels);
      result.by_contact = compare::range_errors(v, truth.reference, shadowed, truth.sizes.contact_pixels);
    }
    if (!has_masks_ || truth.ray_masks.empty()) continue;
    result.same_samples =
        compare::SameSamples{compare::visibility_error(run.visibility[light], truth.rays, truth.judged), {}, {}};
    for (std::size_t piece = first; piece < first + count; ++piece) {
      result.same_samples->pairs += masks_[piece]->counts();
      result.same_samples->verdicts += masks_[piece]->decide(progress);
    }
  }
  return results;
}

void LightJudge::fill(compare::MethodResult& result, const MethodRun& run, bool pairs_of_reference,
                      Progress& progress) {
  result.lights = judge(run, progress);
  result.all_lights_error = error_of_all_lights(run, truths_);
  const compare::LightResult& first = result.lights.front();
  result.error = first.error;
  result.horizon_error = first.horizon_error;
  if (!pairs_of_reference || !first.same_samples) return;
  result.pairs = first.same_samples->pairs;
  result.verdicts = first.same_samples->verdicts;
  result.stats.counters["exactDecided"] = result.verdicts->decided;
  result.stats.counters["methodRight"] = result.verdicts->method_right;
  result.stats.counters["referenceRight"] = result.verdicts->reference_right;
  const auto of_first = std::span(masks_).first(wholes_.front().count);
  if (!std::ranges::all_of(of_first, [](const auto& piece) { return piece->kept_all(); })) {
    result.stats.warnings.push_back(fmt::format("{}: {} pairs differ; {} of them, evenly spaced, were decided exactly",
                                                result.entry, result.pairs->differing, result.verdicts->decided));
  }
}

void LightJudge::count_texels(std::span<compare::LightResult> results, const MethodRun& run,
                              const visibility::MethodDescription& description,
                              const visibility::MethodOptions& options) const {
  if (description.texel_widths == nullptr) return;
  for (std::size_t light = 0; light < results.size(); ++light) {
    const LightTruth& truth = truths_[light];
    if (truth.sizes.width.empty() || wholes_[light].count > 1) continue;
    const std::size_t first = wholes_[light].first;
    std::vector<float> texels =
        description.texel_widths(session_.floats_for(first), session_.samples, session_.lights[first], options);
    if (texels.empty()) continue;
    for (std::size_t i = 0; i < texels.size(); ++i) texels[i] = truth.sizes.width[i] / texels[i];
    results[light].by_texels =
        compare::range_errors(run.visibility[light], truth.reference, truth.classes.penumbra, texels);
  }
}

std::vector<float> judged_errors(std::span<const float> visibility, const LightTruth& truth) {
  std::vector<float> errors(visibility.size(), std::numeric_limits<float>::quiet_NaN());
  for (const std::uint32_t pixel : truth.judged) errors[pixel] = visibility[pixel] - truth.reference[pixel];
  return errors;
}

std::optional<compare::VisibilityError> error_of_all_lights(const MethodRun& run, std::span<const LightTruth> truths) {
  std::vector<compare::JudgedVisibility> lights;
  for (std::size_t light = 0; light < truths.size(); ++light)
    lights.push_back({run.visibility[light], truths[light].reference, truths[light].judged});
  return compare::visibility_error(lights);
}

}  // namespace penumbra::session
