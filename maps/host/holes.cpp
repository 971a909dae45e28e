// SPDX-License-Identifier: Apache-2.0
// Prepares surfaces with holes (alphaMode MASK) for rasterisers: for each texel of a picture, the least vertex alpha at
// which the surface is solid.

#include "maps/host/holes.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace penumbra::maps {
namespace {

using scenes::PictureUse;

std::uint32_t word_of(double value) {
  return std::bit_cast<std::uint32_t>(static_cast<float>(value));
}

std::uint32_t word_of(PictureUse::Wrap wrap) {
  switch (wrap) {
    case PictureUse::Wrap::repeat:
      return gpu::kRepeatTexels;
    case PictureUse::Wrap::mirror:
      return gpu::kMirrorTexels;
    case PictureUse::Wrap::clamp:
      return gpu::kClampTexels;
  }
  return gpu::kRepeatTexels;
}

/// Returns the least vertex alpha in [0, 1] whose product with `alpha` is at least the cutoff; 2 if there is none.
float least_vertex_alpha(double alpha, double cutoff) {
  if (cutoff <= 0) return 0;
  if (alpha < cutoff) return 2;
  auto least = static_cast<float>(cutoff / alpha);
  while (alpha * double{least} < cutoff) least = std::nextafter(least, 2.0F);
  return std::min(least, 1.0F);
}

}  // namespace

bool has_holes(const visibility::SceneFloats& scene, std::uint32_t triangle) {
  return visibility::alpha_mode(scene, triangle) == scenes::Alpha::Mode::mask;
}

std::optional<visibility::SceneFloats> with_holes_drawn(const visibility::SceneFloats& scene) {
  const auto masked = [&](std::uint32_t triangle) { return has_holes(scene, triangle); };
  if (std::ranges::none_of(scene.alphas.casters, masked)) return std::nullopt;
  visibility::SceneFloats drawn = scene;
  for (const std::uint32_t triangle : scene.alphas.casters) {
    if (masked(triangle)) drawn.casts_shadow[triangle] = 1;
  }
  std::erase_if(drawn.alphas.casters, masked);
  return drawn;
}

HoleSurfaces::HoleSurfaces(const visibility::SceneFloats& scene)
    : scene_(&scene), number_(scene.alphas.surfaces.size(), 0) {
  const visibility::SurfaceAlphas& alphas = scene.alphas;
  std::vector<std::uint32_t> objects;
  for (std::uint32_t object = 0; object < alphas.surfaces.size(); ++object) {
    if (alphas.surfaces[object].alpha.mode != scenes::Alpha::Mode::mask) continue;
    number_[object] = static_cast<std::uint32_t>(objects.size());
    objects.push_back(object);
  }
  words_.assign(std::max<std::size_t>(objects.size() * gpu::kSurfaceWords, 1), 0);
  std::vector<std::uint32_t> begins(alphas.pictures.size(), 0);  // first word of each picture; 0: not yet added
  for (const std::uint32_t object : objects) {
    const visibility::SurfaceAlphas::Surface& surface = alphas.surfaces[object];
    const std::size_t first = std::size_t{number_[object]} * gpu::kSurfaceWords;
    if (surface.picture) {
      const visibility::SurfaceAlphas::Picture& picture = alphas.pictures[surface.picture->picture];
      std::uint32_t& begin = begins[surface.picture->picture];
      if (begin == 0) {
        begin = static_cast<std::uint32_t>(words_.size());
        words_.resize(words_.size() + (picture.texels.size() + 3) / 4, 0);
        for (std::size_t i = 0; i < picture.texels.size(); ++i)
          words_[begin + i / 4] |= std::uint32_t{picture.texels[i]} << 8 * (i % 4);
      }
      words_[first] = begin;
      words_[first + 1] = picture.width;
      words_[first + 2] = picture.height;
      words_[first + 3] = word_of(surface.picture->wrap_s);
      words_[first + 4] = word_of(surface.picture->wrap_t);
    }
    for (std::uint32_t texel = 0; texel < 256; ++texel) {
      const double alpha = surface.picture ? surface.alpha.factor * (texel / 255.0) : surface.alpha.factor;
      const double cutoff = surface.alpha.cutoff;
      // Without vertex alphas the decision is made here, without a division on the device.
      const float least = !alphas.vertices.empty() ? least_vertex_alpha(alpha, cutoff) : alpha >= cutoff ? 0 : 2;
      words_[first + 5 + texel] = std::bit_cast<std::uint32_t>(least);
    }
  }
}

void HoleSurfaces::add_corners(std::uint32_t triangle, std::vector<std::uint32_t>& places) const {
  const visibility::SurfaceAlphas& alphas = scene_->alphas;
  for (const std::uint32_t corner : scene_->triangles[triangle]) {
    const double weight = alphas.weights.empty() ? 1 : alphas.weights[corner];
    const glm::dvec2 place = alphas.places.empty() ? glm::dvec2(0) : alphas.places[corner];
    const double vertex = alphas.vertices.empty() ? 1 : double{alphas.vertices[corner]};
    for (const double value : {place.x * weight, place.y * weight, vertex * weight, weight})
      places.push_back(word_of(value));
    places.push_back(number_[scene_->object[triangle]]);
  }
}

}  // namespace penumbra::maps
