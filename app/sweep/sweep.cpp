// SPDX-License-Identifier: Apache-2.0
// Runs comparisons over products of values and finds the Pareto front of error and time.

#include "app/sweep/sweep.hpp"

#include "app/process/say_once.hpp"
#include "base/did_you_mean.hpp"
#include "base/error.hpp"
#include "session/comparison/comparison_entries.hpp"
#include "session/methods.hpp"
#include "session/parse.hpp"
#include "session/session.hpp"

#include <fmt/ranges.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <functional>
#include <set>
#include <utility>

namespace penumbra::app {
namespace {

constexpr const char *kHalf = "light.half", *kAngle = "light.angle", *kSamples = "light-samples";

using Values = std::map<std::string, std::string>;

/// Returns every combination of one value for each key.
std::vector<Values> products(std::span<const SweptKey> keys) {
  std::vector<Values> all = {{}};
  for (const SweptKey& key : keys) {
    std::vector<Values> longer;
    for (const Values& values : all) {
      for (const std::string& value : key.values) {
        longer.push_back(values);
        longer.back()[key.name] = value;
      }
    }
    all = std::move(longer);
  }
  return all;
}

std::vector<SweptKey> keys_where(std::span<const SweptKey> keys, const std::function<bool(const SweptKey&)>& holds) {
  std::vector<SweptKey> chosen;
  std::ranges::copy_if(keys, std::back_inserter(chosen), holds);
  return chosen;
}

bool is_of_light(const SweptKey& key) {
  return key.name == kHalf || key.name == kAngle;
}

double positive(const std::string& key, const std::string& text) {
  const auto value = session::parse_number(text);
  if (!value || *value <= 0) throw UsageError("--over {}={}: expected a number above 0", key, text);
  return *value;
}

/// Scales a light about its center until the larger half of its extent is `half`; only lights that `why_fixed` passes.
struct SetHalf {
  double half;

  void operator()(scenes::Rectangle& light) const { scale(light.half_u, light.half_v); }
  void operator()(scenes::Ellipse& light) const { scale(light.half_u, light.half_v); }
  void operator()(scenes::Disk& light) const { light.radius = half; }
  void operator()(scenes::Sphere& light) const { light.radius = half; }
  void operator()(scenes::Polygon& light) const {
    glm::dvec3 lower(light.vertices.front()), upper = lower;
    for (const glm::dvec3& vertex : light.vertices) {
      lower = glm::min(lower, vertex);
      upper = glm::max(upper, vertex);
    }
    const glm::dvec3 center = (lower + upper) / 2.0, extent = (upper - lower) / 2.0;
    const double larger = std::max({extent.x, extent.y, extent.z});
    for (glm::dvec3& vertex : light.vertices) vertex = center + (vertex - center) * (half / larger);
  }
  void operator()(auto& /*light*/) const {}  // lights without an extent, or of fixed size

 private:
  void scale(glm::dvec3& u, glm::dvec3& v) const {
    const double larger = std::max(glm::length(u), glm::length(v));
    u *= half / larger;
    v *= half / larger;
  }
};

/// Returns why a light's extent or angle cannot vary, after "the light "; nullptr if one of them can.
const char* why_fixed(const scenes::Scene& scene, std::size_t light) {
  const auto& shape = scene.lights[light].shape;
  if (std::holds_alternative<scenes::Dome>(shape)) return "is a dome, which has no size";
  if (std::holds_alternative<scenes::Pieces>(shape)) return "is a mesh in pieces, which cannot change its size";
  if (std::ranges::find(scene.objects, light, &scenes::Object::emits) != scene.objects.end())
    return "is an emitting mesh, which keeps its size";
  return nullptr;
}

bool is_named(const scenes::AreaLight& light, const std::vector<std::string>& names) {
  return std::ranges::find(names, light.name) != names.end();
}

/// Returns the key of the size that a light has; nullptr if its size is fixed.
const char* size_key(const scenes::Scene& scene, std::size_t light) {
  if (why_fixed(scene, light) != nullptr) return nullptr;
  return std::holds_alternative<scenes::Sun>(scene.lights[light].shape) ? kAngle : kHalf;
}

/// Returns the scene with these sizes of the lights named, or of all lights that have such a size if `names` is empty.
scenes::Scene with_lights(scenes::Scene scene, const Values& sizes, const std::vector<std::string>& names) {
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    scenes::AreaLight& light = scene.lights[i];
    const char* const key = size_key(scene, i);
    if (key == nullptr || (!names.empty() && !is_named(light, names))) continue;
    const auto size = sizes.find(key);
    if (size == sizes.end()) continue;
    const double value = positive(key, size->second);
    if (auto* const sun = std::get_if<scenes::Sun>(&light.shape)) {
      if (value >= 180) throw UsageError("--over {}={}: expected less than 180 degrees", kAngle, size->second);
      sun->angle = value;
    } else {
      std::visit(SetHalf{value}, light.shape);
    }
  }
  return scene;
}

/// Throws if a light that was named keeps its size. Warns of other lights that keep their sizes while lights vary.
void report_fixed_lights(const scenes::Scene& scene, std::span<const SweptKey> over,
                         const std::vector<std::string>& names, session::Progress& progress) {
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    const scenes::AreaLight& light = scene.lights[i];
    if (!names.empty() && !is_named(light, names)) continue;
    const char* const key = size_key(scene, i);
    if (key != nullptr && std::ranges::find(over, key, &SweptKey::name) != over.end()) continue;
    if (key == nullptr && !names.empty())
      throw UsageError("--over {}: light \"{}\" {}; choose others with --light", over.front().name, light.name,
                       why_fixed(scene, i));
    const std::string why = key == nullptr ? why_fixed(scene, i) : fmt::format("has another size, {}", key);
    progress.warn(fmt::format("--over {}: light \"{}\" {}, and stays as it is", over.front().name, light.name, why));
  }
}

