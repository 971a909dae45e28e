// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/scene_floats.hpp"
#include "visibility/view_samples.hpp"
#include "engines/vectors/light_grid.hpp"

#include <cstdint>
#include <span>
#include <vector>

/// Turns pixels into clusters of view samples. Inside engines/vectors/ only.
namespace penumbra::vectors {

/// Classification of a view sample that is certain before any triangle is tested.
enum class SampleClass : std::uint8_t {
  in_front,      ///< p is on this side of the light, and at least a part of the light may be above p's horizon
  all_visible,   ///< background, or a triangle that receives no shadow
  none_visible,  ///< the light is below p's horizon
  open,          ///< p is within rounding of the light's plane: exact predicates decide
  other_side,    ///< p is on the light's other side
};

/// Triangles with known normals (visibility::normal_is_known), computed on demand, since few triangles of a large mesh
/// are seen. Thread-safe.
class KnownNormals {
 public:
  KnownNormals() = default;
  /// The scene, or the scene that replaces it, must outlive this object.
  explicit KnownNormals(const visibility::SceneFloats& scene) : scene_(&scene), answers_(scene.triangles.size()) {}

  [[nodiscard]] bool is_known(std::uint32_t triangle) const;
  [[nodiscard]] std::uint64_t memory_bytes() const { return answers_.size() * sizeof(answers_[0]); }

 private:
  enum class Answer : std::uint8_t { not_asked, known, unknown };

  const visibility::SceneFloats* scene_ = nullptr;
  mutable std::vector<Answer> answers_;  // for each triangle; accessed by std::atomic_ref
};

struct ViewInput {
  const visibility::SceneFloats& scene;
  const visibility::ViewSamples& samples;
  const visibility::DeviceLight& light;
  const LightGrid& grid;
  const KnownNormals& normals;
  float scale;
};
/// Classifies a view sample. Fills `at` if the result is in_front or open.
SampleClass classify(const ViewInput& view, std::uint32_t pixel, GridSample& at);

/// Splits view samples at gaps (an object in front of a floor) into at most four consecutive parts, each in the
/// original order. Returns the end of each part.
std::vector<std::size_t> split_at_gaps(std::span<GridSample> samples);

}  // namespace penumbra::vectors
