// SPDX-License-Identifier: Apache-2.0
// View-sample mapping on the Vulkan device: kernels, lists and questions for device::MaskMethod.

#include "vsm/view_sample_vulkan.hpp"

#include "base/error.hpp"
#include "engines/device/mask_method.hpp"
#include "render/compute_pass.hpp"
#include "render/features.hpp"
#include "visibility/lights/device_light.hpp"
#include "vsm/leaf_lists.hpp"
#include "vsm/resolve.comp.spv.hpp"
#include "vsm/test_pairs.comp.spv.hpp"
#include "vsm/uploads.hpp"
#include "vsm/methods.hpp"
#include "vsm/view_sample.shared.h"

#include <algorithm>
#include <optional>
#include <utility>

namespace penumbra::vsm {
namespace {

using visibility::TriangleTree;

constexpr std::uint32_t kSharedBudget = 16 * 1024;  // bytes of shared memory for row masks
constexpr std::uint32_t kMostChunk = 32;            // leaves that one workgroup tests

class ViewSampleMapping final : public device::MaskMethod {
 public:
  explicit ViewSampleMapping(const render::Device& device)
      : MaskMethod(device, view_sample_description(), sizeof(gpu::OpenQuestion)),
        resolve_(device, {.name = "resolve", .spirv = shaders::kResolveComp, .push_bytes = sizeof(gpu::ResolvePush)}),
        lists_(device, view_sample_description().name) {
    render::require_features(device.info(), shaders::kTestPairsComp, "test pairs");  // checked now; the pass is made
                                                                                     // when the light is known
  }

  void prepare_light(const visibility::Light& light) override {
    visibility::require_kind(light, visibility::kPlanarLights,
                             ": view-sample with engine=vulkan supports only planar lights ({}); without engine=vulkan "
                             "it supports every light",
                             visibility::kPlanarLights.words());
    MaskMethod::prepare_light(light);
  }

 private:
  device::TriangleNotes note_triangles() override {
    if (scene().triangles.size() >> kPartShift != 0) {
      throw ResourceError("view-sample handles up to 2^{} triangles; this scene has {}", kPartShift,
                          scene().triangles.size());
    }
    lists_.prepare_mesh(scene(), scale());
    return lists_.notes();
  }

  device::MaskLayout prepare_casters() override {
    // The shader multiplies up to six lengths; with the scene scaled to 1, float32 can represent that for lights of
    // such sizes.
    const visibility::Light& light = this->light();
    visibility::check_size(light, device_light(), view_sample_description().name);
    const std::uint32_t words_per_row = (light.columns + 31) / 32;
    const bool rows = device_light().rows && light.rows * words_per_row * lanes() * 4 <= kSharedBudget;
    SampleTable table = make_sample_table(device_light(), rows);
    table_.emplace(render::make_buffer<std::byte>(device(), "light samples", table.bytes));

    // Some drivers that run on processors end loops after 65535 iterations of a workgroup; a triangle takes about one
    // iteration for each row or point.
    const std::uint32_t turns = TriangleTree::kWidth * ((rows ? light.rows : light.sample_count()) + 8);
    shape_ = {.scattered = !rows,
              .words_per_row = std::max(words_per_row, 1U),
              .shared_words = rows ? light.rows * words_per_row : light.words_per_mask(),
              .chunk = std::clamp(40000 / turns, 1U, kMostChunk)};
    build_passes();
    lists_.prepare_light(tree(), device_light(), scale(), triangles());
    if (std::ranges::is_sorted(table.bit_of)) return {.words = light.words_per_mask()};
    table.bit_of.resize(std::size_t{32} * light.words_per_mask(), device::MaskLayout::kNone);
    return {.words = light.words_per_mask(), .light_sample = std::move(table.bit_of)};
  }

  /// Specialization of the kernels for a light.
  struct Shape {
    bool scattered = false;
    std::uint32_t words_per_row = 1, shared_words = 1, chunk = 1;
  };

  /// Blocks are as square as the subgroup allows: 2×2, 4×2, 4×4, 8×4, 8×8.
  [[nodiscard]] std::uint32_t lanes() const { return device().limits().subgroup_size; }
  [[nodiscard]] std::uint32_t block_width() const { return lanes() >= 32 ? 8 : lanes() >= 8 ? 4 : 2; }
  [[nodiscard]] std::uint32_t block_height() const { return lanes() / block_width(); }

  /// Returns the number of lanes, but at least that of a whole team, which a smaller subgroup handles in parts.
  [[nodiscard]] std::uint32_t lanes_of_teams() const { return std::max(lanes(), TriangleTree::kWidth); }

  void build_passes() {
    // Nodes are taken in depth-first order, one for each team at a time, and each adds at most seven more than it
    // removes. Rounded up, so that few scenes need different passes.
    const std::uint32_t levels = (tree().depth + 3) / 4 * 4 + 2, stack = lanes_of_teams() * levels;
    check_shared_memory(stack);
    const std::vector<std::uint32_t> constants{
        lanes(),      lanes(), shape_.scattered ? 1U : 0U, shape_.words_per_row, shape_.shared_words, block_width(),
        shape_.chunk, stack};
    if (test_pairs_ && constants == constants_) return;
    lists_.build_pass(constants);
    test_pairs_.emplace(device(), render::ComputePassOptions{.name = "test pairs",
                                                             .spirv = shaders::kTestPairsComp,
                                                             .push_bytes = sizeof(gpu::ViewSamplePush),
                                                             .constants = constants,
                                                             .full_subgroups = true});
    constants_ = constants;
  }

