#pragma once

#include "engines/device/growing_list.hpp"
#include "engines/device/mask_layout.hpp"
#include "engines/device/open_judge.hpp"
#include "engines/device/triangle_upload.hpp"
#include "engines/device/view_upload.hpp"
#include "render/commands.hpp"
#include "render/compute_pass.hpp"
#include "render/device.hpp"
#include "visibility/lights/device_light.hpp"
#include "visibility/method.hpp"
#include "visibility/tree/triangle_tree.hpp"

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace penumbra::device {

/// What became of one run over a band of rows.
enum class Attempt : std::uint8_t {
  done,       ///< lists of questions may still have been too short
  again,      ///< lists have grown, or loops are shorter now
  too_large,  ///< a list would be larger than a storage buffer can be: cut the band in two
};

/// A method on the Vulkan device that finds which light samples each view sample sees. What comes before and after its
/// lists and kernels is the same for all: uploads, tiles, lists that grow, open light samples decided by exact
/// predicates, masks and V. The twin of vectors::MaskMethod.
///
/// Kernels write into masks() (MaskLayout) and counts() (visible light samples of a pixel; of a pixel that sees none,
/// or all, the mask says nothing), and append questions to questions(), each of as many bytes as the constructor was
/// told, after a gpu::QuestionHead. The base is virtual so that a method can have another interface beside this one.
class MaskMethod : public virtual visibility::Method {
 public:
  MaskMethod(const render::Device& device, visibility::MethodDescription description, std::uint64_t question_bytes);

  [[nodiscard]] const visibility::MethodDescription& description() const override { return description_; }
  void prepare_mesh(const visibility::SceneFloats& scene) override;
  void prepare_light(const visibility::Light& light) override;
  void prepare_view(const visibility::ViewSamples& samples) override;
  [[nodiscard]] std::uint32_t max_tile_rows() const override;
  void evaluate(const visibility::Tile& tile) override;
  void read_masks(std::span<std::uint32_t> masks) override;
  void read_visibility(std::span<float> visibility) override;
  std::vector<visibility::PassTime> take_pass_times() override { return times_.take(); }
  /// listRetries: a list was too short; loopRetries: a driver ended a loop; splitBands: a band was cut in two; and what
  /// count() was told.
  [[nodiscard]] std::map<std::string, std::uint64_t> counters() const override { return counters_; }
  [[nodiscard]] std::uint64_t memory_bytes() const override { return device_->peak_bytes() - others_bytes_; }

 protected:
  /// Once a mesh, before its upload: what the method adds to triangles. It must keep it.
  virtual TriangleNotes note_triangles() { return {}; }
  /// Once a light: lists and passes. Returns how the kernels lay masks out.
  virtual MaskLayout prepare_casters() = 0;
  /// Lists and kernels over a band of the tile's rows. What is recorded last, this submits.
  virtual Attempt run(const visibility::Tile& band) = 0;
  /// A driver ended a kernel's loop too soon (QuestionHead::cut_off): shorter ones are to follow.
  virtual void shorten_loops();
  /// What the first `count` questions are about.
  virtual std::vector<OpenBits> open_bits(std::uint32_t count) = 0;
  /// After open_bits: decides and settles. For questions on whose answers others hang.
  virtual void answer(std::span<const OpenBits> questions);
  /// After the last band, where kernels leave counts() to a pass of its own.
  virtual void finish() {}
  /// Adds to the counters after a band.
  virtual void count([[maybe_unused]] std::map<std::string, std::uint64_t>& counters) {}
  /// Bytes of a pixel in the largest buffer of the method's own.
  [[nodiscard]] virtual std::uint64_t bytes_per_pixel() const { return 0; }

  std::vector<gpu::MaskWord> decide(std::span<const OpenBits> questions);
  void settle(std::span<const gpu::MaskWord> words);
  void submit() { times_.add(commands_.submit()); }

  [[nodiscard]] const render::Device& device() const { return *device_; }
  [[nodiscard]] const visibility::SceneFloats& scene() const { return *scene_; }
  [[nodiscard]] const visibility::TriangleTree& tree() const { return tree_; }
  [[nodiscard]] float scale() const { return scale_; }  ///< of everything on the device
  [[nodiscard]] bool has_light() const { return light_ != nullptr; }
  [[nodiscard]] const visibility::Light& light() const { return *light_; }
  [[nodiscard]] const visibility::DeviceLight& device_light() const { return device_light_; }
  [[nodiscard]] const visibility::ViewSamples& samples() const { return *samples_; }
  [[nodiscard]] const visibility::Tile& tile() const { return tile_; }
  [[nodiscard]] std::uint64_t tile_pixels() const { return std::uint64_t{tile_.row_count} * samples_->width; }
  [[nodiscard]] const ViewUpload& view() const { return view_; }
  [[nodiscard]] TriangleUpload& triangles() { return triangles_; }
  [[nodiscard]] const render::Buffer& masks() const { return *masks_; }
  [[nodiscard]] const render::Buffer& counts() const { return *counts_; }
  [[nodiscard]] GrowingList& questions() { return questions_; }
  [[nodiscard]] render::Commands& commands() { return commands_; }
  [[nodiscard]] visibility::PassTimes& times() { return times_; }

 private:
  /// False: the band is too large.
  bool run_whole(const visibility::Tile& band);

  const render::Device* device_;
  std::uint64_t others_bytes_;  ///< that were on the device before this
  visibility::MethodDescription description_;
  render::ComputePass settle_;
  render::Commands commands_;

  const visibility::SceneFloats* scene_ = nullptr;
  float scale_ = 1;
  visibility::TriangleTree tree_;
  TriangleNotes notes_;
  TriangleUpload triangles_;

  const visibility::Light* light_ = nullptr;
  visibility::DeviceLight device_light_;
  MaskLayout layout_;

  const visibility::ViewSamples* samples_ = nullptr;
  ViewUpload view_;
  visibility::Tile tile_;
  GrowingList questions_;
  std::unique_ptr<render::Buffer> masks_, counts_, decided_;

  visibility::PassTimes times_;
  std::map<std::string, std::uint64_t> counters_;
};

}  // namespace penumbra::device
