// SPDX-License-Identifier: Apache-2.0
// Runs methods on sessions: timing, tiles, and the host's rules.

#include "session/runner.hpp"

#include "base/memory.hpp"
#include "base/pages.hpp"
#include "session/process/stopwatch.hpp"
#include "visibility/alpha/alpha_filter.hpp"
#include "visibility/changed_defaults.hpp"
#include "visibility/masks/visible_share.hpp"
#include "visibility/share.hpp"

#include <glm/common.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

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

/// Throws for a mesh that needs more memory with this method than this machine has, before it is allocated.
void require_mesh_memory(const visibility::MethodDescription& method, const visibility::SceneFloats& floats) {
  require_memory(floats.triangles.size() * method.bytes_per_triangle,
                 fmt::format("{} on {} triangles", method.name, floats.triangles.size()),
                 "make the meshes smaller, or choose another --method");
}

/// Times of one run, for each light, and for meshes.
struct OneRun {
  std::vector<LightTimes> lights;
  double mesh = 0, view = 0, read = 0;
  double bands = 0;  ///< part of `lights` that is spent because of more tiles than other runs have; an estimate
};

/// Estimate of a run's time before its end. A tile takes a time of its own, such as drawing all maps again, and a time
/// for each of its rows: both by least squares over the tiles that are done, which have different numbers of rows.
class RunEstimate {
 public:
  /// Numbers of the whole run; `rows`: of each light.
  RunEstimate(std::size_t lights, std::uint32_t rows) : lights_(static_cast<double>(lights)), rows_(rows) {}

  void add(std::uint32_t rows, double seconds) {
    const double size = rows;
    ++count_, sizes_ += size, squares_ += size * size, seconds_ += seconds, products_ += size * seconds;
  }
  [[nodiscard]] bool is_done() const { return sizes_ == lights_ * rows_; }
  /// Returns the seconds of a tile of that many rows.
  [[nodiscard]] double of_tile(double rows) const { return of_each_tile() + rows * of_each_row(); }
  /// Returns the seconds of a whole run in tiles of that many rows, of which `elapsed` have passed and `mesh` were
  /// spent on meshes: time outside of tiles is spent once for each light.
  [[nodiscard]] double of_all(double elapsed, double mesh, std::uint32_t rows_of_tile) const {
    const double begun = std::ceil(sizes_ / rows_);
    return mesh + (elapsed - mesh - seconds_) * lights_ / begun +
           lights_ * (tiles_of_light(rows_of_tile) * of_each_tile() + rows_ * of_each_row());
  }
  /// Returns the seconds spent because there were more tiles than with that many rows in each.
  [[nodiscard]] double of_bands(std::uint32_t rows_of_tile) const {
    return std::max(count_ - lights_ * tiles_of_light(rows_of_tile), 0.0) * of_each_tile();
  }

 private:
  [[nodiscard]] double tiles_of_light(std::uint32_t rows_of_tile) const { return std::ceil(rows_ / rows_of_tile); }
  [[nodiscard]] double of_each_tile() const {
    const double spread = count_ * squares_ - sizes_ * sizes_;
    if (!(spread > 0)) return 0;  // all tiles have the same number of rows
    return std::clamp((seconds_ * squares_ - sizes_ * products_) / spread, 0.0, seconds_ / count_);
  }
  [[nodiscard]] double of_each_row() const { return (seconds_ - count_ * of_each_tile()) / sizes_; }

  double lights_, rows_;  // of the whole run; rows of each light
  double count_ = 0, sizes_ = 0, squares_ = 0, seconds_ = 0, products_ = 0;
};

double sum_of(const OneRun& run, double LightTimes::*time) {
  return std::transform_reduce(run.lights.begin(), run.lights.end(), 0.0, std::plus(),
                               [&](const LightTimes& light) { return light.*time; });
}

