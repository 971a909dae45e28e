// Edge scatter on a processor: what becomes of its lists (VectorEdges).

#include "volumes/scatter/vectors/edge_scatter_vectors.hpp"

#include "areas/form_factor_sum.hpp"
#include "base/assert.hpp"
#include "visibility/lights/unshadowed_light.hpp"
#include "volumes/scatter/vectors/vector_edges.hpp"
#include "volumes/scatter/vectors/rows.hpp"

#include <glm/common.hpp>

#include <optional>
#include <utility>

namespace penumbra::volumes {
namespace {

/// Light samples.
class VectorEdgeScatter final : public VectorEdges {
 public:
  explicit VectorEdgeScatter(visibility::MethodDescription given)
      : VectorEdges(std::move(given), "scatter edges", false) {}

 private:
  [[nodiscard]] bool cuts_casters() const override { return true; }
  void do_occluded(const ScatterInput& input, OpenJudge& judge, std::span<SampleMask> masks) override {
    scatter(input, scratch_.local(), judge, masks);
  }
};

/// rows=exact: shares of the light, and their form factors on request.
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
  void evaluate(const visibility::Tile& tile) override {
    shares_.assign(std::size_t{tile.row_count} * samples().width, std::nullopt);
    VectorEdges::evaluate(tile);
  }
  void read_masks(std::span<std::uint32_t>) override {
    PENUMBRA_ASSERT(false, "{} has no masks with rows=exact", description().name);
  }
  void read_visibility(std::span<float> visibility) override {
    // All or nothing, where no share was asked for.
    for (std::size_t i = 0; i < visibility.size(); ++i)
      visibility[i] = shares_[i].value_or(visible_samples()[i] != 0 ? 1.0F : 0.0F);
  }
  /// Evaluates the tile once more, so that a caller who needs V alone does not wait for this.
  void read_form_factors(std::span<glm::dvec3> form_factors) override {
    std::vector<float> visibility(form_factors.size());
    read_visibility(visibility);
    radiance_.assign(form_factors.size(), std::nullopt);
    repeat();
    for (std::size_t i = 0; i < form_factors.size(); ++i) {
      const std::size_t pixel = first_pixel() + i;
      const bool dark = visibility[i] == 0 || samples().triangle[pixel] == visibility::ViewSamples::kBackground;
      form_factors[i] = dark ? glm::dvec3(0) : radiance_[i] ? *radiance_[i] : unshadowed(pixel);
    }
    radiance_.clear();
  }

 private:
  [[nodiscard]] bool asks_for_light_samples() const override { return false; }
  /// A sun of one direction has no area.
  [[nodiscard]] bool is_hard() const { return light().sun && light().sun->tangent == 0; }
  /// Cells that have nothing to do with light samples.
  [[nodiscard]] GridShape grid_shape() const override {
    constexpr std::uint32_t kCells = 16;  // of a side
    if (light().kind == visibility::LightKind::rectangle)
      return {visibility::make_device_light(light(), scale()), true, kCells, kCells};
    const double to_scale = scale();
    const WindowAxes axes = axes_of(light(), window_);
    const glm::dvec3 u = to_scale * 0.5 * axes.u, v = to_scale * 0.5 * axes.v, corner = to_scale * axes.corner;
    visibility::DeviceLight frame;
    frame.center = glm::vec3(corner + u + v);
    frame.u = glm::vec3(u);
    frame.v = glm::vec3(v);
    // Three roundings to float.
    const glm::dvec3 largest = glm::abs(corner) + 2.0 * glm::abs(u) + 2.0 * glm::abs(v);
    frame.deviation = static_cast<float>(0x1p-22 * (largest.x + largest.y + largest.z));
    if (light().kind != visibility::LightKind::polygon) return {frame, true, kCells, kCells};
    return {frame,
            true,
            kCells,
            kCells,
            vectors::LightGridInput::Window{corner, to_scale * axes.u, to_scale * axes.v, axes.skew},
            static_cast<float>(2 + axes.skew)};
  }
  /// Of what nothing hides.
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
      if (!radiance_.empty()) radiance_[tile_pixel(at)] = unshadowed(at.pixel);
    }
  }
  bool decide_open(const GridSample& at) override {
    use_exact_area(at);
    return true;
  }
  void use_exact_area(const GridSample& at) {
    scratch_.local().unproven += is_hard() ? 0 : 1;
    const areas::ExactView exact = areas_.view(samples(), at.pixel);
    shares_[tile_pixel(at)] = static_cast<float>(exact.visibility);
    if (!radiance_.empty()) radiance_[tile_pixel(at)] = exact.form_factor;
  }
  void do_occluded(const ScatterInput& input, OpenJudge& judge, std::span<SampleMask>) override {
    if (is_hard()) {
      for (const GridSample& at : input.samples) use_exact_area(at);
      return;
    }
    std::vector<float> shares(input.samples.size());
    std::vector<glm::dvec3> radiance(radiance_.empty() ? 0 : input.samples.size());
    integrate({input, *region_, blocks_, scene(), light(), samples(), areas_, scale()}, scratch_.local(), judge,
              {shares, radiance});
    for (std::size_t i = 0; i < shares.size(); ++i) shares_[tile_pixel(input.samples[i])] = shares[i];
    for (std::size_t i = 0; i < radiance.size(); ++i) radiance_[tile_pixel(input.samples[i])] = radiance[i];
  }

  void count(std::map<std::string, std::uint64_t>& counters) override {
    VectorEdges::count(counters);
    for (Scratch& scratch : scratch_) counters["unprovenPixels"] += std::exchange(scratch.unproven, 0);
  }

  AreasOnDemand areas_;
  std::optional<LightRegion> region_;                // of the light
  std::optional<areas::TextureBlocks> blocks_;       // of its texture
  std::vector<std::optional<float>> shares_;         // of the tile; none: the light is behind, or below the horizon
  std::vector<std::optional<glm::dvec3>> radiance_;  // likewise; empty: not wanted
};

}  // namespace

std::unique_ptr<visibility::Method> make_edge_scatter_on_vectors(visibility::MethodDescription description,
                                                                 bool exact_rows) {
  if (exact_rows) return std::make_unique<VectorEdgeRows>(std::move(description));
  return std::make_unique<VectorEdgeScatter>(std::move(description));
}

}  // namespace penumbra::volumes
