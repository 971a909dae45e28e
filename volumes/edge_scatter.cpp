// Depth complexity by silhouette edges (Laine et al. 2005), for any soup by signed multiplicities (Bergeron 1986), on a
// grid of light samples: docs/edge-scatter.md.

#include "volumes/edge_scatter.hpp"

#include "base/assert.hpp"
#include "base/error.hpp"
#include "render/compute_pass.hpp"
#include "render/tree_texels.hpp"
#include "visibility/light_frame.hpp"
#include "visibility/triangle_tree.hpp"
#include "visibility/visible_share.hpp"
#include "volumes/edge_scatter.shared.h"
#include "volumes/edge_set.hpp"
#include "volumes/find_edges.comp.spv.hpp"
#include "volumes/row_judge.hpp"
#include "volumes/scatter_edges.comp.spv.hpp"
#include "volumes/settle_rows.comp.spv.hpp"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <optional>
#include <utility>

namespace penumbra::volumes {
namespace {

using render::Texel;
using visibility::TriangleTree;

constexpr std::uint32_t kBlock = 8;                                          // pixels, as in edge_scatter.glsl
constexpr std::uint32_t kClusters = 4;                                       // likewise
constexpr std::uint32_t kMostBandWords = 16;                                 // 64 light rows: what a question can name
constexpr std::uint32_t kFirstWords = 1U << 20, kFirstQuestions = 1U << 14;  // both grow

visibility::MeshVerdict verdict_on(const mesh::Diagnosis& mesh) {
  return {visibility::Verdict::exact,
          visibility::reason_with("signed multiplicities hold for any soup, and every pair is decided exactly", mesh,
                                  {{mesh.boundary_loops, "open boundaries, where light passes as it should"},
                                   {mesh.zero_area_triangles.count, "triangles without area, which cast nothing"}})};
}

/// Head of the buffer of lists.
struct Counts {
  std::uint32_t words = 0, questions = 0, unfinished = 0;
};

/// What device passes read of the casters on one side of the light's plane.
struct SideBuffers {
  std::uint32_t depth = 0;
  std::optional<render::Buffer> nodes, slots;
};

class EdgeScatter final : public visibility::Method {
 public:
  EdgeScatter(const render::Device& device, const visibility::MethodOptions& options)
      : description_(edge_scatter_description()),
        device_(&device),
        settle_(device,
                {.name = "settle rows", .spirv = shaders::kSettleRowsComp, .push_bytes = sizeof(std::uint32_t)}),
        commands_(device) {
    visibility::check_options(description_, options);
    const std::uint32_t lanes = device.limits().subgroup_size;
    if (lanes < TriangleTree::kWidth || kBlock * kBlock % lanes != 0) {
      throw ResourceError("edge-scatter needs subgroups of 8, 16, 32 or 64 lanes; {} has {}", device.info().name,
                          lanes);
    }
  }

  [[nodiscard]] const visibility::MethodDescription& description() const override { return description_; }

  void prepare_mesh(const visibility::SceneFloats& scene) override {
    scene_ = &scene;
    scale_ = render::device_scale(scene);
    tree_ = visibility::make_triangle_tree(scene);
    triangle_nodes_.emplace(make_texels("triangle nodes", render::node_texels(tree_, scale_)));
    triangle_corners_.emplace(make_texels("triangle corners", corner_texels()));
    casters_ = edge_casters(scene, -1);
    casters_without_ = -1;
    whole_ = upload(edge_records(scene, casters_, std::nullopt));
  }

  void prepare_light(const visibility::Light& light) override {
    visibility::check_light(description_, light);
    PENUMBRA_ASSERT(scene_ != nullptr, "prepare_mesh comes first: {}", light.name);
    light_ = &light;
    frame_ = visibility::make_light_frame(light, scale_);
    check_pattern();
    counters_.clear();
    choose_band();
    prepare_edges();
  }

  void prepare_view(const visibility::ViewSamples& samples) override {
    samples_ = &samples;
    view_texels_.clear();
    view_texels_.reserve(2 * samples.size());
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const std::int32_t carrier = samples.triangle[i];
      const bool background = carrier == visibility::ViewSamples::kBackground ||
                              scene_->receives_shadow[static_cast<std::size_t>(carrier)] == 0;  // the host says V = 1
      const auto triangle = background ? 0U : static_cast<std::uint32_t>(carrier);
      const bool known = !background && render::normal_is_known(scene_->corners(triangle));
      view_texels_.push_back({samples.p[i] * scale_, background ? TriangleTree::kNoTriangle : triangle});
      view_texels_.push_back({known ? samples.n[i] : glm::vec3(0), background ? 0U : scene_->plane[triangle]});
    }
    view_rows_ = 0;
    if (max_tile_rows() >= samples.height) upload_rows({0, samples.height});
  }

