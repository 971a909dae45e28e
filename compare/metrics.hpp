#pragma once

#include "visibility/view_samples.hpp"

#include <glm/vec3.hpp>

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace penumbra::compare {

/// The pixels of one class, in order.
std::vector<std::uint32_t> pixels_of_class(std::span<const visibility::PixelClass> classes,
                                           visibility::PixelClass wanted);

/// The pixels that are no background (A = 1), in order.
std::vector<std::uint32_t> pixels_with_alpha(const visibility::ViewSamples& samples);

/// How far V is off over a set of pixels. With e = V − V of the reference:
struct VisibilityError {
  double mean = 0;    ///< of |e|
  double rmse = 0;    ///< √ of the mean of e²
  double p999 = 0;    ///< the smallest |e| that at least 99.9 % of the pixels do not exceed
  double max = 0;     ///< of |e|
  double over05 = 0;  ///< the share of pixels with |e| > 0.05
  double bias = 0;    ///< mean of e; positive: too bright

  bool operator==(const VisibilityError&) const = default;
};

/// Over the given pixels (indices into both spans); nothing if there are none. Which pixels is the caller's choice:
/// for `error` in metrics.json those of PixelClass::judged (among the sampled ones), for the horizon's row
/// PixelClass::horizon.
std::optional<VisibilityError> visibility_error(std::span<const float> visibility, std::span<const float> reference,
                                                std::span<const std::uint32_t> pixels);

/// Judged pixels by what happens there: all of the light is seen, some, or none; and where some is hidden, by whom. A
/// pixel is in one of the first three, and of the shadowed ones in one or both of the others (or in none, where no ray
/// met what hides it).
struct PixelClasses {
  std::vector<std::uint32_t> lit, penumbra, umbra;
  std::vector<std::uint32_t> cast;  ///< another object hides some of the light
  std::vector<std::uint32_t> self;  ///< the object that the pixel shows hides some of it
};

/// Errors over the pixels of one class; nullopt over no pixels.
struct ClassError {
  const char* name = "";
  std::uint64_t pixels = 0;
  std::optional<VisibilityError> error;
};
std::vector<ClassError> class_errors(std::span<const float> visibility, std::span<const float> reference,
                                     const PixelClasses& classes);

/// Errors over the pixels where a size lies from `from` to less than `to`.
struct RangeError {
  double from = 0, to = 0;  ///< the last one's `to` is infinite
  std::uint64_t pixels = 0;
  std::optional<VisibilityError> error;
};
/// The borders between ranges, of widths of penumbrae (in pixels, in texels) and of distances to contact (in pixels).
inline constexpr double kSizeBorders[] = {4, 16, 64};
/// `sizes`: of each pixel; where it is no number the pixel is in no range. From 0 to the first border, and so on.
std::vector<RangeError> range_errors(std::span<const float> visibility, std::span<const float> reference,
                                     std::span<const std::uint32_t> pixels, std::span<const float> sizes);

/// V by a method and by its reference under one light, and the pixels that count (indices into both).
struct JudgedVisibility {
  std::span<const float> visibility, reference;
  std::span<const std::uint32_t> pixels;
};

/// Over the pixels of all lights together: a pixel counts once for each light that it is judged under.
std::optional<VisibilityError> visibility_error(std::span<const JudgedVisibility> lights);

/// How far the beauty is off over a set of pixels: with e the difference of luminances (Rec. 709), both over the mean
/// luminance of the reference.
struct BeautyError {
  double relative_rmse = 0;  ///< √ of the mean of e²
  double relative_bias = 0;  ///< mean of e; positive: too bright

  bool operator==(const BeautyError&) const = default;
};

/// Over the given pixels; nothing if there are none, or if the reference is black on all of them.
std::optional<BeautyError> beauty_error(std::span<const glm::vec3> beauty, std::span<const glm::vec3> reference,
                                        std::span<const std::uint32_t> pixels);

/// What a beauty made of V alone loses by V · ∫G in place of ∫G V, beside what it loses by V.
struct Separation {
  BeautyError alone;  ///< of V of the reference · ∫G
  BeautyError of_v;   ///< of (V − V of the reference) · ∫G: without the separation

  bool operator==(const Separation&) const = default;
};

/// Beauty by a method, as V of the reference alone would make it, and by the reference.
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

/// (View sample, light point) pairs.
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

/// Who was right on differing pairs: on all of them, or on a sample. Each pair makes exactly one of the two right.
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

/// The part of the differing pairs that was decided; 1 where none differ.
double decided_share(const PairCounts& counts, const PairVerdicts& verdicts);

}  // namespace penumbra::compare
