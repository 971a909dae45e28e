// SPDX-License-Identifier: Apache-2.0
// One run of a method: meshes, lights and tiles in order, and the rules that the host applies to what it reads.

#include "session/method_host.hpp"

#include "base/error.hpp"
#include "session/process/stopwatch.hpp"
#include "session/run_estimate.hpp"
#include "visibility/masks/visible_share.hpp"
#include "visibility/share.hpp"

#include <fmt/format.h>
#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace penumbra::session {
namespace {

using visibility::Light;
using visibility::Output;
using visibility::PixelClass;
using visibility::Tile;

/// Smallest V of a round light that is not a rounding error. V is a sum of arcs in double, off by up to 16 · 2⁻⁵³ for
/// each corner (DiskPart); smaller values appear where a sphere touches the receiver's plane from below.
constexpr float kLeastRoundShare = 0x1p-44F;

/// Form factors are sums of terms up to 1/2, each off by a few roundings (visibility/lights/form_factor.hpp).
constexpr double kLeastFormFactor = 0x1p-40;

bool lies_in_light_by_rule(PixelClass pixel) {
  return pixel == PixelClass::background || pixel == PixelClass::emitter || pixel == PixelClass::unshadowed;
}

}  // namespace

std::vector<std::size_t> chosen_lights(const RunPlan& plan) {
  if (!plan.only.empty()) return plan.only;
  std::vector<std::size_t> all(plan.lights.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  return all;
}

OneRun MethodHost::run(bool reads, bool limited, MethodRun& result) {
  constexpr std::uint32_t kFirstShare = 64;  // a limited run's first tile is this part of the rows
  OneRun times{std::vector<LightTimes>(plan_.lights.size())};
  result.counters.clear();
  const Stopwatch whole;
  RunEstimate estimate(chosen_lights(plan_).size(), session_.height);
  std::uint32_t growing = session_.height / kFirstShare + 1, most = 1;
  for (const std::size_t light : in_order_of_meshes()) {
    prepare_meshes(light, times);
    Stopwatch watch;
    method_.prepare_light(plan_.lights[light]);
    times.lights[light].light = watch.seconds();
    watch.restart();
    const visibility::ViewSamples& samples = samples_for(light);
    method_.prepare_view(samples);
    times.view += watch.seconds();
    std::uint32_t rows = std::max(method_.max_tile_rows(), 1u);
    rows = std::min({rows, most_rows_to_read(light), plan_.band_rows});
    most = rows;
    for (std::uint32_t row = 0; row < session_.height; row += rows) {
      const Stopwatch tile_watch;
      if (limited) rows = std::min(growing, most);
      const Tile tile{row, std::min(rows, session_.height - row)};
      times.lights[light].evaluate += evaluate(tile) + filter(light, samples, tile);
      watch.restart();
      if (reads) read(light, tile, result);
      times.read += watch.seconds();
      progress_.advance(tile.row_count);
      if (!limited) continue;
      estimate.add(tile.row_count, tile_watch.seconds());
      const double left = plan_.most_seconds - whole.seconds();
      const double all = estimate.of_all(whole.seconds(), times.mesh, most);
      if (!estimate.is_done() && left < 0 && all > plan_.most_seconds) throw TakesTooLong(all);
      const bool is_second = growing == session_.height / kFirstShare + 1;
      if (is_second || all <= plan_.most_seconds || estimate.of_tile(2 * growing) < left) growing *= 2;
    }
    // Counters start again with each light; the result has their sum.
    for (const auto& [name, count] : method_.counters()) result.counters[name] += count;
    if (filters(light)) {
      result.counters["maskPairs"] += alpha_counts_.mask_pairs;
      result.counters["blendPairs"] += alpha_counts_.blend_pairs;
    }
    alpha_counts_ = {};
  }
  if (limited) times.bands = estimate.of_bands(most);
  return times;
}

void MethodHost::hold(const visibility::SceneFloats* floats) {
  mesh_ = floats;
  if (plan_.holds != nullptr) *plan_.holds = floats;
}

bool MethodHost::filters(std::size_t light) const {
  return !visibility::left_to_host(method_.description(), plan_.lights[light]).empty();
}

bool MethodHost::filtered_alone(std::size_t light) const {
  return plan_.filtered_alone && !plan_.lights[light].filtered_by.empty();
}

const visibility::ViewSamples& MethodHost::samples_for(std::size_t light) {
  const bool alone = filtered_alone(light);
  const std::span<const std::uint8_t> dark = dark_of(light);
  if (!alone && dark.empty()) return session_.samples;
  const std::vector<std::uint8_t>& filtered = session_.filtered[light];
  if (part_.size() == 0) part_ = session_.samples;
  for (std::size_t i = 0; i < part_.size(); ++i) {
    const bool is_asked = (!alone || filtered[i] != 0) && (dark.empty() || dark[i] == 0);
    part_.triangle[i] = is_asked ? session_.samples.triangle[i] : visibility::ViewSamples::kBackground;
  }
  return part_;
}

std::span<const std::uint8_t> MethodHost::dark_of(std::size_t light) const {
  return plan_.dark.empty() ? std::span<const std::uint8_t>() : plan_.dark[light];
}

std::vector<std::size_t> MethodHost::in_order_of_meshes() const {
  std::vector<std::size_t> lights = chosen_lights(plan_);
  const visibility::SceneFloats* mesh = nullptr;
  for (auto from = lights.begin(); from != lights.end();) {
    from = std::stable_partition(from, lights.end(),
                                 [&](std::size_t light) { return &session_.floats_for(light) == mesh; });
    if (from != lights.end()) mesh = &session_.floats_for(*from);
  }
  return lights;
}

std::uint32_t MethodHost::most_rows_to_read(std::size_t light_index) const {
  const Light& light = plan_.lights[light_index];
  constexpr std::uint64_t kMostBytes = 1u << 28;
  std::uint64_t row_bytes = std::uint64_t{4} * session_.width * light.words_per_mask();
  if (filters(light_index) && filter_->dims(light))
    row_bytes += std::uint64_t{4} * session_.width * light.sample_count();
  return static_cast<std::uint32_t>(std::clamp<std::uint64_t>(kMostBytes / row_bytes, 1, session_.height));
}

void MethodHost::prepare_meshes(std::size_t light, OneRun& times) {
  const visibility::SceneFloats& floats = session_.floats_for(light);
  const Stopwatch watch;
  if (mesh_ != &floats) {
    hold(nullptr);
    method_.prepare_mesh(floats);
    hold(&floats);
  }
  if (filters(light) && filtered_ != &floats) {
    filter_.emplace(floats, !method_.description().draws_holes);
    filtered_ = &floats;
  }
  times.mesh += watch.seconds();
}

double MethodHost::evaluate(const Tile& tile) {
  const Stopwatch watch;
  method_.evaluate(tile);
  return watch.seconds();
}

double MethodHost::filter(std::size_t light_index, const visibility::ViewSamples& samples, const Tile& tile) {
  const Light& light = plan_.lights[light_index];
  transmittances_.clear();
  dimmed_.clear();
  if (!filters(light_index)) return 0;
  const std::size_t count = std::size_t{tile.row_count} * session_.width;
  masks_.resize(count * light.words_per_mask());
  method_.read_masks(masks_);
  const Stopwatch watch;
  if (filter_->dims(light)) {
    transmittances_.resize(count * light.sample_count());
    dimmed_.resize(count);
  }
  const visibility::AlphaCounts counts =
      filter_->filter(samples, light, std::size_t{tile.first_row} * session_.width, {masks_, transmittances_, dimmed_});
  alpha_counts_.mask_pairs += counts.mask_pairs;
  alpha_counts_.blend_pairs += counts.blend_pairs;
  return watch.seconds();
}

void MethodHost::share_filtered(const Light& light, std::size_t first, std::span<float> values) {
  const std::span<const glm::vec3> normals = std::span(session_.samples.n).subspan(first, values.size());
  visibility::visible_shares(light, masks_, normals, values);
  const std::size_t words = light.words_per_mask(), pairs = light.sample_count();
  for (std::size_t i = 0; i < dimmed_.size(); ++i) {
    if (dimmed_[i] != 0)
      values[i] = visibility::dimmed_share(light, std::span(masks_).subspan(i * words, words),
                                           std::span(transmittances_).subspan(i * pairs, pairs), normals[i]);
  }
}

void MethodHost::read(std::size_t light_index, const Tile& tile, MethodRun& result) {
  const Light& light = plan_.lights[light_index];
  const std::size_t first = std::size_t{tile.first_row} * session_.width;
  const std::size_t count = std::size_t{tile.row_count} * session_.width;
  const std::span<const PixelClass> classes = std::span(session_.classes[light_index]).subspan(first, count);
  const std::span<float> values = std::span(result.visibility[light_index]).subspan(first, count);
  if (filters(light_index))
    share_filtered(light, first, values);
  else
    method_.read_visibility(values);
  if (method_.description().output == Output::radiance && visibility::is_round(light.kind)) {
    for (float& v : values) v = v < kLeastRoundShare ? 0 : v;
  }
  const std::span<const std::uint8_t> dark = dark_of(light_index);
  for (std::size_t i = 0; i < count; ++i) {
    if (!dark.empty() && dark[first + i] != 0) values[i] = 0.0f;
    if (lies_in_light_by_rule(classes[i])) values[i] = 1.0f;
    if (classes[i] == PixelClass::unlit) values[i] = 0.0f;
  }
  settle_shares(light, first, values);
  leave_out(light_index, first, values);
  if (method_.description().output == Output::mask)
    read_masks(light_index, classes, dark.empty() ? dark : dark.subspan(first, count));
  form_factors_.resize(sink_ && method_.description().output == Output::radiance ? count : 0);
  if (!form_factors_.empty()) {
    method_.read_form_factors(form_factors_);
    settle_form_factors(light, first, values);
  }
  if (sink_) sink_({light_index, tile, values, masks_, transmittances_, dimmed_, form_factors_});
}

void MethodHost::settle_shares(const Light& light, std::size_t first, std::span<float> values) const {
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (visibility::is_share(values[i])) {
      values[i] = std::clamp(values[i], 0.0f, 1.0f);
      continue;
    }
    if (!wanted(first + i)) continue;
    refuse(light, first + i, fmt::format("V = {}, which is not between 0 and 1", values[i]));
  }
}