  [[nodiscard]] std::uint32_t max_tile_rows() const override {
    PENUMBRA_ASSERT(samples_ != nullptr && light_ != nullptr, "prepare_light and prepare_view come first");
    const std::uint64_t per_pixel = std::max<std::uint64_t>(4ULL * words_per_mask(), 2 * sizeof(Texel));
    const std::uint64_t rows = device_->limits().max_storage_buffer_range / (per_pixel * samples_->width);
    if (rows == 0) {
      throw ResourceError(
          "one row of {} pixels with {} light samples is more than this device's storage buffers can hold",
          samples_->width, light_->sample_count());
    }
    const auto whole = static_cast<std::uint32_t>(std::min<std::uint64_t>(rows, samples_->height));
    return whole >= kBlock && whole < samples_->height ? whole / kBlock * kBlock : whole;
  }

  void evaluate(const visibility::Tile& tile) override {
    if (tile.first_row < view_row_ || tile.first_row + tile.row_count > view_row_ + view_rows_) upload_rows(tile);
    tile_ = tile;
    const std::uint64_t pixels = std::uint64_t{tile.row_count} * samples_->width;
    render::grow(*device_, masks_, "masks", pixels * words_per_mask() * 4);
    render::grow(*device_, visible_, "visible light samples", pixels * 4);
    render::grow(*device_, heads_, "heads of lists", blocks() * kClusters * 8 + pixels * 4);
    while (!try_tile()) ++counters_["listRetries"];
  }

  void read_masks(std::span<std::uint32_t> masks) override {
    const std::uint32_t words = light_->words_per_mask(), own = words_per_mask(), columns = light_->columns;
    const std::size_t pixels = masks.size() / words;
    std::vector<std::uint32_t> blocks_of_bits(pixels * own), counts(pixels);
    masks_->read(std::span(blocks_of_bits));
    visible_->read(std::span(counts));
    std::fill(masks.begin(), masks.end(), 0U);
    const std::uint32_t count = light_->sample_count(), row_words = (light_->rows + 3) / 4;
    for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
      const auto mask = masks.subspan(pixel * words, words);
      if (counts[pixel] == 0) continue;
      for (std::uint32_t j = 0; j < count; ++j) {
        const std::uint32_t row = j / columns, column = j % columns;
        const std::uint32_t word = column / 8 * row_words + row / 4, bit = row % 4 * 8 + column % 8;
        const bool visible = counts[pixel] == count || (blocks_of_bits[pixel * own + word] >> bit & 1U) != 0;
        mask[j / 32] |= (visible ? 1U : 0U) << (j % 32);
      }
    }
  }

  void read_visibility(std::span<float> visibility) override {
    if (!light_->weights.empty()) {
      std::vector<std::uint32_t> masks(visibility.size() * light_->words_per_mask());
      read_masks(masks);
      visibility::visible_shares(*light_, masks, visibility);
      return;
    }
    std::vector<std::uint32_t> counts(visibility.size());
    visible_->read(std::span(counts));
    const auto all = static_cast<double>(light_->sample_count());
    std::transform(counts.begin(), counts.end(), visibility.begin(),
                   [&](std::uint32_t count) { return static_cast<float>(count / all); });
  }

  std::vector<visibility::PassTime> take_pass_times() override { return std::exchange(pass_times_, {}); }
  [[nodiscard]] std::map<std::string, std::uint64_t> counters() const override { return counters_; }
  [[nodiscard]] std::uint64_t memory_bytes() const override { return device_->peak_bytes(); }

 private:
  [[nodiscard]] render::Buffer make_texels(const char* name, const std::vector<Texel>& texels) const {
    return render::make_buffer<Texel>(*device_, name, texels, render::BufferUse::texels);
  }

  [[nodiscard]] SideBuffers upload(const std::vector<EdgeRecord>& records) const {
    const EdgeTexels texels = edge_texels(records, scale_);
    SideBuffers side;
    side.depth = texels.depth;
    side.nodes.emplace(make_texels("edge nodes", texels.nodes));
    side.slots.emplace(make_texels("edges", texels.slots));
    return side;
  }

