// SPDX-License-Identifier: Apache-2.0
#pragma once

// Support for tests of methods on a device: a device with validation, a run over a whole picture, and the truth of
// every pair for comparison.

#include "base/error.hpp"
#include "render/device.hpp"
#include "tests/unit/ray_traced_masks.hpp"
#include "tests/unit/visibility/scenes.hpp"
#include "visibility/masks/visible_share.hpp"
#include "visibility/method.hpp"
#include "visibility/pair_truth.hpp"
#include "visibility/receivers.hpp"
#include "vsm/methods.hpp"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <random>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace penumbra::tests {

/// Has one device for all tests of a suite, under the validation layer, which must not report anything.
class DeviceTest : public testing::Test {
 protected:
  static void SetUpTestSuite() { device_ = std::make_unique<render::Device>(render::DeviceOptions{"", true}); }
  static void TearDownTestSuite() { device_.reset(); }
  void TearDown() override {
    for (const std::string& message : device().take_validation_messages()) ADD_FAILURE() << "validation: " << message;
  }

  static render::Device& device() { return *device_; }

 private:
  static inline std::unique_ptr<render::Device> device_;
};

/// Returns V of a whole picture and, if the method gives them, masks; evaluates `rows_at_once` rows at a time (0: as
/// many as the method takes).
inline Masks run(visibility::Method& method, const visibility::SceneFloats& floats, const visibility::Light& light,
                 const visibility::ViewSamples& samples, std::uint32_t rows_at_once = 0) {
  method.prepare_mesh(floats);
  method.prepare_light(light);
  method.prepare_view(samples);
  const bool gives_masks = method.description().output == visibility::Output::mask;
  Masks masks;
  masks.words_per_pixel = gives_masks ? light.words_per_mask() : 0;
  masks.words.resize(samples.size() * masks.words_per_pixel);
  masks.visibility.resize(samples.size());
  const std::uint32_t rows = rows_at_once != 0 ? rows_at_once : method.max_tile_rows();
  for (std::uint32_t first = 0; first < samples.height; first += rows) {
    const visibility::Tile tile{first, std::min(rows, samples.height - first)};
    method.evaluate(tile);
    const std::size_t pixel = std::size_t{first} * samples.width, pixels = std::size_t{tile.row_count} * samples.width;
    if (gives_masks) {
      method.read_masks(std::span(masks.words).subspan(pixel * masks.words_per_pixel, pixels * masks.words_per_pixel));
    }
    method.read_visibility(std::span(masks.visibility).subspan(pixel, pixels));
  }
  return masks;
}
inline Masks run(visibility::Method& method, const Stage& stage, std::uint32_t rows_at_once = 0) {
  return run(method, stage.floats, stage.light, stage.samples, rows_at_once);
}

/// Runs view-sample mapping on the device.
inline Masks map_view_samples(const render::Device& device, const visibility::SceneFloats& floats,
                              const visibility::Light& light, const visibility::ViewSamples& samples,
                              std::uint32_t rows_at_once = 0) {
  const auto method = vsm::make_view_sample(device, {{"engine", "vulkan"}});
  return run(*method, floats, light, samples, rows_at_once);
}

inline const char* name_of(visibility::PairOutcome outcome) {
  switch (outcome) {
    case visibility::PairOutcome::visible:
      return "visible";
    case visibility::PairOutcome::blocked:
      return "blocked";
    case visibility::PairOutcome::horizon:
      return "horizon";
    case visibility::PairOutcome::behind:
      return "behind";
  }
  return "?";
}

inline std::string text_of(const glm::vec3& v) {
  return fmt::format("({:.9g}, {:.9g}, {:.9g})", v.x, v.y, v.z);
}

/// Returns a light's stored numbers as text: the centre and radius of a sphere, the directions of a sun.
inline std::string text_of(const visibility::Light& light) {
  const std::string kind = visibility::name_of(light.kind), center = text_of(light.center);
  if (light.kind == visibility::LightKind::sphere)
    return fmt::format("{} {} radius {:.17g}", kind, center, light.radius);
  if (light.sun) {
    return fmt::format("{} {} axes {} {} tangent {:.17g}", kind, center, text_of(light.sun->axis_u),
                       text_of(light.sun->axis_v), light.sun->tangent);
  }
  return fmt::format("{} {} {} {}", kind, center, text_of(light.center_u), text_of(light.center_v));
}

