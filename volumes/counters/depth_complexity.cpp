// S. Laine, T. Aila, U. Assarsson, J. Lehtinen, T. Akenine-Möller, Soft shadow volumes for ray tracing, 2005: counters
// of light samples changed at silhouette edges. We depart from it (docs/depth-complexity.md): candidates come from a
// hierarchy of edges instead of wedges in a hemicube, signed multiplicities make it right for any soup, the constant is
// counted at a certified corner, and what rounding leaves open is decided exactly.

#include "volumes/counters/depth_complexity.hpp"

#include "base/assert.hpp"
#include "base/error.hpp"
#include "render/compute_pass.hpp"
#include "visibility/light_frame.hpp"
#include "visibility/visible_share.hpp"
#include "volumes/counters/count_edges.comp.spv.hpp"
#include "volumes/counters/depth_judge.hpp"
#include "volumes/edges/edge_lists.hpp"
#include "volumes/counters/packed_counters.hpp"
#include "volumes/edges/settle_rows.comp.spv.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <bit>
#include <optional>

namespace penumbra::volumes {
namespace {

constexpr std::uint32_t kBlock = 8;           // pixels, as in edge_scatter.glsl
constexpr std::uint32_t kQueued = 64;         // edges, as in count_edges.comp
constexpr std::size_t kMostEdges = 1U << 29;  // |k_e| of a record is at most 2: no counter can overflow

enum class Variant { soup, laine, forest };

constexpr visibility::ChoiceOption kVariant{
    "variant",
    {{"soup", Variant::soup}, {"laine", Variant::laine}, {"forest", Variant::forest}},
    Variant::soup,
    "soup: signed multiplicities, any mesh; laine: silhouettes and one reference ray, closed meshes; forest: "
    "silhouettes of the light's centre and hard volumes, at most 16 light samples"};
constexpr auto kCrop = visibility::flag_option(
    "crop", true,
    "soup, laine: leave out edges that are no silhouettes as seen from a group of view samples; V is the same");
constexpr visibility::ChoiceOption kCounterBits{"counter-bits",
                                                {{"6", 6U}, {"8", 8U}, {"16", 16U}},
                                                16U,
                                                "forest: of a packed counter; where it overflows, pairs are exact"};

visibility::MeshVerdict verdict_on(const mesh::Diagnosis& mesh) {
  return {
      visibility::Verdict::exact,
      visibility::reason_with(
          "signed multiplicities hold for any soup, and every pair is decided exactly (variant=forest: only where no "
          "triangle's plane passes through the light)",
          mesh,
          {{mesh.boundary_loops, "open boundaries, where variant=laine is only approximate"},
           {mesh.non_manifold_edges.count, "non-manifold edges, where variant=laine is only approximate"},
           {mesh.zero_area_triangles.count,
            "triangles without area, which cast nothing, and where variant=laine is only approximate"}})};
}

/// Throws UsageError where the chosen variant does not have an option that is given.
visibility::ParsedOptions parse(const visibility::MethodDescription& description,
                                const visibility::MethodOptions& given) {
  visibility::ParsedOptions options = visibility::parse_options(description, given);
  const bool forest = options[kVariant] == Variant::forest;
  if (forest ? options.given(kCrop) : options.given(kCounterBits)) {
    throw UsageError("depth-complexity: variant={} has no option {}", kVariant.name_of(options[kVariant]),
                     forest ? kCrop.name() : kCounterBits.name());
  }
  return options;
}

class DepthComplexity final : public DepthCounters {
 public:
  DepthComplexity(const render::Device& device, Variant variant, bool crops, bool keeps_depths)
      : description_(depth_complexity_description()),
        variant_(variant),
        keeps_depths_(keeps_depths),
        device_(&device),
        edges_(device, description_.name, crops),
        settle_(device,
                {.name = "settle samples", .spirv = shaders::kSettleRowsComp, .push_bytes = sizeof(std::uint32_t)}),
        commands_(device) {}

  [[nodiscard]] const visibility::MethodDescription& description() const override { return description_; }

  void prepare_mesh(const visibility::SceneFloats& scene) override {
    scene_ = &scene;
    edges_.prepare_mesh(scene);
    if (edges_.edge_count() <= kMostEdges) return;
    throw ResourceError("depth-complexity counts up to {} edges without overflow; this scene has {}", kMostEdges,
                        edges_.edge_count());
  }

  void prepare_light(const visibility::Light& light) override {
    visibility::check_light(description_, light);
    check_shared_memory(light);
    light_ = &light;
    const visibility::LightFrame frame = visibility::make_light_frame(light, edges_.scale());
    edges_.prepare_light(light, frame);
    std::vector<glm::vec2> places;
    for (const glm::vec2& at : frame.coordinates) places.push_back(at + 1.0F);
    places_.emplace(render::make_buffer<glm::vec2>(*device_, "places of light samples", places));
    counters_.clear();
    question_retries_ = 0;
    build_pass();
  }

