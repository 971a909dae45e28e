// SPDX-License-Identifier: Apache-2.0
// Chooses a method for each light.

#include "session/light_methods.hpp"

#include "base/error.hpp"
#include "session/methods.hpp"
#include "session/whole_lights.hpp"
#include "visibility/lights/device_light.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <optional>
#include <set>
#include <utility>
#include <variant>

namespace penumbra::session {
namespace {

using visibility::Light;
using visibility::LightKind;
using visibility::MethodDescription;
using visibility::MethodOptions;
using visibility::SceneFloats;

bool has_option(const MethodDescription& method, const std::string& key) {
  return std::ranges::find(method.options, key, &visibility::OptionDescription::name) != method.options.end();
}

/// Returns the requested options that the method has; all of them if the method was named.
MethodOptions options_for(const MethodDescription& method, const MethodWish& wish) {
  if (!wish.method.empty()) return wish.options;
  MethodOptions options;
  for (const auto& [key, value] : wish.options) {
    if (has_option(method, key)) options.emplace(key, value);
  }
  return options;
}

/// Returns the method with options that make its output areas, if the light and the given options allow it.
std::optional<LightMethod> area_method(const MethodDescription& method, const Light& light, const MethodWish& wish) {
  if (!method.exact_area || !method.exact_area->lights.contains(light.kind)) return std::nullopt;
  const bool has_all =
      std::ranges::all_of(wish.options, [&](const auto& one) { return has_option(method, one.first); });
  if (!has_all) return std::nullopt;
  MethodOptions options = wish.options;
  options.insert(method.exact_area->options.begin(), method.exact_area->options.end());  // given options have priority
  try {
    MethodDescription description = describe_method(method.name, options);
    if (!description.gives_area() || !can_do(description, {light})) return std::nullopt;
    return LightMethod{std::move(description), std::move(options), {}};
  } catch (const UsageError&) {  // excluded by the given options
    return std::nullopt;
  }
}

/// Returns a note about why the light has a different method from similar lights.
std::string note_of_span(const Light& light, const std::string& method, const std::string& chosen) {
  return fmt::format(
      "light \"{}\": too far away, or too large or too small relative to the scene, for {}; {} is used instead",
      light.name, method, chosen);
}

LightMethod choose(const Light& light, const LightScene& scene, const MethodWish& wish) {
  const bool samples = wish.samples || is_sampled(scene.sources.at(static_cast<std::size_t>(light.index)));
  if (!samples) {
    std::string first;  // name of the method for lights of this kind that are nearer
    for (const MethodDescription* method : all_methods()) {
      if (!wish.method.empty() && method->name != wish.method) continue;
      auto found = area_method(*method, light, wish);
      if (!found) continue;
      if (!wish.method.empty() || can_span(method->span, light, scene.floats)) {
        if (!first.empty()) found->note = note_of_span(light, first, method->name);
        return *std::move(found);
      }
      if (first.empty()) first = method->name;
    }
  }
  const MethodDescription& method =
      wish.method.empty() ? default_method(light, &scene.floats, scene.triangles) : describe_method(wish.method);
  MethodOptions options = options_for(method, wish);
  LightMethod chosen{describe_method(method.name, options), std::move(options), {}};
  const MethodDescription* nearer = nullptr;  // method for lights of this kind that are nearer
  if (samples && wish.method.empty()) nearer = &default_method(light);
  if (nearer != nullptr && nearer->name != method.name && !can_span(nearer->span, light, scene.floats)) {
    chosen.note = note_of_span(
        light, nearer->name, chosen.description.gives_area() ? method.name + ", without light samples," : method.name);
  } else if (!wish.samples && !chosen.description.counts_light_samples() && !chosen.description.gives_area()) {
    chosen.note = fmt::format("light \"{}\": {} gives an estimate of V without light samples; it is exact for {}",
                              light.name, method.name, method.exact_for);
  } else if (!samples && !chosen.description.gives_area()) {
    const std::string through =
        light.filtered_by.empty() ? "" : fmt::format(" through \"{}\" (alphaMode MASK or BLEND)", light.filtered_by);
    chosen.note =
        wish.method.empty()
            ? fmt::format("light \"{}\" ({}): no method gives its exact area{}; {} with {} light samples", light.name,
                          visibility::name_of(light.kind), through, method.name, light.sample_count())
            : fmt::format("light \"{}\": {} does not give its exact area{}; {} light samples", light.name, method.name,
                          through, light.sample_count());
  }
  return chosen;
}

/// Gives the pieces of one light the same method, if one of the chosen methods supports all.
void unite(const std::vector<Light>& lights, const SceneFloats& scene, const WholeLight& whole,
           std::vector<LightMethod>& chosen) {
  const auto first = static_cast<std::ptrdiff_t>(whole.first), end = first + static_cast<std::ptrdiff_t>(whole.count);
  const std::vector<Light> pieces(lights.begin() + first, lights.begin() + end);
  const auto for_all = std::find_if(chosen.begin() + first, chosen.begin() + end, [&](const LightMethod& one) {
    return can_do(one.description, pieces) && std::ranges::all_of(pieces, [&](const Light& piece) {
             return can_span(one.description.span, piece, scene);
           });
  });
  if (for_all == chosen.begin() + end) return;
  const LightMethod one = *for_all;
  std::fill(chosen.begin() + first, chosen.begin() + end, one);
}

/// Returns whether the method of a dome will certainly compute the visibility of each light sample, and no areas.
/// `samples`: light samples were requested.
bool counts_samples_of_dome(const MethodWish& wish, bool samples) {
  if (wish.method.empty()) return samples && wish.options.empty();  // an option may ask for areas
  const MethodDescription method = describe_method(wish.method, wish.options);
  const bool may_give_areas = method.exact_area && method.exact_area->lights.contains(LightKind::dome);
  return method.output == visibility::Output::mask && (samples || !may_give_areas);
}

}  // namespace

std::vector<LightMethod> choose_light_methods(const std::vector<Light>& lights, const LightScene& scene,
                                              const MethodWish& wish) {
  std::vector<LightMethod> all;
  for (const Light& light : lights) all.push_back(choose(light, scene, wish));
  for (const WholeLight& whole : whole_lights(lights)) unite(lights, scene.floats, whole, all);
  for (std::size_t i = 0; i < lights.size(); ++i) check_light(all[i].description, all[i].options, lights[i]);
  for (const auto& option : wish.options) {
    const std::string& key = option.first;
    if (std::ranges::any_of(all, [&](const LightMethod& one) { return one.options.contains(key); })) continue;
    std::set<std::string> names;
    for (const LightMethod& one : all) names.insert(one.description.name);
    throw UsageError("--method-option {}={}: {} has no such option; see `penumbra methods`", key, option.second,
                     fmt::format("{}", fmt::join(names, ", ")));
  }
  return all;
}

bool is_sampled(const scenes::AreaLight& source) {
  const auto* const dome = std::get_if<scenes::Dome>(&source.shape);
  return dome != nullptr && dome->sampled;
}

bool counts_dome_samples(const MethodWish& wish, const std::vector<scenes::AreaLight>& lights) {
  return std::ranges::all_of(lights, [&](const scenes::AreaLight& light) {
    return !std::holds_alternative<scenes::Dome>(light.shape) ||
           counts_samples_of_dome(wish, wish.samples || is_sampled(light));
  });
}

std::vector<std::vector<std::size_t>> same_methods(const std::vector<LightMethod>& chosen) {
  std::vector<std::vector<std::size_t>> groups;
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    const auto same = std::ranges::find_if(groups, [&](const std::vector<std::size_t>& group) {
      const LightMethod& first = chosen[group.front()];
      return first.description.name == chosen[i].description.name && first.options == chosen[i].options;
    });
    same != groups.end() ? same->push_back(i) : groups.push_back({i});
  }
  return groups;
}

}  // namespace penumbra::session
