#pragma once

#include "render/machine.hpp"
#include "visibility/method.hpp"

#include <functional>
#include <memory>
#include <type_traits>

/// The tables of methods. Each family exports its own, a row a method, made by the functions below; the program joins
/// them and names no method itself.
namespace penumbra::engines {

/// What there is to know of a method before it is made, and how it is made.
struct MethodRow {
  using Options = visibility::MethodOptions;

  visibility::MethodDescription description;  ///< without options
  /// With these options. Throws UsageError for options that it does not have, or that exclude each other.
  std::function<visibility::MethodDescription(const Options&)> describe;
  std::function<std::unique_ptr<visibility::Method>(const render::Machine&, const Options&)> make;
  /// Whether this light's shadows are computed on the Vulkan device. Looks for a GPU only where that decides.
  std::function<bool(const render::Machine&, const Options&, const visibility::Light&)> on_device;
  int precedence = 0;  ///< rows with more come first, whatever their family; the others in the order of the tables
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

/// A method that runs on the Vulkan device.
template <auto kDescribe, auto kMake>
MethodRow on_device() {
  return {describe_with<kDescribe>({}), describe_with<kDescribe>,
          [](const render::Machine& machine, const visibility::MethodOptions& options) {
            return kMake(machine.device(), options);
          },
          [](const render::Machine&, const visibility::MethodOptions&, const visibility::Light&) { return true; }};
}

/// A method of two engines, which chooses. `kOnVectors`: does it choose the processor for this light?
template <auto kDescribe, auto kMake, auto kOnVectors>
MethodRow on_either(int precedence = 0) {
  return {describe_with<kDescribe>({}), describe_with<kDescribe>, kMake,
          [](const render::Machine& machine, const visibility::MethodOptions& options, const visibility::Light& light) {
            return !kOnVectors(machine, options, light);
          },
          precedence};
}

/// A method that runs on the processor: an instance says what it is, without a Vulkan device.
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
