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

/// Denormals as zero while rays are traced, as Embree's manual recommends; put back afterwards, because the threads are
/// shared with code whose results must not depend on this.
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
  for (std::uint32_t i = 0; i < scene_->triangles.size(); ++i) {
    const bool own_body = without_light >= 0 && scene_->emits[i] == without_light;
    if (scene_->casts_shadow[i] != 0 && !own_body) casting.push_back(i);
  }
  embree_.reset();
  embree_.emplace(*scene_, std::move(casting), EmbreeScene::Filter::none);
  built_without_ = without_light;
}

void PlainRays::prepare_mesh(const visibility::SceneFloats& scene) {
  scene_ = &scene;
  build(-1);
  const EmbreeRange& range = embree_->range();
  offset_ = 0x1p-16f * glm::length(range.scaled(scene.upper) - range.scaled(scene.lower));  // a few ulps of its size
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
  if (light.kind == visibility::LightKind::sphere) return;
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
    for (std::size_t lane = 0; lane < kWidth; ++lane) {  // branch-free: the compiler makes vectors of it
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
  const bool sphere = light.kind == visibility::LightKind::sphere;
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
        const FlushDenormals flush;  // no sooner: scene floats may be such, but scaled they are not
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
  switch (options_.width != 0 ? options_.width : embree_->native_width()) {
    case 1:
      return evaluate_pixels<1>(samples, visibility);
    case 4:
      return evaluate_pixels<4>(samples, visibility);
    case 16:
      return evaluate_pixels<16>(samples, visibility);
    default:
      return evaluate_pixels<8>(samples, visibility);
  }
}

}  // namespace penumbra::reference
