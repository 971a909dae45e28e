// Edge scatter on a processor: its lists and what becomes of them. The rest is vectors::MaskMethod.

#include "volumes/scatter/vectors/edge_scatter_vectors.hpp"

#include "areas/form_factor_sum.hpp"
#include "base/assert.hpp"
#include "engines/vectors/horizon.hpp"
#include "engines/vectors/mask_method.hpp"
#include "visibility/lights/unshadowed_light.hpp"
#include "volumes/edges/edge_sides.hpp"
#include "volumes/scatter/vectors/cut.hpp"
#include "volumes/scatter/vectors/rows.hpp"
#include "volumes/scatter/vectors/scatter.hpp"

#include <glm/common.hpp>
#include <tbb/enumerable_thread_specific.h>

#include <optional>
#include <utility>

namespace penumbra::volumes {
namespace {

/// Leaves of triangles between a region and the light's corner from which on neighbouring pixels see other edges.
constexpr std::size_t kDense = 1024;
constexpr std::size_t kGroup = 16, kDenseGroup = 8;  // view samples

/// Finds each cluster's edges and triangles.
class VectorEdges : public vectors::MaskMethod {
 public:
  /// `exact_area`: not of light samples but of the light.
  VectorEdges(visibility::MethodDescription given, bool exact_area)
      : MaskMethod(std::move(given), "scatter edges"), exact_area_(exact_area), sides_(description().name) {}

  void prepare_mesh(const visibility::SceneFloats& scene) override {
    MaskMethod::prepare_mesh(scene);
    sides_.prepare_mesh(scene);
    whole_ = CutEdges(wide_edges(sides_.records(std::nullopt), scale()));
    without_body_.reset();
    front_ = &whole_;
  }
  [[nodiscard]] std::uint64_t memory_bytes() const override {
    return MaskMethod::memory_bytes() + bytes_of(whole_.tree()) + bytes_of(back_.tree()) +
           (without_body_ ? bytes_of(without_body_->edges.tree()) : 0);
  }

 private:
  bool prepare_casters() override {
    LightEdges edges = sides_.prepare_light(light(), device_light(), scale());
    front_->restore();
    if (edges.has_body && !(without_body_ && without_body_->light == light().index)) {
      without_body_ = {light().index, CutEdges(wide_edges(sides_.records(std::nullopt), scale()))};
    }
    front_ = edges.has_body ? &without_body_->edges : &whole_;
    back_ = edges.back ? CutEdges(front_->tree()) : CutEdges();
    const std::int32_t without = edges.has_body ? light().index : -1;
    for (auto* side : {&edges.front, &edges.back}) {
      if (*side) (*side)->window = window_;
    }
    if (edges.back) back_.cut({scene(), tree(), sides_.casters(), without, *edges.back, exact_area_});
    if (edges.front) front_->cut({scene(), tree(), sides_.casters(), without, *edges.front, exact_area_});
    touch_ = exact_area_ || !visibility::is_planar(light().kind) ? visibility::LightTouch()
                                                                 : visibility::find_touch(scene(), tree(), light());
    return edges.front.has_value() && !exact_area_;  // whose edges stay whole
  }
  vectors::Blocks begin_region(const LightGrid& grid, const Cluster& all) override {
    Scratch& scratch = scratch_.local();
    find_edge_roots({grid, edges_of(grid), all}, scratch.edges, scratch.edge_roots);
    find_triangle_roots({grid, triangles(), all, all.corner}, scratch.triangles, scratch.triangle_roots);
    scratch.dense =
        count_leaves({grid, triangles(), all, all.corner}, scratch.triangle_roots, scratch.stack, kDense) == kDense;
    scratch.dense_regions += scratch.dense ? 1 : 0;
    return scratch.dense ? vectors::Blocks::small : vectors::Blocks::usual;
  }
  void do_cluster(const LightGrid& grid, std::span<const GridSample> view_samples, OpenJudge& judge,
                  std::span<SampleMask> masks) final {
    Scratch& scratch = scratch_.local();
    if (scratch.edge_roots.empty() && scratch.triangle_roots.empty())
      return do_unoccluded(grid, view_samples, judge, masks);
    const Cluster cluster = make_cluster(grid, view_samples);
    find_triangles({grid, triangles(), cluster, cluster.corner}, scratch.triangle_roots, scratch.stack,
                   scratch.triangles);
    find_edges({grid, edges_of(grid), cluster}, scratch.edge_roots, scratch.stack, scratch.edges);
    scratch.listed += scratch.edges.count;
    if (scratch.edges.count + scratch.triangles.count == 0) return do_unoccluded(grid, view_samples, judge, masks);
    scratch.samples.clear();
    for (const GridSample& at : view_samples) scratch.samples.push_back(complete(grid, cluster, at));
    do_occluded({grid, touch_, edges_of(grid), triangles(), cluster, scratch.samples, scratch.edges, scratch.triangles,
                 scratch.dense ? kDenseGroup : kGroup, exact_area_, cut_edges(grid).ends(), front_->plane_of_light()},
                judge, masks);
  }

