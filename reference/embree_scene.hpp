// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "reference/embree_range.hpp"
#include "visibility/scene_floats.hpp"

#include <cstdint>
#include <memory>
#include <vector>

struct RTCSceneTy;

namespace penumbra::reference {

/// The triangles `chosen` (indices into SceneFloats::triangles) in an Embree scene of one geometry, robust mode.
/// Primitive i is triangle chosen[i]. Lengths are range().scaled, and rays must be scaled, too. Embree's errors,
/// including exhausted memory, are thrown as ResourceError, sizes out of its range as InputError.
class EmbreeScene {
 public:
  enum class Filter { none, by_context };  ///< whether a ray's context may have a filter function
  enum class Build { medium, high };       ///< quality: fast to build, or fast to traverse

  EmbreeScene(const visibility::SceneFloats& scene, std::vector<std::uint32_t> chosen, Filter filter,
              Build build = Build::high);
  ~EmbreeScene();
  EmbreeScene(EmbreeScene&& other) noexcept;
  EmbreeScene& operator=(EmbreeScene&& other) noexcept;

  [[nodiscard]] RTCSceneTy* handle() const;
  [[nodiscard]] const std::vector<std::uint32_t>& triangles() const;
  [[nodiscard]] const EmbreeRange& range() const;
  /// Returns the largest packet of rays that this processor traces: 16 (AVX-512), 8 (AVX) or 4.
  [[nodiscard]] int native_width() const;
  [[nodiscard]] std::uint64_t peak_bytes() const;
  /// Throws ResourceError if any call since the last check failed.
  void check() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace penumbra::reference
