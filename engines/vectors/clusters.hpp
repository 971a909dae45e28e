#pragma once

#include "visibility/scene_floats.hpp"
#include "visibility/view_samples.hpp"
#include "engines/vectors/light_grid.hpp"

#include <cstdint>
#include <span>
#include <vector>

/// From pixels to clusters of view samples. Inside engines/vectors/ only.
namespace penumbra::vectors {

/// What is certain of a view sample's light samples before any triangle is looked at.
enum class SampleClass : std::uint8_t {
  in_front,      ///< p is on this side of the light, and the light or a part of it may be above p's horizon
  all_visible,   ///< background, or a triangle that receives no shadow
  none_visible,  ///< the light is below p's horizon
  open,          ///< p is within rounding of the light's plane: exact predicates decide
  other_side,    ///< p is on the light's other side
};

/// Of which triangles the normal is known (visibility::normal_is_known): each is looked at when somebody asks, since of
/// a large mesh few are seen. Any thread may ask.
class KnownNormals {
 public:
  KnownNormals() = default;
  /// The scene must outlive it, or the next one that it is of.
  explicit KnownNormals(const visibility::SceneFloats& scene) : scene_(&scene), answers_(scene.triangles.size()) {}

  [[nodiscard]] bool is_known(std::uint32_t triangle) const;
  [[nodiscard]] std::uint64_t memory_bytes() const { return answers_.size() * sizeof(answers_[0]); }

 private:
  enum class Answer : std::uint8_t { not_asked, known, unknown };

  const visibility::SceneFloats* scene_ = nullptr;
  mutable std::vector<Answer> answers_;  // of each triangle; std::atomic_ref
};

struct ViewInput {
  const visibility::SceneFloats& scene;
  const visibility::ViewSamples& samples;
  const visibility::DeviceLight& light;
  const LightGrid& grid;
  const KnownNormals& normals;
  float scale;
};
/// Fills `at` if the answer is in_front or open.
SampleClass classify(const ViewInput& view, std::uint32_t pixel, GridSample& at);

/// Splits view samples at gaps (an object in front of a floor) into at most four parts that follow one another; within
/// a part the order stays. Returns where each part ends.
std::vector<std::size_t> split_at_gaps(std::span<GridSample> samples);

}  // namespace penumbra::vectors
