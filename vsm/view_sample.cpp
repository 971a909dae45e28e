#include "vsm/view_sample.hpp"

#include "base/assert.hpp"
#include "base/error.hpp"
#include "engines/device/triangle_upload.hpp"
#include "engines/device/view_upload.hpp"
#include "engines/engine_choice.hpp"
#include "render/compute_pass.hpp"
#include "visibility/triangle_tree.hpp"
#include "visibility/visible_share.hpp"
#include "vsm/closed_parts.hpp"
#include "vsm/find_leaves.comp.spv.hpp"
#include "visibility/light_frame.hpp"
#include "vsm/resolve.comp.spv.hpp"
#include "vsm/settle.comp.spv.hpp"
#include "vsm/settle.hpp"
#include "vsm/test_pairs.comp.spv.hpp"
#include "vsm/uploads.hpp"
#include "vsm/view_sample.shared.h"
#include "vsm/view_sample_vulkan.hpp"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

namespace penumbra::vsm {
namespace {

using visibility::TriangleTree;

constexpr std::uint32_t kSharedBudget = 16 * 1024;                            // bytes of shared memory for row masks
constexpr std::uint32_t kFirstQuestions = 1U << 16, kFirstChunks = 1U << 15;  // both grow
constexpr std::uint32_t kMostChunk = 32;                                      // leaves that one workgroup tests

visibility::MeshVerdict verdict_on(const mesh::Diagnosis& mesh) {
  return {visibility::Verdict::exact,
          visibility::reason_with("every pair is decided exactly, whatever is wrong with the mesh", mesh,
                                  {{mesh.boundary_loops, "open boundaries, where light passes as it should"},
                                   {mesh.zero_area_triangles.count, "triangles without area, which cast nothing"}})};
}

const visibility::MethodDescription& describe() {
  static const visibility::MethodDescription description{
      .name = "view-sample",
      .family = visibility::Family::geometry,
      .paper = "Eisemann and Décoret 2007; Sintorn, Eisemann and Assarsson 2008",
      .output = visibility::Output::mask,
      .exact_for = "every pair of view sample and light sample, for any triangle soup",
      .lights = {visibility::LightKind::rectangle, visibility::LightKind::disk, visibility::LightKind::polygon},
      .options = {engines::kEngine.description()},
      .verdict_on = verdict_on,
  };
  return description;
}

class ViewSampleMapping final : public visibility::Method {
 public:
  explicit ViewSampleMapping(const render::Device& device)
      : device_(&device),
        settle_(device, {.name = "settle", .spirv = shaders::kSettleComp, .push_bytes = sizeof(std::uint32_t)}),
        resolve_(device, {.name = "resolve", .spirv = shaders::kResolveComp, .push_bytes = sizeof(gpu::ResolvePush)}),
        commands_(device),
        view_(device) {}

  [[nodiscard]] const visibility::MethodDescription& description() const override { return describe(); }

  void prepare_mesh(const visibility::SceneFloats& scene) override {
    scene_ = &scene;
    part_levels_ = 0;
    scale_ = visibility::device_scale(scene);
    tree_ = visibility::make_triangle_tree(scene);
    if (scene.triangles.size() >> kPartShift != 0) {
      throw ResourceError("view-sample handles up to 2^{} triangles; this scene has {}", kPartShift,
                          scene.triangles.size());
    }
    closed_ = find_closed_parts(scene);
    tags_ = part_tags(closed_);
    triangles_.prepare(*device_, scene, tree_, scale_, {tags_, closed_.turn});
    parts_.emplace(
        render::make_buffer<Texel>(*device_, "closed parts", part_texels(closed_, scale_), render::BufferUse::texels));
  }

  void prepare_light(const visibility::Light& light) override {
    visibility::check_light(describe(), light);
    PENUMBRA_ASSERT(scene_ != nullptr, "prepare_mesh comes first: {}", light.name);
    light_ = &light;
    frame_ = visibility::make_light_frame(light, scale_);
    check_proportions();
    counters_.clear();

    const std::uint32_t lanes = device_->limits().subgroup_size;
    const std::uint32_t words_per_row = (light.columns + 31) / 32;
    const bool rows = frame_.rows && light.rows * words_per_row * lanes * 4 <= kSharedBudget;
    SampleTable table = make_sample_table(frame_, rows);
    bit_of_ = std::move(table.bit_of);
    table_.emplace(render::make_buffer<std::byte>(*device_, "light samples", table.bytes));

    // Some processors' drivers end loops after 65535 turns a workgroup; a triangle takes about a turn a row or point.
    const std::uint32_t turns = TriangleTree::kWidth * ((rows ? light.rows : light.sample_count()) + 8);
    layout_ = {.scattered = !rows,
               .words_per_row = std::max(words_per_row, 1U),
               .shared_words = rows ? light.rows * words_per_row : light.words_per_mask(),
               .chunk = std::clamp(40000 / turns, 1U, kMostChunk)};
    build_passes();
    parts_apart_ = parts_apart_from(closed_, frame_, scale_);
    if (parts_apart_ != 0) {
      mark_dispensable(tree_, find_dispensable(closed_, *scene_, frame_, scale_), triangles_.node_texels());
      triangles_.write_nodes();
    }
  }

