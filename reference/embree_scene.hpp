#pragma once

#include "reference/embree_range.hpp"
#include "visibility/scene_floats.hpp"

#include <cstdint>
#include <memory>
#include <vector>

struct RTCSceneTy;

namespace penumbra::reference {

/// The triangles `chosen` (indices into SceneFloats::triangles) in an Embree scene of one geometry, robust mode.
/// Primitive i is triangle chosen[i]. Lengths are range().scaled: rays must be, too. Embree's errors, out of memory
/// among them, are thrown as ResourceError, what it has no range for as InputError.
class EmbreeScene {
 public:
  enum class Filter { none, by_context };  ///< may a ray's context carry a filter function?
  enum class Build { medium, high };       ///< quality: soon built, or soon traversed

  EmbreeScene(const visibility::SceneFloats& scene, std::vector<std::uint32_t> chosen, Filter filter,
              Build build = Build::high);
  ~EmbreeScene();
  EmbreeScene(EmbreeScene&& other) noexcept;
  EmbreeScene& operator=(EmbreeScene&& other) noexcept;

  [[nodiscard]] RTCSceneTy* handle() const;
  [[nodiscard]] const std::vector<std::uint32_t>& triangles() const;
  [[nodiscard]] const EmbreeRange& range() const;
  /// The most rays that this processor traces at once: 16 (AVX-512), 8 (AVX) or 4.
  [[nodiscard]] int native_width() const;
  [[nodiscard]] std::uint64_t peak_bytes() const;
  /// Throws ResourceError if any call since the last check failed.
  void check() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace penumbra::reference