  [[nodiscard]] const CutEdges& cut_edges(const LightGrid& grid) const {
    return grid.side < 0 && !back_.tree().nodes.empty() ? back_ : *front_;
  }
  [[nodiscard]] const WideEdgeTree& edges_of(const LightGrid& grid) const { return cut_edges(grid).tree(); }
  /// View samples with nothing between them and the light.
  virtual void do_unoccluded(const LightGrid& grid, std::span<const GridSample> view_samples, OpenJudge& judge,
                             std::span<SampleMask> masks) = 0;
  virtual void do_occluded(const ScatterInput& input, OpenJudge& judge, std::span<SampleMask> masks) = 0;

 protected:
  void count(std::map<std::string, std::uint64_t>& counters) override {
    if (!touch_.samples.empty()) counters["touchedSamples"] = touch_.samples.size();
    for (Scratch& scratch : scratch_) {
      counters["listedEdges"] += std::exchange(scratch.listed, 0);
      counters["denseRegions"] += std::exchange(scratch.dense_regions, 0);
    }
  }

  bool exact_area_;
  LightWindow window_;  // of the light that is being prepared
  visibility::LightTouch touch_;
  EdgeSides sides_;
  CutEdges whole_;
  struct WithoutBody {
    std::int32_t light;
    CutEdges edges;
  };
  std::optional<WithoutBody> without_body_;  // what casts shadow of the last light with a body
  CutEdges* front_ = &whole_;                // one of these
  CutEdges back_;                            // a copy, where the light's plane cuts and it emits to both sides

 protected:
  tbb::enumerable_thread_specific<Scratch> scratch_;
};

/// Light samples.
class VectorEdgeScatter final : public VectorEdges {
 public:
  explicit VectorEdgeScatter(visibility::MethodDescription given) : VectorEdges(std::move(given), false) {}

 private:
  void do_unoccluded(const LightGrid& grid, std::span<const GridSample> view_samples, OpenJudge& judge,
                     std::span<SampleMask> masks) override {
    Open& open = scratch_.local().open;
    for (std::size_t i = 0; i < view_samples.size(); ++i) {
      reset_open(grid, touch_, view_samples[i], open);
      see_all(grid, view_samples[i], open, judge, masks[i]);
    }
  }
  void do_occluded(const ScatterInput& input, OpenJudge& judge, std::span<SampleMask> masks) override {
    scatter(input, scratch_.local(), judge, masks);
  }
};

/// rows=exact: shares of the light, and their form factors on request.
class VectorEdgeRows final : public VectorEdges {
 public:
  explicit VectorEdgeRows(visibility::MethodDescription given) : VectorEdges(std::move(given), true) {}

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
