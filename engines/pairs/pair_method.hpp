// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engines/pairs/blocked_samples.hpp"
#include "visibility/method.hpp"
#include "visibility/pair_truth.hpp"
#include "visibility/tree/triangle_tree.hpp"

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace penumbra::pairs {

/// A method that starts from all pairs of a view sample and a light sample above its horizon, and removes the pairs
/// that have a triangle between them: `Cartesian product` and `view-sample mapping` methods. Derived methods choose the
/// triangles that are tested against each view sample. Each bit is the truth of its pair if no hiding triangle is left
/// out, because hide() is exact for each triangle. The order of triangles is irrelevant, and so is the number of
/// threads.
class PairMethod : public visibility::Method {
 public:
  /// `pass`: name of its single stage in the pass times.
  PairMethod(visibility::MethodDescription description, std::string pass);

  [[nodiscard]] const visibility::MethodDescription& description() const override { return description_; }
  void prepare_mesh(const visibility::SceneFloats& scene) override;
  void prepare_light(const visibility::Light& light) override;
  void prepare_view(const visibility::ViewSamples& samples) override { samples_ = &samples; }
  [[nodiscard]] std::uint32_t max_tile_rows() const override;
  void evaluate(const visibility::Tile& tile) override;
  void read_masks(std::span<std::uint32_t> masks) override;
  void read_visibility(std::span<float> visibility) override;
  std::vector<visibility::PassTime> take_pass_times() override;
  [[nodiscard]] std::map<std::string, std::uint64_t> counters() const override { return counters_; }
  [[nodiscard]] std::uint64_t memory_bytes() const override;

 protected:
  /// Removes (with hide) the pairs that triangles hide, for the view samples of `pixels`, which still see some of the
  /// light. Adds the method's counters.
  virtual void block(std::span<const std::uint32_t> pixels, std::map<std::string, std::uint64_t>& counters) = 0;
  /// Called after a light is set.
  virtual void prepare_casters() {}
  /// Returns the order of light samples in visible(): `order[i]` is the index of the i-th. Empty: the original order.
  [[nodiscard]] virtual std::vector<std::uint32_t> light_order(const visibility::Light&) { return {}; }

  /// Returns the bits of a pixel's light samples that are not known to be hidden.
  [[nodiscard]] std::span<std::uint32_t> visible(std::uint32_t pixel) {
    return std::span(masks_).subspan((pixel - first_pixel_) * words_, words_);
  }
  [[nodiscard]] bool sees_something(std::uint32_t pixel) const {
    const std::uint32_t* mask = &masks_[(pixel - first_pixel_) * words_];
    for (std::size_t i = 0; i < words_; ++i) {
      if (mask[i] != 0) return true;
    }
    return false;
  }
  [[nodiscard]] bool may_hide(std::uint32_t triangle, std::uint32_t pixel) const {
    return visibility::may_occlude(*scene_, *light_, static_cast<std::uint32_t>(samples_->triangle[pixel]), triangle);
  }
  /// Clears the light samples that the triangle hides from the pixel, if the triangle may hide anything from it.
  void hide(std::uint32_t triangle, std::uint32_t pixel, PairCounts& counts) {
    if (may_hide(triangle, pixel)) blocked_.hide(samples_->p[pixel], scene_->corners(triangle), visible(pixel), counts);
  }
  [[nodiscard]] const BlockedSamples& blocked() const { return blocked_; }
  /// Tests every triangle that meets the bounding box of p and the light: for view samples that a method's own search
  /// cannot handle.
  void try_all(std::uint32_t pixel, PairCounts& counts);
  /// Calls `visit` for triangles of the tree near the hull of the light and the box [lower, upper].
  template <typename Visit>
  void for_each_towards_light(const glm::vec3& lower, const glm::vec3& upper, Visit&& visit) const {
    const visibility::Bounds bounds = towards_light({lower, upper});
    tree_.for_each_near(bounds.lower, bounds.upper, visit);
  }
  void add(const PairCounts& counts);

  [[nodiscard]] const visibility::SceneFloats& scene() const { return *scene_; }
  /// Returns the light with its samples in light_order().
  [[nodiscard]] const visibility::Light& light() const { return *light_; }
  [[nodiscard]] const visibility::ViewSamples& samples() const { return *samples_; }
  [[nodiscard]] const visibility::TriangleTree& tree() const { return tree_; }
  [[nodiscard]] std::size_t words() const { return words_; }

 private:
  [[nodiscard]] visibility::Bounds towards_light(const visibility::Bounds& box) const;
  void start(std::size_t pixel);

  visibility::MethodDescription description_;
  std::string pass_;
  const visibility::SceneFloats* scene_ = nullptr;
  visibility::TriangleTree tree_;
  const visibility::Light* light_ = nullptr;
  visibility::Light sorted_;          // the light, if its samples are reordered
  std::vector<std::uint32_t> order_;  // light_order
  visibility::Bounds bounds_;
  BlockedSamples blocked_;
  const visibility::ViewSamples* samples_ = nullptr;
  std::size_t words_ = 0, first_pixel_ = 0;
  std::vector<std::uint32_t> masks_, full_;  // masks of the tile; mask of a pixel that sees all
  double milliseconds_ = 0;
  std::map<std::string, std::uint64_t> counters_;
};

}  // namespace penumbra::pairs
