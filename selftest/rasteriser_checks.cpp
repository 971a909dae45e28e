// SPDX-License-Identifier: Apache-2.0
// Compares maps and view samples of rasterisers with RasterTwin and with each other.

#include "selftest/rasteriser_checks.hpp"

#include "maps/host/map_fit.hpp"
#include "engines/vectors/scan_conversion.hpp"
#include "render/proposed_view_samples.hpp"
#include "render/visibility_buffer.hpp"
#include "selftest/centre_maps.hpp"
#include "selftest/raster_twin.hpp"

#include <fmt/format.h>

#include <cmath>
#include <vector>

namespace penumbra::selftest {
namespace {

constexpr std::uint32_t kLayers = 4;

const char* name_of(maps::Rasteriser rasteriser) {
  return rasteriser == maps::Rasteriser::opengl ? "OpenGL" : "Vulkan";
}

double step_of(const render::Device& device, maps::Rasteriser rasteriser) {
  const std::uint32_t bits =
      rasteriser == maps::Rasteriser::opengl ? device.opengl().info().subpixel_bits : device.limits().subpixel_bits;
  return std::ldexp(1.0, -static_cast<int>(bits));
}

/// Returns the corners of casters, as drawn by CasterMaps.
std::vector<glm::vec3> casters_of(const Stage& stage) {
  std::vector<glm::vec3> corners;
  for (std::uint32_t i = 0; i < stage.floats.triangles.size(); ++i) {
    if (stage.floats.casts_shadow[i] == 0 || stage.floats.emits[i] == stage.light.index) continue;
    for (const glm::vec3& corner : stage.floats.corners(i)) corners.push_back(corner);
  }
  return corners;
}

const char* name_of(ViewSampler sampler) {
  switch (sampler) {
    case ViewSampler::vulkan:
      return "Vulkan";
    case ViewSampler::opengl:
      return "OpenGL";
    case ViewSampler::vectors:
      return "processor";
  }
  return "";
}

visibility::ViewSamples view_samples_by(ViewSampler sampler, const render::Device& device,
                                        const visibility::SceneFloats& floats,
                                        const visibility::PinholeCamera& camera) {
  switch (sampler) {
    case ViewSampler::vulkan:
      return render::VisibilityBuffer(device, floats).render(camera);
    case ViewSampler::opengl:
      return render::proposed_view_samples(device.opengl(), floats, camera);
    case ViewSampler::vectors:
      return vectors::scan_view_samples(floats, camera);
  }
  return {};
}

/// Calls `visit` for every texel of every face, with the surfaces that the texel may have.
template <typename Visit>
void for_each_texel(const Stage& stage, const CentreMaps& maps, double step, const Visit& visit) {
  const std::vector<glm::vec3> corners = casters_of(stage);
  std::vector<Surface> surfaces;
  for (std::uint32_t face = 0; face < maps.fitted.faces; ++face) {
    const RasterTwin twin(maps::face_push(maps.fitted.views.front(), maps.basis, face), maps.size, step, corners);
    for (std::uint32_t y = 0; y < maps.size; ++y) {
      for (std::uint32_t x = 0; x < maps.size; ++x) {
        twin.find(x, y, surfaces);
        visit(surfaces, (std::size_t{face} * maps.size + y) * maps.size + x,
              [=] { return fmt::format("face {}, texel {}, {}", face, x, y); });
      }
    }
  }
}

}  // namespace

Check check_view_samples(const render::Device& device, const visibility::SceneFloats& floats,
                         const visibility::ViewSamples& expected, ViewSampler sampler) {
  Check check;
  check.pass = fmt::format("view samples ({})", name_of(sampler));
  check.against = "every triangle at every pixel";
  check.rule = "the same triangle, point and normal, bit by bit";
  const visibility::PinholeCamera& camera = expected.camera;
  const visibility::ViewSamples found = view_samples_by(sampler, device, floats, camera);
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const bool same = expected.triangle[i] == found.triangle[i] && expected.p[i] == found.p[i] &&
                      expected.n[i] == found.n[i] && expected.depth[i] == found.depth[i] &&
                      expected.facing[i] == found.facing[i];
    check.same(same, true, [&] {
      return fmt::format("pixel {}, {}: triangle {}, not {}", i % camera.width, i / camera.width, found.triangle[i],
                         expected.triangle[i]);
    });
  }
  return check;
}

Check check_maps(const render::Device& device, const Stage& stage, std::uint32_t size, maps::Rasteriser rasteriser) {
  Check check;
  check.pass = fmt::format("depth maps, {} layers and the farthest ({})", kLayers, name_of(rasteriser));
  check.against = "the triangles in double";
  const double step = step_of(device, rasteriser);
  check.rule =
      fmt::format("the same coverage, except where an edge is within {:g} texel of the centre; depth likewise", step);
  const CentreMaps maps(device, stage, size, {0, 0}, {.layers = kLayers, .farthest = true, .rasteriser = rasteriser});
  const std::vector<float> texels = maps.read();
  const std::size_t layer_texels = maps.texel_count();
  for_each_texel(stage, maps, step, [&](std::span<const Surface> surfaces, std::size_t texel, const auto& where) {
    for (std::uint32_t layer = 0; layer <= kLayers; ++layer) {
      const auto held = [&](std::uint32_t l) { return static_cast<double>(texels[l * layer_texels + texel]); };
      const double found = held(layer);
      const Judged judged = layer == kLayers ? judge_farthest(surfaces, found)
                            : layer > 0      ? judge_behind(surfaces, found, held(layer - 1))
                                             : judge_nearest(surfaces, found);
      ++check.compared;
      if (judged.settled) {
        check.keep_worst(judged.difference, judged.allowed);
        // The twin's depth, rounded once.
        check.differing += judged.difference > found * 0x1p-24 ? 1 : 0;
      }
      if (!judged.right) {
        ++check.differing;
        check.fail([&] {
          return fmt::format("{}, layer {}: {} is none of {} surfaces", where(), layer, found, surfaces.size());
        });
      }
    }
  });
  return check;
}

Check check_rasterisers_agree(const render::Device& device, const Stage& stage, std::uint32_t size) {
  Check check;
  check.pass = "depth maps, Vulkan's";
  check.against = "OpenGL's";
  const double step = step_of(device, maps::Rasteriser::vulkan) + step_of(device, maps::Rasteriser::opengl);
  check.rule = fmt::format("the same, except where an edge is within {:g} texel of the centre; depth likewise", step);
  const auto draw = [&](maps::Rasteriser rasteriser) {
    return CentreMaps(device, stage, size, {0, 0}, {.farthest = true, .rasteriser = rasteriser});
  };
  const CentreMaps maps = draw(maps::Rasteriser::vulkan);
  const std::vector<float> one = maps.read(), other = draw(maps::Rasteriser::opengl).read();
  const std::size_t layer_texels = maps.texel_count();
  for_each_texel(stage, maps, step, [&](std::span<const Surface> surfaces, std::size_t texel, const auto& where) {
    for (const bool farthest : {false, true}) {
      const std::size_t at = (farthest ? layer_texels : 0) + texel;
      const double difference = std::abs(static_cast<double>(one[at]) - static_cast<double>(other[at]));
      const double bound = largest_disagreement(surfaces, farthest);
      const auto place = [&] { return fmt::format("{}: {} and {}", where(), one[at], other[at]); };
      if (std::isfinite(bound)) {
        check.within(difference, bound, place);
      } else {  // either surface is possible: any difference is permitted
        ++check.compared;
        check.differing += difference != 0 ? 1 : 0;
      }
    }
  });
  return check;
}

}  // namespace penumbra::selftest
