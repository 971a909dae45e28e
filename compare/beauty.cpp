// SPDX-License-Identifier: Apache-2.0
// Computes direct light on diffuse surfaces, equations 1.3 and 1.4 of Eisemann, Schwarz, Assarsson, Wimmer: Real-Time
// Shadows (2011), with the integrals in closed form where available (visibility/lights/form_factor.hpp).
#include "compare/beauty.hpp"

#include "base/assert.hpp"
#include "compare/visible_light.hpp"
#include "visibility/lights/whole_form_factors.hpp"
#include "visibility/receivers.hpp"

#include <glm/geometric.hpp>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace penumbra::compare {
namespace {

/// Returns the radiance of the light's body at p: the light's radiance times the texel there, or nearest to p.
glm::dvec3 radiance_at(const visibility::Light& light, const glm::vec3& p) {
  if (!light.texture) return light.radiance;
  const auto [c, u, v] = visibility::light_frame(light);
  const glm::dvec3 q = glm::dvec3(p) - c, n = glm::cross(u, v);
  // q = s u + t v + h n: s (u × v) · n = (q × v) · n; t in the same form.
  const double under = glm::dot(n, n);
  const glm::dvec2 st(glm::dot(glm::cross(q, v), n) / under, glm::dot(glm::cross(u, q), n) / under);
  return light.radiance * glm::dvec3(light.texture->colors[light.texture->texel_at(st)]);
}

/// Returns the form factor of the visible part of the light at a shadowed pixel, by its mask or V.
glm::dvec3 form_factor_of(const LitPoint& at, const VisibleLight& light, const LightVisibility& seen, std::size_t pixel,
                          std::size_t words) {
  if (!seen.masks.empty()) {
    const std::size_t pairs = light.light().sample_count();
    const bool dimmed = !seen.dimmed.empty() && seen.dimmed[pixel] != 0;
    return light.visible(at, seen.masks.subspan(pixel * words, words),
                         dimmed ? seen.transmittances.subspan(pixel * pairs, pairs) : std::span<const float>());
  }
  return double{seen.visibility[pixel]} * light.whole(at);
}

/// Returns the factor by which the whole light's form factor is multiplied at a pixel. If the method gave the form
/// factor of the facet, this is the visible fraction of the light received by the facet, in which each part of the
/// light counts by its distance and cosines, not by its area alone. It is V without a form factor, and where some of
/// the light is below the facet's plane, which V counts as hidden.
double share_of(const visibility::Light& light, const BeautyScene& in, std::size_t i, const LightVisibility& seen,
                std::size_t asked) {
  const double v = seen.visibility[asked];
  if (v == 1 || seen.form_factors.empty()) return v;
  const visibility::UnshadowedLight facet(light, in.samples.p[i], in.samples.n[i]);
  const double whole = facet.shines() && facet.above_horizon() ? facet.whole() : 0;
  return whole > 0 ? std::clamp(seen.form_factors[asked].x / whole, 0.0, 1.0) : v;
}

/// Returns whether the light has uniform radiance, so that its form factor has a closed form.
bool is_plain(const visibility::Light& light) {
  return !light.texture && (!light.dome || light.dome->sky == nullptr);
}

/// Returns whether the pixel needs only the form factor of the whole light (all of a plain light is visible, or V
/// multiplies it), which is computed with vector instructions.
bool takes_whole(const VisibleLight& light, const LightVisibility& seen, std::size_t pixel, std::size_t words) {
  if (!is_plain(light.light())) return false;
  if (seen.masks.empty()) return true;
  const bool dimmed = !seen.dimmed.empty() && seen.dimmed[pixel] != 0;
  return !dimmed && light.sees_all(seen.masks.subspan(pixel * words, words));
}

bool is_unwanted(std::span<const float> wanted, std::size_t asked) {
  return !wanted.empty() && std::isnan(wanted[asked]);
}

/// Adds one light to the pixels [begin, end), which are within the range of `beauty`.
void add_light(const BeautyScene& in, const VisibleLight& visible, const LightVisibility& seen,
               std::span<const float> wanted, std::size_t begin, std::size_t end, std::span<glm::dvec3> beauty) {
  const visibility::Light& light = visible.light();
  const std::size_t words = light.words_per_mask();
  const auto add = [&](std::size_t i, const glm::dvec3& form_factor) {
    if (form_factor == glm::dvec3(0)) return;
    const auto triangle = static_cast<std::size_t>(in.samples.triangle[i]);
    const glm::dvec3 color = in.pixel_colors.empty() ? in.colors[in.scene.object[triangle]] : in.pixel_colors[i];
    const glm::vec3& normal = in.normals.empty() ? in.samples.n[i] : in.normals[i];
    beauty[i - begin] += color * light.radiance * spot_share(light, in.samples.p[i], normal) * form_factor;
  };
  std::vector<std::uint32_t> wholes;  // pixels, and the factors of their form factors
  std::vector<double> shares;
  for (std::size_t i = begin; i < end; ++i) {
    const std::size_t asked = i - in.first_pixel;
    if (in.samples.triangle[i] < 0 || is_unwanted(wanted, asked)) continue;
    const auto triangle = static_cast<std::size_t>(in.samples.triangle[i]);
    // the light's own body: V and masks are set by a rule, not computed
    if (in.scene.emits[triangle] == light.index) continue;
    if (!is_lit_by(in.scene, light, static_cast<std::uint32_t>(triangle))) continue;
    const bool bent = !in.normals.empty() && in.normals[i] != in.samples.n[i];
    const bool shadowed = in.scene.receives_shadow[triangle] != 0;
    if (shadowed && !seen.form_factors.empty() && (!bent || seen.visibility.empty())) {
      add(i, seen.form_factors[asked]);
      continue;
    }
    if (shadowed && seen.masks.empty() && seen.visibility[asked] == 0) continue;
    if (shadowed ? takes_whole(visible, seen, asked, words) : is_plain(light)) {
      wholes.push_back(static_cast<std::uint32_t>(i));
      shares.push_back(shadowed && seen.masks.empty() ? share_of(light, in, i, seen, asked) : 1.0);
      continue;
    }
    if (shadowed && !seen.masks.empty() && !visible.sees_any(seen.masks.subspan(asked * words, words))) continue;
    const visibility::UnshadowedLight view(light, in.samples.p[i], bent ? in.normals[i] : in.samples.n[i]);
    if (!view.shines()) continue;
    const LitPoint at{view, in.samples.p[i]};
    if (shadowed)
      add(i, form_factor_of(at, visible, seen, asked, words));
    else
      add(i, seen.masks.empty() ? visible.whole(at) : visible.unshadowed(at));
  }
  std::vector<double> form_factors(wholes.size());
  visibility::whole_form_factors(light, {in.samples.p, in.normals.empty() ? in.samples.n : in.normals, wholes},
                                 form_factors);
  for (std::size_t k = 0; k < wholes.size(); ++k) add(wholes[k], glm::dvec3(shares[k] * form_factors[k]));
}

}  // namespace

