// SPDX-License-Identifier: Apache-2.0
#pragma once

// Compares a mask method with the ray caster, pair by pair on the same view and light samples. They share no code that
// decides anything: here hierarchies of shafts and float arithmetic with error bounds, there Embree's rays. Where they
// differ, the exact decision shows which of them is right.

#include "tests/agreement/mask_methods.hpp"
#include "tests/agreement/support.hpp"

#include "render/visibility_buffer.hpp"

namespace penumbra::tests {

struct Differences {
  std::size_t pairs_all = 0, pairs = 0, differing = 0;
  std::size_t judged = 0, mapped_right = 0, zero_predicate = 0;
  std::string first_wrong;

  void operator+=(const Differences& other) {
    pairs_all += other.pairs_all;
    pairs += other.pairs;
    differing += other.differing;
    judged += other.judged;
    mapped_right += other.mapped_right;
    zero_predicate += other.zero_predicate;
    if (first_wrong.empty()) first_wrong = other.first_wrong;
  }
};

inline constexpr std::size_t kMostJudged = 2000;

/// Counts pairs that differ; the first `most_judged` of them are decided exactly.
inline Differences differences(const visibility::SceneFloats& floats, const visibility::ViewSamples& samples,
                               const visibility::Light& light, const Masks& mapped, const Masks& traced,
                               std::size_t most_judged = kMostJudged) {
  Differences result;
  const std::uint32_t n = light.sample_count();
  for (std::size_t pixel = 0; pixel < samples.size(); ++pixel) {
    if (samples.triangle[pixel] == visibility::ViewSamples::kBackground) continue;
    result.pairs_all += n;
    const auto partly = [&](const Masks& masks) {
      return masks.visible_count(pixel) > 0 && masks.visible_count(pixel) < n;
    };
    if (partly(mapped) || partly(traced)) result.pairs += n;
    for (std::uint32_t j = 0; j < n; ++j) {
      if (mapped.visible(pixel, j) == traced.visible(pixel, j)) continue;
      ++result.differing;
      if (result.judged == most_judged) continue;
      const auto truth = visibility::decide_pair(floats, samples, pixel, light, j);
      ++result.judged;
      result.zero_predicate += truth.zero_predicate ? 1 : 0;
      if (mapped.visible(pixel, j) == (truth.outcome == visibility::PairOutcome::visible)) {
        ++result.mapped_right;
      } else if (result.first_wrong.empty()) {
        result.first_wrong = describe_pair(floats, samples, pixel, light, j);
      }
    }
  }
  return result;
}

inline void print(const std::string& name, const Differences& found) {
  fmt::print(
      "{}: {} of {} pairs differ ({:.2e}; {:.2e} of those in penumbra); of {} judged, {} with a zero, the mask method "
      "is "
      "right about {}\n",
      name, found.differing, found.pairs_all,
      static_cast<double>(found.differing) / static_cast<double>(found.pairs_all),
      static_cast<double>(found.differing) / static_cast<double>(found.pairs), found.judged, found.zero_predicate,
      found.mapped_right);
}

/// Both methods, kept between pictures: making them costs more than a small picture.
class BothMethods {
 public:
  explicit BothMethods(const render::Device& device, const MaskMethod& mapped = kViewSample)
      : device_(device), map_(mapped.make(device, {})), trace_(reference::make_ray_traced({})) {}

  Differences on(const scenes::Scene& scene, std::uint32_t size, const visibility::SampleRequest& request = {},
                 std::size_t most_judged = kMostJudged) {
    const visibility::SceneFloats floats = visibility::make_scene_floats(scene);
    const visibility::Light light = visibility::make_light(scene, 0, floats.origin, request);
    render::VisibilityBuffer view(device_, floats);
    const visibility::ViewSamples samples =
        view.render(visibility::make_camera(scene.cameras[0], floats.origin, size, size));
    const Masks mapped = run(*map_, floats, light, samples), traced = run(*trace_, floats, light, samples);
    return differences(floats, samples, light, mapped, traced, most_judged);
  }
  [[nodiscard]] const visibility::Method& mapped() const { return *map_; }

 private:
  const render::Device& device_;
  std::unique_ptr<visibility::Method> map_, trace_;
};

/// Returns a floor under a rectangle light and, as a separate object, the unchanged soup.
inline scenes::Scene with_a_floor(const mesh::TriangleSoup& soup) {
  scenes::Scene scene;
  add_object(scene, "floor", quad({0, 0, 0}, {5, 0, 0}, {0, 0, -5}));
  const auto first = static_cast<std::uint32_t>(scene.soup.positions.size());
  scene.soup.positions.insert(scene.soup.positions.end(), soup.positions.begin(), soup.positions.end());
  for (std::size_t i = 0; i < soup.triangles.size(); ++i) {
    const auto [a, b, c] = soup.triangles[i];
    scene.soup.triangles.push_back({a + first, b + first, c + first});
    scene.soup.object.push_back(1);
    scene.soup.source_face.push_back(static_cast<std::uint32_t>(i));
  }
  scene.objects.emplace_back().name = "mesh";
  scene.lights.push_back(rectangle_light({0.5, 5, 0.5}, {1, 0, 0}, {0, 0, 1}));
  scene.cameras.push_back(camera({4, 3, 5}, {0, 0.8, 0}));
  return scene;
}

/// Scales and moves the soup to a height of 2, or a width of 4 if that makes it smaller, with its bottom on the floor.
inline mesh::TriangleSoup fitted(mesh::TriangleSoup soup) {
  glm::dvec3 low(std::numeric_limits<double>::max()), high(-low);
  for (const mesh::Triangle& triangle : soup.triangles) {
    for (const std::uint32_t corner : triangle) {
      low = glm::min(low, soup.positions[corner]);
      high = glm::max(high, soup.positions[corner]);
    }
  }
  const glm::dvec3 extent = high - low, base((low.x + high.x) / 2, low.y, (low.z + high.z) / 2);
  const double scale = 2 / std::max({extent.y, extent.x / 2, extent.z / 2});
  for (glm::dvec3& position : soup.positions) position = (position - base) * scale;
  return soup;
}

}  // namespace penumbra::tests
