// SPDX-License-Identifier: Apache-2.0
// Writes stats.json and metrics.json.

#include "compare/stats.hpp"

#include <cmath>

namespace penumbra::compare {
namespace {

using Json = nlohmann::ordered_json;

template <typename Value>
Json or_null(const std::optional<Value>& value) {
  return value ? Json(*value) : Json();
}

Json to_json(const Seconds& seconds) {
  return {{"load", or_null(seconds.load)},         {"mesh", or_null(seconds.mesh)},
          {"view", or_null(seconds.view)},         {"light", or_null(seconds.light)},
          {"evaluate", or_null(seconds.evaluate)}, {"shadow", or_null(seconds.shadow())},
          {"beauty", or_null(seconds.beauty)},     {"write", or_null(seconds.write)},
          {"warmup", or_null(seconds.warmup)},     {"total", or_null(seconds.total)}};
}

Json to_json(const std::optional<VisibilityError>& error) {
  if (!error) return nullptr;
  return {{"mean", error->mean}, {"rmse", error->rmse},     {"p999", error->p999},
          {"max", error->max},   {"over05", error->over05}, {"bias", error->bias}};
}

Json options_json(const visibility::MethodOptions& options) {
  Json json = Json::object();  // a null map would be written as null
  for (const auto& [key, value] : options) json[key] = value;
  return json;
}

/// Returns a pattern's name; null if there are no light samples.
Json pattern_json(const std::string& pattern) {
  return pattern.empty() ? Json() : Json(pattern);
}

/// Adds the keys of pairs and verdicts; null where there are none.
void add_pairs(Json& json, const std::optional<PairCounts>& pairs, const std::optional<PairVerdicts>& verdicts) {
  json["pairs"] = pairs ? Json(pairs->penumbra) : Json();
  json["pairsAll"] = pairs ? Json(pairs->all) : Json();
  json["pairsDiffering"] = pairs ? Json(pairs->differing) : Json();
  json["pairsDecided"] = verdicts ? Json(verdicts->decided) : Json();
  json["pairsDecidedShare"] = pairs && verdicts ? Json(decided_share(*pairs, *verdicts)) : Json();
  json["pairsZeroPredicate"] = verdicts ? Json(verdicts->zero_predicate) : Json();
  json["pairsMethodRight"] = verdicts ? Json(verdicts->method_right) : Json();
  json["pairsReferenceRight"] = verdicts ? Json(verdicts->reference_right) : Json();
}

void add_budget(Json& json, const LightResult* light) {
  const ErrorBudget* budget = light != nullptr && light->error_budget ? &*light->error_budget : nullptr;
  json["errorBudget"] = budget != nullptr ? to_json(*budget) : Json();
  json["errorBudgetRuns"] = budget != nullptr ? runs_json(*budget) : Json();
}

/// Returns an object with one key for each class; null if there are none.
Json classes_json(const std::vector<ClassError>& classes) {
  Json json;
  for (const ClassError& one : classes) {
    json[one.name] = {{"pixels", one.pixels},
                      {"rmse", one.error ? Json(one.error->rmse) : Json()},
                      {"bias", one.error ? Json(one.error->bias) : Json()},
                      {"max", one.error ? Json(one.error->max) : Json()}};
  }
  return json;
}

/// Returns an array of ranges; `to` of the last is null. Returns null if there are no ranges.
Json ranges_json(const std::vector<RangeError>& ranges) {
  Json json;
  for (const RangeError& one : ranges) {
    json.push_back({{"from", one.from},
                    {"to", std::isfinite(one.to) ? Json(one.to) : Json()},
                    {"pixels", one.pixels},
                    {"rmse", one.error ? Json(one.error->rmse) : Json()},
                    {"bias", one.error ? Json(one.error->bias) : Json()},
                    {"max", one.error ? Json(one.error->max) : Json()}});
  }
  return json;
}

void add_classes(Json& json, const LightResult& light) {
  json["classes"] = classes_json(light.classes);
  json["penumbraWidth"] = {{"pixels", ranges_json(light.by_width)}, {"texels", ranges_json(light.by_texels)}};
  json["contactDistance"] = {{"pixels", ranges_json(light.by_contact)}};
  Json eye;  // null
  if (light.eye) eye = {{"over255", light.eye->over255}, {"banding", or_null(light.eye->banding)}};
  json["eye"] = eye;
}

Json beauty_json(const std::optional<BeautyError>& error) {
  return error ? Json{{"relativeRmse", error->relative_rmse}, {"relativeBias", error->relative_bias}} : Json();
}

Json separation_json(const MethodResult& result) {
  if (!result.separation || !result.beauty_error) return nullptr;
  const auto& [alone, of_v] = *result.separation;
  return {{"alone", beauty_json(alone)},
          {"ofV", beauty_json(of_v)},
          {"change", of_v.relative_rmse - result.beauty_error->relative_rmse}};
}

/// Returns each light's statistics, if known, and results.
Json lights_json(const std::vector<LightStats>& asked, const std::vector<LightResult>& lights) {
  Json json = Json::array();
  for (const LightResult& light : lights) {
    const std::size_t index = json.size();
    Json same;  // null
    if (const auto& rays = light.same_samples) {
      same = {{"error", to_json(rays->error)}};
      add_pairs(same, rays->pairs, rays->verdicts);
    }
    Json row = index < asked.size() ? compare::to_json(asked[index]) : Json{{"name", light.name}};
    row["judgedPixels"] = light.judged_pixels;
    row["horizonPixels"] = light.horizon_pixels;
    row["error"] = to_json(light.error);
    row["horizonError"] = to_json(light.horizon_error);
    add_classes(row, light);
    row["sameSamples"] = same;
    add_budget(row, &light);
    json.push_back(std::move(row));
  }
  return json;
}

Json to_json(const MethodResult& result) {
  Json json = compare::to_json(result.stats);
  json["entry"] = result.entry;
  json["error"] = to_json(result.error);
  json["horizonError"] = to_json(result.horizon_error);
  add_classes(json, result.lights.empty() ? LightResult{} : result.lights.front());
  json["eye"]["flip"] = result.flip ? Json{{"mean", result.flip->mean}, {"max", result.flip->max}} : Json();
  json["errorAllLights"] = to_json(result.all_lights_error);
  if (!result.lights.empty()) json["lights"] = lights_json(result.stats.lights, result.lights);
  json["beautyError"] = beauty_json(result.beauty_error);
  json["separation"] = separation_json(result);
  if (result.flicker) json["flicker"] = *result.flicker;
  if (result.pops) json["pops"] = {{"share", result.pops->share}, {"max", result.pops->max}};
  add_pairs(json, result.pairs, result.verdicts);
  add_budget(json, result.lights.empty() ? nullptr : &result.lights.front());
  const auto& failure = result.failure;
  json["failure"] = failure ? Json{{"exitCode", failure->exit_code}, {"message", failure->message}} : Json();
  return json;
}

}  // namespace

std::optional<double> Seconds::shadow() const {
  if (!light || !evaluate) return std::nullopt;
  return *light + *evaluate;
}

double Seconds::sum() const {
  double all = 0;
  for (const auto& phase : {load, mesh, view, light, evaluate, beauty, write}) all += phase.value_or(0);
  return all;
}

Json to_json(const LightStats& light) {
  std::optional<double> shadow;
  if (light.light && light.evaluate) shadow = *light.light + *light.evaluate;
  return {{"name", light.name},
          {"method", light.method},
          {"options", options_json(light.options)},
          {"lightSamples", light.light_samples},
          {"samplePattern", pattern_json(light.sample_pattern)},
          {"quantity", light.area ? "area" : "count"},
          {"seconds",
           {{"light", or_null(light.light)}, {"evaluate", or_null(light.evaluate)}, {"shadow", or_null(shadow)}}}};
}

Json to_json(const Stats& stats) {
  Json passes = Json::array();
  for (const visibility::PassTime& pass : stats.passes) {
    passes.push_back({{"name", pass.name}, {"milliseconds", pass.milliseconds}});
  }
  Json counters = Json::object(), memory = Json::object(), lights = Json::array();
  for (const auto& [name, bytes] : stats.memory) memory[name] = bytes;
  for (const auto& [name, count] : stats.counters) counters[name] = count;
  for (const LightStats& light : stats.lights) lights.push_back(to_json(light));
  Json json = {{"scene", stats.scene},
               {"size", Json::array({stats.width, stats.height})},
               {"device", stats.device},
               {"triangles", stats.triangles},
               {"method", stats.method},
               {"options", options_json(stats.options)},
               {"lightSamples", stats.light_samples},
               {"samplePattern", pattern_json(stats.sample_pattern)},
               {"runs", stats.runs},
               {"seconds", to_json(stats.seconds)},
               {"passes", passes},
               {"peakMemoryBytes", stats.peak_memory_bytes},
               {"memory", memory},
               {"counters", counters},
               {"warnings", stats.warnings},
               {"lights", lights}};
  if (const auto& cutoff = stats.light_cutoff)
    json["lightCutoff"] = {{"below", cutoff->below}, {"pairs", cutoff->pairs}, {"largestShare", cutoff->largest_share}};
  return json;
}

Json to_json(const Metrics& metrics) {
  Json methods = Json::array();
  for (const MethodResult& result : metrics.methods) methods.push_back(to_json(result));
  Json same_samples;  // null
  if (const auto& rays = metrics.same_samples) {
    same_samples = compare::to_json(rays->stats);
    same_samples["errorAllLights"] = to_json(rays->all_lights_error);
    same_samples["lights"] = lights_json(rays->stats.lights, rays->lights);
  }
  Json left_out = Json::array();
  for (const LeftOut& one : metrics.left_out)
    left_out.push_back({{"entry", one.entry}, {"seconds", one.seconds}, {"limit", one.limit}});
  return {{"reference", to_json(metrics.reference)},
          {"judgedPixels", metrics.judged_pixels},
          {"horizonPixels", metrics.horizon_pixels},
          {"sameSamples", same_samples},
          {"methods", methods},
          {"leftOut", left_out}};
}

std::string json_text(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace penumbra::compare
