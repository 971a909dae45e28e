// SPDX-License-Identifier: Apache-2.0
// Plain shadow rays through Embree in packets, as a renderer traces them; a speed reference for benchmarks.

#include "reference/plain_rays.hpp"

#include "base/assert.hpp"
#include "reference/embree_packets.hpp"
#include "reference/tracing_order.hpp"
#include "visibility/pair_truth.hpp"
#include "visibility/receivers.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <pmmintrin.h>
#include <tbb/blocked_range2d.h>
#include <tbb/parallel_for.h>
#include <xmmintrin.h>

#include <algorithm>
#include <limits>
#include <numeric>

namespace penumbra::reference {
namespace {

/// Flushes denormals to zero while rays are traced, as Embree's manual recommends; restored afterwards, because the
/// threads also run code whose results must not depend on this mode.
class FlushDenormals {
 public:
  FlushDenormals() : saved_(_mm_getcsr()) {
    _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);
    _MM_SET_DENORMALS_ZERO_MODE(_MM_DENORMALS_ZERO_ON);
  }
  ~FlushDenormals() { _mm_setcsr(saved_); }
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;

 private:
  unsigned saved_;
};

}  // namespace

PlainRays::PlainRays(const Options& options) : options_(options) {
  PENUMBRA_ASSERT(
      options.width == 0 || options.width == 1 || options.width == 4 || options.width == 8 || options.width == 16,
      "width {}", options.width);
}

void PlainRays::build(std::int32_t without_light) {
  std::vector<std::uint32_t> casting;
  casting.reserve(scene_->triangles.size());
  for (std::uint32_t i = 0; i < scene_->triangles.size(); ++i) {
    const bool own_body = without_light >= 0 && scene_->emits[i] == without_light;
    if (scene_->casts_shadow[i] != 0 && !own_body) casting.push_back(i);
  }
  embree_.reset();
  embree_.emplace(*scene_, std::move(casting), EmbreeScene::Filter::none,
                  options_.one_frame ? EmbreeScene::Build::medium : EmbreeScene::Build::high);
  built_without_ = without_light;
}

void PlainRays::prepare_mesh(const visibility::SceneFloats& scene) {
  scene_ = &scene;
  build(-1);
  const EmbreeRange& range = embree_->range();
  // a few ulps of the scene's size
  offset_ = 0x1p-16f * glm::length(range.scaled(scene.upper) - range.scaled(scene.lower));
}

void PlainRays::prepare_light(const visibility::Light& light) {
  PENUMBRA_ASSERT(scene_ != nullptr, "prepare_mesh comes first");
  light_ = &light;
  const bool has_body = std::find(scene_->emits.begin(), scene_->emits.end(), light.index) != scene_->emits.end();
  const std::int32_t without = has_body ? light.index : -1;
  if (without != built_without_) build(without);
  order_.resize(light.sample_count());
  std::iota(order_.begin(), order_.end(), 0u);
  if (options_.neighbours) order_ = tracing_order(light);
  if (!light.sun) embree_->range().require_light(light, point_bounds(light));
  if (is_body(light.kind)) return;
  const EmbreeRange& range = embree_->range();
  points_.assign(light.points, order_,
                 [&](const glm::vec3& l) { return light.sun ? EmbreeRange::direction(l) : range.scaled(l); });
}

template <typename Scaled>
void PlainRays::PointArrays::assign(std::span<const glm::vec3> points, std::span<const std::uint32_t> order,
                                    const Scaled& scaled) {
  constexpr std::size_t kWidest = 16;
  const std::size_t padded = (order.size() + kWidest - 1) / kWidest * kWidest;
  for (std::vector<float>* axis : {&x, &y, &z}) axis->resize(padded);
  for (std::size_t i = 0; i < padded; ++i) {
    const glm::vec3 point = scaled(points[order[std::min(i, order.size() - 1)]]);
    x[i] = point.x;
    y[i] = point.y;
    z[i] = point.z;
  }
}

template <typename Body>
void PlainRays::with_width(const Body& body) const {
  switch (options_.width != 0 ? options_.width : embree_->native_width()) {
    case 1:
      return body.template operator()<1>();
    case 4:
      return body.template operator()<4>();
    case 16:
      return body.template operator()<16>();
    default:
      return body.template operator()<8>();
  }
}