  void prepare_view(const visibility::ViewSamples& samples) override {
    samples_ = &samples;
    edges_.prepare_view(samples);
    if (light_ != nullptr && max_tile_rows() >= samples.height) edges_.load({0, samples.height});
  }

  [[nodiscard]] std::uint32_t max_tile_rows() const override {
    PENUMBRA_ASSERT(samples_ != nullptr && light_ != nullptr, "prepare_light and prepare_view come first");
    const std::uint64_t of_counters = keeps_depths_ ? 4ULL * light_->sample_count() : 0;
    const std::uint64_t per_pixel =
        std::max<std::uint64_t>({4ULL * light_->words_per_mask(), device::ViewUpload::kBytesPerPixel, of_counters});
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
    tile_ = tile;
    edges_.load(tile);
    render::grow(*device_, masks_, "masks", pixels() * light_->words_per_mask() * 4);
    render::grow(*device_, visible_, "visible light samples", pixels() * 4);
    render::grow(*device_, depths_, "counters", keeps_depths_ ? pixels() * light_->sample_count() * 4 : 4);
    while (!try_tile()) ++question_retries_;
    if (edges_.retries() + question_retries_ > 0) counters_["listRetries"] = edges_.retries() + question_retries_;
  }

  void read_masks(std::span<std::uint32_t> masks) override { masks_->read(masks); }

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

  void read_counters(std::span<std::int32_t> counters) override {
    PENUMBRA_ASSERT(keeps_depths_ && counters.size() == pixels() * light_->sample_count(), "{}", counters.size());
    depths_->read(counters);
    for (const gpu::DepthQuestion& question : asked_) {
      for (std::uint32_t i = 0; i < 32; ++i) {
        if ((question.bits >> i & 1U) == 0) continue;
        counters[std::size_t{question.pixel} * light_->sample_count() + question.word * 32 + i] = kNoCounter;
      }
    }
  }

  std::vector<visibility::PassTime> take_pass_times() override { return times_.take(); }
  [[nodiscard]] std::map<std::string, std::uint64_t> counters() const override { return counters_; }
  [[nodiscard]] std::uint64_t memory_bytes() const override { return device_->peak_bytes(); }

 private:
  /// One counter a light sample, two bits of masks, and the queue of edges.
  void check_shared_memory(const visibility::Light& light) const {
    const std::uint64_t needed = 4ULL * light.sample_count() + 8ULL * light.words_per_mask() + 24ULL * kQueued;
    if (needed <= device_->limits().max_shared_memory) return;
    throw InputError(
        "light \"{}\": {} light samples need {} bytes of shared memory, {} has {}; take fewer, or view-sample",
        light.name, light.sample_count(), needed, device_->info().name, device_->limits().max_shared_memory);
  }

  void build_pass() {
    const std::uint32_t lanes = device_->limits().subgroup_size;
    const std::vector<std::uint32_t> constants{lanes,
                                               lanes,
                                               light_->sample_count(),
                                               light_->words_per_mask(),
                                               variant_ == Variant::laine ? 1U : 0U,
                                               keeps_depths_ ? 1U : 0U};
    if (count_ && constants == constants_) return;
    count_.emplace(*device_, render::ComputePassOptions{.name = "count edges",
                                                        .spirv = shaders::kCountEdgesComp,
                                                        .push_bytes = sizeof(gpu::ScatterPush),
                                                        .constants = constants,
                                                        .full_subgroups = true});
    constants_ = constants;
  }

  [[nodiscard]] std::uint64_t pixels() const { return std::uint64_t{tile_.row_count} * samples_->width; }

  /// False when the list of questions was too short; it has grown then.
  bool try_tile() {
    if (variant_ == Variant::laine) {  // each view sample asks for its reference ray
      question_capacity_ = std::max(question_capacity_, static_cast<std::uint32_t>(pixels() + pixels() / 8));
    }
    render::grow(*device_, questions_, "open samples", std::uint64_t{question_capacity_} * sizeof(gpu::DepthQuestion));
    if (keeps_depths_) commands_.fill(*depths_, static_cast<std::uint32_t>(kNoCounter));
    gpu::ScatterPush push{};
    push.rows = push.columns = 2;  // cells as large as the frame's half-sizes
    push.question_capacity = question_capacity_;
    std::uint32_t questions = 0;
    for (const float side : {1.0F, -1.0F}) {
      if (side < 0 && !light_->two_sided) continue;
      counters_["listWords"] += edges_.find(commands_, push, side, questions);
      times_.add(edges_.times());
      count_->record(commands_, push,
                     {edges_.view(), edges_.heads(), edges_.lists(), edges_.slots(side, 0), edges_.slots(side, 1),
                      edges_.slots(side, 2), edges_.slots(side, 3), edges_.slots(side, 4), edges_.slots(side, 5),
                      edges_.triangle_corners(0), edges_.triangle_corners(1), edges_.triangle_corners(2), *places_,
                      *masks_, *visible_, *questions_, *depths_},
                     pixels());
      times_.add(commands_.submit());
      questions = edges_.question_count();
      if (questions > question_capacity_) {
        question_capacity_ = questions + questions / 8;
        return false;
      }
    }
    answer(questions);
    return true;
  }