void MethodHost::settle_form_factors(const Light& light, std::size_t first, std::span<const float> values) {
  for (std::size_t i = 0; i < form_factors_.size(); ++i) {
    glm::dvec3& f = form_factors_[i];
    if (values[i] == 0) f = glm::dvec3(0);
    if (std::min({f.x, f.y, f.z}) >= -kLeastFormFactor && std::isfinite(f.x + f.y + f.z)) {
      f = glm::max(f, glm::dvec3(0));
    } else if (wanted(first + i)) {
      refuse(light, first + i,
             fmt::format("the form factor ({}, {}, {}), which must be finite and not negative", f.x, f.y, f.z));
    }
  }
}

bool MethodHost::wanted(std::size_t pixel) const {
  return !plan_.pixels || std::ranges::binary_search(*plan_.pixels, static_cast<std::uint32_t>(pixel));
}

void MethodHost::refuse(const Light& light, std::size_t pixel, const std::string& what) const {
  throw ResourceError(
      "method {} gave {}, under light \"{}\" at pixel ({}, {}): an error of this program, so no result of this method "
      "is shown; choose another --method, and please report the scene",
      method_.description().name, what, light.name, pixel % session_.width, pixel / session_.width);
}

void MethodHost::leave_out(std::size_t light, std::size_t first, std::span<float> values) const {
  const bool filtered_alone = this->filtered_alone(light);
  if (session_.filtered[light].empty() || (!filtered_alone && !plan_.lights[light].filtered_by.empty())) return;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if ((session_.filtered[light][first + i] != 0) != filtered_alone)
      values[i] = std::numeric_limits<float>::quiet_NaN();
  }
}

void MethodHost::read_masks(std::size_t light_index, std::span<const PixelClass> classes,
                            std::span<const std::uint8_t> dark) {
  const Light& light = plan_.lights[light_index];
  const std::size_t words = light.words_per_mask();
  if (!filters(light_index)) {
    masks_.resize(classes.size() * words);
    method_.read_masks(masks_);
  }
  const std::uint32_t rest = light.sample_count() % 32;
  const std::uint32_t last_word = rest == 0 ? 0xffffffffu : (1u << rest) - 1;
  for (std::size_t i = 0; i < classes.size(); ++i) {
    const std::span<std::uint32_t> mask = std::span(masks_).subspan(i * words, words);
    if (classes[i] == PixelClass::unlit || (!dark.empty() && dark[i] != 0)) std::ranges::fill(mask, 0u);
    if (!lies_in_light_by_rule(classes[i])) continue;
    std::ranges::fill(mask, 0xffffffffu);
    mask.back() = last_word;
  }
}

}  // namespace penumbra::session
