// SPDX-License-Identifier: Apache-2.0
#pragma once

// Plain C++ twins of depth-complexity variant=forest, with exact signs: by edges, as the method computes counters, and
// by triangles, as docs/depth-complexity.md defines them.

#include "tests/agreement/support.hpp"
#include "visibility/tree/triangle_tree.hpp"
#include "volumes/counters/packed_counters.hpp"
#include "volumes/wedges/wedge_casters.hpp"

#include "mesh/silhouettes.hpp"

namespace penumbra::tests {

class PackedTwin {
 public:
  PackedTwin(const visibility::SceneFloats& floats, const visibility::ViewSamples& samples,
             const visibility::Light& light)
      : floats_(floats),
        samples_(samples),
        light_(light),
        center_(visibility::center_of(light)),
        casters_(volumes::casters_of(floats, light)),
        silhouettes_(mesh::silhouette_edges(casters_.view(), casters_.graph, glm::dvec3(center_))) {
    if (floats.triangles.size() > kMostTried) tree_ = visibility::make_triangle_tree(floats);
  }

  /// Returns the count at the light's centre plus its change by silhouettes on the straight segment to each light
  /// sample, as in variant=forest; nullopt where a sign is exactly zero.
  [[nodiscard]] std::vector<std::optional<std::int16_t>> by_edges(std::size_t pixel) const {
    const glm::dvec3 p(samples_.p[pixel]), c(center_);
    std::int16_t constant = 0;
    for_each_met(pixel, center_, [&](std::uint32_t) { ++constant; });
    std::vector<std::optional<std::int16_t>> counters(light_.points.size(), constant);
    for (std::size_t j = 0; j < counters.size(); ++j) {
      const glm::dvec3 l(light_.points[j]);
      for (const mesh::SilhouetteEdge& silhouette : silhouettes_) {
        const mesh::Edge& edge = casters_.graph.edges[silhouette.edge];
        const glm::dvec3 &a = casters_.positions[edge.a], &b = casters_.positions[edge.b];
        const int from = sign(p, c, l, a), to = sign(p, c, l, b);
        const std::array around{sign(p, c, a, b), sign(c, l, a, b), sign(l, p, a, b)};
        const auto [low, high] = std::ranges::minmax(around);
        if (from * to > 0 || (low < 0 && high > 0)) continue;
        if (from * to == 0 || low == 0 || high == 0) {
          counters[j].reset();
          break;
        }
        counters[j] = static_cast<std::int16_t>(*counters[j] - silhouette.multiplicity * low);
      }
    }
    return counters;
  }

  /// Returns Σ σ over the triangles that p→l meets: σ is 1 if p and the light's centre are on opposite sides of the
  /// triangle, −1 if they are on the same side.
  [[nodiscard]] int by_triangles(std::size_t pixel, std::uint32_t j) const {
    int sum = 0;
    for_each_met(pixel, light_.points[j], [&](std::uint32_t triangle) {
      const auto [a, b, c] = floats_.corners(triangle);
      const int at_center = static_cast<int>(mesh::side_of_plane(a, b, c, center_));
      sum -= at_center * static_cast<int>(mesh::side_of_plane(a, b, c, samples_.p[pixel]));
    });
    return sum;
  }

 private:
  static int sign(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& d) {
    return static_cast<int>(mesh::side_of_plane(a, b, c, d));
  }

  template <typename Visit>
  void for_each_met(std::size_t pixel, const glm::vec3& l, const Visit& visit) const {
    const auto carrier = static_cast<std::uint32_t>(samples_.triangle[pixel]);
    const auto try_it = [&](std::uint32_t i) {
      if (!visibility::may_occlude(floats_, light_, carrier, i)) return false;
      if (visibility::segment_meets_triangle(samples_.p[pixel], l, floats_.corners(i), light_).meets) visit(i);
      return false;
    };
    if (tree_) {
      tree_->any_along(samples_.p[pixel], l, try_it);
      return;
    }
    for (std::uint32_t i = 0; i < floats_.triangles.size(); ++i) try_it(i);
  }