  void answer(std::uint32_t count) {
    asked_.resize(count);
    if (count == 0) return;
    questions_->read(std::span(asked_));
    const std::size_t first_pixel = std::size_t{tile_.first_row} * samples_->width;
    const DepthAnswers answers = times_.add("exact predicates", [&] {
      return judge_depths({*scene_, edges_.tree(), *samples_, *light_, first_pixel}, asked_);
    });
    for (const gpu::DepthQuestion& question : asked_) {
      const bool reference = (question.word & gpu::kReference) != 0;
      ++counters_[reference ? "referenceRays" : "openWords"];
      counters_["openPairs"] += static_cast<std::uint64_t>(std::popcount(question.bits));
    }
    settle(answers.dark);
    settle(answers.decided);
  }

  void settle(const std::vector<gpu::MaskWord>& words) {
    const std::size_t at_once = device_->limits().max_storage_buffer_range / sizeof(gpu::MaskWord);
    for (std::size_t first = 0; first < words.size(); first += at_once) {
      const auto part = std::span(words).subspan(first, std::min(at_once, words.size() - first));
      render::grow(*device_, decided_, "decided samples", part.size_bytes());
      decided_->write(part);
      settle_.record(commands_, static_cast<std::uint32_t>(part.size()), {*masks_, *visible_, *decided_},
                     (part.size() + 63) / 64);
      times_.add(commands_.submit());
    }
  }

  visibility::MethodDescription description_;
  Variant variant_;
  bool keeps_depths_;
  const render::Device* device_;
  EdgeLists edges_;
  render::ComputePass settle_;
  std::optional<render::ComputePass> count_;
  std::vector<std::uint32_t> constants_;
  render::Commands commands_;

  const visibility::SceneFloats* scene_ = nullptr;
  const visibility::Light* light_ = nullptr;
  const visibility::ViewSamples* samples_ = nullptr;
  visibility::Tile tile_;
  std::optional<render::Buffer> places_;
  std::unique_ptr<render::Buffer> masks_, visible_, depths_, questions_, decided_;
  std::uint32_t question_capacity_ = 1U << 14;  // grows
  std::uint64_t question_retries_ = 0;
  std::vector<gpu::DepthQuestion> asked_;  // of the tile

  visibility::PassTimes times_;
  std::map<std::string, std::uint64_t> counters_;
};

}  // namespace

visibility::MethodDescription depth_complexity_description(const visibility::MethodOptions& options) {
  using visibility::LightKind;
  visibility::MethodDescription description{
      .name = "depth-complexity",
      .family = visibility::Family::geometry,
      .paper = "Laine et al. 2005; Lehtinen et al. 2006; Forest et al. 2008; any soup: ours, after Bergeron 1986",
      .output = visibility::Output::mask,
      .exact_for =
          "variant=soup: every pair of view sample and light sample, for any triangle soup; variant=laine: "
          "the same for closed meshes whose triangles all have an area, approximate for others; variant=forest: the "
          "same where no occluding triangle's "
          "plane passes through the light, too bright elsewhere",
      .lights = {LightKind::rectangle, LightKind::disk, LightKind::polygon},
      .options = {kVariant.description(), kCrop.description(), kCounterBits.description()},
      .verdict_on = verdict_on};
  parse(description, options);
  return description;
}

std::unique_ptr<visibility::Method> make_depth_complexity(const render::Device& device,
                                                          const visibility::MethodOptions& given) {
  const visibility::ParsedOptions options = parse(depth_complexity_description(), given);
  if (options[kVariant] == Variant::forest) return make_packed_counters(device, options[kCounterBits]);
  return std::make_unique<DepthComplexity>(device, options[kVariant], options[kCrop], false);
}

std::unique_ptr<DepthCounters> make_depth_counters(const render::Device& device) {
  return std::make_unique<DepthComplexity>(device, Variant::soup, true, true);
}

}  // namespace penumbra::volumes
