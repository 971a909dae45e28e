// SPDX-License-Identifier: Apache-2.0
// View-sample mapping on a processor: its lists, and their use for each cluster. vectors::MaskMethod does the rest.

#include "vsm/vectors/view_sample_vectors.hpp"

#include "base/parallel.hpp"
#include "engines/vectors/horizon.hpp"
#include "engines/vectors/mask_method.hpp"
#include "vsm/closed_parts.hpp"
#include "vsm/vectors/pairs.hpp"

#include <glm/common.hpp>
#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <utility>

namespace penumbra::vsm {
namespace {

bool is_outside(const visibility::Bounds& box, const glm::vec3& p) {
  for (int axis = 0; axis < 3; ++axis) {
    if (p[axis] < box.lower[axis] || p[axis] > box.upper[axis]) return true;
  }
  return false;
}

/// Returns whether p is outside of the part, or on a face of its box that the part does not reach there.
bool is_outside(const ClosedPart& part, const glm::vec3& p) {
  if (is_outside(part.box, p)) return true;
  for (std::size_t face = 0; face < 6; ++face) {
    const auto axis = static_cast<int>(face % 3);
    const float bound = face < 3 ? part.box.lower[axis] : part.box.upper[axis];
    if (p[axis] == bound && is_outside(part.touching[face], p)) return true;
  }
  return false;
}

class VectorViewSample final : public vectors::MaskMethod {
 public:
  explicit VectorViewSample(visibility::MethodDescription given) : MaskMethod(std::move(given), "test pairs") {}

  void prepare_mesh(const visibility::SceneFloats& scene) override {
    MaskMethod::prepare_mesh(scene);
    closed_ = find_closed_parts(scene);
    if (closed_.parts.empty()) return;
    for_each_index(tree().leaves.size(), [&](std::size_t number) {
      const visibility::TriangleTree::Leaf& leaf = tree().leaves[number];
      for (std::size_t lane = 0; lane < kWide; ++lane) {
        if (leaf[lane] == visibility::TriangleTree::kNoTriangle || closed_.part[leaf[lane]] == 0) continue;
        WideTriangles& wide = triangles().leaves[number];
        wide.closed[lane] = 1U << closed_.part[leaf[lane]];
        if (closed_.turn[leaf[lane]] > 0) continue;
        for (std::size_t axis = 0; axis < 3; ++axis) std::swap(wide.corner[1][axis][lane], wide.corner[2][axis][lane]);
      }
    });
  }

 private:
  bool prepare_casters() override {
    apart_ = visibility::is_planar(light().kind) ? parts_apart_from(closed_, device_light(), scale())
                                                 : parts_apart_from(closed_, light());
    return false;
  }

  vectors::Blocks begin_region(const LightGrid& grid, const Cluster& all) override {
    PairScratch& scratch = scratch_.local();
    find_triangle_roots({grid, triangles(), all, all.whole}, scratch.triangles, scratch.roots);
    return vectors::Blocks::usual;
  }

  void do_cluster(const LightGrid& grid, std::span<const GridSample> view_samples, OpenJudge& judge,
                  std::span<SampleMask> masks) override {
    PairScratch& scratch = scratch_.local();
    scratch.triangles.count = 0;
    Cluster cluster;
    if (!scratch.roots.empty()) {
      cluster = make_cluster(grid, view_samples);
      find_triangles({grid, triangles(), cluster, cluster.whole, parts_around(view_samples)}, scratch.roots,
                     scratch.stack, scratch.triangles);
    }
    if (scratch.triangles.count == 0) {
      for (std::size_t i = 0; i < view_samples.size(); ++i) {
        scratch.open.clear();
        see_all(grid, view_samples[i], scratch.open, judge, masks[i]);
      }
      return;
    }
    scratch.samples.clear();
    for (const GridSample& at : view_samples) scratch.samples.push_back(complete(grid, cluster, at));
    const PairInput input{grid,    light(),         device_light(),    scale(),    triangles(),
                          cluster, scratch.samples, scratch.triangles, samples().p};
    if (grid.tiles) {
      test_tiles(input, scratch, judge, masks);
    } else {
      test_pairs(input, scratch, judge, masks);
    }
  }

  /// Returns a word with bit k set if all these view samples are outside of part k, which does not carry them. Exact:
  /// compares the stored floats.
  [[nodiscard]] std::uint32_t parts_around(std::span<const GridSample> view_samples) const {
    if (apart_ == 0) return 0;
    std::uint32_t carried = 0;
    glm::vec3 lower(samples().p[view_samples.front().pixel]), upper(lower);
    for (const GridSample& at : view_samples) {
      carried |= 1U << closed_.part[static_cast<std::size_t>(samples().triangle[at.pixel])];
      lower = glm::min(lower, samples().p[at.pixel]);
      upper = glm::max(upper, samples().p[at.pixel]);
    }
    std::uint32_t around = 0;
    for (std::uint32_t k = 1; k <= closed_.parts.size(); ++k) {
      if ((apart_ & ~carried & 1U << k) == 0) continue;
      const ClosedPart& part = closed_.parts[k - 1];
      bool outside = false;  // all view samples are beyond one face
      for (int axis = 0; axis < 3; ++axis) {
        outside = outside || upper[axis] < part.box.lower[axis] || lower[axis] > part.box.upper[axis];
      }
      outside = outside || std::all_of(view_samples.begin(), view_samples.end(),
                                       [&](const GridSample& at) { return is_outside(part, samples().p[at.pixel]); });
      if (outside) around |= 1U << k;
    }
    return around;
  }

  void count(std::map<std::string, std::uint64_t>& counters) override {
    for (PairScratch& scratch : scratch_) {
      counters["trianglesTested"] += std::exchange(scratch.pairs, 0);
      counters["trianglesTestedCarefully"] += std::exchange(scratch.careful, 0);
    }
  }

  ClosedParts closed_;
  std::uint32_t apart_ = 0;  // bits: closed parts separate from the light
  tbb::enumerable_thread_specific<PairScratch> scratch_;
};

}  // namespace

std::unique_ptr<visibility::Method> make_view_sample_on_vectors(visibility::MethodDescription description) {
  return std::make_unique<VectorViewSample>(std::move(description));
}

}  // namespace penumbra::vsm