bool has_option(const session::MethodEntry& entry, const std::string& key) {
  const auto& options = session::describe_method(entry.name).options;
  return std::ranges::find(options, key, &visibility::OptionDescription::name) != options.end();
}

/// Returns each entry with each combination of the swept options that it has and does not set itself.
std::vector<session::MethodEntry> with_swept_options(std::span<const session::MethodEntry> entries,
                                                     std::span<const SweptKey> keys) {
  std::vector<session::MethodEntry> all;
  std::set<std::string> labels;
  for (const session::MethodEntry& entry : entries) {
    const std::vector<SweptKey> own = keys_where(
        keys, [&](const SweptKey& key) { return has_option(entry, key.name) && !entry.options.contains(key.name); });
    for (const Values& values : products(own)) {
      session::MethodEntry with = entry;
      for (const auto& [key, value] : values) {
        with.options[key] = value;
        with.label += fmt::format(":{}={}", key, value);
      }
      if (labels.insert(with.label).second) all.push_back(std::move(with));
    }
  }
  return all;
}

/// Returns whether a chosen light has this size (light.half, light.angle).
bool is_size_of_some(const std::string& key, const scenes::Scene& scene, const std::vector<std::string>& chosen) {
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    const char* const own = size_key(scene, i);
    if (own != nullptr && key == own && (chosen.empty() || is_named(scene.lights[i], chosen))) return true;
  }
  return false;
}

bool counts_samples(const session::MethodEntry& entry) {
  return session::describe_method(entry.name, entry.options).counts_light_samples();
}

/// Throws for a key that would have no effect.
void require_known_keys(std::span<const SweptKey> over, std::span<const session::MethodEntry> entries,
                        const scenes::Scene& scene, const std::vector<std::string>& lights) {
  for (const SweptKey& key : over) {
    if (is_of_light(key)) {
      if (is_size_of_some(key.name, scene, lights)) continue;
      throw UsageError("--over {}: none of the lights {}", key.name,
                       key.name == kAngle ? "is a sun"
                                          : "has an extent that can vary (a sun has light.angle; domes and emitting "
                                            "meshes have none)");
    }
    if (key.name == kSamples) {
      if (std::ranges::any_of(entries, counts_samples)) continue;
      throw UsageError("--over {}: none of the methods counts light samples", key.name);
    }
    if (std::ranges::any_of(entries, [&](const session::MethodEntry& entry) {
          return has_option(entry, key.name) && !entry.options.contains(key.name);
        }))
      continue;
    std::vector<std::string> names = {kHalf, kAngle, kSamples};
    for (const session::MethodEntry& entry : entries) {
      for (const auto& option : session::describe_method(entry.name).options) {
        if (!entry.options.contains(option.name)) names.push_back(option.name);
      }
    }
    std::ranges::sort(names);
    names.erase(std::unique(names.begin(), names.end()), names.end());
    throw UsageError("--over {}: none of the methods has such an option to vary; the options are: {}{}", key.name,
                     fmt::join(names, ", "), did_you_mean(key.name, names));
  }
}

