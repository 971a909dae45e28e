// Heckbert and Herf 1997, "Simulating soft shadows with graphics hardware": V is the mean of hard shadows from points
// of the light. Departures: they draw the blended shadow into a texture a receiver polygon; here each light sample has
// a shadow map (Williams 1978), looked up at the view samples, and its answer is kept as a bit of its own.
//
// Maps of all light samples together would not fit into memory, so evaluate renders them in batches and looks each
// batch up at once. A batch is a power of two of light samples, at most 32: no batch lies across two words of a mask.

#include "maps/accumulate.hpp"

#include "base/assert.hpp"
#include "maps/accumulate.comp.spv.hpp"
#include "maps/accumulate.shared.h"
#include "maps/caster_maps.hpp"
#include "maps/center_map.hpp"
#include "maps/map_fit.hpp"
#include "maps/mesh_verdict.hpp"
#include "maps/options.hpp"
#include "maps/receivers.hpp"
#include "render/compute_pass.hpp"
#include "visibility/visible_share.hpp"

#include <algorithm>
#include <bit>

namespace penumbra::maps {
namespace {

constexpr std::uint32_t kBitsPerWord = 32;
/// No batch of several light samples takes more, and no tile's masks.
constexpr std::uint64_t kBatchBytes = std::uint64_t{128} << 20, kMaskBytes = std::uint64_t{256} << 20;

visibility::MeshVerdict verdict_on(const mesh::Diagnosis& mesh) {
  return judge_for_maps("each pair within half a texel of a shadow's edge may be wrong", mesh);
}

visibility::MethodDescription describe() {
  return {.name = "accumulate",
          .family = visibility::Family::image,
          .paper = "Heckbert and Herf 1997",
          .output = visibility::Output::mask,
          .exact_for =
              "nothing; in the limit of large maps every pair of view sample and light sample, any soup of "
              "triangles that can be rasterised",
          .lights = planar_lights(),
          .options = map_option_descriptions(),
          .verdict_on = verdict_on};
}

class Accumulate final : public visibility::Method {
 public:
  Accumulate(const render::Device& device, const visibility::MethodOptions& options)
      : device_(&device),
        description_(describe()),
        options_((visibility::check_options(description_, options), parse_map_options(device, description_, options))),
        casters_(device, options_.size),
        pass_(device, {.name = "accumulate look-up",
                       .spirv = shaders::kAccumulateComp,
                       .push_bytes = sizeof(gpu::AccumulatePush),
                       .constants = {}}) {}

  [[nodiscard]] const visibility::MethodDescription& description() const override { return description_; }

  void prepare_mesh(const visibility::SceneFloats& scene) override {
    scene_ = &scene;
    casters_.upload(scene);
  }
  void prepare_light(const visibility::Light& light) override;
  void prepare_view(const visibility::ViewSamples& samples) override {
    PENUMBRA_ASSERT(scene_ != nullptr, "{}: prepare_view before prepare_mesh", description_.name);
    receivers_.upload(*device_, *scene_, samples);
  }
  [[nodiscard]] std::uint32_t max_tile_rows() const override;
  void evaluate(const visibility::Tile& tile) override;
  void read_masks(std::span<std::uint32_t> masks) override;
  void read_visibility(std::span<float> visibility) override;

  std::vector<visibility::PassTime> take_pass_times() override { return times_.take(); }
  [[nodiscard]] std::map<std::string, std::uint64_t> counters() const override { return counters_; }
  [[nodiscard]] std::uint64_t memory_bytes() const override;

 private:
  /// Records maps of light samples first … first + count − 1, in submissions that can be timed.
  void render_batch(render::Commands& commands, std::uint32_t first, std::uint32_t count);

