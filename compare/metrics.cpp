// SPDX-License-Identifier: Apache-2.0
// Computes error metrics of V, pairs and beauty over sets of pixels.

#include "compare/metrics.hpp"

#include "base/assert.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>
#include <limits>

namespace penumbra::compare {
namespace {

/// Words of one pixel's masks, with bits beyond the last sample cleared.
struct PixelMasks {
  const std::uint32_t* method;
  const std::uint32_t* reference;
};

PixelMasks masks_of(const MaskPair& masks, std::uint32_t pixel) {
  const std::size_t first = std::size_t{pixel} * masks.words_per_mask();
  const std::size_t end = first + masks.words_per_mask();
  PENUMBRA_ASSERT(end <= masks.method.size() && end <= masks.reference.size(), "pixel {} of {} and {} mask words",
                  pixel, masks.method.size(), masks.reference.size());
  return {&masks.method[first], &masks.reference[first]};
}

std::uint32_t existing_samples(const MaskPair& masks, std::uint32_t word) {
  const std::uint32_t left = masks.sample_count - word * 32;
  return left >= 32 ? 0xffffffffu : (1u << left) - 1;
}

}  // namespace

std::vector<std::uint32_t> pixels_of_class(std::span<const visibility::PixelClass> classes,
                                           visibility::PixelClass wanted) {
  std::vector<std::uint32_t> pixels;
  for (std::size_t i = 0; i < classes.size(); ++i) {
    if (classes[i] == wanted) pixels.push_back(static_cast<std::uint32_t>(i));
  }
  return pixels;
}

std::vector<std::uint32_t> pixels_with_alpha(const visibility::ViewSamples& samples) {
  std::vector<std::uint32_t> pixels;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (samples.triangle[i] != visibility::ViewSamples::kBackground) pixels.push_back(static_cast<std::uint32_t>(i));
  }
  return pixels;
}

std::optional<VisibilityError> visibility_error(std::span<const float> visibility, std::span<const float> reference,
                                                std::span<const std::uint32_t> pixels) {
  const JudgedVisibility light{visibility, reference, pixels};
  return visibility_error({&light, 1});
}

std::vector<ClassError> class_errors(std::span<const float> visibility, std::span<const float> reference,
                                     const PixelClasses& classes) {
  std::vector<ClassError> errors;
  const auto add = [&](const char* name, const std::vector<std::uint32_t>& pixels) {
    errors.push_back({name, pixels.size(), visibility_error(visibility, reference, pixels)});
  };
  add("lit", classes.lit);
  add("penumbra", classes.penumbra);
  add("umbra", classes.umbra);
  add("cast", classes.cast);
  add("self", classes.self);
  return errors;
}

std::vector<RangeError> range_errors(std::span<const float> visibility, std::span<const float> reference,
                                     std::span<const std::uint32_t> pixels, std::span<const float> sizes) {
  std::vector<RangeError> ranges;
  double from = 0;
  for (std::size_t i = 0; i <= std::size(kSizeBorders); ++i) {
    const double to = i < std::size(kSizeBorders) ? kSizeBorders[i] : std::numeric_limits<double>::infinity();
    std::vector<std::uint32_t> inside;
    std::ranges::copy_if(pixels, std::back_inserter(inside),
                         [&](std::uint32_t pixel) { return sizes[pixel] >= from && sizes[pixel] < to; });
    ranges.push_back({from, to, inside.size(), visibility_error(visibility, reference, inside)});
    from = to;
  }
  return ranges;
}

std::optional<VisibilityError> visibility_error(std::span<const JudgedVisibility> lights) {
  std::vector<double> magnitudes;
  VisibilityError error;
  double squares = 0;
  for (const JudgedVisibility& light : lights) {
    for (const std::uint32_t pixel : light.pixels) {
      PENUMBRA_ASSERT(pixel < light.visibility.size() && pixel < light.reference.size(), "pixel {} of {} and {}", pixel,
                      light.visibility.size(), light.reference.size());
      const double e = static_cast<double>(light.visibility[pixel]) - static_cast<double>(light.reference[pixel]);
      // NaN makes every comparison below false, and a broken method would be reported as perfect.
      PENUMBRA_ASSERT(std::isfinite(e), "V is {} and {} at pixel {}", light.visibility[pixel], light.reference[pixel],
                      pixel);
      const double magnitude = std::abs(e);
      magnitudes.push_back(magnitude);
      error.mean += magnitude;
      error.bias += e;
      squares += e * e;
      if (magnitude > 0.05) error.over05 += 1;
    }
  }
  if (magnitudes.empty()) return std::nullopt;
  const auto count = static_cast<double>(magnitudes.size());
  error.mean /= count;
  error.bias /= count;
  error.over05 /= count;
  error.rmse = std::sqrt(squares / count);
  // Nearest rank ⌈0.999 n⌉, in integers: 0.999 is not representable as a double.
  const std::size_t rank = (999 * magnitudes.size() + 999) / 1000;
  const auto place = magnitudes.begin() + static_cast<std::ptrdiff_t>(rank - 1);
  std::nth_element(magnitudes.begin(), place, magnitudes.end());
  error.p999 = *place;
  error.max = *std::max_element(place, magnitudes.end());
  return error;
}