  /// For each slot of each leaf: (a, triangle), (b, plane), (c, light that the triangle is the body of).
  [[nodiscard]] std::vector<Texel> corner_texels() const {
    std::vector<Texel> texels;
    for (const TriangleTree::Leaf& leaf : tree_.leaves) {
      for (const std::uint32_t triangle : leaf) {
        const bool used = triangle != TriangleTree::kNoTriangle;
        const auto at = used ? scene_->corners(triangle) : std::array<glm::vec3, 3>{};
        texels.push_back({at[0] * scale_, triangle});
        texels.push_back({at[1] * scale_, used ? scene_->plane[triangle] : visibility::SceneFloats::kNoPlane});
        texels.push_back({at[2] * scale_, used ? static_cast<std::uint32_t>(scene_->emits[triangle]) : 0xffffffffU});
      }
    }
    return texels;
  }

  void check_pattern() const {
    PENUMBRA_ASSERT(frame_.rows, "light {} has no rows that a step describes", light_->name);
    const std::uint32_t lanes = device_->limits().subgroup_size;
    if (std::uint64_t{light_->columns} * lanes * 4 > device_->limits().max_shared_memory) {
      throw InputError(
          "light \"{}\": edge-scatter handles rows of up to {} light samples on {}; this has {}; use view-sample",
          light_->name, device_->limits().max_shared_memory / (lanes * 4), device_->info().name, light_->columns);
    }
    const auto size = [](const glm::vec3& x) { return std::max({std::abs(x.x), std::abs(x.y), std::abs(x.z)}); };
    const float largest = size(frame_.center) + size(frame_.u) + size(frame_.v);
    const float smallest = std::min(size(frame_.u), size(frame_.v));
    if (largest <= 0x1p28F && smallest >= 0x1p-28F) return;
    throw InputError(
        "light \"{}\": edge-scatter handles lights between 2^-28 and 2^28 of the scene's size; this one has half-size "
        "{:.3g} and reaches {:.3g} from the origin of a scene of size 1; use raytrace, or bring light and scene closer "
        "in scale",
        light_->name, smallest, largest);
  }

  /// As many light rows at a time as the histograms of a subgroup leave room for.
  void choose_band() {
    const std::uint32_t lanes = device_->limits().subgroup_size;
    const std::uint32_t room = device_->limits().max_shared_memory / (4 * lanes * light_->columns);
    band_words_ = std::min({room, kMostBandWords, (light_->rows + 3) / 4});
    const std::uint32_t block_width = lanes >= 32 ? 8 : 4;
    const std::vector<std::uint32_t> constants{lanes,           lanes,       block_width,
                                               light_->columns, band_words_, light_->columns * band_words_};
    const std::vector<std::uint32_t> walk_constants{lanes, lanes, stack_size()};
    if (!find_edges_ || walk_constants != walk_constants_) {
      find_edges_.emplace(*device_, render::ComputePassOptions{.name = "find edges",
                                                               .spirv = shaders::kFindEdgesComp,
                                                               .push_bytes = sizeof(gpu::ScatterPush),
                                                               .constants = walk_constants,
                                                               .full_subgroups = true});
      walk_constants_ = walk_constants;
    }
    if (!scatter_ || constants != constants_) {
      scatter_.emplace(*device_, render::ComputePassOptions{.name = "scatter edges",
                                                            .spirv = shaders::kScatterEdgesComp,
                                                            .push_bytes = sizeof(gpu::ScatterPush),
                                                            .constants = constants,
                                                            .full_subgroups = true});
      constants_ = constants;
    }
  }

  /// Depth first, `teams` nodes at a time, each leaves at most seven more than it takes. Cut edges may deepen a
  /// hierarchy.
  [[nodiscard]] std::uint32_t stack_size() const {
    const std::uint32_t teams = device_->limits().subgroup_size / TriangleTree::kWidth;
    return teams * TriangleTree::kWidth * (std::max(tree_.depth, whole_.depth) + 10);
  }