  /// Shared memory: a mask for each lane; and the stack and leaves of the traversal, or the triangles that are tested
  /// again.
  void check_shared_memory(std::uint32_t stack) const {
    const std::uint64_t walk = stack + shape_.chunk + lanes_of_teams() + 8;
    const std::uint64_t twice = std::uint64_t{shape_.chunk} * TriangleTree::kWidth + 1;
    const std::uint64_t needed = 4 * (std::uint64_t{shape_.shared_words} * lanes() + std::max(walk, twice));
    if (needed <= device().limits().max_shared_memory) return;
    throw InputError(
        "light \"{}\": {} light samples need {} bytes of shared memory, but {} has {}; use fewer light samples, or the "
        "method raytrace",
        light().name, light().sample_count(), needed, device().info().name, device().limits().max_shared_memory);
  }

  [[nodiscard]] gpu::ViewSamplePush make_push(const visibility::Tile& band) {
    const visibility::DeviceLight& frame = device_light();
    gpu::ViewSamplePush push{};
    for (int i = 0; i < 3; ++i) {
      push.center[i] = frame.center[i];
      push.u[i] = frame.u[i];
      push.v[i] = frame.v[i];
    }
    push.deviation = frame.deviation;
    push.reach = visibility::reach_of(scene(), frame, scale());
    push.two_sided = light().two_sided ? 1 : 0;
    push.light = light().index;
    push.width = samples().width;
    push.first_row = view().place_of(tile().first_row);
    push.band_first = band.first_row;
    push.band_rows = band.row_count;
    push.sample_count = light().sample_count();
    push.rows = light().rows;
    push.columns = light().columns;
    push.shift_step = frame.shift_step;
    push.question_capacity = questions().capacity();
    push.empty_tree = tree().nodes.empty() ? 1 : 0;
    return push;
  }

  device::Attempt run(const visibility::Tile& band) override {
    gpu::ViewSamplePush push = make_push(band);
    const std::uint64_t blocks = std::uint64_t{(samples().width + block_width() - 1) / block_width()} *
                                 ((band.row_count + block_height() - 1) / block_height());
    const device::Attempt found = lists_.find(
        commands(), push, {view().buffer(), *table_, masks(), questions().buffer(), triangles().nodes()}, blocks);
    times().add(lists_.times());
    if (found == device::Attempt::again) ++(lists_.was_cut_off() ? loop_retries_ : list_retries_);
    if (found != device::Attempt::done) return found;
    chunks_ = push.chunk_capacity;
    test_pairs_->record(commands(), push,
                        {view().buffer(), *table_, masks(), questions().buffer(), lists_.chunks(),
                         triangles().corners(0), triangles().corners(1), triangles().corners(2)},
                        chunks_);
    return found;
  }

  void shorten_loops() override {
    if (shape_.chunk == 1)
      throw ResourceError("view-sample: {} ends loops over the light samples too early", device().info().name);
    shape_.chunk = std::max(shape_.chunk / 4, 1U);
    build_passes();
  }

  std::vector<device::OpenBits> open_bits(std::uint32_t count) override {
    std::vector<gpu::OpenQuestion> asked(count);
    questions().read(std::span(asked));
    open_questions_ = count;
    std::vector<device::OpenBits> open;
    open.reserve(count);
    for (const gpu::OpenQuestion& question : asked) {
      const std::uint32_t sample = question.light_sample;
      if (sample != gpu::kAllSamples) {
        open.push_back({question.pixel, sample / 32, 1U << (sample % 32), question.hider});
        continue;
      }
      for (std::uint32_t word = 0; word < light().words_per_mask(); ++word) {
        const std::uint32_t left = light().sample_count() - 32 * word;
        open.push_back({question.pixel, word, left >= 32 ? ~0U : (1U << left) - 1, question.hider});
      }
    }
    return open;
  }

  /// Computes each pixel's number of visible light samples from the finished masks.
  void finish() override {
    const auto pixels = static_cast<std::uint32_t>(tile_pixels());
    resolve_.record(commands(), gpu::ResolvePush{pixels, light().sample_count()}, {masks(), counts()},
                    (pixels + 63) / 64);
    submit();
  }

  void count(std::map<std::string, std::uint64_t>& counters) override {
    counters["leafChunks"] += chunks_;
    counters["openQuestions"] += std::exchange(open_questions_, 0);
    if (list_retries_ > 0) counters["listRetries"] += std::exchange(list_retries_, 0);
    if (loop_retries_ > 0) counters["loopRetries"] += std::exchange(loop_retries_, 0);
  }

  render::ComputePass resolve_;
  LeafLists lists_;
  std::optional<render::ComputePass> test_pairs_;
  Shape shape_;
  std::vector<std::uint32_t> constants_;
  std::optional<render::Buffer> table_;
  std::uint64_t chunks_ = 0, open_questions_ = 0, list_retries_ = 0, loop_retries_ = 0;  // counters
};

}  // namespace

std::unique_ptr<visibility::Method> make_vulkan_view_sample(const render::Device& device) {
  return std::make_unique<ViewSampleMapping>(device);
}

}  // namespace penumbra::vsm
