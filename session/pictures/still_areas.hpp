// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "session/pictures/asked_areas.hpp"
#include "visibility/bounds.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace penumbra::session {

/// Differences between one moment of a scene and the next.
class MovedParts {
 public:
  /// Treats everything as moving.
  MovedParts() = default;
  MovedParts(const visibility::SceneFloats& before, const visibility::SceneFloats& now);

  /// Returns whether the triangle differs from that of the previous moment.
  [[nodiscard]] bool has(std::size_t triangle) const { return !is_known_ || moved_[triangle] != 0; }
  /// Returns whether a moving triangle may be between p and the light, before or now; false only if certainly not.
  [[nodiscard]] bool may_hide(const glm::vec3& p, const visibility::Light& light) const;

 private:
  bool is_known_ = false;
  std::vector<std::uint8_t> moved_;        // for each triangle
  std::vector<visibility::Bounds> boxes_;  // around each object, before and now, slightly enlarged
};

/// Answers of a moment: for each light and each view sample.
struct StillAnswers {
  visibility::ViewSamples samples;
  std::vector<visibility::Light> lights;
  std::vector<std::vector<AreaAnswer>> answers;  ///< empty for a light that was not evaluated
};

/// Moments of a picture, one after the other.
struct StillMoments {
  /// Returns whether the answers of two moments, for each light at each view sample, are worth the memory to keep them.
  static bool are_worth(std::size_t view_samples, std::size_t lights);
  /// Begins the next moment, of a scene with these floats.
  void begin(const visibility::SceneFloats& floats);

  MovedParts moved;
  StillAnswers before, now;

 private:
  std::optional<visibility::SceneFloats> floats_;
};

/// Areas at one of several moments. A view sample whose surface and light do not move, with no moving triangle between
/// them, keeps its answer of the previous moment: the bits are the same, since every input is.
class StillAreas final : public AskedAreas {
 public:
  /// The moment's lights are numbered as those of the previous moment. All arguments must outlive this object.
  StillAreas(visibility::Method& method, StillMoments& moments, std::span<const visibility::Light> lights);

  void prepare_light(const visibility::Light& light) override;
  void prepare_view(const visibility::ViewSamples& samples) override;

 private:
  std::vector<std::size_t> answer(const visibility::Tile& tile, std::span<AreaAnswer> answers) override;
  void keep(const visibility::Tile& tile, std::span<const AreaAnswer> answers) override;
  [[nodiscard]] bool is_still(std::size_t sample) const;

  StillMoments& moments_;
  std::span<const visibility::Light> lights_;
  std::size_t light_ = 0;  // index of the light prepared last
  bool is_known_ = false;  // the light existed at the previous moment, and was evaluated
};

}  // namespace penumbra::session