template <int kWidth>
void PlainRays::look_at_pixels(const visibility::PinholeCamera& camera, visibility::ViewSamples& samples) const {
  const EmbreeRange& range = embree_->range();
  const glm::vec3 eye = range.scaled(glm::vec3(camera.eye));
  const auto unscaled = static_cast<float>(1 / range.scale());
  tbb::parallel_for(tbb::blocked_range<std::uint32_t>(0, camera.height, 8), [&](const auto& rows) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    typename Packet<kWidth>::Hits rays;
    alignas(64) int valid[kWidth];
    for (std::uint32_t y = rows.begin(); y != rows.end(); ++y) {
      for (std::uint32_t x = 0; x < camera.width; x += kWidth) {
        for (std::uint32_t lane = 0; lane < kWidth; ++lane) {
          const glm::vec3 d(camera.direction(x + lane, y));
          valid[lane] = x + lane < camera.width ? -1 : 0;
          lanes(rays.ray.org_x)[lane] = eye.x;
          lanes(rays.ray.org_y)[lane] = eye.y;
          lanes(rays.ray.org_z)[lane] = eye.z;
          lanes(rays.ray.dir_x)[lane] = d.x;
          lanes(rays.ray.dir_y)[lane] = d.y;
          lanes(rays.ray.dir_z)[lane] = d.z;
          lanes(rays.ray.tnear)[lane] = 0;
          lanes(rays.ray.tfar)[lane] = std::numeric_limits<float>::infinity();
          lanes(rays.ray.mask)[lane] = 0xffffffffu;
          lanes(rays.ray.time)[lane] = 0;
          lanes(rays.ray.id)[lane] = 0;
          lanes(rays.ray.flags)[lane] = 0;
          lanes(rays.hit.geomID)[lane] = RTC_INVALID_GEOMETRY_ID;
          lanes(rays.hit.instID[0])[lane] = RTC_INVALID_GEOMETRY_ID;
        }
        const FlushDenormals flush;
        Packet<kWidth>::intersect(valid, embree_->handle(), &context, &rays);
        for (std::uint32_t lane = 0; lane < kWidth; ++lane) {
          if (valid[lane] == 0 || lanes(rays.hit.geomID)[lane] == RTC_INVALID_GEOMETRY_ID) continue;
          const std::size_t pixel = std::size_t{y} * camera.width + x + lane;
          const glm::vec3 d(lanes(rays.ray.dir_x)[lane], lanes(rays.ray.dir_y)[lane], lanes(rays.ray.dir_z)[lane]);
          const glm::vec3 n = glm::normalize(
              glm::vec3(lanes(rays.hit.Ng_x)[lane], lanes(rays.hit.Ng_y)[lane], lanes(rays.hit.Ng_z)[lane]));
          samples.triangle[pixel] = static_cast<std::int32_t>(embree_->triangles()[lanes(rays.hit.primID)[lane]]);
          samples.p[pixel] = (eye + lanes(rays.ray.tfar)[lane] * d) * unscaled;
          samples.n[pixel] = glm::dot(n, d) > 0 ? -n : n;
        }
      }
    }
  });
  embree_->check();
}

visibility::ViewSamples PlainRays::look(const visibility::PinholeCamera& camera) const {
  PENUMBRA_ASSERT(embree_ && !camera.half_height, "prepare_mesh comes first; a perspective camera");
  visibility::ViewSamples samples;
  samples.width = camera.width;
  samples.height = camera.height;
  const std::size_t pixels = std::size_t{camera.width} * camera.height;
  samples.triangle.assign(pixels, visibility::ViewSamples::kBackground);
  samples.p.assign(pixels, glm::vec3(0));
  samples.n.assign(pixels, glm::vec3(0));
  with_width([&]<int kWidth>() { look_at_pixels<kWidth>(camera, samples); });
  return samples;
}

