// SPDX-License-Identifier: Apache-2.0
// Edge scatter on a processor: evaluation of its lists (VectorEdges), by light samples or by areas.

#include "volumes/scatter/vectors/edge_scatter_vectors.hpp"

#include "areas/form_factor_sum.hpp"
#include "base/assert.hpp"
#include "visibility/lights/unshadowed_light.hpp"
#include "visibility/lights/whole_form_factors.hpp"
#include "volumes/edges/vectors/vector_edges.hpp"
#include "volumes/scatter/vectors/integrate.hpp"
#include "volumes/scatter/vectors/points.hpp"
#include "volumes/scatter/vectors/rows.hpp"
#include "volumes/scatter/vectors/scatter.hpp"

#include <glm/common.hpp>
#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <atomic>
#include <optional>
#include <utility>

namespace penumbra::volumes {
namespace {

/// Evaluation by light samples.
class VectorEdgeScatter final : public VectorEdges {
 public:
  explicit VectorEdgeScatter(visibility::MethodDescription given)
      : VectorEdges(std::move(given), "scatter edges", false) {}

 private:
  [[nodiscard]] bool cuts_casters() const override { return true; }
  void do_occluded(const ClusterInput& input, OpenJudge& judge, std::span<SampleMask> masks) override {
    if (input.grid.tiles)
      scatter_points(input, scratch_.local(), points_.local(), judge, masks);
    else
      scatter(input, scratch_.local(), rows_.local(), judge, masks);
  }

  tbb::enumerable_thread_specific<RowScratch> rows_;
  tbb::enumerable_thread_specific<PointScratch> points_;
};

/// rows=exact: visible fractions of the light, and form factors on request.
class VectorEdgeRows final : public VectorEdges {
 public:
  explicit VectorEdgeRows(visibility::MethodDescription given) : VectorEdges(std::move(given), "scatter edges", true) {}

  void prepare_mesh(const visibility::SceneFloats& scene) override {
    VectorEdges::prepare_mesh(scene);
    areas_.prepare_mesh(scene, tree());
  }
  void prepare_light(const visibility::Light& light) override {
    areas_.prepare_light(light);
    window_ = window_of(light);
    VectorEdges::prepare_light(light);
    region_.emplace(make_light_region(light, window_, grid(), scale()));
    blocks_.reset();
    if (light.texture) blocks_.emplace(*light.texture);
  }
  void want_form_factors(bool wanted) override { wants_radiance_ = finds_radiance_ = wanted; }
  void evaluate(const visibility::Tile& tile) override {
    partly_seen_.clear();
    shares_.assign(std::size_t{tile.row_count} * samples().width, std::nullopt);
    VectorEdges::evaluate(tile);
  }
  void read_masks(std::span<std::uint32_t>) override {
    PENUMBRA_ASSERT(false, "{} has no masks with rows=exact", description().name);
  }
  void read_visibility(std::span<float> visibility) override {
    // Pixels without a computed fraction are fully visible or hidden.
    for (std::size_t i = 0; i < visibility.size(); ++i) visibility[i] = share_of(i);
  }
  void read_form_factors(std::span<glm::dvec3> form_factors) override {
    if (!finds_radiance_) {  // computed again, so that callers who need V alone did not wait for it
      finds_radiance_ = true;
      repeat();
      finds_radiance_ = wants_radiance_;
    }
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, form_factors.size(), 1024),
                      [&](const auto& range) { shade_unshadowed(range.begin(), range.end(), form_factors); });
    for (const PartlySeen& seen : partly_seen_) {
      for (const auto& [pixel, form_factor] : seen) form_factors[pixel] = form_factor;
    }
    if (!finds_radiance_) partly_seen_.clear();
  }

 private:
  [[nodiscard]] bool asks_for_light_samples() const override { return false; }
  [[nodiscard]] bool cuts_casters() const override { return true; }
  /// Returns whether the light is a sun of one direction, which has no area.
  [[nodiscard]] bool is_hard() const { return light().sun && light().sun->tangent == 0; }
  /// Returns a grid of cells independent of light samples.
  [[nodiscard]] GridShape grid_shape() const override {
    constexpr std::uint32_t kCells = 16;  // cells along each side
    if (is_parallelogram(light().kind)) return {visibility::make_device_light(light(), scale()), true, kCells, kCells};
    const double to_scale = scale();
    const WindowAxes axes = axes_of(light(), window_);
    const glm::dvec3 u = to_scale * 0.5 * axes.u, v = to_scale * 0.5 * axes.v, corner = to_scale * axes.corner;
    visibility::DeviceLight frame;
    frame.center = glm::vec3(corner + u + v);
    frame.u = glm::vec3(u);
    frame.v = glm::vec3(v);
    // The deviation is that of three roundings to float.
    const glm::dvec3 largest = glm::abs(corner) + 2.0 * glm::abs(u) + 2.0 * glm::abs(v);
    frame.deviation = static_cast<float>(0x1p-22 * (largest.x + largest.y + largest.z));
    if (!is_polygon(light().kind)) return {frame, true, kCells, kCells};
    return {frame,
            true,
            kCells,
            kCells,
            vectors::LightGridInput::Window{corner, to_scale * axes.u, to_scale * axes.v, axes.skew},
            static_cast<float>(2 + axes.skew)};
  }
  /// Returns V of a pixel of the tile.
  [[nodiscard]] float share_of(std::size_t pixel) const {
    return shares_[pixel].value_or(visible_samples()[pixel] != 0 ? 1.0F : 0.0F);
  }
  /// Computes form factors of the tile's pixels from `begin` to `end` for which float32 decided that all or nothing of
  /// the light is visible.
  void shade_unshadowed(std::size_t begin, std::size_t end, std::span<glm::dvec3> form_factors) const {
    std::vector<std::uint32_t> wholes;
    for (std::size_t i = begin; i < end; ++i) {
      form_factors[i] = glm::dvec3(0);
      const std::size_t pixel = first_pixel() + i;
      if (share_of(i) != 1 || samples().triangle[pixel] == visibility::ViewSamples::kBackground) continue;
      if (blocks_)
        form_factors[i] = unshadowed(pixel);
      else
        wholes.push_back(static_cast<std::uint32_t>(pixel));
    }
    std::vector<double> found(wholes.size());
    visibility::whole_form_factors(light(), {samples().p, samples().n, wholes}, found);
    for (std::size_t k = 0; k < wholes.size(); ++k) form_factors[wholes[k] - first_pixel()] = glm::dvec3(found[k]);
  }
  /// Returns the form factor of the unoccluded light.
  [[nodiscard]] glm::dvec3 unshadowed(std::size_t pixel) const {
    const visibility::UnshadowedLight seen(light(), samples().p[pixel], samples().n[pixel]);
    areas::FormFactorSum sum(seen, blocks_);
    sum.add_whole();
    return sum.sum();
  }