  /// Records without the light's own body, cut at its plane where something lies behind that.
  void prepare_edges() {
    const bool has_body = std::find(scene_->emits.begin(), scene_->emits.end(), light_->index) != scene_->emits.end();
    const std::int32_t without = has_body ? light_->index : -1;
    if (casters_without_ != without) {
      casters_ = edge_casters(*scene_, without);
      casters_without_ = without;
    }
    const glm::dvec3 center(light_->center);
    const LightSide front{center, glm::dvec3(light_->center_u) - center, glm::dvec3(light_->center_v) - center, 1};
    cut_ = reaches_behind(*scene_, front);
    front_.reset();
    back_.reset();
    if (cut_ || has_body) {
      front_ = upload(edge_records(*scene_, casters_, cut_ ? std::optional(front) : std::nullopt));
    }
    if (cut_ && light_->two_sided) {
      LightSide back = front;
      back.sign = -1;
      back_ = upload(edge_records(*scene_, casters_, back));
    }
  }

  void upload_rows(const visibility::Tile& tile) {
    const std::span<const Texel> rows = std::span<const Texel>(view_texels_)
                                            .subspan(std::size_t{2} * tile.first_row * samples_->width,
                                                     std::size_t{2} * tile.row_count * samples_->width);
    render::grow(*device_, view_, "view samples", rows.size_bytes(), render::BufferUse::texels);
    view_->write(rows);
    view_row_ = tile.first_row;
    view_rows_ = tile.row_count;
  }

  [[nodiscard]] std::uint32_t words_per_mask() const { return (light_->columns + 7) / 8 * ((light_->rows + 3) / 4); }
  [[nodiscard]] std::uint64_t blocks() const {
    return std::uint64_t{(samples_->width + kBlock - 1) / kBlock} * ((tile_.row_count + kBlock - 1) / kBlock);
  }

  [[nodiscard]] gpu::ScatterPush push_constants() const {
    gpu::ScatterPush push{};
    float reach = 0;
    for (int i = 0; i < 3; ++i) {
      push.center[i] = frame_.center[i];
      push.u[i] = frame_.u[i];
      push.v[i] = frame_.v[i];
      reach = std::max({reach, std::abs(frame_.center[i]) + std::abs(frame_.u[i]) + std::abs(frame_.v[i]),
                        std::abs(scene_->lower[i]) * scale_, std::abs(scene_->upper[i]) * scale_});
    }
    push.deviation = frame_.deviation;
    push.reach = reach;
    push.cut_reach = cut_ ? 4 * reach : 0;
    push.keeps_rest = light_->two_sided ? 1 : 0;
    push.light = static_cast<std::uint32_t>(light_->index);
    push.width = samples_->width;
    push.first_row = tile_.first_row - view_row_;
    push.row_count = tile_.row_count;
    push.rows = light_->rows;
    push.columns = light_->columns;
    push.shift_step = frame_.shift_step;
    push.block_count = static_cast<std::uint32_t>(blocks());
    push.list_capacity = list_capacity_;
    push.question_capacity = question_capacity_;
    push.triangle_depth = tree_.depth;
    return push;
  }

  /// False when a list was too short; it has grown then.
  bool try_tile() {
    gpu::ScatterPush push = push_constants();
    render::grow(*device_, lists_, "edge lists", sizeof(Counts) + std::uint64_t{list_capacity_} * 4);
    render::grow(*device_, questions_, "open rows", std::uint64_t{question_capacity_} * sizeof(gpu::RowQuestion));
    commands_.fill(*visible_, 0);
    std::uint32_t questions = 0;
    for (const float side : {1.0F, -1.0F}) {
      if (side < 0 && !light_->two_sided) continue;
      push.side = side;
      const SideBuffers& edges = side < 0 && back_ ? *back_ : front_ ? *front_ : whole_;
      push.edge_depth = edges.depth;
      commands_.fill(*lists_, questions, sizeof(std::uint32_t), sizeof(std::uint32_t));
      commands_.fill(*lists_, 0, 0, sizeof(std::uint32_t));
      commands_.fill(*lists_, 0, 2 * sizeof(std::uint32_t), sizeof(std::uint32_t));
      find_edges_->record(commands_, push,
                          {*view_, *heads_, *lists_, *edges.nodes, *triangle_nodes_, *edges.slots, *triangle_corners_},
                          blocks());
      submit();
      Counts counts = read_counts();
      if (counts.unfinished != 0) {
        throw ResourceError("edge-scatter: {} cuts off loops that a hierarchy over {} triangles needs",
                            device_->info().name, scene_->triangles.size());
      }
      if (counts.words > list_capacity_) {
        list_capacity_ = counts.words + counts.words / 8;
        return false;
      }
      const std::uint32_t lanes = device_->limits().subgroup_size,
                          bands = (light_->rows + 4 * band_words_ - 1) / (4 * band_words_);
      scatter_->record(commands_, push,
                       {*view_, *heads_, *lists_, *edges.slots, *triangle_corners_, *masks_, *visible_, *questions_},
                       blocks() * (kBlock * kBlock / lanes) * bands);
      submit();
      counts = read_counts();
      questions = counts.questions;
      if (questions > question_capacity_) {
        question_capacity_ = questions + questions / 8;
        return false;
      }
      counters_["listWords"] += counts.words;
    }
    answer(questions);
    return true;
  }

