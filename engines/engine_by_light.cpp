// SPDX-License-Identifier: Apache-2.0
// A method that delegates each light to one of two engines with equal results.

#include "engines/engine_by_light.hpp"

#include "base/assert.hpp"

#include <utility>

namespace penumbra::engines {
namespace {

class EngineByLight final : public visibility::Method {
 public:
  explicit EngineByLight(TwoEngines engines) : engines_(std::move(engines)) { usual_.method = engines_.usual(); }

  void expect_frames() override {
    expects_frames_ = true;
    usual_.method->expect_frames();
  }

  [[nodiscard]] const visibility::MethodDescription& description() const override {
    return usual_.method->description();
  }
  void prepare_mesh(const visibility::SceneFloats& scene) override {
    scene_ = &scene;
    usual_.has_mesh = other_.has_mesh = usual_.has_view = other_.has_view = false;
    samples_ = nullptr;  // the old samples belong to the previous mesh
    current_ = nullptr;
    give_mesh(usual_);
  }
  void prepare_light(const visibility::Light& light) override {
    PENUMBRA_ASSERT(scene_ != nullptr, "prepare_mesh comes first: {}", light.name);
    current_ = engines_.is_usual(light) ? &usual_ : &other_;
    if (!current_->method) {
      current_->method = engines_.other();
      if (expects_frames_) current_->method->expect_frames();
    }
    give_mesh(*current_);
    current_->method->prepare_light(light);
    if (samples_ != nullptr) give_view(*current_);
  }
  void prepare_view(const visibility::ViewSamples& samples) override {
    samples_ = &samples;
    usual_.has_view = other_.has_view = false;
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
  std::map<std::string, std::uint64_t> take_mesh_counters() override {
    std::map<std::string, std::uint64_t> all = usual_.method->take_mesh_counters();
    if (!other_.method) return all;
    for (const auto& [name, count] : other_.method->take_mesh_counters()) all[name] += count;
    return all;
  }
  [[nodiscard]] std::uint64_t memory_bytes() const override {
    return usual_.method->memory_bytes() + (other_.method ? other_.method->memory_bytes() : 0);
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

  TwoEngines engines_;
  const visibility::SceneFloats* scene_ = nullptr;
  const visibility::ViewSamples* samples_ = nullptr;
  Engine usual_, other_;
  bool expects_frames_ = false;
  Engine* current_ = nullptr;
};

}  // namespace

std::unique_ptr<visibility::Method> make_engine_by_light(TwoEngines engines) {
  return std::make_unique<EngineByLight>(std::move(engines));
}

}  // namespace penumbra::engines
