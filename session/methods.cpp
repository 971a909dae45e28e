// SPDX-License-Identifier: Apache-2.0
// Joins the tables of methods and selects default methods.

#include "session/methods.hpp"

#include "base/assert.hpp"
#include "base/did_you_mean.hpp"
#include "base/error.hpp"
#include "engines/method_row.hpp"
#include "hybrids/methods.hpp"
#include "maps/methods.hpp"
#include "reference/methods.hpp"
#include "render/features.hpp"
#include "visibility/lights/device_light.hpp"
#include "volumes/methods.hpp"
#include "vsm/methods.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <deque>
#include <functional>
#include <iterator>
#include <mutex>
#include <shared_mutex>
#include <string>

namespace penumbra::session {
namespace {

using engines::MethodRow;
using visibility::Family;
using visibility::Light;
using visibility::Method;
using visibility::MethodDescription;
using visibility::MethodOptions;

/// Returns the tables of all families, joined.
const std::vector<MethodRow>& table() {
  static const std::vector<MethodRow> rows = [] {
    std::vector<MethodRow> all;
    for (const auto& methods :
         {volumes::methods(), vsm::methods(), hybrids::methods(), maps::methods(), reference::methods()})
      std::ranges::copy(methods, std::back_inserter(all));
    std::ranges::stable_sort(all, std::greater(), &MethodRow::precedence);
    return all;
  }();
  return rows;
}

/// Methods added by a program. Rows are never moved.
struct AddedMethods {
  std::shared_mutex mutex;
  std::deque<MethodRow> rows;
};
AddedMethods& added() {
  static AddedMethods methods;
  return methods;
}

/// Returns all current rows.
std::vector<const MethodRow*> all_rows() {
  std::vector<const MethodRow*> rows;
  for (const MethodRow& row : table()) rows.push_back(&row);
  const std::shared_lock lock(added().mutex);
  for (const MethodRow& row : added().rows) rows.push_back(&row);
  return rows;
}

std::vector<std::string> names_of(const std::vector<const MethodDescription*>& methods) {
  std::vector<std::string> names;
  for (const MethodDescription* method : methods) names.push_back(method->name);
  return names;
}

const MethodRow& find_row(std::string_view name) {
  for (const MethodRow* row : all_rows()) {
    if (row->description.name == name) return *row;
  }
  const std::vector<std::string> names = names_of(all_methods());
  throw UsageError("there is no method \"{}\"; methods: {}{}", name, fmt::join(names, ", "), did_you_mean(name, names));
}

}  // namespace

std::vector<const MethodDescription*> all_methods() {
  std::vector<const MethodDescription*> methods;
  for (const MethodRow* row : all_rows()) methods.push_back(&row->description);
  return methods;
}

void add_method(MethodRow row) {
  if (method_group(row.description.name))
    throw UsageError("a method cannot be called \"{}\": that is a group of methods", row.description.name);
  const std::unique_lock lock(added().mutex);
  const auto has_name = [&](const MethodRow& other) { return other.description.name == row.description.name; };
  if (std::ranges::any_of(table(), has_name) || std::ranges::any_of(added().rows, has_name))
    throw UsageError("there is a method \"{}\" already", row.description.name);
  added().rows.push_back(std::move(row));
}

std::optional<std::vector<const MethodDescription*>> method_group(std::string_view group) {
  auto methods = all_methods();
  if (group == "all") return methods;
  if (group == "default") {
    std::erase_if(methods, [](const MethodDescription* method) {
      return method->family == Family::reference || method->on_request;
    });
    return methods;
  }
  for (const Family family : {Family::reference, Family::geometry, Family::image}) {
    if (group != visibility::name_of(family)) continue;
    std::erase_if(methods, [&](const MethodDescription* method) { return method->family != family; });
    return methods;
  }
  return std::nullopt;
}

const MethodDescription& describe_method(std::string_view name) {
  return find_row(name).description;
}

MethodDescription describe_method(std::string_view name, const MethodOptions& options) {
  return find_row(name).describe(options);
}

std::vector<std::string> judge_names() {
  return names_of(method_group(visibility::name_of(Family::reference)).value());
}

const MethodDescription& describe_judge(std::string_view name) {
  const std::vector<std::string> names = judge_names();
  if (std::ranges::find(names, name) != names.end()) return describe_method(name);
  throw UsageError("--reference {}: expected {}{}", name, fmt::join(names, " or "), did_you_mean(name, names));
}

const MethodDescription& ray_judge() {
  const auto judge = std::ranges::find_if(table(), [](const MethodRow& row) {
    return row.description.family == Family::reference && row.description.output == visibility::Output::mask;
  });
  PENUMBRA_ASSERT(judge != table().end(), "no method of the family reference has masks");
  return judge->description;
}

std::unique_ptr<Method> make_method(std::string_view name, const MethodOptions& options,
                                    const render::Machine& machine) {
  try {
    return find_row(name).make(machine, options);
  } catch (const render::LacksFeature& error) {
    throw render::LacksFeature("{}: {}", name, error.what());
  } catch (const ResourceError& error) {  // no driver, no usable device
    throw ResourceError("{}: {}", name, error.what());
  }
}

bool runs_on_device(std::string_view name, const MethodOptions& options, const Light& light,
                    const render::Machine& machine) {
  return find_row(name).on_device(machine, options, light);
}

bool is_slow_on_processors(std::string_view name) {
  return find_row(name).slow_on_processors;
}

bool needs_device(std::string_view name, const MethodOptions& options) {
  return find_row(name).on_device(render::Machine({.wanted = "cpu"}), options, Light{});
}

bool passes_triangles(std::string_view name, const visibility::MethodOptions& options) {
  return maps::passes_triangles(name, options);
}

void check_light(const MethodDescription& description, const MethodOptions& options, const Light& light) {
  for (const auto& [key, value] : options) {
    if (description.lights.contains(light.kind)) break;
    MethodOptions others = options;
    others.erase(key);
    try {
      if (!describe_method(description.name, others).lights.contains(light.kind)) continue;
    } catch (const UsageError&) {  // another option needs this one
      continue;
    }
    throw InputError(
        "light \"{0}\" is a {1}; method {2} supports a {1}, but not with {3}={4}. Leave the option out, or choose "
        "another light (--light)",
        light.name, visibility::name_of(light.kind), description.name, key, value);
  }
  visibility::check_light(description, light);
}

bool can_do(const MethodDescription& method, const std::vector<Light>& lights) {
  return std::ranges::all_of(lights, [&](const Light& light) {
    return method.lights.contains(light.kind) && (method.textures || !light.texture) &&
           (method.any_pattern || light.rows != 0) &&
           (left_to_host(method, light).empty() || method.output == visibility::Output::mask);
  });
}

namespace {

/// Returns whether rays are faster than geometry: only possible for a dome. All around p, the edges of the whole mesh
/// count, whatever the number of light samples, while the cost of rays is proportional to that number. Measured, the
/// two are equally fast at about 40 triangles for each light sample (docs/domes.md).
bool rays_are_quicker(const Light& light, std::uint64_t triangles) {
  constexpr std::uint64_t kTriangles = 32;  // for each light sample
  return light.dome && triangles > kTriangles * light.sample_count();
}

}  // namespace

const MethodDescription& default_method(const Light& light, const visibility::SceneFloats* scene,
                                        std::uint64_t triangles) {
  const bool by_rays = rays_are_quicker(light, triangles);
  const MethodDescription *rays = nullptr, *areas = nullptr;
  bool refused = false;  // a method would support the light if it were nearer
  for (const MethodDescription* method : all_methods()) {
    if (!can_do(*method, {light})) continue;
    // A hard shadow of the light's centre is not accepted where rays are possible, nor is a method slower than rays.
    if (method->output == visibility::Output::scalar || method->on_request) continue;
    const bool holds = scene == nullptr || visibility::can_span(method->span, light, *scene);
    if (method->family == Family::geometry && by_rays) continue;
    if (method->family == Family::geometry && !refused) {
      if (holds) return *method;
      refused = true;
    }
    if (method->family != Family::reference || !holds) continue;
    (method->output == visibility::Output::mask ? rays : areas) = method;
  }
  if (rays != nullptr) return *rays;
  if (areas != nullptr) return *areas;
  throw InputError("light \"{}\" is a {}, which no method of this build supports; choose another with --light",
                   light.name, visibility::name_of(light.kind));
}

}  // namespace penumbra::session