  [[nodiscard]] Counts read_counts() const {
    Counts counts;
    lists_->read(std::span(&counts, 1));
    return counts;
  }

  void answer(std::uint32_t count) {
    if (count == 0) return;
    std::vector<gpu::RowQuestion> questions(count);
    questions_->read(std::span(questions));
    const auto start = std::chrono::steady_clock::now();
    const std::vector<gpu::MaskWord> words =
        judge_rows({*scene_, tree_, *samples_, *light_, std::size_t{tile_.first_row} * samples_->width}, questions);
    add_time({"exact predicates",
              std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count()});
    counters_["openPixels"] += count;
    for (const gpu::RowQuestion& question : questions) {
      counters_["openRows"] += static_cast<std::uint64_t>(std::popcount(question.low) + std::popcount(question.high));
    }
    render::grow(*device_, decided_, "decided rows", words.size() * sizeof(gpu::MaskWord));
    decided_->write(std::span<const gpu::MaskWord>(words));
    settle_.record(commands_, static_cast<std::uint32_t>(words.size()), {*masks_, *visible_, *decided_},
                   (words.size() + 63) / 64);
    submit();
  }

  void submit() {
    for (const render::PassMilliseconds& pass : commands_.submit()) add_time({pass.name, pass.milliseconds});
  }

  void add_time(const visibility::PassTime& time) {
    const auto same = std::find_if(pass_times_.begin(), pass_times_.end(),
                                   [&](const auto& other) { return other.name == time.name; });
    if (same == pass_times_.end()) {
      pass_times_.push_back(time);
    } else {
      same->milliseconds += time.milliseconds;
    }
  }

  visibility::MethodDescription description_;
  const render::Device* device_;
  render::ComputePass settle_;
  std::optional<render::ComputePass> find_edges_, scatter_;
  std::vector<std::uint32_t> constants_, walk_constants_;
  render::Commands commands_;

  const visibility::SceneFloats* scene_ = nullptr;
  float scale_ = 1;
  TriangleTree tree_;
  std::optional<render::Buffer> triangle_nodes_, triangle_corners_;
  EdgeCasters casters_;
  std::int32_t casters_without_ = -1;  // whose body is left out of them
  SideBuffers whole_;                  // of all casters, cut nowhere

  const visibility::Light* light_ = nullptr;
  visibility::LightFrame frame_;
  std::uint32_t band_words_ = 1;
  bool cut_ = false;
  std::optional<SideBuffers> front_, back_;  // where `whole_` will not do

  const visibility::ViewSamples* samples_ = nullptr;
  std::vector<Texel> view_texels_;
  std::uint32_t view_row_ = 0, view_rows_ = 0;  // what view_ holds
  std::unique_ptr<render::Buffer> view_, masks_, visible_, heads_, lists_, questions_, decided_;
  std::uint32_t list_capacity_ = kFirstWords, question_capacity_ = kFirstQuestions;
  visibility::Tile tile_;

  std::vector<visibility::PassTime> pass_times_;
  std::map<std::string, std::uint64_t> counters_;
};

}  // namespace

visibility::MethodDescription edge_scatter_description() {
  return {.name = "edge-scatter",
          .family = visibility::Family::geometry,
          .paper = "ours; after Laine et al. 2005 and Bergeron 1986",
          .output = visibility::Output::mask,
          .exact_for = "every pair of view sample and light sample, for any triangle soup (rows of a rectangle light)",
          .lights = {visibility::LightKind::rectangle},
          .any_pattern = false,
          .options = {},
          .verdict_on = verdict_on};
}

std::unique_ptr<visibility::Method> make_edge_scatter(const render::Device& device,
                                                      const visibility::MethodOptions& options) {
  return std::make_unique<EdgeScatter>(device, options);
}

}  // namespace penumbra::volumes
