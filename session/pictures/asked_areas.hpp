// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/method.hpp"

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace penumbra::session {

/// Answer of a method of Output::radiance for one view sample.
struct AreaAnswer {
  float visibility = 1;
  glm::dvec3 form_factor{0};
};

/// A method of Output::radiance that takes its answers from another method. It composes pictures of view samples for
/// the other method, and returns the other method's answers bit for bit. The other method must outlive this object. For
/// one thread at a time.
class AskedAreas : public visibility::Method {
 public:
  [[nodiscard]] const visibility::MethodDescription& description() const final { return method_.description(); }
  void want_form_factors(bool wanted) final { method_.want_form_factors(wanted); }
  void expect_frames() final { method_.expect_frames(); }
  void prepare_mesh(const visibility::SceneFloats& scene) final { method_.prepare_mesh(scene); }
  void prepare_light(const visibility::Light& light) override;
  void prepare_view(const visibility::ViewSamples& samples) override { samples_ = &samples; }
  [[nodiscard]] std::uint32_t max_tile_rows() const override;
  void evaluate(const visibility::Tile& tile) final;
  void read_visibility(std::span<float> visibility) final;
  void read_form_factors(std::span<glm::dvec3> form_factors) final;
  std::vector<visibility::PassTime> take_pass_times() final { return method_.take_pass_times(); }
  /// Returns the statistics of the other method, and those counted here.
  [[nodiscard]] std::map<std::string, std::uint64_t> counters() const final;
  std::map<std::string, std::uint64_t> take_mesh_counters() final { return method_.take_mesh_counters(); }
  [[nodiscard]] std::uint64_t memory_bytes() const override;

 protected:
  explicit AskedAreas(visibility::Method& method);

  /// Answers some of a tile's view samples, numbered from its first one, and returns the others in the order in which
  /// the other method shall evaluate them: neighbours in space follow one another. Background is already answered.
  virtual std::vector<std::size_t> answer(const visibility::Tile& tile, std::span<AreaAnswer> answers) = 0;

  /// Receives all answers of a tile once they are complete.
  virtual void keep(const visibility::Tile& /*tile*/, std::span<const AreaAnswer> /*answers*/) {}
  /// Returns the pixels of a picture, region by region as engines evaluate them; in each region neighbours follow one
  /// another.
  static std::vector<std::size_t> in_regions(std::uint32_t width, std::uint32_t height);

  /// Returns the method's answers at all view samples of a picture, in its order.
  std::vector<AreaAnswer> ask(const visibility::ViewSamples& samples);
  /// Returns the view samples that prepare_view() received.
  [[nodiscard]] const visibility::ViewSamples& samples() const { return *samples_; }
  void count(const std::string& name, std::uint64_t more) { counters_[name] += more; }

 private:
  /// View samples of the picture in the given order, packed into regions as engines evaluate them.
  struct Packed {
    visibility::ViewSamples samples;
    std::vector<std::size_t> at;  ///< position of each view sample in the packed picture
  };
  [[nodiscard]] Packed packed(std::span<const std::size_t> which) const;
  /// Lets the other method answer the `open` view samples of the current tile, which begins with view sample `first`.
  void ask_open(std::vector<std::size_t> open, std::size_t first);

  visibility::Method& method_;
  const visibility::ViewSamples* samples_ = nullptr;
  std::vector<AreaAnswer> answers_;  // for the last evaluated tile
  std::map<std::string, std::uint64_t> counters_;
};

}  // namespace penumbra::session
