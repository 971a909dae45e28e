// Direct light on diffuse surfaces, equations 1.3 and 1.4 of Eisemann, Schwarz, Assarsson, Wimmer: Real-Time Shadows
// (2011), estimated with the light samples of the method. cos θp · cos θl / d² is written (n·d)(−m·d) / (d²)², m the
// light's normal: no square root, and loops over 32 samples that compilers turn into vector instructions.
#include "compare/beauty.hpp"

#include "base/assert.hpp"

#include <glm/geometric.hpp>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>

namespace penumbra::compare {
namespace {

constexpr std::size_t kBlock = 32;  // samples in one word of a mask
constexpr std::size_t kLanes = 4;   // partial sums, so that additions need not wait for one another

/// The bits of four neighbouring samples as factors.
constexpr auto kFactors = [] {
  std::array<std::array<double, kLanes>, 16> factors{};
  for (unsigned bits = 0; bits < 16; ++bits) {
    for (unsigned lane = 0; lane < kLanes; ++lane) factors[bits][lane] = bits >> lane & 1;
  }
  return factors;
}();

/// Light points one coordinate after the other, filled up to whole blocks (the mask's bits are 0 there).
struct Points {
  std::vector<double> x, y, z;
  explicit Points(std::size_t count) : x((count + kBlock - 1) / kBlock * kBlock), y(x.size()), z(x.size()) {}
  void set(std::size_t i, const glm::vec3& p) {
    x[i] = p.x;
    y[i] = p.y;
    z[i] = p.z;
  }
};

struct Receiver {
  glm::dvec3 p, n;  ///< view sample
  glm::dvec3 m;     ///< the light's normal
};

/// A block's light points.
struct Block {
  const double *x, *y, *z;
};

/// cos θp · cos θl / d² of the block's samples.
template <bool kTwoSided>
std::array<double, kBlock> weigh_block(const Receiver& r, const Block& block) {
  const double *x = block.x, *y = block.y, *z = block.z;
  std::array<double, kBlock> weight;
  for (std::size_t j = 0; j < kBlock; ++j) {
    const double dx = x[j] - r.p.x, dy = y[j] - r.p.y, dz = z[j] - r.p.z;
    const double squared = dx * dx + dy * dy + dz * dz;
    const double at_receiver = std::max(0.0, r.n.x * dx + r.n.y * dy + r.n.z * dz);
    const double along = -(r.m.x * dx + r.m.y * dy + r.m.z * dz);
    const double at_light = kTwoSided ? std::abs(along) : std::max(0.0, along);
    // d = 0 makes the numerator 0 as well; float32 coordinates keep every other (d²)² above 1e-180.
    weight[j] = at_receiver * at_light / std::max(squared * squared, 1e-300);
  }
  return weight;
}

/// Σ over the block's samples whose bit is set of their weight.
double sum_block(const std::array<double, kBlock>& weight, std::uint32_t bits) {
  std::array<double, kLanes> sum{};
  for (std::size_t j = 0; j < kBlock; j += kLanes) {
    const auto& factor = kFactors[bits >> j & 15];
    for (std::size_t lane = 0; lane < kLanes; ++lane) sum[lane] += weight[j + lane] * factor[lane];
  }
  return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

/// The word of a mask in which every sample that exists is visible.
std::uint32_t full_word(std::uint32_t sample_count, std::size_t word) {
  const std::size_t left = sample_count - word * 32;
  return left >= 32 ? 0xffffffffu : (1u << left) - 1;
}

/// The same with each sample's texel as a factor.
glm::dvec3 sum_block(const std::array<double, kBlock>& weight, std::uint32_t bits, const glm::vec3* colors) {
  glm::dvec3 sum(0);
  for (; bits != 0; bits &= bits - 1) {
    const auto j = static_cast<std::size_t>(std::countr_zero(bits));
    sum += weight[j] * glm::dvec3(colors[j]);
  }
  return sum;
}

/// Σ_j visible_j · texel_j · cos θp · cos θl / d² of a view sample; `mask` null: all visible; no texture: texel 1.
glm::dvec3 sum_light(const Receiver& receiver, const visibility::Light& light, const Points& points,
                     const std::uint32_t* mask) {
  const bool two_sided = light.two_sided && light.kind != visibility::LightKind::sphere;
  double sum = 0;
  glm::dvec3 colored(0);
  for (std::size_t word = 0; word < light.words_per_mask(); ++word) {
    const std::uint32_t full = full_word(light.sample_count(), word);
    const std::uint32_t bits = mask != nullptr ? mask[word] & full : full;
    if (bits == 0) continue;
    const std::size_t i = word * kBlock;
    const Block block{&points.x[i], &points.y[i], &points.z[i]};
    const auto weight = two_sided ? weigh_block<true>(receiver, block) : weigh_block<false>(receiver, block);
    if (light.texture) {
      colored += sum_block(weight, bits, &light.sample_colors[i]);
    } else {
      sum += sum_block(weight, bits);
    }
  }
  return light.texture ? colored : glm::dvec3(sum);
}

/// What the light's body shows at p: radiance times the texel that is there, or nearest to p.
glm::dvec3 radiance_at(const visibility::Light& light, const glm::vec3& p) {
  if (!light.texture) return light.radiance;
  const glm::dvec3 c(light.center), u = glm::dvec3(light.center_u) - c, v = glm::dvec3(light.center_v) - c;
  const glm::dvec3 q = glm::dvec3(p) - c, n = glm::cross(u, v);
  // q = s u + t v + h n: s (u × v) · n = (q × v) · n, and likewise t.
  const double under = glm::dot(n, n);
  const glm::dvec2 st(glm::dot(glm::cross(q, v), n) / under, glm::dot(glm::cross(u, q), n) / under);
  return light.radiance * glm::dvec3(light.texture->colors[light.texture->texel_at(st)]);
}

/// Adds one light to the pixels [begin, end).
void add_light(const BeautyScene& in, const visibility::Light& light, const LightVisibility& seen, std::size_t begin,
               std::size_t end, const Points& fixed_points, std::span<glm::dvec3> beauty) {
  const bool is_sphere = light.kind == visibility::LightKind::sphere;
  const std::uint32_t count = light.sample_count();
  const glm::dvec3 scale = light.radiance * (light.area / count / std::numbers::pi);
  const glm::dvec3 center(light.center);
  const glm::dvec3 frame_normal =
      is_sphere ? glm::dvec3(0) : glm::cross(glm::dvec3(light.center_u) - center, glm::dvec3(light.center_v) - center);
  Points sphere_points(is_sphere ? count : 0);
  std::vector<glm::vec3> scratch(is_sphere ? count : 0);

  for (std::size_t i = begin; i < end; ++i) {
    const std::int32_t triangle = in.samples.triangle[i];
    if (triangle < 0 || in.scene.emits[static_cast<std::size_t>(triangle)] >= 0) continue;
    const bool shadowed = in.scene.receives_shadow[static_cast<std::size_t>(triangle)] != 0;
    Receiver receiver{glm::dvec3(in.samples.p[i]), glm::dvec3(in.samples.n[i]), frame_normal};
    if (is_sphere) {
      visibility::light_points_for(light, in.samples.p[i], scratch.data());
      for (std::uint32_t j = 0; j < count; ++j) sphere_points.set(j, scratch[j]);
      receiver.m = receiver.p - center;
    }
    const double length = glm::length(receiver.m);
    if (length == 0) continue;  // p is the centre of a sphere light: it sees no disk
    receiver.m /= length;
    const Points& points = is_sphere ? sphere_points : fixed_points;
    glm::dvec3 sum(0);
    if (!shadowed || seen.masks.empty()) {
      sum = sum_light(receiver, light, points, nullptr);
      if (shadowed) sum *= static_cast<double>(seen.visibility[i]);
    } else {
      sum = sum_light(receiver, light, points, &seen.masks[i * light.words_per_mask()]);
    }
    beauty[i - begin] += in.colors[in.scene.object[static_cast<std::size_t>(triangle)]] * scale * sum;
  }
}

}  // namespace

std::vector<glm::vec3> integrate_beauty(const BeautyScene& scene, std::span<const LightVisibility> visibility) {
  const std::size_t pixel_count = scene.samples.size();
  PENUMBRA_ASSERT(visibility.size() == scene.lights.size(), "{} visibilities for {} lights", visibility.size(),
                  scene.lights.size());
  std::vector<Points> points;
  for (std::size_t k = 0; k < scene.lights.size(); ++k) {
    const visibility::Light& light = scene.lights[k];
    const LightVisibility& seen = visibility[k];
    const bool fits = seen.masks.empty() ? seen.visibility.size() == pixel_count
                                         : seen.masks.size() == pixel_count * light.words_per_mask();
    PENUMBRA_ASSERT(fits, "{} mask words and {} values for {} pixels and {} samples", seen.masks.size(),
                    seen.visibility.size(), pixel_count, light.sample_count());
    Points& fixed = points.emplace_back(light.points.size());  // a sphere has none
    for (std::size_t j = 0; j < light.points.size(); ++j) fixed.set(j, light.points[j]);
  }

  std::vector<glm::vec3> beauty(pixel_count);
  constexpr std::size_t kGrain = 256;  // pixels: enough to drown the cost of a task
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, pixel_count, kGrain), [&](const auto& range) {
    std::vector<glm::dvec3> sum(range.size(), glm::dvec3(0));
    for (std::size_t k = 0; k < scene.lights.size(); ++k) {
      add_light(scene, scene.lights[k], visibility[k], range.begin(), range.end(), points[k], sum);
    }
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      const std::int32_t triangle = scene.samples.triangle[i];
      const std::int32_t emits = triangle < 0 ? -1 : scene.scene.emits[static_cast<std::size_t>(triangle)];
      if (emits >= 0) {
        // By the light's number in the scene: `lights` may hold only those that were asked for.
        for (const visibility::Light& light : scene.lights) {
          if (light.index == emits) sum[i - range.begin()] = radiance_at(light, scene.samples.p[i]);
        }
      }
      beauty[i] = glm::vec3(sum[i - range.begin()]);
    }
  });
  return beauty;
}

}  // namespace penumbra::compare
