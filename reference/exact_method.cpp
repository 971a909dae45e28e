// SPDX-License-Identifier: Apache-2.0
// The method `exact`: V and the form factor of each view sample by areas/exact_area.hpp, in parallel over pixels.

#include "reference/methods.hpp"

#include "base/assert.hpp"
#include "base/error.hpp"
#include "areas/exact_area.hpp"
#include "visibility/masks/dome_method.hpp"
#include "visibility/receivers.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <limits>
#include <optional>
#include <vector>

namespace penumbra::reference {
namespace {

using areas::ExactArea, areas::ExactView, areas::Receiver, areas::SweepArithmetic;
using visibility::Light;
using visibility::SceneFloats;
using visibility::Tile;
using visibility::ViewSamples;

constexpr float kNotEvaluated = std::numeric_limits<float>::quiet_NaN();
constexpr std::uint32_t kTileRows = 8;  // rows of a tile: enough pixels for all cores, few enough to report progress

constexpr visibility::ChoiceOption kSweep{
    "sweep",
    {{"rounded", SweepArithmetic::rounded}, {"rational", SweepArithmetic::rational}},
    SweepArithmetic::rounded,
    "add areas in double on exactly projected vertices, or in rational numbers (slow)"};

class Exact final : public visibility::Method {
 public:
  explicit Exact(const visibility::MethodOptions& options);

  [[nodiscard]] const visibility::MethodDescription& description() const override { return description_; }
  void want_pixels(std::span<const std::uint32_t> pixels) override { wanted_.emplace(pixels.begin(), pixels.end()); }
  void prepare_mesh(const SceneFloats& scene) override;
  void prepare_light(const Light& light) override;
  void prepare_view(const ViewSamples& samples) override { samples_ = &samples; }
  [[nodiscard]] std::uint32_t max_tile_rows() const override { return kTileRows; }
  void evaluate(const Tile& tile) override;
  void read_visibility(std::span<float> visibility) override;
  void read_form_factors(std::span<glm::dvec3> form_factors) override;
  [[nodiscard]] std::map<std::string, std::uint64_t> counters() const override {
    return {{"viewSamples", view_samples_}, {"triangles", triangles_}, {"edges", edges_}};
  }
  [[nodiscard]] std::uint64_t memory_bytes() const override {
    return (area_ ? area_->memory_bytes() : 0) + visibility_.capacity() * sizeof(float) +
           form_factors_.capacity() * sizeof(glm::dvec3);
  }

 private:
  [[nodiscard]] bool is_question(std::size_t pixel) const;
  ExactView evaluate_pixel(std::size_t pixel);

