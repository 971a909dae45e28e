// SPDX-License-Identifier: Apache-2.0
// Selects the entries of a comparison and the number of their runs.

#include "session/comparison/comparison_entries.hpp"

#include "base/did_you_mean.hpp"
#include "base/error.hpp"
#include "render/features.hpp"
#include "session/methods.hpp"
#include "visibility/lights/device_light.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

namespace penumbra::session {
namespace {

using visibility::MethodDescription;

/// Returns the entry described with its options, which may change its output and its supported lights. Returns nullopt
/// for a group's exact areas if --method-option excludes them.
std::optional<Entry> describe_entry(const MethodEntry& chosen, const std::function<void(std::string)>& warn) {
  try {
    return Entry{chosen.label, describe_method(chosen.name, chosen.options), chosen.options, chosen.from_group};
  } catch (const UsageError& error) {
    if (!chosen.exact_area) throw;
    warn(fmt::format("{} is left out: {}", chosen.label, error.what()));
    return std::nullopt;
  }
}

/// Returns the reason why no method of a group can run on a Vulkan device; empty if they can, or none needs to.
std::string why_no_device(const ComparisonOptions& options, const render::Machine& machine) {
  const auto needs = [](const MethodEntry& chosen) {
    return chosen.from_group && needs_device(chosen.name, chosen.options);
  };
  if (std::ranges::none_of(options.methods, needs)) return {};
  try {
    static_cast<void>(machine.device());
    return {};
  } catch (const ResourceError& error) {
    return error.what();
  }
}

/// Returns the features that the device lacks and a method of a group needs there; empty if none is missing.
std::string why_not_there(const MethodEntry& chosen, const render::Machine& machine) {
  if (machine.device().info().lacks.empty()) return {};
  try {
    static_cast<void>(make_method(chosen.name, chosen.options, machine));
    return {};
  } catch (const render::LacksFeature& error) {
    return error.what();
  }
}

}  // namespace

std::vector<MethodEntry> with_method_options(const ComparisonOptions& options) {
  std::vector<MethodEntry> entries = options.methods;
  for (const auto& [key, value] : options.method_options) {
    bool known = false;
    for (MethodEntry& entry : entries) {
      const auto& has = describe_method(entry.name).options;
      if (std::ranges::find(has, key, &visibility::OptionDescription::name) == has.end()) continue;
      entry.options.emplace(key, value);  // an entry's own option has priority
      known = true;
    }
    if (!known) throw UsageError("--method-option {}={}: none of the chosen methods has such an option", key, value);
  }
  return entries;
}

Entry describe_reference(const std::string& text) {
  const std::string name = text.substr(0, text.find(':'));
  const auto methods = all_methods();
  if (std::ranges::find(methods, name, &MethodDescription::name) == methods.end())
    throw UsageError(
        "--reference {}: expected {}, or any method whose areas are exact, with options if it takes any, such as {}{}",
        text, fmt::join(judge_names(), ", "), exact_area_example(), did_you_mean(name, judge_names()));
  const std::vector<MethodEntry> entries = parse_methods(text);
  if (entries.size() == 1) {
    MethodDescription description = describe_method(name, entries.front().options);
    if (description.family == visibility::Family::reference || description.gives_area())
      return {"reference", std::move(description), entries.front().options};
  }
  throw UsageError("--reference {}: expected {}, or one method with options that make it give exact areas, such as {}",
                   text, fmt::join(judge_names(), ", "), exact_area_example());
}

std::string exact_area_example() {
  for (const MethodDescription* method : all_methods()) {
    if (!method->exact_area || method->exact_area->options.empty()) continue;
    std::string label = method->name;
    for (const auto& [key, value] : method->exact_area->options) label += fmt::format(":{}={}", key, value);
    return label;
  }
  return "none";
}

std::vector<Entry> choose_entries(const ComparisonOptions& options, const Session& session,
                                  const render::Machine& machine, const std::function<void(std::string)>& warn) {
  std::vector<Entry> entries;
  const std::string no_device = why_no_device(options, machine);
  std::vector<std::string> without_device, slow, costly;
  std::vector<Entry> costly_entries;
  // Maps see a sphere as up to 54 disks (maps/host/lamp_disks.hpp), a dome as suns (maps/host/dome_suns.hpp).
  const bool costs_maps_much = std::ranges::any_of(session.lights, [](const visibility::Light& light) {
    return (visibility::kBodies | visibility::kDomes).contains(light.kind);
  });
  for (const MethodEntry& chosen : with_method_options(options)) {
    std::optional<Entry> described = describe_entry(chosen, warn);
    if (!described) continue;
    Entry& entry = *described;
    const bool can_hold = std::ranges::all_of(session.lights, [&](const visibility::Light& light) {
      return visibility::can_span(entry.description.span, light, session.floats);
    });
    if (chosen.from_group && !(can_do(entry.description, session.lights) && can_hold)) {
      warn(fmt::format("{} is left out: it does not support every light of the scene", entry.label));
      continue;
    }
    if (chosen.from_group && needs_device(chosen.name, chosen.options)) {
      if (!no_device.empty()) {
        without_device.push_back(entry.label);
        continue;
      }
      if (const std::string reason = why_not_there(chosen, machine); !reason.empty()) {
        warn("left out: " + reason);
        continue;
      }
      if (chosen.by_default && is_slow_on_processors(chosen.name) && machine.device().info().kind == "cpu") {
        slow.push_back(entry.label);
        continue;
      }
    }
    for (const visibility::Light& light : session.lights) check_light(entry.description, entry.options, light);
    if (wants_bits(entry, options)) check_bits(entry.description, session.lights);
    if (chosen.from_group && costs_maps_much && entry.description.family == visibility::Family::image) {
      costly.push_back(entry.label);
      costly_entries.push_back(std::move(entry));
      continue;
    }
    entries.push_back(std::move(entry));
  }
  if (entries.empty())
    entries = std::move(costly_entries);
  else if (!costly.empty())
    warn(
        fmt::format("{} left out: image-based methods replace a sphere by up to 54 disks and a dome by many suns, each "
                    "with separate maps; request a method by name to include it",
                    fmt::join(costly, ", ")));
  if (!slow.empty())
    warn(
        fmt::format("{} left out: a picture takes seconds on {}, which is not a GPU; request a method, or the group "
                    "image, by name to include it",
                    fmt::join(slow, ", "), machine.device().info().name));
  if (!without_device.empty()) {
    if (entries.empty()) throw ResourceError("{}: {}", fmt::join(without_device, ", "), no_device);
    warn(fmt::format("{} left out: {}", fmt::join(without_device, ", "), no_device));
  }
  if (entries.empty()) {
    throw InputError(
        "none of the chosen methods supports the lights of {}; choose one that does with --methods (see "
        "`penumbra methods`)",
        session.scene.name);
  }
  return entries;
}

void require_explainable(std::span<const MethodEntry> methods) {
  if (std::ranges::any_of(methods, [](const MethodEntry& m) { return describe_method(m.name).repairs != nullptr; }))
    return;
  throw UsageError(
      "--error-budget: the chosen methods are references, whose errors are not divided by cause: choose another one "
      "with --methods (see `penumbra methods`)");
}

RunPlan plan_of(const Entry& entry, bool is_reference, const ComparisonOptions& options) {
  const visibility::MethodDescription& method = entry.description;
  const bool is_judge = is_reference || method.family == visibility::Family::reference;
  // The times of a reference's areas are not compared, and may be minutes: one run.
  if (is_judge && method.output != visibility::Output::mask) return {.lights = {}, .runs = 1};
  RunPlan plan{.lights = {}, .runs = 5, .run_seconds = 2, .discard_first = true};
  if (options.runs != 0) {
    plan.runs = options.runs;
    plan.run_seconds = std::numeric_limits<double>::infinity();
  }
  if (entry.from_group && !is_reference) plan.most_seconds = options.most_seconds;
  return plan;
}

Entry as_run(Entry entry, const MethodRun& run) {
  entry.options.insert(run.changed_defaults.begin(), run.changed_defaults.end());
  return entry;
}

std::vector<MethodLabel> labels_of(const Entry& entry, std::span<const visibility::Light> lights,
                                   const render::Machine& machine) {
  std::vector<MethodLabel> labels;
  for (const visibility::Light& light : lights) {
    labels.push_back(
        {entry.description, entry.options, device_of(entry.description.name, entry.options, light, machine)});
  }
  return labels;
}

bool wants_bits(const Entry& entry, const ComparisonOptions& options) {
  return options.bits && entry.description.output == visibility::Output::mask;
}

}  // namespace penumbra::session
