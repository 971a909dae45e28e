#pragma once
// Scenes built by hand, and one way to run a method of maps/ on them.

#include "maps/accumulate.hpp"
#include "maps/pcss.hpp"
#include "maps/shadow_map.hpp"
#include "render/device.hpp"
#include "scenes/scene.hpp"
#include "visibility/light_samples.hpp"
#include "visibility/method.hpp"
#include "visibility/scene_floats.hpp"
#include "visibility/view_samples.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

namespace penumbra::maps_test {

/// Adds one object of these triangles (three corners each) and returns it.
inline scenes::Object& add_object(scenes::Scene& scene, const std::vector<glm::dvec3>& corners) {
  const auto object = static_cast<std::uint32_t>(scene.objects.size());
  for (std::size_t i = 0; i < corners.size(); i += 3) {
    const auto first = static_cast<std::uint32_t>(scene.soup.positions.size());
    scene.soup.positions.insert(scene.soup.positions.end(), {corners[i], corners[i + 1], corners[i + 2]});
    scene.soup.triangles.push_back({first, first + 1, first + 2});
    scene.soup.object.push_back(object);
    scene.soup.source_face.push_back(static_cast<std::uint32_t>(i / 3));
  }
  scene.objects.emplace_back();
  return scene.objects.back();
}

inline scenes::Object& add_quad(scenes::Scene& scene, const glm::dvec3& c, const glm::dvec3& u, const glm::dvec3& v) {
  return add_object(scene, {c - u - v, c + u - v, c + u + v, c - u - v, c + u + v, c - u + v});
}

/// A sphere of `rings` × 2 `rings` faces.
inline scenes::Object& add_sphere(scenes::Scene& scene, const glm::dvec3& center, double radius, int rings) {
  const auto at = [&](int i, int j) {
    const double theta = std::numbers::pi * i / rings, phi = std::numbers::pi * j / rings;
    return center +
           radius * glm::dvec3(std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi));
  };
  std::vector<glm::dvec3> corners;
  for (int i = 0; i < rings; ++i) {
    for (int j = 0; j < 2 * rings; ++j) {
      if (i > 0) corners.insert(corners.end(), {at(i, j), at(i, j + 1), at(i + 1, j)});
      if (i + 1 < rings) corners.insert(corners.end(), {at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)});
    }
  }
  return add_object(scene, corners);
}

inline scenes::AreaLight rectangle_light(const glm::dvec3& center, const glm::dvec3& half_u, const glm::dvec3& half_v) {
  scenes::AreaLight light;
  light.name = "light";
  light.shape = scenes::Rectangle{center, half_u, half_v};
  return light;
}

/// Emits downward.
inline scenes::AreaLight square_light(double height, double half) {
  return rectangle_light({0, height, 0}, {half, 0, 0}, {0, 0, half});
}

inline scenes::Camera camera_at(const glm::dvec3& eye, const glm::dvec3& target, double fov = 45) {
  scenes::Camera camera;
  camera.name = "camera";
  camera.eye = eye;
  camera.target = target;
  camera.vertical_fov = fov;
  return camera;
}

/// Everything that a method is given.
struct Stage {
  visibility::SceneFloats scene;
  visibility::Light light;
  visibility::ViewSamples samples;
};

inline Stage make_stage(const scenes::Scene& scene, const visibility::SampleRequest& request, std::uint32_t size = 64) {
  Stage stage;
  stage.scene = visibility::make_scene_floats(scene);
  stage.light = visibility::make_light(scene, 0, stage.scene.origin, request);
  const auto camera = visibility::make_camera(scene.cameras.front(), stage.scene.origin, size, size);
  stage.samples = visibility::brute_force_view_samples(stage.scene, camera);
  return stage;
}

inline visibility::SampleRequest samples(std::uint32_t count) {
  visibility::SampleRequest request;
  request.count = count;
  return request;
}

using Factory =
    std::function<std::unique_ptr<visibility::Method>(const render::Device&, const visibility::MethodOptions&)>;

struct Result {
  std::vector<float> visibility;
  std::vector<std::uint32_t> masks;  ///< Output::mask only
};

/// A device with validation; whatever the layers say fails the test.
class MapsTest : public testing::Test {
 protected:
  void TearDown() override {
    for (const std::string& message : device_.take_validation_messages()) ADD_FAILURE() << message;
  }

  /// Runs the method over the picture in tiles of `tile_rows` (0: as high as it can).
  Result run(visibility::Method& method, const Stage& stage, std::uint32_t tile_rows = 0) {
    method.prepare_mesh(stage.scene);
    method.prepare_light(stage.light);
    method.prepare_view(stage.samples);
    const bool masks = method.description().output == visibility::Output::mask;
    const std::uint32_t words = stage.light.words_per_mask(), width = stage.samples.width,
                        height = stage.samples.height;
    Result result;
    result.visibility.resize(stage.samples.size());
    if (masks) result.masks.resize(stage.samples.size() * words);
    const std::uint32_t rows = tile_rows == 0 ? method.max_tile_rows() : tile_rows;
    for (std::uint32_t row = 0; row < height; row += rows) {
      const visibility::Tile tile{row, std::min(rows, height - row)};
      method.evaluate(tile);
      const std::size_t first = std::size_t{row} * width, count = std::size_t{tile.row_count} * width;
      method.read_visibility(std::span(result.visibility).subspan(first, count));
      if (masks) method.read_masks(std::span(result.masks).subspan(first * words, count * words));
    }
    return result;
  }
  Result run(const Factory& factory, const Stage& stage, const visibility::MethodOptions& options = {}) {
    return run(*factory(device_, options), stage);
  }

  render::Device device_{render::DeviceOptions{.wanted = "", .validation = true}};
};

/// Root of the mean square of difference(pixel) over pixels for which `judged(pixel)`.
inline double rmse(const Stage& stage, const std::function<bool(std::size_t)>& judged,
                   const std::function<double(std::size_t)>& difference) {
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < stage.samples.size(); ++i) {
    if (!judged(i)) continue;
    sum += difference(i) * difference(i);
    ++count;
  }
  EXPECT_GT(count, 0u);
  return std::sqrt(sum / static_cast<double>(count));
}

}  // namespace penumbra::maps_test