std::optional<double> rmse_of(const SweepRow& row) {
  const auto& error = row.result.all_lights_error;
  return error ? std::optional(error->rmse) : std::nullopt;
}

/// Marks the rows of one light that no other row of this light surpasses in both error and time.
void mark_hull(std::span<SweepRow> rows) {
  for (SweepRow& row : rows) {
    const auto rmse = rmse_of(row), seconds = row.result.stats.seconds.shadow();
    row.on_hull = rmse && seconds && std::ranges::none_of(rows, [&](const SweepRow& other) {
                    const auto other_rmse = rmse_of(other), other_seconds = other.result.stats.seconds.shadow();
                    return other_rmse && other_seconds && *other_rmse <= *rmse && *other_seconds <= *seconds &&
                           (*other_rmse < *rmse || *other_seconds < *seconds);
                  });
  }
}

std::vector<SweepSummary> summarize(std::span<const SweepRow> rows) {
  std::vector<SweepSummary> summaries;
  for (const SweepRow& row : rows) {
    const std::string& method = row.result.stats.method;
    if (std::ranges::find(summaries, method, &SweepSummary::method) == summaries.end())
      summaries.push_back({row.light, method, {{1.0 / 64}, {1.0 / 128}, {1.0 / 256}}});
    SweepSummary& summary = *std::ranges::find(summaries, method, &SweepSummary::method);
    const auto rmse = rmse_of(row), seconds = row.result.stats.seconds.shadow();
    if (!rmse || !seconds) continue;
    for (SecondsTo& to : summary.to) {
      if (*rmse > to.rmse || (to.seconds && *to.seconds <= *seconds)) continue;
      to.seconds = seconds;
      to.entry = row.result.entry;
    }
  }
  return summaries;
}

}  // namespace

Sweep sweep_methods(const scenes::Scene& scene, const session::RunOptions& run, session::ComparisonOptions options,
                    std::vector<SweptKey> over, session::Progress& progress) {
  options.methods = session::with_method_options(options);
  options.method_options.clear();
  require_known_keys(over, options.methods, scene, run.lights);
  Sweep sweep{std::move(over), {}, {}, {}};
  const auto of_light = keys_where(sweep.over, is_of_light);
  const auto samples = keys_where(sweep.over, [](const SweptKey& key) { return key.name == kSamples; });
  const auto of_methods =
      keys_where(sweep.over, [](const SweptKey& key) { return !is_of_light(key) && key.name != kSamples; });
  const std::vector<session::MethodEntry> entries = with_swept_options(options.methods, of_methods);
  options.writes = false;
  // Throws for invalid values before any long work.
  for (const session::MethodEntry& entry : entries)
    static_cast<void>(session::describe_method(entry.name, entry.options));
  std::vector<session::RunOptions> counts;
  for (const Values& count : products(samples)) {
    counts.push_back(run);
    if (!count.empty()) counts.back().light_samples = count.begin()->second;
    static_cast<void>(session::parse_light_samples(counts.back()));
  }
  const std::vector<Values> sizes = products(of_light);
  for (const Values& light : sizes) static_cast<void>(with_lights(session::without_meshes(scene), light, run.lights));

  if (!of_light.empty()) report_fixed_lights(scene, of_light, run.lights, progress);
  SayOnce said(progress);
  for (const Values& light : sizes) {
    const scenes::Scene lit = with_lights(scene, light, run.lights);
    const std::size_t first_row = sweep.rows.size();
    for (const session::RunOptions& with : counts) {
      options.methods.clear();
      std::ranges::copy_if(entries, std::back_inserter(options.methods), [&](const session::MethodEntry& entry) {
        return &with == &counts.front() || counts_samples(entry);
      });
      compare::Metrics metrics = session::compare_methods(lit, with, options, said);
      if (sweep.reference.method.empty()) sweep.reference = metrics.reference;
      for (compare::MethodResult& result : metrics.methods) {
        if (!samples.empty() &&
            session::describe_method(result.stats.method, result.stats.options).counts_light_samples())
          result.entry += fmt::format(":{}={}", kSamples, with.light_samples);
        sweep.rows.push_back({light, std::move(result)});
      }
    }
    const std::span rows = std::span(sweep.rows).subspan(first_row);
    mark_hull(rows);
    std::ranges::move(summarize(rows), std::back_inserter(sweep.summaries));
  }
  return sweep;
}

}  // namespace penumbra::app
