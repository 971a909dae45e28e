// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/view_samples.hpp"

#include <glm/vec3.hpp>

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace penumbra::compare {

/// Returns the pixels of one class, in order.
std::vector<std::uint32_t> pixels_of_class(std::span<const visibility::PixelClass> classes,
                                           visibility::PixelClass wanted);

/// Returns the pixels that are not background (A = 1), in order.
std::vector<std::uint32_t> pixels_with_alpha(const visibility::ViewSamples& samples);

/// Errors of V over a set of pixels, with e = V − V of the reference:
struct VisibilityError {
  double mean = 0;    ///< of |e|
  double rmse = 0;    ///< √ of the mean of e²
  double p999 = 0;    ///< the smallest |e| that at least 99.9 % of the pixels do not exceed
  double max = 0;     ///< of |e|
  double over05 = 0;  ///< fraction of pixels with |e| > 0.05
  double bias = 0;    ///< mean of e; positive: too bright

  bool operator==(const VisibilityError&) const = default;
};

/// Returns the errors over the given pixels (indices into both spans); nullopt if there are none. The caller selects
/// the pixels: for `error` in metrics.json those of PixelClass::judged (among the sampled ones), for the horizon's row
/// PixelClass::horizon.
std::optional<VisibilityError> visibility_error(std::span<const float> visibility, std::span<const float> reference,
                                                std::span<const std::uint32_t> pixels);

/// Judged pixels by visibility (all, some or none of the light is seen), and, if some is hidden, by the hiding object.
/// A pixel is in one of the first three classes, and a shadowed pixel also in one or both of the others (or in none, if
/// no ray hit the hiding object).
struct PixelClasses {
  std::vector<std::uint32_t> lit, penumbra, umbra;
  std::vector<std::uint32_t> cast;  ///< another object hides some of the light
  std::vector<std::uint32_t> self;  ///< the object visible at the pixel hides some of the light
};

/// Errors over the pixels of one class; nullopt if there are no pixels.
struct ClassError {
  const char* name = "";
  std::uint64_t pixels = 0;
  std::optional<VisibilityError> error;
};
std::vector<ClassError> class_errors(std::span<const float> visibility, std::span<const float> reference,
                                     const PixelClasses& classes);

/// Errors over the pixels where a size lies from `from` to less than `to`.
struct RangeError {
  double from = 0, to = 0;  ///< the last range's `to` is infinite
  std::uint64_t pixels = 0;
  std::optional<VisibilityError> error;
};
/// Borders between ranges, of widths of penumbrae (in pixels, in texels) and of distances to contact (in pixels).
inline constexpr double kSizeBorders[] = {4, 16, 64};
/// Returns the errors by range: from 0 to the first border, and so on. `sizes`: of each pixel; a pixel with NaN is in
/// no range.
std::vector<RangeError> range_errors(std::span<const float> visibility, std::span<const float> reference,
                                     std::span<const std::uint32_t> pixels, std::span<const float> sizes);

/// V by a method and by its reference under one light, and the pixels to be counted (indices into both).
struct JudgedVisibility {
  std::span<const float> visibility, reference;
  std::span<const std::uint32_t> pixels;
};

/// Returns the errors over the pixels of all lights together: a pixel counts once for each light under which it is
/// judged.
std::optional<VisibilityError> visibility_error(std::span<const JudgedVisibility> lights);

/// Errors of the beauty over a set of pixels. e is the difference of luminances (Rec. 709), and both errors are divided
/// by the mean luminance of the reference.
struct BeautyError {
  double relative_rmse = 0;  ///< √ of the mean of e²
  double relative_bias = 0;  ///< mean of e; positive: too bright

  bool operator==(const BeautyError&) const = default;
};

/// Returns the errors over the given pixels; nullopt if there are none, or if the reference is black on all of them.
std::optional<BeautyError> beauty_error(std::span<const glm::vec3> beauty, std::span<const glm::vec3> reference,
                                        std::span<const std::uint32_t> pixels);

/// Error of a beauty that is computed from V alone, as V · ∫G instead of ∫G V, and separately the error due to V.
struct Separation {
  BeautyError alone;  ///< of V of the reference · ∫G
  BeautyError of_v;   ///< of (V − V of the reference) · ∫G: without the separation

  bool operator==(const Separation&) const = default;
};

/// Beauty by a method, by V of the reference alone, and by the reference.
struct SeparatedBeauty {
  std::span<const glm::vec3> method, separated, reference;
};
std::optional<Separation> separation(const SeparatedBeauty& beauty, std::span<const std::uint32_t> pixels);

/// Masks of one method and of its reference on the same light samples, words_per_mask words a pixel.
struct MaskPair {
  std::span<const std::uint32_t> method, reference;
  std::uint32_t sample_count = 0;

  [[nodiscard]] std::uint32_t words_per_mask() const { return (sample_count + 31) / 32; }
};

/// Numbers of pairs of view sample and light sample.
struct PairCounts {
  std::uint64_t all = 0;        ///< `pairsAll`: of all given pixels
  std::uint64_t penumbra = 0;   ///< `pairs`: of the pixels where 0 < V < 1 in either
  std::uint64_t differing = 0;  ///< `pairsDiffering`: visible in one, hidden in the other

  PairCounts& operator+=(const PairCounts& other);
  bool operator==(const PairCounts&) const = default;
};

PairCounts count_pairs(const MaskPair& masks, std::span<const std::uint32_t> pixels);

/// Calls `visit(pixel, light sample, visible for the method)` for every differing pair, by pixel, then by sample.
void for_each_differing_pair(const MaskPair& masks, std::span<const std::uint32_t> pixels,
                             const std::function<void(std::uint32_t, std::uint32_t, bool)>& visit);

/// Which side is right on differing pairs: on all of them, or on a sample. For each pair either the method or its
/// reference is right.
struct PairVerdicts {
  std::uint64_t decided = 0;  ///< `pairsDecided`; the other counts are of these
  std::uint64_t method_right = 0;
  std::uint64_t reference_right = 0;
  std::uint64_t zero_predicate = 0;  ///< `pairsZeroPredicate`

  bool operator==(const PairVerdicts&) const = default;
  PairVerdicts& operator+=(const PairVerdicts& other) {
    decided += other.decided, zero_predicate += other.zero_predicate;
    method_right += other.method_right, reference_right += other.reference_right;
    return *this;
  }
};

/// Returns the fraction of the differing pairs that was decided; 1 where none differ.
double decided_share(const PairCounts& counts, const PairVerdicts& verdicts);

}  // namespace penumbra::compare