std::optional<BeautyError> beauty_error(std::span<const glm::vec3> beauty, std::span<const glm::vec3> reference,
                                        std::span<const std::uint32_t> pixels) {
  const auto luminance = [](const glm::vec3& color) {
    return glm::dot(glm::dvec3(0.2126, 0.7152, 0.0722), glm::dvec3(color));
  };
  double squares = 0, sum = 0, truth = 0;
  for (const std::uint32_t pixel : pixels) {
    PENUMBRA_ASSERT(pixel < beauty.size() && pixel < reference.size(), "pixel {} of {} and {}", pixel, beauty.size(),
                    reference.size());
    const double expected = luminance(reference[pixel]), e = luminance(beauty[pixel]) - expected;
    PENUMBRA_ASSERT(std::isfinite(e), "beauty is off by {} at pixel {}", e, pixel);
    squares += e * e;
    sum += e;
    truth += expected;
  }
  if (!(truth > 0)) return std::nullopt;
  const auto count = static_cast<double>(pixels.size());
  return BeautyError{std::sqrt(squares / count) / (truth / count), sum / truth};
}

std::optional<Separation> separation(const SeparatedBeauty& beauty, std::span<const std::uint32_t> pixels) {
  std::vector<glm::vec3> of_v(beauty.reference.begin(), beauty.reference.end());
  for (const std::uint32_t pixel : pixels) of_v[pixel] += beauty.method[pixel] - beauty.separated[pixel];
  const auto alone = beauty_error(beauty.separated, beauty.reference, pixels);
  const auto without = beauty_error(of_v, beauty.reference, pixels);
  return alone && without ? std::optional(Separation{*alone, *without}) : std::nullopt;
}

PairCounts& PairCounts::operator+=(const PairCounts& other) {
  all += other.all;
  penumbra += other.penumbra;
  differing += other.differing;
  return *this;
}

PairCounts count_pairs(const MaskPair& masks, std::span<const std::uint32_t> pixels) {
  PairCounts counts;
  for (const std::uint32_t pixel : pixels) {
    const PixelMasks pair = masks_of(masks, pixel);
    std::uint32_t seen_by_method = 0, seen_by_reference = 0;
    for (std::uint32_t word = 0; word < masks.words_per_mask(); ++word) {
      const std::uint32_t existing = existing_samples(masks, word);
      const std::uint32_t a = pair.method[word] & existing, b = pair.reference[word] & existing;
      seen_by_method += static_cast<std::uint32_t>(std::popcount(a));
      seen_by_reference += static_cast<std::uint32_t>(std::popcount(b));
      counts.differing += static_cast<std::uint64_t>(std::popcount(a ^ b));
    }
    const auto partly = [&](std::uint32_t seen) { return seen > 0 && seen < masks.sample_count; };
    counts.all += masks.sample_count;
    if (partly(seen_by_method) || partly(seen_by_reference)) counts.penumbra += masks.sample_count;
  }
  return counts;
}

void for_each_differing_pair(const MaskPair& masks, std::span<const std::uint32_t> pixels,
                             const std::function<void(std::uint32_t, std::uint32_t, bool)>& visit) {
  for (const std::uint32_t pixel : pixels) {
    const PixelMasks pair = masks_of(masks, pixel);
    for (std::uint32_t word = 0; word < masks.words_per_mask(); ++word) {
      std::uint32_t differing = (pair.method[word] ^ pair.reference[word]) & existing_samples(masks, word);
      for (; differing != 0; differing &= differing - 1) {
        const auto bit = static_cast<std::uint32_t>(std::countr_zero(differing));
        visit(pixel, word * 32 + bit, (pair.method[word] >> bit & 1) != 0);
      }
    }
  }
}

double decided_share(const PairCounts& counts, const PairVerdicts& verdicts) {
  if (counts.differing == 0) return 1;
  return static_cast<double>(verdicts.decided) / static_cast<double>(counts.differing);
}

}  // namespace penumbra::compare
