// `view-sample`: which of its two engines does a light.

#include "vsm/view_sample.hpp"

#include "base/assert.hpp"
#include "engines/engine_choice.hpp"
#include "visibility/device_light.hpp"
#include "vsm/vectors/view_sample_native.hpp"
#include "vsm/view_sample_vulkan.hpp"

#include <utility>

namespace penumbra::vsm {
namespace {

visibility::MeshVerdict verdict_on(const mesh::Diagnosis& mesh) {
  return {visibility::Verdict::exact,
          visibility::reason_with("every pair is decided exactly, whatever is wrong with the mesh", mesh,
                                  {{mesh.boundary_loops, "open boundaries, where light passes as it should"},
                                   {mesh.zero_area_triangles.count, "triangles without area, which cast nothing"}})};
}

/// Rows of a rectangle light on the processor, whatever else on the device. An engine is made, and given the mesh, when
/// a light first needs it; the processor's with the mesh.
class ViewSample final : public visibility::Method {
 public:
  explicit ViewSample(const render::Device& device) : device_(&device) {
    native_.method = make_native_view_sample(view_sample_description());
  }

  [[nodiscard]] const visibility::MethodDescription& description() const override {
    return native_.method->description();
  }
  void prepare_mesh(const visibility::SceneFloats& scene) override {
    scene_ = &scene;
    native_.has_mesh = vulkan_.has_mesh = native_.has_view = vulkan_.has_view = false;
    samples_ = nullptr;  // they are of the mesh before
    current_ = nullptr;
    give_mesh(native_);
  }
  void prepare_light(const visibility::Light& light) override {
    PENUMBRA_ASSERT(scene_ != nullptr, "prepare_mesh comes first: {}", light.name);
    const bool rows = light.kind == visibility::LightKind::rectangle && visibility::make_device_light(light, 1).rows;
    current_ = rows ? &native_ : &vulkan_;
    if (!current_->method) current_->method = make_vulkan_view_sample(*device_);
    give_mesh(*current_);
    current_->method->prepare_light(light);
    if (samples_ != nullptr) give_view(*current_);
  }
  void prepare_view(const visibility::ViewSamples& samples) override {
    samples_ = &samples;
    native_.has_view = vulkan_.has_view = false;
    if (current_ != nullptr) give_view(*current_);
  }
  [[nodiscard]] std::uint32_t max_tile_rows() const override { return current().max_tile_rows(); }
  void evaluate(const visibility::Tile& tile) override { current().evaluate(tile); }
  void read_masks(std::span<std::uint32_t> masks) override { current().read_masks(masks); }
  void read_visibility(std::span<float> visibility) override { current().read_visibility(visibility); }
  std::vector<visibility::PassTime> take_pass_times() override {
    return current_ == nullptr ? std::vector<visibility::PassTime>{} : current().take_pass_times();
  }
  [[nodiscard]] std::map<std::string, std::uint64_t> counters() const override {
    return current_ == nullptr ? std::map<std::string, std::uint64_t>{} : current().counters();
  }
  [[nodiscard]] std::uint64_t memory_bytes() const override {
    return native_.method->memory_bytes() + (vulkan_.method ? vulkan_.method->memory_bytes() : 0);
  }

 private:
  struct Engine {
    std::unique_ptr<visibility::Method> method;
    bool has_mesh = false, has_view = false;
  };
  void give_mesh(Engine& engine) {
    if (!std::exchange(engine.has_mesh, true)) engine.method->prepare_mesh(*scene_);
  }
  void give_view(Engine& engine) {
    if (!std::exchange(engine.has_view, true)) engine.method->prepare_view(*samples_);
  }
  [[nodiscard]] visibility::Method& current() const {
    PENUMBRA_ASSERT(current_ != nullptr, "{}: prepare_light comes first", description().name);
    return *current_->method;
  }

  const render::Device* device_;
  const visibility::SceneFloats* scene_ = nullptr;
  const visibility::ViewSamples* samples_ = nullptr;
  Engine native_, vulkan_;
  Engine* current_ = nullptr;
};

}  // namespace

const visibility::MethodDescription& view_sample_description() {
  static const visibility::MethodDescription description{
      .name = "view-sample",
      .family = visibility::Family::geometry,
      .paper = "Eisemann and Décoret 2007; Sintorn, Eisemann and Assarsson 2008",
      .output = visibility::Output::mask,
      .exact_for = "every pair of view sample and light sample, for any triangle soup",
      .lights = {visibility::LightKind::rectangle, visibility::LightKind::disk, visibility::LightKind::ellipse,
                 visibility::LightKind::polygon},
      .options = {engines::kEngine.description()},
      .verdict_on = verdict_on,
  };
  return description;
}

std::unique_ptr<visibility::Method> make_view_sample(const render::Device& device,
                                                     const visibility::MethodOptions& given) {
  const visibility::ParsedOptions options = visibility::parse_options(view_sample_description(), given);
  if (engines::runs_on_vectors(device, options[engines::kEngine])) return std::make_unique<ViewSample>(device);
  return make_vulkan_view_sample(device);
}

}  // namespace penumbra::vsm