  static constexpr std::size_t kMostTried =
      2000;  // triangles; of more than these, only triangles near the segment are tried
  const visibility::SceneFloats& floats_;
  const visibility::ViewSamples& samples_;
  const visibility::Light& light_;
  glm::vec3 center_;
  volumes::Casters casters_;
  std::vector<mesh::SilhouetteEdge> silhouettes_;
  std::optional<visibility::TriangleTree> tree_;
};

struct PackedTotals {
  std::size_t pairs = 0, known = 0, several = 0, negative = 0, too_bright = 0, by_edges = 0, wrong = 0;

  void operator+=(const PackedTotals& other) {
    pairs += other.pairs;
    known += other.known;
    several += other.several;
    negative += other.negative;
    too_bright += other.too_bright;
    by_edges += other.by_edges;
    wrong += other.wrong;
  }
};

/// Checks every pair of a picture: counters equal both twins without tolerance, masks are set where counters are 0, and
/// pairs without a counter have the true bit. `by_edges`: the number of pixels at which the twin by edges is computed,
/// as it is slow.
inline PackedTotals expect_packed(volumes::DepthCounters& method, const visibility::SceneFloats& floats,
                                  const visibility::ViewSamples& samples, const visibility::Light& light,
                                  std::size_t by_edges, const std::string& name) {
  const PackedTwin twin(floats, samples, light);
  const Masks masks = run(method, floats, light, samples);
  const std::uint32_t n = light.sample_count();
  std::vector<std::int32_t> counters(samples.size() * n);
  method.read_counters(counters);
  struct Row {
    PackedTotals totals;
    std::string first;
  };
  std::vector<Row> rows(samples.size());
  const std::vector<visibility::PixelClass> classes = visibility::classify_pixels(floats, samples, light);
  const std::size_t step = std::max<std::size_t>(samples.size() / std::max<std::size_t>(by_edges, 1), 1);
  tbb::parallel_for(std::size_t{0}, samples.size(), [&](std::size_t pixel) {
    Row& row = rows[pixel];
    const auto wrong = [&](std::uint32_t j, const std::string& what) {
      if (row.totals.wrong++ != 0) return;
      row.first = fmt::format("{}: {}, pixel {}", name, what, pixel);
      if (samples.triangle[pixel] >= 0) row.first += ", " + describe_pair(floats, samples, pixel, light, j);
    };
    using visibility::PixelClass;
    if (classes[pixel] <= PixelClass::unshadowed) {
      if (masks.visible_count(pixel) != n) wrong(0, "not lit");
      return;
    }
    std::vector<std::optional<std::int16_t>> edges;
    if (by_edges > 0 && pixel % step == 0) edges = twin.by_edges(pixel);
    for (std::uint32_t j = 0; j < n; ++j) {
      const std::int32_t counter = counters[pixel * n + j];
      const bool truth =
          visibility::decide_pair(floats, samples, pixel, light, j).outcome == visibility::PairOutcome::visible;
      const bool visible = masks.visible(pixel, j);
      ++row.totals.pairs;
      if (counter == volumes::DepthCounters::kNoCounter) {
        if (visible != truth) wrong(j, "no counter, and not the truth");
        continue;
      }
      ++row.totals.known;
      row.totals.several += counter > 1 ? 1U : 0U;
      row.totals.negative += counter < 0 ? 1U : 0U;
      row.totals.too_bright += visible && !truth ? 1U : 0U;
      const int triangles = twin.by_triangles(pixel, j);
      if (counter != triangles) wrong(j, fmt::format("counter {}, by triangles {}", counter, triangles));
      if (visible != (counter == 0)) wrong(j, fmt::format("counter {}, visible {}", counter, visible));
      if (truth && !visible) wrong(j, "too dark");
      if (edges.empty() || !edges[j]) continue;
      ++row.totals.by_edges;
      if (*edges[j] != counter) wrong(j, fmt::format("counter {}, by edges {}", counter, *edges[j]));
    }
  });
  PackedTotals totals;
  for (const Row& row : rows) {
    if (totals.wrong == 0 && row.totals.wrong != 0) ADD_FAILURE() << row.first;
    totals += row.totals;
  }
  EXPECT_EQ(totals.wrong, 0U) << name;
  return totals;
}

}  // namespace penumbra::tests
