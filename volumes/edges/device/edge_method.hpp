// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engines/device/mask_method.hpp"
#include "volumes/edges/device/edge_lists.hpp"

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace penumbra::volumes {

/// A mask method on the device over lists of signed edges: a derived class adds one kernel, run once for each emitting
/// side of the light.
class EdgeMethod : public device::MaskMethod {
 public:
  EdgeMethod(const render::Device& device, visibility::MethodDescription given, std::uint64_t question_bytes,
             bool crops = true)
      : MaskMethod(device, std::move(given), question_bytes), edges_(device, description().name, crops) {}

  void prepare_mesh(const visibility::SceneFloats& scene) override {
    MaskMethod::prepare_mesh(scene);
    edges_.prepare_mesh(scene, tree(), scale());
  }

 protected:
  /// Called once for each light, after the lists are prepared.
  virtual device::MaskLayout prepare_kernel() = 0;
  /// Returns the kernel's push constants other than those of the lists.
  [[nodiscard]] virtual gpu::ScatterPush make_push() const = 0;
  /// Records the kernel over a band's lists. `inputs`: the lists' bindings, from 0 on; the kernel's own bindings
  /// follow.
  virtual void record(const gpu::ScatterPush& push, std::vector<render::BufferReference> inputs,
                      const visibility::Tile& band) = 0;
  void count(std::map<std::string, std::uint64_t>& counters) override {
    counters["listWords"] += std::exchange(words_, 0);
    if (retries_ > 0) counters["listRetries"] += std::exchange(retries_, 0);
  }

  [[nodiscard]] const EdgeLists& edges() const { return edges_; }

  device::Attempt run(const visibility::Tile& band) override {
    gpu::ScatterPush push = make_push();
    push.question_capacity = questions().capacity();
    for (const float side : {1.0F, -1.0F}) {
      if (side < 0 && !light().two_sided) continue;
      const EdgeListInput input{view(), triangles(), samples().width, tile(), band, side};
      if (!edges_.find(commands(), push, input)) return device::Attempt::too_large;
      times().add(edges_.times());
      words_ += edges_.words();
      retries_ += edges_.retries();
      record(push, edges_.inputs(input), band);
      submit();
    }
    return device::Attempt::done;
  }

 private:
  device::MaskLayout prepare_casters() override {
    edges_.prepare_light(light(), device_light());
    return prepare_kernel();
  }

  EdgeLists edges_;
  std::uint64_t words_ = 0, retries_ = 0;  // counters
};

}  // namespace penumbra::volumes
