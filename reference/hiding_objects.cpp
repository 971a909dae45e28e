// SPDX-License-Identifier: Apache-2.0
// Rays that record every object that they meet: Embree's filter function inspects and rejects each hit.

#include "reference/hiding_objects.hpp"

#include "reference/embree_packets.hpp"
#include "reference/embree_scene.hpp"
#include "reference/tracing_order.hpp"
#include "visibility/pair_truth.hpp"

#include <glm/geometric.hpp>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <limits>

namespace penumbra::reference {
namespace {

using visibility::Light;
using visibility::SceneFloats;
using visibility::ViewSamples;

constexpr std::size_t kSpread = 16;  // light samples that are always tested

/// Embree passes the address of the first member to the filter.
struct Context {
  RTCIntersectContext embree;
  const SceneFloats* scene;
  const std::uint32_t* triangles;  // triangle of each primitive
  std::int32_t light;              // the light, whose own body hides nothing
  std::uint32_t carrier;
  HiddenBy found;
  float first;  // smallest t on the ray at which something hides the light
};

void note_object(const RTCFilterFunctionNArguments* hits) {
  auto& context = *reinterpret_cast<Context*>(hits->context);
  const SceneFloats& scene = *context.scene;
  for (unsigned i = 0; i < hits->N; ++i) {
    if (hits->valid[i] == 0) continue;
    const std::uint32_t triangle = context.triangles[RTCHitN_primID(hits->hit, hits->N, i)];
    const bool hides = scene.plane[triangle] != scene.plane[context.carrier] && scene.emits[triangle] != context.light;
    if (hides) {
      (scene.object[triangle] == scene.object[context.carrier] ? context.found.own : context.found.other) = true;
      context.first = std::min(context.first, RTCRayN_tfar(hits->ray, hits->N, i));
    }
    hits->valid[i] = 0;  // farther than the nearest hit so far
  }
}

/// Returns light samples from one end of the light to the other, those that are always tested first.
std::vector<std::uint32_t> spread_order(const Light& light) {
  const std::vector<std::uint32_t> near = tracing_order(light);
  const std::size_t step = std::max<std::size_t>(near.size() / kSpread, 1);
  std::vector<std::uint32_t> order;
  for (std::size_t start = 0; start < step; ++start) {
    for (std::size_t i = start; i < near.size(); i += step) order.push_back(near[i]);
  }
  return order;
}

HiddenBy hidden_by(const EmbreeScene& embree, Context& context, const Light& light, const glm::vec3& p,
                   std::span<const glm::vec3> points, std::span<const std::uint32_t> order) {
  const EmbreeRange& range = embree.range();
  const glm::vec3 origin = range.scaled(p);
  context.found = {};
  constexpr float kNever = std::numeric_limits<float>::infinity();
  double widening = 0;
  std::size_t hidden = 0;
  for (std::size_t i = 0; i < order.size() && (i < kSpread || hidden == 0); ++i) {
    const glm::vec3& point = points[order[i]];
    const glm::vec3 direction = light.sun ? EmbreeRange::direction(point) : range.scaled(point) - origin;
    RTCRay ray{};
    ray.org_x = origin.x, ray.org_y = origin.y, ray.org_z = origin.z;
    ray.dir_x = direction.x, ray.dir_y = direction.y, ray.dir_z = direction.z;
    ray.tfar = light.sun ? kNever : 0x1.fffffep-1F;
    ray.mask = 0xffffffffU;
    context.first = kNever;
    rtcOccluded1(embree.handle(), &context.embree, &ray);
    if (context.first == kNever) continue;
    ++hidden;
    const double share = double{context.first}, toward = share * glm::length(glm::dvec3(direction)) / range.scale();
    context.found.nearest = std::min(context.found.nearest, toward);
    widening += light.sun ? toward : share / (1 - share);
  }
  if (hidden != 0) context.found.widening = widening / static_cast<double>(hidden);
  return context.found;
}

}  // namespace

std::vector<HiddenBy> hiding_objects(const SceneFloats& scene, const ViewSamples& samples, const Light& light,
                                     std::span<const std::uint32_t> pixels) {
  std::vector<HiddenBy> hidden(pixels.size());
  std::vector<std::uint32_t> casting;
  for (std::uint32_t i = 0; i < scene.triangles.size(); ++i) {
    if (scene.casts_shadow[i] != 0) casting.push_back(i);
  }
  if (casting.empty() || pixels.empty()) return hidden;
  const EmbreeScene embree(scene, std::move(casting), EmbreeScene::Filter::by_context, EmbreeScene::Build::medium);
  if (!light.sun) embree.range().require_light(light, point_bounds(light));
  const std::vector<std::uint32_t> order = spread_order(light);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, pixels.size(), 256), [&](const auto& range) {
    Context context{};
    rtcInitIntersectContext(&context.embree);
    context.embree.filter = note_object;
    context.scene = &scene;
    context.triangles = embree.triangles().data();
    context.light = light.index;
    std::vector<glm::vec3> points(light.points);
    for (std::size_t i = range.begin(); i != range.end(); ++i) {
      const glm::vec3& p = samples.p[pixels[i]];
      if (light.points.empty()) {  // a sphere's light points depend on p
        points.resize(light.sample_count());
        light_points_for(light, p, points.data());
      }
      context.carrier = static_cast<std::uint32_t>(samples.triangle[pixels[i]]);
      hidden[i] = hidden_by(embree, context, light, p, points, order);
    }
  });
  embree.check();
  return hidden;
}

}  // namespace penumbra::reference