  visibility::MethodDescription description_;
  SweepArithmetic arithmetic_ = SweepArithmetic::rounded;
  const SceneFloats* scene_ = nullptr;
  const Light* light_ = nullptr;
  const ViewSamples* samples_ = nullptr;
  std::optional<ExactArea> area_;
  std::optional<std::vector<std::uint32_t>> wanted_;  // ascending; nullopt: every pixel
  std::vector<float> visibility_;                     // of the last evaluated tile
  std::vector<glm::dvec3> form_factors_;              // of the last evaluated tile
  std::atomic<std::uint64_t> view_samples_ = 0, triangles_ = 0, edges_ = 0;
};

visibility::MeshVerdict exact_method_verdict(const mesh::Diagnosis& mesh) {
  return {
      visibility::Verdict::exact,
      visibility::reason_with("the area of the light that no triangle hides, whatever the defects of the mesh", mesh,
                              {{mesh.zero_area_triangles.count, "triangles without area, which cast no shadow"}})};
}

Exact::Exact(const visibility::MethodOptions& options) {
  description_.name = "exact";
  description_.family = visibility::Family::reference;
  description_.paper =
      "area of the union of back-projected triangles, by signed edges (after Laine et al., Soft shadow volumes for ray "
      "tracing, 2005) and a sweep";
  description_.output = visibility::Output::radiance;
  description_.exact_for =
      "any light, textured or not, and any triangle soup, up to float32 of V, and for the beauty under constant "
      "radiance, pictures of domes and textures of up to 64 x 64 texels";
  description_.lights = visibility::kEveryLight;
  description_.exact_area = visibility::ExactArea{description_.lights};
  description_.verdict_on = exact_method_verdict;
  description_.options = {kSweep.description()};
  arithmetic_ = visibility::parse_options(description_, options)[kSweep];
}

void Exact::prepare_mesh(const SceneFloats& scene) {
  scene_ = &scene;
  area_.reset();
  area_.emplace(scene);
}

void Exact::prepare_light(const Light& light) {
  PENUMBRA_ASSERT(area_.has_value(), "prepare_mesh comes first");
  visibility::check_light(description_, light);
  area_->set_light(light);
  light_ = &light;
  view_samples_ = triangles_ = edges_ = 0;
}

/// Returns false for pixels that the host's rules decide.
bool Exact::is_question(std::size_t pixel) const {
  return visibility::is_receiver(*scene_, *light_, *samples_, pixel);
}

ExactView Exact::evaluate_pixel(std::size_t pixel) {
  const Receiver receiver{samples_->p[pixel], static_cast<std::uint32_t>(samples_->triangle[pixel]),
                          samples_->facing[pixel], samples_->n[pixel]};
  const ExactView view = area_->view(receiver, arithmetic_);
  view_samples_.fetch_add(1, std::memory_order_relaxed);
  triangles_.fetch_add(view.work.triangles, std::memory_order_relaxed);
  edges_.fetch_add(view.work.edges, std::memory_order_relaxed);
  return view;
}

void Exact::evaluate(const Tile& tile) {
  PENUMBRA_ASSERT(samples_ != nullptr && area_.has_value(), "prepare_light and prepare_view come first");
  PENUMBRA_ASSERT(tile.first_row + tile.row_count <= samples_->height, "rows {} + {} of {}", tile.first_row,
                  tile.row_count, samples_->height);
  const std::size_t first = std::size_t{tile.first_row} * samples_->width;
  const std::size_t end = first + std::size_t{tile.row_count} * samples_->width;
  visibility_.assign(end - first, wanted_ ? kNotEvaluated : 1.0f);
  form_factors_.assign(end - first, glm::dvec3(wanted_ ? kNotEvaluated : 0.0f));
  std::vector<std::size_t> questions;
  const auto ask = [&](std::size_t pixel) {
    visibility_[pixel - first] = 1;
    form_factors_[pixel - first] = glm::dvec3(0);
    if (is_question(pixel)) questions.push_back(pixel);
  };
  if (wanted_) {
    for (auto pixel = std::ranges::lower_bound(*wanted_, first); pixel != wanted_->end() && *pixel < end; ++pixel)
      ask(*pixel);
  } else {
    for (std::size_t pixel = first; pixel < end; ++pixel) ask(pixel);
  }
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, questions.size(), 4), [&](const auto& range) {
    for (std::size_t i = range.begin(); i != range.end(); ++i) {
      const ExactView view = evaluate_pixel(questions[i]);
      visibility_[questions[i] - first] = static_cast<float>(view.visibility);
      form_factors_[questions[i] - first] = view.form_factor;
    }
  });
}

void Exact::read_visibility(std::span<float> visibility) {
  PENUMBRA_ASSERT(visibility.size() == visibility_.size(), "{} pixels asked for, {} evaluated", visibility.size(),
                  visibility_.size());
  std::ranges::copy(visibility_, visibility.begin());
}

void Exact::read_form_factors(std::span<glm::dvec3> form_factors) {
  PENUMBRA_ASSERT(form_factors.size() == form_factors_.size(), "{} pixels asked for, {} evaluated", form_factors.size(),
                  form_factors_.size());
  std::ranges::copy(form_factors_, form_factors.begin());
}

}  // namespace

std::unique_ptr<visibility::Method> make_exact(const visibility::MethodOptions& options) {
  return visibility::with_domes(std::make_unique<Exact>(options));
}

}  // namespace penumbra::reference
