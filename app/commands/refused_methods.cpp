// SPDX-License-Identifier: Apache-2.0
// Finds the methods, and values of their options, that a device cannot run, by making each of them on a device that
// only checks features: there is no second list of requirements that could differ from the passes' own.

#include "app/commands/refused_methods.hpp"

#include "base/error.hpp"
#include "render/features.hpp"
#include "render/machine.hpp"
#include "session/methods.hpp"

#include <fmt/format.h>

#include <optional>

namespace penumbra::app {
namespace {

/// Returns the feature that the method needs and the device lacks; nullopt if nothing is missing, or if there is no
/// such form of the method.
std::optional<std::string> why_not(const std::string& method, const visibility::MethodOptions& options,
                                   const render::Machine& machine) {
  try {
    static_cast<void>(session::make_method(method, options, machine));
  } catch (const render::LacksFeature& error) {
    return error.what();
  } catch (const UsageError&) {     // options that exclude each other
  } catch (const ResourceError&) {  // a cause other than this device, such as no OpenGL
  }
  return std::nullopt;
}

}  // namespace

std::vector<RefusedMethod> refused_methods(const render::DeviceInfo& device) {
  std::vector<RefusedMethod> refused;
  if (!device.usable() || device.lacks.empty()) return refused;
  const render::Device checks({.wanted = fmt::format("{}", device.index), .only_checks = true});
  const render::Machine machine(checks);
  for (const visibility::MethodDescription* method : session::all_methods()) {
    if (const auto reason = why_not(method->name, {}, machine)) {
      refused.push_back({method->name, *reason});
      continue;
    }
    for (const visibility::OptionDescription& option : method->options) {
      for (const std::string& choice : option.choices) {
        if (choice == option.default_value) continue;
        if (const auto reason = why_not(method->name, {{option.name, choice}}, machine))
          refused.push_back({fmt::format("{}:{}={}", method->name, option.name, choice), *reason});
      }
    }
  }
  return refused;
}

}  // namespace penumbra::app
