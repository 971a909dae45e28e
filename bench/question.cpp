// SPDX-License-Identifier: Apache-2.0
// Prepares subjects, reference visibility and pixel sets for the contestants.

#include "bench/question.hpp"

#include "base/assert.hpp"
#include "compare/metrics.hpp"
#include "engines/view_sampler.hpp"
#include "session/methods.hpp"
#include "session/sample_pixels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <span>

namespace penumbra::bench {
namespace {

using visibility::PixelClass;

constexpr std::uint32_t kBlock = 8;
constexpr std::uint32_t kMostAtOnce = 4096;  // number of light samples of one light

/// Returns V of every pixel by a method that is used once.
std::vector<float> evaluate_once(visibility::Method& method, const Ground& ground, const visibility::Light& light) {
  method.prepare_light(light);
  method.prepare_view(ground.samples);
  const std::uint32_t step = method.max_tile_rows(), height = ground.samples.height, width = ground.samples.width;
  std::vector<float> visibility(ground.samples.size());
  for (std::uint32_t row = 0; row < height; row += step) {
    const visibility::Tile tile{row, std::min(step, height - row)};
    method.evaluate(tile);
    method.read_visibility(
        std::span(visibility).subspan(std::size_t{row} * width, std::size_t{tile.row_count} * width));
  }
  return visibility;
}

/// Returns V by many light samples: the mean of several patterns of at most kMostAtOnce samples each.
std::vector<float> dense_visibility(visibility::Method& rays, const Ground& ground, std::uint32_t samples) {
  std::vector<double> sum(ground.samples.size());
  std::uint32_t seed = 1;
  for (std::uint32_t left = samples; left > 0; ++seed) {
    const std::uint32_t count = std::min(left, kMostAtOnce);
    const auto light = light_of(ground, count, visibility::SamplePattern::sobol, seed);
    const std::vector<float> visibility = evaluate_once(rays, ground, light);
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += static_cast<double>(visibility[i]) * count;
    left -= count;
  }
  std::vector<float> mean(sum.size());
  for (std::size_t i = 0; i < sum.size(); ++i) mean[i] = static_cast<float>(sum[i] / samples);
  return mean;
}

std::vector<std::uint32_t> penumbra_pixels(visibility::Method& rays, const Ground& ground) {
  const auto light = light_of(ground, 64, visibility::SamplePattern::sobol);
  const std::vector<float> visibility = evaluate_once(rays, ground, light);
  std::vector<std::uint32_t> pixels = ground.judged;
  std::erase_if(pixels, [&](std::uint32_t pixel) { return visibility[pixel] <= 0 || visibility[pixel] >= 1; });
  return pixels;
}

/// Returns whether contestants evaluate pixels of this class.
bool asks(PixelClass c) {
  return c == PixelClass::judged || c == PixelClass::horizon || c == PixelClass::behind;
}

/// Returns whether V is 0 at all evaluated view samples of a block, or 1 at all of them.
bool is_trivial(const Question& question, std::uint32_t left, std::uint32_t top) {
  const visibility::ViewSamples& samples = question.ground.samples;
  bool lit = false, dark = false;
  for (std::uint32_t y = top; y < std::min(top + kBlock, samples.height); ++y) {
    for (std::uint32_t x = left; x < std::min(left + kBlock, samples.width); ++x) {
      const std::size_t pixel = std::size_t{y} * samples.width + x;
      if (!asks(question.ground.classes[pixel])) continue;
      lit |= question.truth[pixel] > 0;
      dark |= question.truth[pixel] < 1;
    }
  }
  return !(lit && dark);
}

}  // namespace

Ground make_ground(const Subject& subject, const render::Machine& machine) {
  Ground ground;
  ground.scene = read_subject(subject);
  ground.pattern = subject.pattern;
  ground.floats = visibility::make_scene_floats(ground.scene);
  if (const visibility::Light light = light_of(ground, 1); !light.unshaded_by.empty())
    ground.floats = cast_for(ground.floats, light);
  const auto camera =
      visibility::make_camera(ground.scene.cameras.front(), ground.floats.origin, subject.size, subject.size);
  ground.samples = engines::ViewSampler(machine, ground.floats).find(camera);
  ground.classes = visibility::classify_pixels(ground.floats, ground.samples, light_of(ground, 1));
  ground.judged = compare::pixels_of_class(ground.classes, PixelClass::judged);
  return ground;
}

visibility::Light light_of(const Ground& ground, std::uint32_t samples,
                           std::optional<visibility::SamplePattern> pattern, std::uint32_t seed) {
  return visibility::make_light(ground.scene, 0, ground.floats.origin,
                                {.count = samples, .pattern = pattern.value_or(ground.pattern), .seed = seed});
}

bool takes_area(const Options& options) {
  return !options.reference.empty() && session::describe_method(options.reference).gives_area();
}

ReferenceVisibility make_reference(const Ground& ground, const Options& options, const render::Machine& machine) {
  PENUMBRA_ASSERT(!options.reference.empty(), "no reference was asked for");
  const auto rays = session::make_method(session::ray_judge().name, {}, machine);
  rays->prepare_mesh(ground.floats);
  if (!takes_area(options)) {
    return {fmt::format("{} at {} light samples", options.reference, options.reference_samples),
            dense_visibility(*rays, ground, options.reference_samples), ground.judged};
  }
  const auto areas = session::make_method(options.reference, {}, machine);
  ReferenceVisibility reference;
  reference.name = options.reference;
  reference.pixels = session::sample_pixels(penumbra_pixels(*rays, ground), options.sample_pixels, ground.samples.width,
                                            ground.samples.height);
  areas->want_pixels(reference.pixels);
  areas->prepare_mesh(ground.floats);
  const auto light = light_of(ground, 1);
  reference.visibility = evaluate_once(*areas, ground, light);
  return reference;
}

std::vector<std::uint8_t> nontrivial_pixels(const Question& question) {
  const visibility::ViewSamples& samples = question.ground.samples;
  std::vector<std::uint8_t> chosen(samples.size());
  for (std::uint32_t top = 0; top < samples.height; top += kBlock) {
    for (std::uint32_t left = 0; left < samples.width; left += kBlock) {
      if (is_trivial(question, left, top)) continue;
      for (std::uint32_t y = top; y < std::min(top + kBlock, samples.height); ++y) {
        for (std::uint32_t x = left; x < std::min(left + kBlock, samples.width); ++x) {
          const std::size_t pixel = std::size_t{y} * samples.width + x;
          chosen[pixel] = asks(question.ground.classes[pixel]) ? 1 : 0;
        }
      }
    }
  }
  return chosen;
}

}  // namespace penumbra::bench