  void prepare_view(const visibility::ViewSamples& samples) override {
    samples_ = &samples;
    view_.prepare(samples, *scene_, scale_, tags_);
    if (max_tile_rows() >= samples.height) view_.load({0, samples.height});
  }

  [[nodiscard]] std::uint32_t max_tile_rows() const override {
    PENUMBRA_ASSERT(samples_ != nullptr && light_ != nullptr, "prepare_light and prepare_view come first");
    const std::uint64_t per_pixel = std::max<std::uint64_t>(4ULL * light_->words_per_mask(), device::ViewUpload::kBytesPerPixel);
    const std::uint64_t rows = device_->limits().max_storage_buffer_range / (per_pixel * samples_->width);
    if (rows == 0) {
      throw ResourceError(
          "one row of {} pixels with {} light samples is more than this device's storage buffers can hold",
          samples_->width, light_->sample_count());
    }
    const auto whole = static_cast<std::uint32_t>(std::min<std::uint64_t>(rows, samples_->height));
    return whole >= 16 && whole < samples_->height ? whole / 16 * 16 : whole;
  }

  void evaluate(const visibility::Tile& tile) override {
    view_.load(tile);
    tile_ = tile;
    const std::uint32_t pixels = tile.row_count * samples_->width;
    render::grow(*device_, masks_, "masks", std::uint64_t{pixels} * light_->words_per_mask() * 4);
    render::grow(*device_, visibility_, "visibility", std::uint64_t{pixels} * 4);
    // Bands of rows, cut in two where the lists of one would be more than a buffer can hold.
    std::vector<visibility::Tile> bands{{0, tile.row_count}};
    while (!bands.empty()) {
      const visibility::Tile band = bands.back();
      bands.pop_back();
      if (run_band(band)) continue;
      if (band.row_count < 2 * block_height()) {
        throw ResourceError(
            "view-sample: the lists of one row of pixels are more than this device's storage buffers can hold");
      }
      const std::uint32_t half = band.row_count / 2 / block_height() * block_height();
      bands.push_back({band.first_row + half, band.row_count - half});
      bands.push_back({band.first_row, half});
      ++counters_["splitBands"];
    }
    if (light_->weights.empty()) {  // else read_visibility adds weights, which floats could not do in any order
      resolve_.record(commands_, gpu::ResolvePush{pixels, light_->sample_count()}, {*masks_, *visibility_},
                      (pixels + 63) / 64);
    }
    submit();
  }

  void read_masks(std::span<std::uint32_t> masks) override {
    masks_->read(masks);
    const std::uint32_t words = light_->words_per_mask(), count = light_->sample_count();
    const bool sorted = !std::is_sorted(bit_of_.begin(), bit_of_.end());
    std::vector<std::uint32_t> blocked(words);
    for (std::size_t first = 0; first < masks.size(); first += words) {
      const auto mask = masks.subspan(first, words);
      if (sorted) {
        std::copy(mask.begin(), mask.end(), blocked.begin());
        std::fill(mask.begin(), mask.end(), 0U);
        for (std::uint32_t j = 0; j < count; ++j) {
          if ((blocked[j / 32] >> (j % 32) & 1U) != 0) mask[bit_of_[j] / 32] |= 1U << (bit_of_[j] % 32);
        }
      }
      for (std::uint32_t& word : mask) word = ~word;
      if (count % 32 != 0) mask.back() &= (1U << (count % 32)) - 1;
    }
  }

  void read_visibility(std::span<float> visibility) override {
    if (light_->weights.empty()) return visibility_->read(visibility);
    std::vector<std::uint32_t> masks(visibility.size() * light_->words_per_mask());
    read_masks(masks);
    visibility::visible_shares(*light_, masks, visibility);
  }

  std::vector<visibility::PassTime> take_pass_times() override { return times_.take(); }
  [[nodiscard]] std::map<std::string, std::uint64_t> counters() const override { return counters_; }
  [[nodiscard]] std::uint64_t memory_bytes() const override { return device_->peak_bytes(); }

