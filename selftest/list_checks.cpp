// SPDX-License-Identifier: Apache-2.0
// Compares lists made from maps of light samples with each sample's map.

#include "selftest/list_checks.hpp"

#include "maps/host/map_fit.hpp"
#include "maps/products/lists/penumbra_events.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <bit>
#include <cmath>

namespace penumbra::selftest {
namespace {

/// Counts the samples that do not see a position, each by its own map; nullopt where rounding decides.
class SampleTwin {
 public:
  SampleTwin(const ListSource& made, const maps::SampleMaps& samples, std::uint32_t size)
      : made_(made), faces_(samples.faces()), size_(size), depths_(depths_of(samples, size)), views_(samples.count()) {
    samples.views().read<maps::gpu::LightView>(views_);
  }

  [[nodiscard]] std::optional<std::uint32_t> hidden(const glm::dvec3& place, std::size_t side) const {
    std::uint32_t count = 0;
    for (std::size_t j = 0; j < views_.size(); ++j) {
      const maps::gpu::SideView& seen = views_[j].side[side];
      for (std::uint32_t f = 0; f < seen.face_count; ++f) {
        const maps::Face axes = maps::face_of(views_[j], made_.basis, seen.first_face + f);
        const glm::dvec3 d = place - glm::dvec3(views_[j].point);
        const double w = glm::dot(d, axes.w);
        if (!(w > 0)) continue;
        const glm::dvec2 cell = (glm::dvec2(glm::dot(d, axes.a), glm::dot(d, axes.b)) / w - axes.lower) /
                                (axes.upper - axes.lower) * static_cast<double>(size_);
        const double off = std::min(std::abs(cell.x - std::round(cell.x)), std::abs(cell.y - std::round(cell.y)));
        if (off < 1e-3) return std::nullopt;  // on a texel's border: rounding decides
        const auto size = static_cast<double>(size_);
        if (cell.x < 0 || cell.y < 0 || cell.x >= size || cell.y >= size) continue;
        const std::size_t index =
            ((j * faces_ + seen.first_face + f) * size_ + static_cast<std::size_t>(cell.y)) * size_ +
            static_cast<std::size_t>(cell.x);
        const double depth = static_cast<double>(depths_[index]) * static_cast<double>(views_[j].far);
        if (std::abs(w - depth) < 1e-4 * w) return std::nullopt;
        count += w > depth ? 1 : 0;
      }
    }
    return count;
  }

 private:
  const ListSource& made_;
  std::size_t faces_, size_;
  std::vector<float> depths_;
  std::vector<maps::gpu::LightView> views_;
};

}  // namespace

ListSource::ListSource(const render::Device& device, const Stage& s, std::uint32_t size)
    : stage(s), basis(maps::light_basis(s.light)), casters(device, size) {
  const glm::vec3 at(basis.center);
  centre = maps::fit_views(s.floats, s.light, basis, std::span(&at, 1), {.size = size});
  casters.upload(s.floats);
  source.emplace(maps::MapSource{s.floats, s.light, basis, casters, centre.views.front(), centre.faces, size, 0.5,
                                 times, counters});
}

std::vector<float> depths_of(const maps::SampleMaps& samples, std::uint32_t size) {
  std::vector<float> depths;
  for (const maps::SampleMaps::Part& part : samples.parts()) {
    std::vector<float> more(std::size_t{part.count} * samples.faces() * size * size);
    part.maps->read<float>(more);
    depths.insert(depths.end(), more.begin(), more.end());
  }
  return depths;
}

float stepped(std::span<const std::uint32_t> words, std::size_t texels, std::size_t texel, float t) {
  float v = 1;
  for (std::uint32_t k = words[texel]; k < words[texel + 1]; ++k) {
    const std::size_t step = texels + 1 + 2 * std::size_t{k};
    if (std::bit_cast<float>(words[step]) < t) v = std::bit_cast<float>(words[step + 1]);
  }
  return v;
}

Check check_penumbra_events(const render::Device& device, const Stage& stage, std::uint32_t size) {
  Check check{.pass = "penumbra events",
              .against = "each sample's map, evaluated in double",
              .rule = "the share of samples, within 4 roundings of a float"};
  ListSource made(device, stage, size);
  maps::PenumbraEvents product(device, 0);
  product.make(*made.source);
  maps::SampleMaps samples(device);
  samples.make(*made.source);
  const SampleTwin twin(made, samples, size);
  std::vector<std::uint32_t> words(product.buffer().bytes() / sizeof(std::uint32_t));
  product.buffer().read<std::uint32_t>(words);
  const maps::gpu::LightView& centre = made.centre.views.front();
  const std::size_t texels = std::size_t{made.centre.faces} * size * size;
  for (std::size_t texel = 0; texel < texels; ++texel) {
    const auto face = static_cast<std::uint32_t>(texel / (std::size_t{size} * size));
    const auto x = static_cast<std::uint32_t>(texel % size), y = static_cast<std::uint32_t>(texel / size % size);
    const glm::dvec3 direction = maps::face_of(centre, made.basis, face).direction(x, y, size);
    for (int i = 1; i < 40; ++i) {
      const double t = 7.0 * i / 40 + 0.0137;
      if (t > static_cast<double>(centre.far)) break;  // beyond the far end of the scene the lists are never used
      const auto hidden =
          twin.hidden(glm::dvec3(centre.point) + t * direction, glm::dot(direction, made.basis.n) > 0 ? 0 : 1);
      if (!hidden) continue;
      const double found = static_cast<double>(stepped(words, texels, texel, static_cast<float>(t)));
      const double expected = 1 - static_cast<double>(*hidden) / samples.count();
      check.within(std::abs(found - expected), 4 * 0x1p-24,
                   [&] { return fmt::format("texel {} at {}: {}, not {}", texel, t, found, expected); });
    }
  }
  return check;
}

}  // namespace penumbra::selftest