/// Returns the lights of a plan, as indices.
std::vector<std::size_t> chosen_lights(const RunPlan& plan) {
  if (!plan.only.empty()) return plan.only;
  std::vector<std::size_t> all(plan.lights.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  return all;
}

/// Runs a method on all lights of a session and passes on the results.
class Host {
 public:
  Host(visibility::Method& method, const Session& session, const RunPlan& plan, const TileSink& sink,
       Progress& progress)
      : method_(method), session_(session), plan_(plan), sink_(sink), progress_(progress), mesh_(plan.prepared) {}

  [[nodiscard]] const visibility::SceneFloats* prepared() const { return mesh_; }

  /// `reads`: pass on the results. `limited`: ends with TakesTooLong if it would take longer than
  /// RunPlan::most_seconds. Its tiles are a few rows first and double, so that both parts of a tile's time become
  /// known.
  OneRun run(bool reads, bool limited, MethodRun& result) {
    constexpr std::uint32_t kFirstShare = 64;  // of a light's rows
    OneRun times{std::vector<LightTimes>(plan_.lights.size())};
    result.counters.clear();
    const Stopwatch whole;
    RunEstimate estimate(chosen_lights(plan_).size(), session_.height);
    std::uint32_t growing = session_.height / kFirstShare + 1, most = 1;
    for (const std::size_t light : in_order_of_meshes()) {
      Stopwatch watch;
      if (const visibility::SceneFloats& floats = session_.floats_for(light); mesh_ != &floats) {
        watch.restart();
        hold(nullptr);
        method_.prepare_mesh(floats);
        hold(&floats);
        times.mesh += watch.seconds();
      }
      if (const visibility::SceneFloats& floats = session_.floats_for(light); filters(light) && filtered_ != &floats) {
        watch.restart();
        filter_.emplace(floats, !method_.description().draws_holes);
        filtered_ = &floats;
        times.mesh += watch.seconds();
      }
      watch.restart();
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

 private:
  void hold(const visibility::SceneFloats* floats) {
    mesh_ = floats;
    if (plan_.holds != nullptr) *plan_.holds = floats;
  }
  /// Returns whether part of this light's shadow is computed by the host.
  [[nodiscard]] bool filters(std::size_t light) const {
    return !visibility::left_to_host(method_.description(), plan_.lights[light]).empty();
  }
  [[nodiscard]] bool filtered_alone(std::size_t light) const {
    return plan_.filtered_alone && !plan_.lights[light].filtered_by.empty();
  }
  /// Returns the view samples for a light; samples that need no evaluation are background.
  [[nodiscard]] const visibility::ViewSamples& samples_for(std::size_t light) {
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
  [[nodiscard]] std::span<const std::uint8_t> dark_of(std::size_t light) const {
    return plan_.dark.empty() ? std::span<const std::uint8_t>() : plan_.dark[light];
  }
  /// Returns the lights in an order in which lights with the same casters are consecutive, so that each mesh is
  /// prepared once a run. The same order in every run: beauty is a sum over lights.
  [[nodiscard]] std::vector<std::size_t> in_order_of_meshes() const {
    std::vector<std::size_t> lights = chosen_lights(plan_);
    const visibility::SceneFloats* mesh = nullptr;
    for (auto from = lights.begin(); from != lights.end();) {
      from = std::stable_partition(from, lights.end(),
                                   [&](std::size_t light) { return &session_.floats_for(light) == mesh; });
      if (from != lights.end()) mesh = &session_.floats_for(*from);
    }
    return lights;
  }
  /// Returns the rows whose masks are read back at once: at most a quarter of a GiB of host memory.
  [[nodiscard]] std::uint32_t most_rows_to_read(std::size_t light_index) const {
    const Light& light = plan_.lights[light_index];
    constexpr std::uint64_t kMostBytes = 1u << 28;
    std::uint64_t row_bytes = std::uint64_t{4} * session_.width * light.words_per_mask();
    if (filters(light_index) && filter_->dims(light))
      row_bytes += std::uint64_t{4} * session_.width * light.sample_count();
    return static_cast<std::uint32_t>(std::clamp<std::uint64_t>(kMostBytes / row_bytes, 1, session_.height));
  }

  double evaluate(const Tile& tile) {
    const Stopwatch watch;
    method_.evaluate(tile);
    return watch.seconds();
  }

  /// Applies translucent surfaces and holes to the masks. Returns the seconds, without reading masks.
  double filter(std::size_t light_index, const visibility::ViewSamples& samples, const Tile& tile) {
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
    const visibility::AlphaCounts counts = filter_->filter(samples, light, std::size_t{tile.first_row} * session_.width,
                                                           {masks_, transmittances_, dimmed_});
    alpha_counts_.mask_pairs += counts.mask_pairs;
    alpha_counts_.blend_pairs += counts.blend_pairs;
    return watch.seconds();
  }

  /// Computes V of masks changed by filter().
  void share_filtered(const Light& light, std::size_t first, std::span<float> values) {
    const std::span<const glm::vec3> normals = std::span(session_.samples.n).subspan(first, values.size());
    visibility::visible_shares(light, masks_, normals, values);
    const std::size_t words = light.words_per_mask(), pairs = light.sample_count();
    for (std::size_t i = 0; i < dimmed_.size(); ++i) {
      if (dimmed_[i] != 0)
        values[i] = visibility::dimmed_share(light, std::span(masks_).subspan(i * words, words),
                                             std::span(transmittances_).subspan(i * pairs, pairs), normals[i]);
    }
  }

  void read(std::size_t light_index, const Tile& tile, MethodRun& result) {
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

  /// Sets values that are outside 0 … 1 by rounding alone to 0 or 1, and throws for others; V of every method passes
  /// through this function.
  void settle_shares(const Light& light, std::size_t first, std::span<float> values) const {
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (visibility::is_share(values[i])) {
        values[i] = std::clamp(values[i], 0.0f, 1.0f);
        continue;
      }
      if (!wanted(first + i)) continue;
      refuse(light, first + i, fmt::format("V = {}, which is no share of a light (0 to 1)", values[i]));
    }
  }
  /// Sets form factors to 0 where V is 0, and where negative by rounding; throws for other negative numbers.
  void settle_form_factors(const Light& light, std::size_t first, std::span<const float> values) {
    for (std::size_t i = 0; i < form_factors_.size(); ++i) {
      glm::dvec3& f = form_factors_[i];
      if (values[i] == 0) f = glm::dvec3(0);
      if (std::min({f.x, f.y, f.z}) >= -kLeastFormFactor && std::isfinite(f.x + f.y + f.z)) {
        f = glm::max(f, glm::dvec3(0));
      } else if (wanted(first + i)) {
        refuse(light, first + i,
               fmt::format("the form factor ({}, {}, {}): no finite numbers from 0 on", f.x, f.y, f.z));
      }
    }
  }
  [[nodiscard]] bool wanted(std::size_t pixel) const {
    return !plan_.pixels || std::ranges::binary_search(*plan_.pixels, static_cast<std::uint32_t>(pixel));
  }
  [[noreturn]] void refuse(const Light& light, std::size_t pixel, const std::string& what) const {
    throw ResourceError(
        "method {} gave {}, under light \"{}\" at pixel ({}, {}): a fault of this program, so nothing of this method "
        "is "
        "shown; choose another --method, and report the scene",
        method_.description().name, what, light.name, pixel % session_.width, pixel / session_.width);
  }

  void leave_out(std::size_t light, std::size_t first, std::span<float> values) const {
    const bool filtered_alone = this->filtered_alone(light);
    if (session_.filtered[light].empty() || (!filtered_alone && !plan_.lights[light].filtered_by.empty())) return;
    for (std::size_t i = 0; i < values.size(); ++i) {
      if ((session_.filtered[light][first + i] != 0) != filtered_alone)
        values[i] = std::numeric_limits<float>::quiet_NaN();
    }
  }

  /// `dark`: of these pixels; may be empty.
  void read_masks(std::size_t light_index, std::span<const PixelClass> classes, std::span<const std::uint8_t> dark) {
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

  visibility::Method& method_;
  const Session& session_;
  const RunPlan& plan_;
  const TileSink& sink_;
  Progress& progress_;
  const visibility::SceneFloats* mesh_;                // scene that the method has
  const visibility::SceneFloats* filtered_ = nullptr;  // scene that filter_ has
  std::optional<visibility::AlphaFilter> filter_;
  visibility::ViewSamples part_;          // view samples of the current light, if only some are evaluated
  visibility::AlphaCounts alpha_counts_;  // of the current light
  std::vector<float> transmittances_;     // of the most recent tile, as set by filter()
  std::vector<std::uint8_t> dimmed_;
  UnsetList<std::uint32_t> masks_;
  std::vector<glm::dvec3> form_factors_;
};

}  // namespace

void add_run(MethodRun& to, MethodRun&& other) {
  if (to.visibility.empty()) {
    to = std::move(other);
    return;
  }
  to.times.mesh += other.times.mesh;
  to.times.light += other.times.light;
  to.times.evaluate += other.times.evaluate;
  to.times.view += other.times.view;
  to.times.read += other.times.read;
  to.times.total += other.times.total;
  for (std::size_t light = 0; light < to.visibility.size(); ++light) {
    if (other.visibility[light].empty()) continue;
    to.times.lights[light].light += other.times.lights[light].light;
    to.times.lights[light].evaluate += other.times.lights[light].evaluate;
    if (to.visibility[light].empty()) {
      to.visibility[light] = std::move(other.visibility[light]);
      continue;
    }
    for (std::size_t i = 0; i < to.visibility[light].size(); ++i) {
      if (std::isnan(to.visibility[light][i])) to.visibility[light][i] = other.visibility[light][i];
    }
  }
  to.passes.insert(to.passes.end(), other.passes.begin(), other.passes.end());
  for (const auto& [name, count] : other.counters) to.counters[name] += count;
  to.memory_bytes += other.memory_bytes;
}

MethodRun run_method(visibility::Method& method, const Session& session, const RunPlan& plan, const TileSink& sink,
                     Progress& progress) {
  // Throws for unsupported lights before any work.
  const std::vector<std::size_t> chosen = chosen_lights(plan);
  for (const std::size_t light : chosen) visibility::check_light(method.description(), plan.lights[light]);

  if (plan.pixels) method.want_pixels(*plan.pixels);
  method.want_form_factors(plan.shades);

  const Stopwatch total;
  MethodRun result;
  result.visibility.resize(plan.lights.size());
  for (const std::size_t light : chosen) result.visibility[light].resize(session.pixel_count());
  const std::uint32_t discarded = plan.discard_first ? 1 : 0;
  progress.begin(plan.stage.empty() ? method.description().name : plan.stage,
                 std::uint64_t{session.height} * chosen.size() * (plan.runs + discarded));
  require_mesh_memory(method.description(), session.floats);

  Host host(method, session, plan, sink, progress);
  std::vector<OneRun> runs;
  std::optional<OneRun> first;
  double elapsed = 0, latest = 0;  // of timed runs
  while (runs.empty() || (runs.size() < plan.runs && elapsed + latest <= plan.run_seconds)) {
    method.take_pass_times();  // discards those of earlier runs
    const bool is_first = !first && runs.empty(), is_discarded = is_first && plan.discard_first;
    const Stopwatch watch;
    OneRun times = host.run(is_first, is_discarded && std::isfinite(plan.most_seconds), result);
    latest = is_discarded ? 0 : watch.seconds();
    elapsed += latest;
    if (is_first) {
      result.times.mesh = times.mesh;  // later runs prepare meshes again only where lights' casters differ
      result.times.view = times.view;
      result.times.read = times.read;
    }
    if (is_discarded) {
      first = std::move(times);
    } else {
      runs.push_back(std::move(times));
    }
  }
  result.times.runs = static_cast<std::uint32_t>(runs.size());
  progress.advance(std::uint64_t{session.height} * chosen.size() * (plan.runs - runs.size()));
  const auto median_of = [&](const auto& time) {
    std::vector<double> seconds;
    for (const OneRun& run : runs) seconds.push_back(time(run));
    return median(std::move(seconds));
  };
  result.times.light = median_of([](const OneRun& run) { return sum_of(run, &LightTimes::light); });
  result.times.evaluate = median_of([](const OneRun& run) { return sum_of(run, &LightTimes::evaluate); });
  for (std::size_t light = 0; light < plan.lights.size(); ++light) {
    result.times.lights.push_back({median_of([&](const OneRun& run) { return run.lights[light].light; }),
                                   median_of([&](const OneRun& run) { return run.lights[light].evaluate; })});
  }
  if (first) {
    // A first run that happens to be faster than the median has no warm-up time.
    const double longer = sum_of(*first, &LightTimes::light) + sum_of(*first, &LightTimes::evaluate) -
                          result.times.light - result.times.evaluate - first->bands;
    result.times.warmup = std::max(longer, 0.0);
  }
  for (const auto& [name, count] : method.take_mesh_counters()) result.counters[name] += count;
  result.prepared = host.prepared();
  result.passes = method.take_pass_times();
  result.memory_bytes = method.memory_bytes();
  result.changed_defaults = visibility::changed_defaults(method);
  result.times.total = total.seconds();
  return result;
}

}  // namespace penumbra::session