/// Describes one pair in numbers, enough to write a test for it alone. The pixel shows a triangle.
inline std::string describe_pair(const visibility::SceneFloats& floats, const visibility::ViewSamples& samples,
                                 std::size_t pixel, const visibility::Light& light, std::uint32_t j) {
  const auto truth = visibility::decide_pair(floats, samples, pixel, light, j);
  const auto corners = floats.corners(static_cast<std::uint32_t>(samples.triangle[pixel]));
  std::vector<glm::vec3> points(light.sample_count());  // a sphere has different points for each p
  visibility::light_points_for(light, samples.p[pixel], points.data());
  return fmt::format("pixel {} sample {}: truth {}{}; p {} facing {} on {} {} {}; l {}; light {}", pixel, j,
                     name_of(truth.outcome), truth.zero_predicate ? " (zero)" : "", text_of(samples.p[pixel]),
                     samples.facing[pixel], text_of(corners[0]), text_of(corners[1]), text_of(corners[2]),
                     text_of(points[j]), text_of(light));
}

/// Counts of a picture's pairs by outcome, so that a test can check that it covered its cases.
struct PairCounts {
  std::size_t pairs = 0, visible = 0, blocked = 0, horizon = 0, behind = 0, zero = 0;

  void operator+=(const PairCounts& other) {
    pairs += other.pairs;
    visible += other.visible;
    blocked += other.blocked;
    horizon += other.horizon;
    behind += other.behind;
    zero += other.zero;
  }
};

/// Compares every pair of every `step`-th pixel with the exact decision; surfaces that receive no shadow must be fully
/// lit, the bits beyond the last sample 0, and V the share of set bits.
inline testing::AssertionResult equals_truth(const visibility::SceneFloats& floats, const visibility::Light& light,
                                             const visibility::ViewSamples& samples, const Masks& masks,
                                             PairCounts* counts = nullptr, std::size_t step = 1) {
  const std::uint32_t n = light.sample_count();
  struct Row {
    PairCounts counts;
    std::size_t wrong = 0;
    std::string first;
  };
  std::vector<Row> rows((samples.size() + step - 1) / step);
  tbb::parallel_for(std::size_t{0}, rows.size(), [&](std::size_t i) {
    const std::size_t pixel = i * step;
    Row& row = rows[i];
    const auto wrong = [&](const std::string& what) {
      if (row.wrong++ == 0) row.first = what;
    };
    const std::uint32_t set = masks.visible_count(pixel);
    if (masks.visibility[pixel] != visibility::visible_share(light, masks.of(pixel))) {
      wrong(fmt::format("pixel {}: V is {}, but {} of {} bits are set", pixel, masks.visibility[pixel], set, n));
    }
    if (n % 32 != 0 && masks.word(pixel, light.words_per_mask() - 1) >> (n % 32) != 0) {
      wrong(fmt::format("pixel {}: bits beyond sample {} are set", pixel, n - 1));
    }
    if (!visibility::is_receiver(floats, light, samples, pixel)) {
      if (set != n) wrong(fmt::format("pixel {} receives no shadow, and is not lit", pixel));
      return;
    }
    for (std::uint32_t j = 0; j < n; ++j) {
      const auto truth = visibility::decide_pair(floats, samples, pixel, light, j);
      PairCounts& count = row.counts;
      ++count.pairs;
      count.visible += truth.outcome == visibility::PairOutcome::visible ? 1 : 0;
      count.blocked += truth.outcome == visibility::PairOutcome::blocked ? 1 : 0;
      count.horizon += truth.outcome == visibility::PairOutcome::horizon ? 1 : 0;
      count.behind += truth.outcome == visibility::PairOutcome::behind ? 1 : 0;
      count.zero += truth.zero_predicate ? 1 : 0;
      if (masks.visible(pixel, j) != (truth.outcome == visibility::PairOutcome::visible)) {
        wrong("device says the contrary of " + describe_pair(floats, samples, pixel, light, j));
      }
    }
  });
  std::size_t wrong = 0;
  std::string first;
  for (const Row& row : rows) {
    if (counts != nullptr) *counts += row.counts;
    if (wrong == 0) first = row.first;
    wrong += row.wrong;
  }
  if (wrong == 0) return testing::AssertionSuccess();
  return testing::AssertionFailure() << wrong << " wrong, the first: " << first;
}

