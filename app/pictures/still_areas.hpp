#pragma once

#include "app/pictures/asked_areas.hpp"
#include "visibility/bounds.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace penumbra::app {

/// What moves from one moment of a scene to the next.
class MovedParts {
 public:
  /// Nothing is known: everything moves.
  MovedParts() = default;
  MovedParts(const visibility::SceneFloats& before, const visibility::SceneFloats& now);

  /// Is it another triangle than before?
  [[nodiscard]] bool has(std::size_t triangle) const { return !is_known_ || moved_[triangle] != 0; }
  /// May what moves be between p and the light, before or now? No only where it certainly is not.
  [[nodiscard]] bool may_hide(const glm::vec3& p, const visibility::Light& light) const;

 private:
  bool is_known_ = false;
  std::vector<std::uint8_t> moved_;        // of each triangle
  std::vector<visibility::Bounds> boxes_;  // around those of each object, before and now, and a little more
};

/// The answers of a moment: of each light each view sample.
struct StillAnswers {
  visibility::ViewSamples samples;
  std::vector<visibility::Light> lights;
  std::vector<std::vector<AreaAnswer>> answers;  ///< empty for a light that was not asked about
};

/// The moments of a picture, one after the other.
struct StillMoments {
  /// Answers of two moments are kept, of each light at each view sample; false: they would not be worth their memory.
  static bool are_worth(std::size_t view_samples, std::size_t lights);
  /// The next moment, of a scene with these floats.
  void begin(const visibility::SceneFloats& floats);

  MovedParts moved;
  StillAnswers before, now;

 private:
  std::optional<visibility::SceneFloats> floats_;
};

/// Areas at one of several moments. A view sample whose surface and light stay where they are, with nothing between
/// them that moves, has the answer of the moment before: the same bits, for nothing that could change them is another.
class StillAreas final : public AskedAreas {
 public:
  /// The moment's lights are numbered as those of the moment before. All must outlive it.
  StillAreas(visibility::Method& method, StillMoments& moments, std::span<const visibility::Light> lights);

  void prepare_light(const visibility::Light& light) override;
  void prepare_view(const visibility::ViewSamples& samples) override;

 private:
  std::vector<std::size_t> answer(const visibility::Tile& tile, std::span<AreaAnswer> answers) override;
  void keep(const visibility::Tile& tile, std::span<const AreaAnswer> answers) override;
  [[nodiscard]] bool is_still(std::size_t sample) const;

  StillMoments& moments_;
  std::span<const visibility::Light> lights_;
  std::size_t light_ = 0;  // prepared last, among these
  bool is_known_ = false;  // it was there before, and was asked about
};

}  // namespace penumbra::app
