// SPDX-License-Identifier: Apache-2.0
// E. Haines, Soft planar shadows using plateaus, Journal of Graphics Tools 6 (1), 2001; course notes, 5.3.1: the hard
// shadow of the light's centre, darkened outward by disks at the silhouette's vertices and sheets between them, with
// the sine of S. Parker et al. 1998. Departures: any receiver, each on its own plane (the paper draws the disks and
// sheets of one plane into its z-buffer); the nearest place of an edge is exact even if the disks at its ends differ
// (the paper's sheets are hyperbolic there); any planar light, by the disk of its area; any soup.

#include "volumes/soft/methods.hpp"

#include "base/parallel.hpp"
#include "volumes/soft/hard_and_wedges.hpp"
#include "volumes/soft/outer_penumbra.hpp"
#include "volumes/soft/plateaus.frag.spv.hpp"
#include "volumes/soft/repairs.hpp"

#include <glm/geometric.hpp>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace penumbra::volumes {
namespace {

using visibility::Light;
using visibility::Tile;

visibility::MeshVerdict plateaus_verdict(const mesh::Diagnosis& mesh) {
  return {visibility::Verdict::approximate,
          visibility::reason_with(
              "a hard shadow with a penumbra around it that depends only on distance: umbrae are too large", mesh,
              {{mesh.zero_area_triangles.count, "triangles without area, which cast no shadow"}})};
}

}  // namespace

visibility::MethodDescription plateaus_description() {
  return {.name = "plateaus",
          .family = visibility::Family::geometry,
          .paper = "Haines 2001",
          .output = visibility::Output::scalar,
          .exact_for =
              "only points that are lit outside of all penumbrae, and points in umbrae that the light's centre does "
              "not see",
          .lights = visibility::kPlanarLights,
          .textures = false,
          .options = {},
          .verdict_on = plateaus_verdict,
          .repairs = plateaus_repairs};
}

namespace {

class Plateaus final : public HardAndWedges {
 public:
  Plateaus(const render::Device& device, const visibility::MethodOptions& options)
      : HardAndWedges(plateaus_description(), options, VolumeCount(device, CountVariant::z_fail),
                      WedgeRaster(device, {.name = "plateaus", .fragment = shaders::kPlateausFrag})) {}

  void prepare_light(const Light& light) override;
  void evaluate(const Tile& tile) override;

 private:
  [[nodiscard]] glm::dvec3 normal_of(std::uint32_t triangle) const {
    const auto [a, b, c] = scene_->corners(triangle);
    const glm::dvec3 n = glm::cross(glm::dvec3(b) - glm::dvec3(a), glm::dvec3(c) - glm::dvec3(a));
    return glm::dot(n, n) > 0 ? glm::normalize(n) : n;
  }
  [[nodiscard]] double depth_on_host(std::size_t pixel) const;

  OuterPenumbra penumbra_;
};

/// Returns a hull around the sphere. A point that an edge darkens (OuterPenumbra) sees the edge in front of a point
/// within the radius of the light's centre, so the wedges of this hull contain it.
LightHull hull_of(const OuterPenumbra& penumbra) {
  LightHull hull{{}, penumbra.center, penumbra.radius * 0.75, true};
  const double reach = penumbra.radius * (1 + 0x1p-20);
  for (int i = 0; i < 8; ++i) {
    hull.corners.push_back(penumbra.center +
                           reach * glm::dvec3((i & 1) != 0 ? 1 : -1, (i & 2) != 0 ? 1 : -1, (i & 4) != 0 ? 1 : -1));
  }
  return hull;
}

void Plateaus::prepare_light(const Light& light) {
  visibility::check_light(description_, light);
  light_ = &light;
  count_.prepare_light(light);
  penumbra_ = {glm::dvec3(count_.center()), std::sqrt(light.area / std::numbers::pi)};
  const std::vector<VolumeEdge>& edges = count_.volumes().edges;
  std::vector<WedgeEdge> asked(edges.size());
  for (std::size_t i = 0; i < edges.size(); ++i) {
    asked[i].a = edges[i].a;
    asked[i].b = edges[i].b;
  }
  wedges_ = {edges, build_wedges(asked, hull_of(penumbra_), Construction::original)};
  std::vector<double> table(1 + 3 * scene_->triangles.size(), penumbra_.radius);
  for_each_index(scene_->triangles.size(), [&](std::size_t i) {
    const glm::dvec3 n = normal_of(static_cast<std::uint32_t>(i));
    for (int k = 0; k < 3; ++k) table[1 + 3 * i + static_cast<std::size_t>(k)] = n[k];
  });
  raster_.set_table(table);
  faces_.reset();
  on_host_ = 0;
}

double Plateaus::depth_on_host(std::size_t pixel) const {
  const glm::dvec3 normal = normal_of(static_cast<std::uint32_t>(samples_->triangle[pixel]));
  double deepest = 0;
  for (const VolumeEdge& edge : wedges_.edges) {
    deepest = std::max(deepest, penumbra_.depth_at(glm::dvec3(samples_->p[pixel]), normal, edge.a, edge.b));
  }
  return deepest;
}

void Plateaus::evaluate(const Tile& tile) {
  using Kind = VolumeCount::Kind;
  if (!faces_) faces_ = faces_of(wedges_, *samples_, WedgeTests::both, penumbra_.center);
  count_.count(tile);
  const std::span<const Kind> kinds = count_.kinds();
  const std::size_t first = std::size_t{tile.first_row} * samples_->width;
  std::vector<gpu::WedgeReceiver> receivers(kinds.size());
  std::vector<std::uint8_t> away(kinds.size());
  for_each_index(kinds.size(), [&](std::size_t i) {
    if (kinds[i] != Kind::counted || count_.counts()[i] != 0) return;
    const glm::vec3& p = samples_->p[first + i];
    away[i] = appears_in_place(samples_->camera, p, first + i) ? 0 : 1;
    receivers[i] = {p, away[i] == 0 ? 1 + static_cast<std::uint32_t>(samples_->triangle[first + i]) : 0U};
  });
  raster_.add(*faces_, receivers, wedge_push(*light_), tile, samples_->width);
  visibility_.resize(kinds.size());
  tbb::parallel_for(std::size_t{0}, kinds.size(), [&](std::size_t i) {
    visibility_[i] = kinds[i] == Kind::lit ? 1.0F : 0.0F;
    if (kinds[i] != Kind::counted || count_.counts()[i] != 0) return;
    const double depth =
        away[i] != 0 ? depth_on_host(first + i) : gpu::kSumUnit * static_cast<double>(raster_.sums()[i]);
    visibility_[i] = static_cast<float>(std::clamp(1 - hidden_at(depth), 0.0, 1.0));
  });
  on_host_ += static_cast<std::uint64_t>(std::ranges::count(away, 1));
}

}  // namespace

std::unique_ptr<visibility::Method> make_plateaus(const render::Device& device,
                                                  const visibility::MethodOptions& options) {
  return std::make_unique<Plateaus>(device, options);
}

}  // namespace penumbra::volumes
