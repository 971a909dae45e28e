// SPDX-License-Identifier: Apache-2.0
// Lists methods as JSON.

#include "session/method_list.hpp"

#include "base/error.hpp"
#include "session/methods.hpp"

#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <utility>

namespace penumbra::session {

using visibility::LightKind;
using visibility::MethodDescription;
using visibility::OptionDescription;

std::vector<std::string> light_names(const MethodDescription& method) {
  std::vector<std::string> names;
  for (const LightKind kind : method.lights.list()) names.emplace_back(visibility::name_of(kind));
  return names;
}

std::vector<Variant> variants_of(const MethodDescription& method) {
  std::vector<Variant> variants;
  for (const OptionDescription& option : method.options) {
    std::vector<std::string> values = option.choices;
    if (values.empty() && option.whole) {
      for (const double value : {option.least, option.least + 1, option.most})
        values.push_back(fmt::format("{}", value));
    }
    for (const std::string& value : values) {
      MethodDescription with;
      try {
        with = describe_method(method.name, {{option.name, value}});
      } catch (const UsageError&) {
        continue;  // needs another option, too
      }
      if (with.lights == method.lights && with.textures == method.textures && with.output == method.output &&
          with.any_pattern == method.any_pattern)
        continue;
      variants.push_back({option.name, value, std::move(with)});
      if (option.choices.empty()) break;
    }
  }
  return variants;
}

namespace {

/// Returns null if exact areas are not supported.
nlohmann::ordered_json exact_area_json(const MethodDescription& method) {
  if (!method.exact_area) return nullptr;
  const MethodDescription with = describe_method(method.name, method.exact_area->options);
  auto lights = nlohmann::ordered_json::array(), options = nlohmann::ordered_json::object();
  for (const LightKind kind : method.exact_area->lights.list()) lights.push_back(visibility::name_of(kind));
  for (const auto& [key, value] : method.exact_area->options) options[key] = value;
  return {{"lights", lights}, {"textures", with.textures}, {"options", options}};
}

nlohmann::ordered_json variants_json(const MethodDescription& method) {
  auto variants = nlohmann::ordered_json::array();
  for (const auto& [option, value, with] : variants_of(method)) {
    variants.push_back({{"options", {{option, value}}},
                        {"output", visibility::name_of(with.output)},
                        {"lights", light_names(with)},
                        {"textures", with.textures},
                        {"anyPattern", with.any_pattern}});
  }
  return variants;
}

}  // namespace

nlohmann::ordered_json methods_json() {
  auto rows = nlohmann::ordered_json::array();
  for (const MethodDescription* method : all_methods()) {
    auto options = nlohmann::ordered_json::array();
    for (const OptionDescription& option : method->options) {
      nlohmann::ordered_json row = {
          {"name", option.name}, {"values", option.values()}, {"default", option.default_value}, {"help", option.help}};
      if (option.choices.empty()) {
        row["range"] = {{"least", option.least}, {"most", option.most}, {"whole", option.whole}};
      } else {
        row["choices"] = option.choices;
      }
      options.push_back(std::move(row));
    }
    rows.push_back({{"name", method->name},
                    {"family", visibility::name_of(method->family)},
                    {"paper", method->paper},
                    {"output", visibility::name_of(method->output)},
                    {"exactFor", method->exact_for},
                    {"lights", light_names(*method)},
                    {"textures", method->textures},
                    {"anyPattern", method->any_pattern},
                    {"onRequest", method->on_request},
                    {"slowOnProcessors", is_slow_on_processors(method->name)},
                    {"exactArea", exact_area_json(*method)},
                    {"variants", variants_json(*method)},
                    {"options", options}});
  }
  return {{"methods", rows}};
}

}  // namespace penumbra::session