 private:
  /// The shader multiplies up to six lengths; with the scene scaled to 1, float32 holds that for lights from 2⁻²⁸ to
  /// 2²⁸.
  void check_proportions() const {
    const auto size = [](const glm::vec3& x) { return std::max({std::abs(x.x), std::abs(x.y), std::abs(x.z)}); };
    const float largest = size(frame_.center) + size(frame_.u) + size(frame_.v);
    const float smallest = std::min(size(frame_.u), size(frame_.v));
    if (largest <= 0x1p28F && smallest >= 0x1p-28F) return;
    throw InputError(
        "light \"{}\": view-sample handles lights between 2^-28 and 2^28 of the scene's size; this one has half-size "
        "{:.3g} "
        "and reaches {:.3g} from the origin of a scene of size 1; use raytrace, or bring light and scene closer in "
        "scale",
        light_->name, smallest, largest);
  }

  /// How the shaders are specialised for a light.
  struct Layout {
    bool scattered = false;
    std::uint32_t words_per_row = 1, shared_words = 1, chunk = 1;
    bool operator==(const Layout&) const = default;
  };

  /// Blocks as square as the subgroup allows: 4×2, 4×4, 8×4, 8×8.
  [[nodiscard]] std::uint32_t block_width() const { return device_->limits().subgroup_size >= 32 ? 8 : 4; }
  [[nodiscard]] std::uint32_t block_height() const { return device_->limits().subgroup_size / block_width(); }

  void build_passes() {
    const std::uint32_t lanes = device_->limits().subgroup_size, teams = lanes / TriangleTree::kWidth;
    // Depth first, `teams` nodes at a time, each leaves at most seven more than it takes.
    const std::uint32_t stack = teams * TriangleTree::kWidth * (tree_.depth + 2);
    const std::vector<std::uint32_t> constants{
        lanes,         lanes, layout_.scattered ? 1U : 0U, layout_.words_per_row, layout_.shared_words, block_width(),
        layout_.chunk, stack};
    if (find_leaves_ && constants == constants_) return;
    const auto make = [&](const char* name, std::span<const std::uint32_t> spirv) {
      return render::ComputePass(*device_, {.name = name,
                                            .spirv = spirv,
                                            .push_bytes = sizeof(gpu::ViewSamplePush),
                                            .constants = constants,
                                            .full_subgroups = true});
    };
    find_leaves_.emplace(make("find leaves", shaders::kFindLeavesComp));
    test_pairs_.emplace(make("test pairs", shaders::kTestPairsComp));
    constants_ = constants;
  }

  [[nodiscard]] gpu::ViewSamplePush push_constants() const {
    gpu::ViewSamplePush push{};
    for (int i = 0; i < 3; ++i) {
      push.center[i] = frame_.center[i];
      push.u[i] = frame_.u[i];
      push.v[i] = frame_.v[i];
    }
    push.deviation = frame_.deviation;
    push.reach = visibility::reach_of(*scene_, frame_, scale_);
    push.two_sided = light_->two_sided ? 1 : 0;
    push.light = light_->index;
    push.width = samples_->width;
    push.first_row = view_.place_of(tile_.first_row);
    push.sample_count = light_->sample_count();
    push.rows = light_->rows;
    push.columns = light_->columns;
    push.shift_step = frame_.shift_step;
    push.empty_tree = tree_.nodes.empty() ? 1 : 0;
    push.closed_parts = parts_apart_;
    return push;
  }

  /// Head of the buffer of open questions.
  struct Counts {
    std::uint32_t questions = 0, chunks = 0, unfinished = 0;
  };

  /// Masks of one band of the tile, the open questions answered. Lists grow until they hold all of it, and what a try
  /// that overflowed left behind is not used. False when a list would be larger than a storage buffer.
  bool run_band(const visibility::Tile& band) {
    gpu::ViewSamplePush push = push_constants();
    push.band_first = band.first_row;
    push.band_rows = band.row_count;
    const std::uint64_t blocks = std::uint64_t{(samples_->width + block_width() - 1) / block_width()} *
                                 ((band.row_count + block_height() - 1) / block_height());
    for (;;) {
      const std::uint64_t chunk_bytes = std::uint64_t{chunk_capacity_} * (2 + layout_.chunk) * sizeof(std::uint32_t);
      const std::uint64_t question_bytes =
          sizeof(Counts) + std::uint64_t{question_capacity_} * sizeof(gpu::OpenQuestion);
      if (std::max(chunk_bytes, question_bytes) > device_->limits().max_storage_buffer_range) {
        chunk_capacity_ = kFirstChunks;
        question_capacity_ = kFirstQuestions;
        return false;
      }
      render::grow(*device_, chunks_, "leaf lists", chunk_bytes);
      render::grow(*device_, questions_, "open questions", question_bytes);
      push.question_capacity = question_capacity_;
      push.chunk_capacity = chunk_capacity_;
      Counts counts = find_leaves(push, blocks);
      if ((counts.unfinished & gpu::kWalkCut) != 0) {
        // What is left of the deepest walk when all levels are taken is one leaf.
        if (part_levels_ >= tree_.depth) {
          throw ResourceError("view-sample: {} cuts off loops that a tree over {} triangles needs",
                              device_->info().name, scene_->triangles.size());
        }
        ++part_levels_;
        ++counters_["loopRetries"];
        continue;
      }
      if (counts.chunks > chunk_capacity_) {
        chunk_capacity_ = counts.chunks + counts.chunks / 8;
        ++counters_["listRetries"];
        continue;
      }
      push.chunk_capacity = counts.chunks;
      test_pairs_->record(commands_, push,
                          {view_.buffer(), *table_, *masks_, *questions_, *chunks_, triangles_.corners(0),
                           triangles_.corners(1), triangles_.corners(2)},
                          counts.chunks);
      submit();
      questions_->read(std::span(&counts, 1));
      if ((counts.unfinished & gpu::kTestCut) != 0) {
        if (layout_.chunk == 1)
          throw ResourceError("view-sample: {} cuts off loops over the light samples", device_->info().name);
        layout_.chunk = std::max(layout_.chunk / 4, 1U);
        build_passes();
        ++counters_["loopRetries"];
        continue;
      }
      if (counts.questions > question_capacity_) {
        question_capacity_ = counts.questions + counts.questions / 8;
        ++counters_["listRetries"];
        continue;
      }
      counters_["leafChunks"] += counts.chunks;
      answer(counts.questions);
      return true;
    }
  }