  const render::Device* device_;
  visibility::MethodDescription description_;
  MapOptions options_;
  CasterMaps casters_;
  render::ComputePass pass_;
  Receivers receivers_;
  visibility::PassTimes times_;
  std::map<std::string, std::uint64_t> counters_;
  const visibility::SceneFloats* scene_ = nullptr;
  const visibility::Light* light_ = nullptr;
  LightFrame frame_;
  FittedViews fitted_;
  std::uint32_t batch_ = 1;        ///< light samples at a time
  std::uint32_t tile_pixels_ = 0;  ///< of the tile last evaluated
  std::unique_ptr<render::Buffer> views_, depths_, masks_;
};

void Accumulate::prepare_light(const visibility::Light& light) {
  visibility::check_light(description_, light);
  PENUMBRA_ASSERT(scene_ != nullptr, "{}: prepare_light before prepare_mesh", description_.name);
  light_ = &light;
  frame_ = frame_of(light);
  fitted_ = fit_views(*scene_, light, frame_, light.points, options_.size);
  const std::uint32_t faces = std::max(fitted_.faces, 1u);
  check_faces_fit(*device_, options_.size, faces);

  const std::uint64_t point_bytes = std::uint64_t{faces} * options_.size * options_.size * sizeof(float);
  const std::uint64_t most = std::min(kBatchBytes, device_->limits().max_storage_buffer_range) / point_bytes;
  batch_ = std::bit_floor(std::clamp(static_cast<std::uint32_t>(most), 1u, kBitsPerWord));
  batch_ = std::min(batch_, std::bit_ceil(light.sample_count()));
  render::grow(*device_, depths_, "map depths", point_bytes * batch_);
  render::grow(*device_, views_, "map views", fitted_.views.size() * sizeof(gpu::LightView));
  views_->write<gpu::LightView>(fitted_.views);
  counters_ = {{"maps", 0}, {"mapFaces", 0}, {"casters", casters_.caster_count()}, {"mapsPerBatch", batch_}};
}

std::uint32_t Accumulate::max_tile_rows() const {
  PENUMBRA_ASSERT(light_ != nullptr, "{}: max_tile_rows before prepare_light", description_.name);
  // Every tile renders all maps again: tiles are as high as memory allows.
  const std::uint64_t row_bytes =
      std::uint64_t{std::max(receivers_.width(), 1u)} * light_->words_per_mask() * sizeof(std::uint32_t);
  const std::uint32_t possible = receivers_.max_rows(*device_, light_->words_per_mask() * sizeof(std::uint32_t));
  return static_cast<std::uint32_t>(std::clamp<std::uint64_t>(kMaskBytes / row_bytes, 1, possible));
}

void Accumulate::render_batch(render::Commands& commands, std::uint32_t first, std::uint32_t count) {
  std::uint32_t recorded = 0;
  for (std::uint32_t k = 0; k < count; ++k) {
    if (recorded + fitted_.faces > kFacesPerSubmission && recorded > 0) {
      times_.add(commands.submit());
      recorded = 0;
    }
    casters_.record(commands, fitted_.views[first + k], frame_, light_->index, *depths_,
                    std::uint64_t{k} * fitted_.faces);
    recorded += fitted_.faces;
  }
  counters_["maps"] += count;
  counters_["mapFaces"] += std::uint64_t{count} * fitted_.faces;
}

void Accumulate::evaluate(const visibility::Tile& tile) {
  PENUMBRA_ASSERT(light_ != nullptr, "{}: evaluate before prepare_light", description_.name);
  tile_pixels_ = tile.row_count * receivers_.width();
  if (tile_pixels_ == 0) return;
  const std::uint32_t words = light_->words_per_mask(), samples = light_->sample_count();
  render::grow(*device_, masks_, "map masks", std::uint64_t{tile_pixels_} * words * sizeof(std::uint32_t));

  gpu::AccumulatePush push{.lookup = {.frame = frame_.rounded(),
                                      .bias = static_cast<float>(options_.bias),
                                      .size = options_.size,
                                      .two_sided = light_->two_sided ? 1u : 0u,
                                      .first_receiver = 0,
                                      .receiver_count = 0,
                                      .first_result = 0},
                           .words_per_mask = words,
                           .first_sample = 0,
                           .sample_count = 0,
                           .faces = fitted_.faces};
  const std::vector<Receivers::Part> parts = receivers_.parts(tile);
  render::Commands commands(*device_);
  for (std::uint32_t first = 0; first < samples; first += batch_) {
    push.first_sample = first;
    push.sample_count = std::min(batch_, samples - first);
    render_batch(commands, first, push.sample_count);
    for (const Receivers::Part& part : parts) {
      push.lookup.first_receiver = part.first_receiver;
      push.lookup.receiver_count = part.count;
      push.lookup.first_result = part.first_result;
      pass_.record(commands, push, {*part.receivers, *views_, *depths_, *masks_}, part.groups());
    }
    times_.add(commands.submit());
  }
}

void Accumulate::read_masks(std::span<std::uint32_t> masks) {
  const std::size_t words = std::size_t{tile_pixels_} * (light_ == nullptr ? 0 : light_->words_per_mask());
  PENUMBRA_ASSERT(masks.size() == words, "{} words for masks of {}", masks.size(), words);
  if (!masks.empty()) masks_->read(masks);
}

void Accumulate::read_visibility(std::span<float> visibility) {
  PENUMBRA_ASSERT(visibility.size() == tile_pixels_, "{} values for a tile of {} pixels", visibility.size(),
                  tile_pixels_);
  if (visibility.empty()) return;
  const std::size_t words = light_->words_per_mask();
  std::vector<std::uint32_t> masks(visibility.size() * words);
  read_masks(masks);
  visibility::visible_shares(*light_, masks, visibility);
}

std::uint64_t Accumulate::memory_bytes() const {
  std::uint64_t bytes = casters_.memory_bytes() + receivers_.memory_bytes();
  for (const auto* buffer : {&views_, &depths_, &masks_}) bytes += *buffer ? (*buffer)->bytes() : 0;
  return bytes;
}

}  // namespace

visibility::MethodDescription accumulate_description() {
  return describe();
}

std::unique_ptr<visibility::Method> make_accumulate(const render::Device& device,
                                                    const visibility::MethodOptions& options) {
  return std::make_unique<Accumulate>(device, options);
}

}  // namespace penumbra::maps