template <int kWidth>
int PlainRays::trace_pixel(const glm::vec3& p, const glm::vec3& n, const PointArrays& points,
                           RTCIntersectContext& context) const {
  typename Packet<kWidth>::Rays rays;
  alignas(64) int valid[kWidth];
  for (std::size_t lane = 0; lane < kWidth; ++lane) {
    lanes(rays.org_x)[lane] = p.x;
    lanes(rays.org_y)[lane] = p.y;
    lanes(rays.org_z)[lane] = p.z;
    lanes(rays.tnear)[lane] = 0;
    lanes(rays.mask)[lane] = 0xffffffffu;
    lanes(rays.time)[lane] = 0;
    lanes(rays.id)[lane] = 0;
    lanes(rays.flags)[lane] = 0;
  }
  const glm::vec3 from = light_->sun ? glm::vec3(0) : p;
  const float end = light_->sun ? std::numeric_limits<float>::infinity() : 1.0F;
  int visible = 0;
  const std::size_t count = light_->sample_count();
  for (std::size_t first = 0; first < count; first += kWidth) {
    int alive = 0;
    for (std::size_t lane = 0; lane < kWidth; ++lane) {  // branch-free, so that the compiler vectorises the loop
      const float dx = points.x[first + lane] - from.x, dy = points.y[first + lane] - from.y,
                  dz = points.z[first + lane] - from.z;
      const bool above = n.x * dx + n.y * dy + n.z * dz > 0;
      valid[lane] = -static_cast<int>(above & (first + lane < count));
      alive |= valid[lane];
      lanes(rays.dir_x)[lane] = dx;
      lanes(rays.dir_y)[lane] = dy;
      lanes(rays.dir_z)[lane] = dz;
      lanes(rays.tfar)[lane] = end;
    }
    if (alive == 0) continue;
    Packet<kWidth>::occluded(valid, embree_->handle(), &context, &rays);
    for (std::size_t lane = 0; lane < kWidth; ++lane) {
      visible += static_cast<int>((valid[lane] != 0) & (lanes(rays.tfar)[lane] != kOccluded));
    }
  }
  return visible;
}

template <int kWidth>
void PlainRays::evaluate_pixels(const visibility::ViewSamples& samples, std::span<float> visibility) const {
  const visibility::Light& light = *light_;
  const bool sphere = is_body(light.kind);
  const EmbreeRange& range = embree_->range();
  const glm::vec3 light_center = range.scaled(light.center);
  const glm::dvec3 light_normal = glm::cross(glm::dvec3(light.center_u - light.center),  // may be far too long
                                             glm::dvec3(light.center_v - light.center));
  const tbb::blocked_range2d<std::size_t> pixels(0, samples.height, 8, 0, samples.width, 32);
  tbb::parallel_for(pixels, [&](const tbb::blocked_range2d<std::size_t>& block) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = options_.coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    std::vector<glm::vec3> own_points(sphere ? light.sample_count() : 0);
    PointArrays own_arrays;
    for (std::size_t y = block.rows().begin(); y != block.rows().end(); ++y) {
      for (std::size_t x = block.cols().begin(); x != block.cols().end(); ++x) {
        const std::size_t pixel = y * samples.width + x;
        visibility[pixel] = 1;
        if (!visibility::is_receiver(*scene_, light, samples, pixel)) continue;
        visibility[pixel] = 0;
        const glm::vec3 n = samples.n[pixel], p = range.scaled(samples.p[pixel]) + offset_ * n;
        if (sphere) {
          if (!in_front_of_light(light, samples.p[pixel])) continue;
          light_points_for(light, samples.p[pixel], own_points.data());
          own_arrays.assign(own_points, order_, [&](const glm::vec3& l) { return range.scaled(l); });
        } else if (!light.sun) {
          const double front = glm::dot(light_normal, glm::dvec3(p - light_center));
          if (light.two_sided ? front == 0 : front <= 0) continue;
        }
        const FlushDenormals flush;  // set only now: scene floats may be denormal, but scaled ones are not
        const int visible = trace_pixel<kWidth>(p, n, sphere ? own_arrays : points_, context);
        visibility[pixel] = static_cast<float>(visible) / static_cast<float>(light.sample_count());
      }
    }
  });
  embree_->check();
}

void PlainRays::evaluate(const visibility::ViewSamples& samples, std::span<float> visibility) const {
  PENUMBRA_ASSERT(light_ != nullptr && visibility.size() == samples.size(), "{} pixels for {}", visibility.size(),
                  samples.size());
  with_width([&]<int kWidth>() { evaluate_pixels<kWidth>(samples, visibility); });
}

}  // namespace penumbra::reference
