// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/machine.hpp"
#include "visibility/method.hpp"

#include <functional>
#include <memory>
#include <type_traits>

/// Tables of methods. Each family exports its own, with a row for each method, made by the functions below; the program
/// joins the tables and names no method itself.
namespace penumbra::engines {

/// Properties of a method that are known before it is made, and its factory.
struct MethodRow {
  using Options = visibility::MethodOptions;

  visibility::MethodDescription description;  ///< description with default options
  /// Returns the description with the given options. Throws UsageError for unknown options, or options that exclude
  /// each other.
  std::function<visibility::MethodDescription(const Options&)> describe;
  std::function<std::unique_ptr<visibility::Method>(const render::Machine&, const Options&)> make;
  /// Returns whether the light's shadows are computed on the Vulkan device. Looks for a GPU only if the answer depends
  /// on it.
  std::function<bool(const render::Machine&, const Options&, const visibility::Light&)> on_device;
  /// True if a picture takes milliseconds on a GPU, but seconds on a Vulkan device that is a processor: there the
  /// method is left out of the default comparison.
  bool slow_on_processors = false;
  int precedence = 0;  ///< rows with higher values come first, regardless of family; others keep the order of the
                       ///< tables
};

template <auto kDescribe>
visibility::MethodDescription describe_with(const visibility::MethodOptions& options) {
  if constexpr (std::is_invocable_v<decltype(kDescribe), const visibility::MethodOptions&>) {
    return kDescribe(options);
  } else {
    visibility::MethodDescription description = kDescribe();
    visibility::parse_options(description, options);
    return description;
  }
}

/// Makes the row of a method that runs on the Vulkan device.
template <auto kDescribe, auto kMake>
MethodRow on_device() {
  return {describe_with<kDescribe>({}), describe_with<kDescribe>,
          [](const render::Machine& machine, const visibility::MethodOptions& options) {
            return kMake(machine.device(), options);
          },
          [](const render::Machine&, const visibility::MethodOptions&, const visibility::Light&) { return true; }};
}

/// Makes the row of a method with two engines. `kOnVectors` returns whether the method uses the processor for a light.
template <auto kDescribe, auto kMake, auto kOnVectors>
MethodRow on_either(int precedence = 0) {
  return {describe_with<kDescribe>({}),
          describe_with<kDescribe>,
          kMake,
          [](const render::Machine& machine, const visibility::MethodOptions& options, const visibility::Light& light) {
            return !kOnVectors(machine, options, light);
          },
          false,
          precedence};
}

/// Makes the row of a method that runs on the processor: an instance, made without a Vulkan device, gives the
/// description.
template <auto kMake>
MethodRow on_processor() {
  const auto describe = [](const visibility::MethodOptions& options) {
    return visibility::MethodDescription(kMake(options)->description());
  };
  return {describe({}), describe,
          [](const render::Machine&, const visibility::MethodOptions& options) { return kMake(options); },
          [](const render::Machine&, const visibility::MethodOptions&, const visibility::Light&) { return false; }};
}

}  // namespace penumbra::engines