std::vector<glm::vec3> integrate_beauty(const BeautyScene& scene, std::span<const LightVisibility> visibility) {
  PENUMBRA_ASSERT(scene.first_pixel == 0, "all pixels, not those from {} on", scene.first_pixel);
  std::vector<glm::vec3> beauty(scene.samples.size(), glm::vec3(0));
  add_beauty(scene, visibility, {}, beauty);
  return beauty;
}

void add_beauty(const BeautyScene& scene, std::span<const LightVisibility> visibility, std::span<const float> wanted,
                std::span<glm::vec3> beauty) {
  const std::size_t pixel_count = beauty.size();
  PENUMBRA_ASSERT(visibility.size() == scene.lights.size(), "{} visibilities for {} lights", visibility.size(),
                  scene.lights.size());
  for (std::size_t k = 0; k < scene.lights.size(); ++k) {
    const visibility::Light& light = scene.lights[k];
    const LightVisibility& seen = visibility[k];
    const bool fits = !seen.form_factors.empty() ? seen.form_factors.size() == pixel_count
                      : seen.masks.empty()       ? seen.visibility.size() == pixel_count
                                                 : seen.masks.size() == pixel_count * light.words_per_mask();
    PENUMBRA_ASSERT(fits, "{} form factors, {} mask words and {} values for {} pixels and {} samples",
                    seen.form_factors.size(), seen.masks.size(), seen.visibility.size(), pixel_count,
                    light.sample_count());
  }

  const std::vector<VisibleLight> lights(scene.lights.begin(), scene.lights.end());
  constexpr std::size_t kGrain = 256;  // pixels: enough to make the cost of a task negligible
  const std::size_t first = scene.first_pixel;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(first, first + pixel_count, kGrain), [&](const auto& range) {
    std::vector<glm::dvec3> sum(range.size(), glm::dvec3(0));
    for (std::size_t k = 0; k < lights.size(); ++k)
      add_light(scene, lights[k], visibility[k], wanted, range.begin(), range.end(), sum);
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      if (is_unwanted(wanted, i - first)) continue;
      const std::int32_t triangle = scene.samples.triangle[i];
      const std::int32_t emits = triangle < 0 ? -1 : scene.scene.emits[static_cast<std::size_t>(triangle)];
      if (emits >= 0) {
        // Compared by the light's index in the scene: `lights` may hold only the requested lights.
        for (const visibility::Light& light : scene.lights) {
          if (light.index == emits && light.piece == 0)
            sum[i - range.begin()] += radiance_at(light, scene.samples.p[i]);
        }
      }
      beauty[i - first] += glm::vec3(sum[i - range.begin()]);
    }
  });
}

}  // namespace penumbra::compare