/// Returns the light with its samples not in rows, so that methods take the code path for samples anywhere.
inline visibility::Light scattered(visibility::Light light, bool as_polygon) {
  light.pattern = visibility::SamplePattern::sobol;
  light.rows = light.columns = 0;
  light.row_shift.clear();
  if (as_polygon) light.kind = visibility::LightKind::polygon;
  return light;
}

/// Appends one picture below another of the same width.
inline void append(visibility::ViewSamples& to, const visibility::ViewSamples& more) {
  const auto join = [](auto& a, const auto& b) { a.insert(a.end(), b.begin(), b.end()); };
  to.width = more.width;
  to.height += more.height;
  join(to.triangle, more.triangle);
  join(to.p, more.p);
  join(to.n, more.n);
  join(to.depth, more.depth);
  join(to.facing, more.facing);
}

/// Makes view samples: on each of `rows` × `width` randomly chosen triangles with area, the point a + s (b − a) + t (c
/// − a) with s, t multiples of ¼, seen from a random side. `object`: only on triangles of this object.
inline visibility::ViewSamples samples_on_triangles(const visibility::SceneFloats& floats, std::uint32_t width,
                                                    std::uint32_t rows, std::mt19937& random,
                                                    std::optional<std::uint32_t> object = {}) {
  visibility::ViewSamples samples;
  samples.width = width;
  samples.height = rows;
  std::vector<std::uint32_t> with_area;
  for (std::uint32_t i = 0; i < floats.triangles.size(); ++i) {
    if (object && floats.object[i] != *object) continue;
    if (floats.plane[i] != visibility::SceneFloats::kNoPlane) with_area.push_back(i);
  }
  for (std::uint32_t i = 0; i < width * rows; ++i) {
    if (with_area.empty() || random() % 16 == 0) {
      samples.triangle.push_back(visibility::ViewSamples::kBackground);
      samples.p.emplace_back(0);
      samples.n.emplace_back(0);
      samples.depth.push_back(0);
      samples.facing.push_back(0);
      continue;
    }
    const std::uint32_t triangle = with_area[random() % with_area.size()];
    const auto [a, b, c] = floats.corners(triangle);
    const auto quarters_s = random() % 5, quarters_t = random() % (5 - quarters_s);
    const glm::dvec3 da(a), ab = glm::dvec3(b) - da, ac = glm::dvec3(c) - da;
    const auto facing = static_cast<std::int8_t>(random() % 2 == 0 ? 1 : -1);
    samples.triangle.push_back(static_cast<std::int32_t>(triangle));
    const double s = 0.25 * static_cast<double>(quarters_s), t = 0.25 * static_cast<double>(quarters_t);
    samples.p.push_back(glm::vec3(da + s * ab + t * ac) + 0.0F);
    samples.n.push_back(glm::vec3(glm::normalize(glm::cross(ab, ac)) * static_cast<double>(facing)) + 0.0F);
    samples.depth.push_back(1);
    samples.facing.push_back(facing);
  }
  return samples;
}

/// Returns the whole scene, with lights and cameras, as world · scale + offset.
inline scenes::Scene moved(scenes::Scene scene, double scale, const glm::dvec3& offset = glm::dvec3(0)) {
  const auto place = [&](glm::dvec3& point) { point = point * scale + offset; };
  for (glm::dvec3& position : scene.soup.positions) place(position);
  for (scenes::AreaLight& light : scene.lights) {
    if (auto* rectangle = std::get_if<scenes::Rectangle>(&light.shape)) {
      place(rectangle->center);
      rectangle->half_u *= scale;
      rectangle->half_v *= scale;
    } else if (auto* disk = std::get_if<scenes::Disk>(&light.shape)) {
      place(disk->center);
      disk->radius *= scale;
    } else if (auto* ellipse = std::get_if<scenes::Ellipse>(&light.shape)) {
      place(ellipse->center);
      ellipse->half_u *= scale;
      ellipse->half_v *= scale;
    } else if (auto* polygon = std::get_if<scenes::Polygon>(&light.shape)) {
      for (glm::dvec3& vertex : polygon->vertices) place(vertex);
    } else if (auto* sphere = std::get_if<scenes::Sphere>(&light.shape)) {
      place(sphere->center);
      sphere->radius *= scale;
    }
  }
  for (scenes::Camera& camera : scene.cameras) {
    place(camera.eye);
    place(camera.target);
  }
  return scene;
}

}  // namespace penumbra::tests
