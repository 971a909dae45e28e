// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "areas/exact_area.hpp"
#include "visibility/view_samples.hpp"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <optional>

namespace penumbra::volumes {

/// The exact areas of the light prepared last, made when the first view sample needs them. In most scenes none does.
class AreasOnDemand {
 public:
  /// All arguments must outlive this object's use.
  void prepare_mesh(const visibility::SceneFloats& scene, const visibility::TriangleTree& tree);
  void prepare_light(const visibility::Light& light);

  /// Returns V and the form factor of a view sample. Thread-safe.
  [[nodiscard]] areas::ExactView view(const visibility::ViewSamples& samples, std::size_t pixel);
  [[nodiscard]] std::uint64_t memory_bytes() const { return area_ ? area_->memory_bytes() : 0; }

 private:
  const visibility::SceneFloats* scene_ = nullptr;
  const visibility::TriangleTree* tree_ = nullptr;
  const visibility::Light* light_ = nullptr;
  std::mutex mutex_;
  std::optional<areas::ExactArea> area_;
  std::atomic<bool> is_ready_ = false;  // area_ is ready for light_
};

}  // namespace penumbra::volumes
