// SPDX-License-Identifier: Apache-2.0
// E. Sintorn, E. Eisemann and U. Assarsson, Sample based visibility for soft shadows using alias-free shadow maps,
// Computer Graphics Forum 27 (4), 2008: view samples are in lists of light pixels on the far plane of the light's
// frustum. For each triangle, the hull of its footprints from the light's corners is rasterised conservatively; in each
// light pixel, the triangle is tested against each view sample of the list.
//
// Departures. On the processor. View samples outside of the frustum are tested against all triangles. A view sample
// that no longer sees any light is removed from its list. Half-spaces through view sample and edge are those of the
// paper's section 4.3, but are evaluated for each light sample instead of read from a table: each bit is exact,
// independent of a table's resolution.

#include "vsm/view_sample_lists.hpp"

#include "engines/pairs/far_plane.hpp"
#include "engines/pairs/list_raster.hpp"
#include "engines/pairs/pair_method.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <mutex>
#include <vector>

namespace penumbra::vsm {
namespace {

using pairs::PairCounts;

constexpr double kListPerPixel = 2;  // average number of view samples in a light pixel

class ViewSampleLists final : public pairs::PairMethod {
 public:
  explicit ViewSampleLists(visibility::MethodDescription description)
      : PairMethod(std::move(description), "view-sample lists") {}

 private:
  void prepare_casters() override {
    casters_.clear();
    for (std::uint32_t i = 0; i < scene().triangles.size(); ++i) {
      if (scene().casts_shadow[i] != 0 && scene().emits[i] != light().index) casters_.push_back(i);
    }
  }
  void block(std::span<const std::uint32_t> pixels, std::map<std::string, std::uint64_t>& counters) override;
  void rasterise(pairs::FarPlane& plane, std::map<std::string, std::uint64_t>& counters);

  std::vector<std::uint32_t> casters_;
};

void ViewSampleLists::block(std::span<const std::uint32_t> pixels, std::map<std::string, std::uint64_t>& counters) {
  const pairs::LightBox box = pairs::make_light_box(light());
  const double reach = 2 * std::max(glm::length(glm::dvec3(scene().lower)), glm::length(glm::dvec3(scene().upper))) +
                       glm::length(box.origin) + glm::length(box.lower) + glm::length(box.upper);
  std::vector<std::uint32_t> outside;
  for (const double side : {1.0, -1.0}) {
    if (side < 0 && !light().two_sided) continue;
    pairs::FarPlane plane(box, side, reach, pixels, samples().p, kListPerPixel);
    outside.insert(outside.end(), plane.outside().begin(), plane.outside().end());
    if (plane.empty()) continue;
    counters["longestList"] = std::max<std::uint64_t>(counters["longestList"], plane.light_pixels().longest_list());
    rasterise(plane, counters);
  }
  // View samples in the plane of a two-sided light are outside of both frusta.
  std::ranges::sort(outside);
  outside.erase(std::unique(outside.begin(), outside.end()), outside.end());
  counters["viewSamplesOutside"] += outside.size();
  std::mutex adding;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, outside.size(), 16), [&](const auto& range) {
    PairCounts pairs;
    for (std::size_t i = range.begin(); i < range.end(); ++i) try_all(outside[i], pairs);
    const std::lock_guard lock(adding);
    add(pairs);
  });
}

void ViewSampleLists::rasterise(pairs::FarPlane& plane, std::map<std::string, std::uint64_t>& counters) {
  const pairs::ListCounts counts = pairs::draw<PairCounts>(
      {plane.light_pixels(), plane.heights(), casters_},
      [&](std::uint32_t triangle) { return plane.footprint(scene().corners(triangle)); },
      [&](std::uint32_t triangle) { return plane.nearest(scene().corners(triangle)); },
      [&](std::uint32_t triangle, std::uint32_t number, PairCounts& pairs) {
        const std::uint32_t pixel = plane.pixel(number);
        hide(triangle, pixel, pairs);
        return sees_something(pixel);
      },
      [&](const PairCounts& pairs) { add(pairs); });
  counters["footprints"] += counts.footprints;
  counters["listsTouched"] += counts.lists;
}

}  // namespace

std::unique_ptr<visibility::Method> make_view_sample_lists(visibility::MethodDescription description) {
  return std::make_unique<ViewSampleLists>(std::move(description));
}

}  // namespace penumbra::vsm
