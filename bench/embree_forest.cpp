// SPDX-License-Identifier: Apache-2.0
// A plain program on Embree's two-level instancing: the peer of bench/forest.py, for scenes under one sun.
//   embree_forest SCENE.json SIZE SAMPLES
// Reads the scene, builds one hierarchy a mesh and one over the instances, traces a ray through each pixel's centre and
// SAMPLES (a square number) jittered shadow rays to the sun from surfaces that face its middle, and prints the mean
// visibility of these pixels.

#include "base/error.hpp"
#include "bench/embree_mesh.hpp"
#include "scenes/formats/reader.hpp"
#include "scenes/instances.hpp"
#include "visibility/view_samples.hpp"

#include <embree3/rtcore.h>
#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <string>
#include <utility>
#include <variant>

namespace penumbra::bench {
namespace {

constexpr int kLanes = 8;

RTCScene whole_scene(RTCDevice device, const scenes::Scene& scene, const scenes::Instances& instances) {
  RTCScene whole = rtcNewScene(device);
  rtcSetSceneFlags(whole, RTC_SCENE_FLAG_ROBUST);
  const auto add = [&](RTCScene part, const glm::dmat4& to_world) {
    std::array<float, 12> columns{};
    for (std::size_t i = 0; i < columns.size(); ++i)
      columns[i] = static_cast<float>(to_world[static_cast<int>(i / 3)][static_cast<int>(i % 3)]);
    RTCGeometry instance = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(instance, part);
    rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns.data());
    rtcCommitGeometry(instance);
    rtcAttachGeometry(whole, instance);
    rtcReleaseGeometry(instance);
  };
  add(robust_scene(device, scene.soup), glm::dmat4(1));
  std::vector<RTCScene> meshes;
  for (const auto& mesh : instances.meshes) meshes.push_back(robust_scene(device, mesh->soup));
  for (const scenes::Instance& instance : instances.all) add(meshes[instance.mesh], instance.placement.to_world);
  rtcCommitScene(whole);
  return whole;
}

/// Random numbers of one pixel in [0, 1) (PCG-RXS-M-XS, O'Neill 2014).
class Random {
 public:
  explicit Random(std::uint32_t seed) : state_(seed * 747796405u + 2891336453u) {}
  float operator()() {
    state_ = state_ * 747796405u + 2891336453u;
    const std::uint32_t word = ((state_ >> ((state_ >> 28u) + 4u)) ^ state_) * 277803737u;
    return static_cast<float>(((word >> 22u) ^ word) >> 8u) * 0x1p-24f;
  }