  void do_unoccluded(const LightGrid& grid, std::span<const GridSample> view_samples, OpenJudge& judge,
                     std::span<SampleMask>) override {
    RowSum rows(grid, *region_, scene(), scale());
    for (const GridSample& at : view_samples) {
      std::optional<double> share = 1;
      if (is_hard() && at.straddles) {
        share = std::nullopt;
      } else if (at.straddles) {
        rows.set_view_sample(at);
        rows.add_horizon(judge.horizon(at));
        share = rows.visible_share(0, nullptr);
      }
      if (!share) {
        use_exact_area(at);
        continue;
      }
      shares_[tile_pixel(at)] = static_cast<float>(*share);
      if (finds_radiance_ && is_partial(*share)) set_radiance(at, unshadowed(at.pixel));
    }
  }
  bool decide_open(const GridSample& at) override {
    use_exact_area(at);
    return true;
  }
  void use_exact_area(const GridSample& at) {
    if (!is_hard()) unproven_.fetch_add(1, std::memory_order_relaxed);
    const areas::ExactView exact = areas_.view(samples(), at.pixel);
    shares_[tile_pixel(at)] = static_cast<float>(exact.visibility);
    if (finds_radiance_ && is_partial(exact.visibility)) set_radiance(at, exact.form_factor);
  }
  static bool is_partial(double share) { return static_cast<float>(share) != 0 && static_cast<float>(share) != 1; }
  void set_radiance(const GridSample& at, const glm::dvec3& form_factor) {
    partly_seen_.local().emplace_back(static_cast<std::uint32_t>(tile_pixel(at)), form_factor);
  }
  void do_occluded(const ClusterInput& input, OpenJudge& judge, std::span<SampleMask>) override {
    if (is_hard()) {
      for (const GridSample& at : input.samples) use_exact_area(at);
      return;
    }
    std::vector<float> shares(input.samples.size());
    std::vector<glm::dvec3> radiance(finds_radiance_ ? input.samples.size() : 0);
    const std::size_t unproven = integrate({input, *region_, blocks_, scene(), light(), samples(), areas_, scale()},
                                           scratch_.local(), judge, {shares, radiance});
    unproven_.fetch_add(unproven, std::memory_order_relaxed);
    for (std::size_t i = 0; i < shares.size(); ++i) {
      shares_[tile_pixel(input.samples[i])] = shares[i];
      if (finds_radiance_ && is_partial(double{shares[i]})) set_radiance(input.samples[i], radiance[i]);
    }
  }

  void count(std::map<std::string, std::uint64_t>& counters) override {
    VectorEdges::count(counters);
    counters["unprovenPixels"] += unproven_.exchange(0);
  }

  AreasOnDemand areas_;
  std::atomic<std::uint64_t> unproven_ = 0;     // number of view samples whose fraction double could not prove
  std::optional<LightRegion> region_;           // region of the light
  std::optional<areas::TextureBlocks> blocks_;  // blocks of the light's texture
  std::vector<std::optional<float>> shares_;    // for the tile; nullopt: the light is behind, or below the horizon
  bool wants_radiance_ = false;                 // form factors are requested after each tile
  bool finds_radiance_ = false;                 // form factors are computed together with fractions
  using PartlySeen = std::vector<std::pair<std::uint32_t, glm::dvec3>>;
  tbb::enumerable_thread_specific<PartlySeen> partly_seen_;  // pixels of the tile that see a part of the light, with
                                                             // their form factors
};

}  // namespace

std::unique_ptr<visibility::Method> make_edge_scatter_on_vectors(visibility::MethodDescription description,
                                                                 bool exact_rows) {
  if (exact_rows) return std::make_unique<VectorEdgeRows>(std::move(description));
  return std::make_unique<VectorEdgeScatter>(std::move(description));
}

}  // namespace penumbra::volumes
