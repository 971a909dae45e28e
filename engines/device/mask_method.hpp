// SPDX-License-Identifier: Apache-2.0
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

/// Result of one run over a band of rows.
enum class Attempt : std::uint8_t {
  done,       ///< success, except that lists of questions may have been too short
  again,      ///< must be repeated: lists have grown, or loops are shorter now
  too_large,  ///< a list would exceed the largest storage buffer: the band must be divided in two
};

/// Base class of methods on the Vulkan device that compute the light samples visible from each view sample. Implements
/// the steps around a method's lists and kernels that are the same for all: uploads, tiles, growing lists, open light
/// samples decided by exact predicates, masks and V. The counterpart of vectors::MaskMethod.
///
/// Kernels write into masks() (MaskLayout) and counts() (visible light samples of a pixel; if none or all are visible,
/// the mask is undefined), and append questions to questions(), each with the number of bytes given to the constructor,
/// after a gpu::QuestionHead. The base is virtual so that a method can have another interface as well.
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
  /// Returns listRetries (a list was too short), loopRetries (a driver ended a loop), splitBands (a band was divided in
  /// two), and the counters added by count().
  [[nodiscard]] std::map<std::string, std::uint64_t> counters() const override { return counters_; }
  [[nodiscard]] std::uint64_t memory_bytes() const override { return device_->peak_bytes() - others_bytes_; }

 protected:
  /// Called once for each mesh, before its upload: returns the method's additions to triangles, which the method must
  /// keep alive.
  virtual TriangleNotes note_triangles() { return {}; }
  /// Called once for each light: makes lists and passes. Returns the kernels' layout of masks.
  virtual MaskLayout prepare_casters() = 0;
  /// Records lists and kernels for a band of the tile's rows. The caller submits the last recorded commands.
  virtual Attempt run(const visibility::Tile& band) = 0;
  /// Called if a driver ended a kernel's loop too soon (QuestionHead::cut_off): shortens loops.
  virtual void shorten_loops();
  /// Returns the bits that the first `count` questions are about.
  virtual std::vector<OpenBits> open_bits(std::uint32_t count) = 0;
  /// Called after open_bits: decides and settles the questions. Override if later questions depend on earlier answers.
  virtual void answer(std::span<const OpenBits> questions);
  /// Called after the last band, for kernels that compute counts() in a separate pass.
  virtual void finish() {}
  /// Adds the method's counters after a band.
  virtual void count([[maybe_unused]] std::map<std::string, std::uint64_t>& counters) {}
  /// Returns the bytes for each pixel in the largest of the method's own buffers.
  [[nodiscard]] virtual std::uint64_t bytes_per_pixel() const { return 0; }

  std::vector<gpu::MaskWord> decide(std::span<const OpenBits> questions);
  void settle(std::span<const gpu::MaskWord> words);
  void submit() { times_.add(commands_.submit()); }

  [[nodiscard]] const render::Device& device() const { return *device_; }
  [[nodiscard]] const visibility::SceneFloats& scene() const { return *scene_; }
  [[nodiscard]] const visibility::TriangleTree& tree() const { return tree_; }
  [[nodiscard]] float scale() const { return scale_; }  ///< scale of all lengths on the device
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
  /// Returns false if the band is too large.
  bool run_whole(const visibility::Tile& band);

  const render::Device* device_;
  std::uint64_t others_bytes_;  ///< bytes on the device before this method was made
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