 private:
  std::uint32_t state_;
};

class Tracer {
 public:
  Tracer(RTCScene scene, const visibility::PinholeCamera& camera, const scenes::Sun& sun, std::uint32_t side)
      : scene_(scene), camera_(camera), side_(side), to_sun_(-sun.direction) {
    const glm::dvec3 other = std::abs(to_sun_.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const double radius = std::tan(sun.angle / 360 * std::numbers::pi);
    u_ = radius * glm::normalize(glm::cross(to_sun_, other));
    v_ = glm::cross(to_sun_, u_);
  }

  /// Adds the visibility of a row's pixels to `sum`, and their number to `count`.
  void row(std::uint32_t y, double& sum, std::uint64_t& count) const {
    for (std::uint32_t x = 0; x < camera_.width; ++x) {
      RTCIntersectContext context;
      rtcInitIntersectContext(&context);
      const glm::dvec3 d = camera_.direction(x, y);
      RTCRayHit hit{};
      hit.ray = {.org_x = static_cast<float>(camera_.eye.x),
                 .org_y = static_cast<float>(camera_.eye.y),
                 .org_z = static_cast<float>(camera_.eye.z),
                 .tnear = 0,
                 .dir_x = static_cast<float>(d.x),
                 .dir_y = static_cast<float>(d.y),
                 .dir_z = static_cast<float>(d.z),
                 .time = 0,
                 .tfar = std::numeric_limits<float>::infinity(),
                 .mask = ~0u,
                 .id = 0,
                 .flags = 0};
      hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
      hit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
      rtcIntersect1(scene_, &context, &hit);
      if (hit.hit.geomID == RTC_INVALID_GEOMETRY_ID) continue;
      sum += shadow(hit, camera_.eye + static_cast<double>(hit.ray.tfar) * d, d, y * camera_.width + x, count);
    }
  }

 private:
  double shadow(const RTCRayHit& hit, glm::dvec3 p, const glm::dvec3& d, std::uint32_t seed,
                std::uint64_t& count) const {
    glm::dmat4 to_world(1);
    std::array<float, 16> columns{};
    rtcGetGeometryTransform(rtcGetGeometry(scene_, hit.hit.instID[0]), 0, RTC_FORMAT_FLOAT4X4_COLUMN_MAJOR,
                            columns.data());
    for (std::size_t i = 0; i < columns.size(); ++i)
      to_world[static_cast<int>(i / 4)][static_cast<int>(i % 4)] = columns[i];
    glm::dvec3 n(scenes::world_normal(to_world, {hit.hit.Ng_x, hit.hit.Ng_y, hit.hit.Ng_z}));
    if (glm::dot(n, d) > 0) n = -n;
    if (glm::dot(n, to_sun_) <= 0) return 0;
    ++count;
    p += 1e-4 * n;
    Random random(seed);
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    alignas(32) int valid[kLanes];
    std::uint32_t seen = 0, begun = 0;
    while (begun < side_ * side_) {
      RTCRay8 rays{};
      for (int lane = 0; lane < kLanes; ++lane, ++begun) {
        const std::uint32_t i = begun % side_, j = begun / side_;
        const float radius = std::sqrt((static_cast<float>(i) + random()) / static_cast<float>(side_));
        const float angle =
            (static_cast<float>(j) + random()) / static_cast<float>(side_) * 2 * std::numbers::pi_v<float>;
        const glm::dvec3 to = to_sun_ + static_cast<double>(radius * std::cos(angle)) * u_ +
                              static_cast<double>(radius * std::sin(angle)) * v_;
        valid[lane] = begun < side_ * side_ ? -1 : 0;
        rays.org_x[lane] = static_cast<float>(p.x);
        rays.org_y[lane] = static_cast<float>(p.y);
        rays.org_z[lane] = static_cast<float>(p.z);
        rays.dir_x[lane] = static_cast<float>(to.x);
        rays.dir_y[lane] = static_cast<float>(to.y);
        rays.dir_z[lane] = static_cast<float>(to.z);
        rays.tfar[lane] = std::numeric_limits<float>::infinity();
        rays.mask[lane] = ~0u;
      }
      rtcOccluded8(valid, scene_, &context, &rays);
      for (int lane = 0; lane < kLanes; ++lane) seen += valid[lane] != 0 && rays.tfar[lane] > 0 ? 1 : 0;
    }
    return static_cast<double>(seen) / (side_ * side_);
  }

  RTCScene scene_;
  const visibility::PinholeCamera& camera_;
  std::uint32_t side_;
  glm::dvec3 to_sun_, u_{}, v_{};
};

int run(const std::string& file, std::uint32_t size, std::uint32_t samples) {
  scenes::Instances instances;
  scenes::ReadOptions options;
  options.instances = &instances;
  const scenes::Scene scene = scenes::read_scene(file, options);
  const auto* const sun = std::get_if<scenes::Sun>(&scene.lights.front().shape);
  const auto side = static_cast<std::uint32_t>(std::lround(std::sqrt(samples)));
  if (sun == nullptr || side * side != samples) throw UsageError("expected a sun and a square number of light samples");
  RTCDevice device = rtcNewDevice(nullptr);
  RTCScene whole = whole_scene(device, scene, instances);
  const visibility::PinholeCamera camera = visibility::make_camera(scene.cameras.front(), glm::dvec3(0), size, size);
  const Tracer tracer(whole, camera, *sun, side);
  using Sum = std::pair<double, std::uint64_t>;
  const Sum sum = tbb::parallel_reduce(
      tbb::blocked_range<std::uint32_t>(0, size, 4), Sum{},
      [&](const auto& rows, Sum some) {
        for (std::uint32_t y = rows.begin(); y != rows.end(); ++y) tracer.row(y, some.first, some.second);
        return some;
      },
      [](const Sum& a, const Sum& b) {
        return Sum{a.first + b.first, a.second + b.second};
      });
  fmt::print("{:.5f}\n", sum.first / static_cast<double>(sum.second));
  rtcReleaseScene(whole);
  rtcReleaseDevice(device);
  return 0;
}

}  // namespace
}  // namespace penumbra::bench

int main(int count, char** words) {
  if (count != 4) {
    fmt::print(stderr, "embree_forest SCENE.json SIZE SAMPLES\n");
    return 2;
  }
  try {
    return penumbra::bench::run(words[1], static_cast<std::uint32_t>(std::stoul(words[2])),
                                static_cast<std::uint32_t>(std::stoul(words[3])));
  } catch (const std::exception& error) {
    fmt::print(stderr, "embree_forest: {}\n", error.what());
    return 3;
  }
}
