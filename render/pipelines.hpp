// SPDX-License-Identifier: Apache-2.0
#pragma once
// Inside render/ only.

#include "render/bindings.hpp"

#include <concepts>
#include <cstdint>
#include <initializer_list>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace penumbra::render {

/// A pipeline, and the interface that its shaders declare.
struct KeptPipeline {
  std::uint32_t push_bytes = 0;
  Bindings bindings;
  vk::raii::Pipeline pipeline{nullptr};
};

/// Everything that a pipeline depends on: its name and numbers, each list of numbers (constants, SPIR-V) after its
/// length.
class PipelineKey {
 public:
  PipelineKey(std::string name, std::initializer_list<std::uint32_t> settings)
      : name_(std::move(name)), words_(settings) {}
  PipelineKey& add(std::span<const std::uint32_t> list) {
    words_.push_back(static_cast<std::uint32_t>(list.size()));
    words_.insert(words_.end(), list.begin(), list.end());
    return *this;
  }
  auto operator<=>(const PipelineKey&) const = default;

 private:
  std::string name_;
  std::vector<std::uint32_t> words_;
};

/// The pipelines that a device has made. Drivers compile for a long time (on processors for tenths of a second), many
/// methods draw the same maps, and a method is made again for every run of an error budget.
class Pipelines {
 public:
  /// Returns the pipeline of the key, from `make` if it does not exist. The reference stays valid.
  template <std::invocable Make>
  const KeptPipeline& find(PipelineKey key, const Make& make) {
    const auto found = made_.find(key);
    return found != made_.end() ? found->second : made_.emplace(std::move(key), make()).first->second;
  }

 private:
  std::map<PipelineKey, KeptPipeline> made_;
};

/// Returns the device's pipelines.
inline Pipelines& pipelines_of(Device::State& device) {
  if (!device.pipelines) device.pipelines = {new Pipelines, [](Pipelines* all) { delete all; }};
  return *device.pipelines;
}

}  // namespace penumbra::render
