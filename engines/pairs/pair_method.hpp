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

/// A method that starts from all pairs of a view sample and a light sample above its horizon, and takes away those that
/// some triangle is between: `Cartesian product` and `view-sample mapping` methods. What a method adds is which
/// triangles are tried against which view samples. Each bit is the truth of its pair if no triangle is left out that
/// hides something, because hide() says of each the truth. No order matters, so neither does the number of threads.
class PairMethod : public visibility::Method {
 public:
  /// `pass`: the name of its one stage in the pass times.
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
  /// Takes away (hide) what triangles are between, of the view samples of `pixels`, which see some of the light so far.
  /// Adds to the counters what is its own.
  virtual void block(std::span<const std::uint32_t> pixels, std::map<std::string, std::uint64_t>& counters) = 0;
  /// After a light is set.
  virtual void prepare_casters() {}
  /// The order that light samples have in visible(): `order[i]` is the number of the i-th. Empty: their own.
  [[nodiscard]] virtual std::vector<std::uint32_t> light_order(const visibility::Light&) { return {}; }

  /// Of a pixel, what is not known to be hidden.
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
  /// Takes away what the triangle is between, if it may hide anything from that pixel.
  void hide(std::uint32_t triangle, std::uint32_t pixel, PairCounts& counts) {
    if (may_hide(triangle, pixel)) blocked_.hide(samples_->p[pixel], scene_->corners(triangle), visible(pixel), counts);
  }
  [[nodiscard]] const BlockedSamples& blocked() const { return blocked_; }
  /// Tries every triangle that something in the box of p and the light may meet: for view samples that a method's own
  /// search cannot place.
  void try_all(std::uint32_t pixel, PairCounts& counts);
  /// Triangles of the tree near what is between the light and [lower, upper].
  template <typename Visit>
  void for_each_towards_light(const glm::vec3& lower, const glm::vec3& upper, Visit&& visit) const {
    const visibility::Bounds bounds = towards_light({lower, upper});
    tree_.for_each_near(bounds.lower, bounds.upper, visit);
  }
  void add(const PairCounts& counts);

  [[nodiscard]] const visibility::SceneFloats& scene() const { return *scene_; }
  /// With its samples in light_order().
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
  visibility::Light sorted_;          // the light, if its samples are in another order
  std::vector<std::uint32_t> order_;  // light_order
  visibility::Bounds bounds_;
  BlockedSamples blocked_;
  const visibility::ViewSamples* samples_ = nullptr;
  std::size_t words_ = 0, first_pixel_ = 0;
  std::vector<std::uint32_t> masks_, full_;  // of the tile; of one that sees all
  double milliseconds_ = 0;
  std::map<std::string, std::uint64_t> counters_;
};

}  // namespace penumbra::pairs