  /// In parts of the tree, one dispatch after the other, where the device ends loops too soon for all of it.
  Counts find_leaves(gpu::ViewSamplePush& push, std::uint64_t blocks) {
    Counts counts;
    commands_.fill(*questions_, 0, 0, sizeof(Counts));
    push.part_levels = part_levels_;
    for (push.part = 0; push.part < 1U << (3 * part_levels_); ++push.part) {
      find_leaves_->record(commands_, push, {view_.buffer(), *table_, *masks_, *questions_, *chunks_, triangles_.nodes(), *parts_},
                           blocks);
      submit();
      questions_->read(std::span(&counts, 1));
      if (counts.unfinished != 0) break;
    }
    return counts;
  }

  void answer(std::uint32_t count) {
    counters_["openQuestions"] += count;
    if (count == 0) return;
    std::vector<gpu::OpenQuestion> questions(count);
    questions_->read(std::span(questions), sizeof(Counts));
    apply(times_.add("exact predicates", [&] {
      return settle({*scene_, tree_, *samples_, *light_, std::size_t{tile_.first_row} * samples_->width, bit_of_},
                    questions);
    }));
  }

  void apply(const std::vector<Answer>& answers) {
    counters_["blockedByExactPredicates"] += answers.size();
    if (answers.empty()) return;
    render::grow(*device_, answers_, "answers", answers.size() * sizeof(Answer));
    answers_->write(std::span<const Answer>(answers));
    settle_.record(commands_, static_cast<std::uint32_t>(answers.size()), {*masks_, *answers_},
                   (answers.size() + 63) / 64);
    submit();
  }

  void submit() { times_.add(commands_.submit()); }

  const render::Device* device_;
  render::ComputePass settle_, resolve_;
  std::optional<render::ComputePass> find_leaves_, test_pairs_;
  Layout layout_;
  std::vector<std::uint32_t> constants_;
  render::Commands commands_;

  const visibility::SceneFloats* scene_ = nullptr;
  float scale_ = 1;
  TriangleTree tree_;
  ClosedParts closed_;
  std::vector<std::uint32_t> tags_;  // of triangles: closed parts
  std::uint32_t parts_apart_ = 0;    // bits: closed parts apart from the light
  device::TriangleUpload triangles_;
  std::optional<render::Buffer> parts_;

  const visibility::Light* light_ = nullptr;
  visibility::LightFrame frame_;
  std::vector<std::uint32_t> bit_of_;  // the device's sample number → the light sample
  std::optional<render::Buffer> table_;

  const visibility::ViewSamples* samples_ = nullptr;
  device::ViewUpload view_;
  std::unique_ptr<render::Buffer> masks_, visibility_, chunks_, questions_, answers_;
  std::uint32_t part_levels_ = 0;  // grows: 8 to that power are the parts that the tree is walked in
  std::uint32_t chunk_capacity_ = kFirstChunks, question_capacity_ = kFirstQuestions;
  visibility::Tile tile_;

  visibility::PassTimes times_;
  std::map<std::string, std::uint64_t> counters_;
};

}  // namespace

const visibility::MethodDescription& view_sample_description() {
  return describe();
}

std::unique_ptr<visibility::Method> make_vulkan_view_sample(const render::Device& device) {
  return std::make_unique<ViewSampleMapping>(device);
}

}  // namespace penumbra::vsm
