// SPDX-License-Identifier: Apache-2.0
// Attenuation of masks by surfaces with holes and translucent surfaces: for each view sample, finds the triangles in
// the pyramid from the view sample to the visible part of the light. For each triangle, double arithmetic finds the
// light samples that it may affect; for each of these, the exact predicate decides, and the texel's alpha is applied.

#include "visibility/alpha/alpha_filter.hpp"

#include "base/assert.hpp"
#include "visibility/alpha/alpha_reach.hpp"
#include "visibility/alpha_shares.hpp"
#include "visibility/pair_truth.hpp"
#include "visibility/receivers.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>

namespace penumbra::visibility {
namespace {

/// A rectangle of slopes: sideways components of a direction over its component along the middle.
struct Slopes {
  glm::dvec2 least{std::numeric_limits<double>::infinity()}, greatest{-std::numeric_limits<double>::infinity()};

  void add(const glm::dvec2& slope) {
    least = glm::min(least, slope);
    greatest = glm::max(greatest, slope);
  }
  /// A slope is rounded by a few 2⁻⁵³ of its terms.
  [[nodiscard]] bool touches(const Slopes& other) const {
    const double slack =
        0x1p-30 * (1 + std::abs(least.x) + std::abs(least.y) + std::abs(greatest.x) + std::abs(greatest.y));
    return least.x <= other.greatest.x + slack && least.y <= other.greatest.y + slack &&
           greatest.x >= other.least.x - slack && greatest.y >= other.least.y - slack;
  }
};

/// A pyramid around directions from p, for tests of boxes: four sides and an end. Only culls; its slack exceeds
/// rounding.
class Pyramid {
 public:
  /// `directions`: not empty. `ends`: each vector is a whole segment, not the direction of a ray.
  Pyramid(const glm::dvec3& p, std::span<const glm::dvec3> directions, bool ends) : p_(p) {
    glm::dvec3 middle(0);
    for (const glm::dvec3& direction : directions) middle += direction;
    const double length = glm::length(middle);
    if (!(length > 0) || !std::isfinite(length)) return;
    middle_ = middle / length;
    const glm::dvec3 other = std::abs(middle_.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    axes_[0] = glm::normalize(glm::cross(middle_, other));
    axes_[1] = glm::cross(middle_, axes_[0]);
    double farthest = 0;
    Slopes all;
    for (const glm::dvec3& direction : directions) {
      const std::optional<glm::dvec2> slope = slope_of(direction);
      if (!slope) return;  // the directions span too wide an angle: nothing is culled
      farthest = std::max(farthest, glm::dot(direction, middle_));
      all.add(*slope);
      const std::size_t number = slopes_++;
      if (number % kBlock == 0) blocks_.emplace_back();
      blocks_.back().add(*slope);
    }
    for (int i = 0; i < 2; ++i) {
      const double slack = 0x1p-30 * (1 + std::abs(all.least[i]) + std::abs(all.greatest[i]));
      const glm::dvec3& axis = axes_[static_cast<std::size_t>(i)];
      planes_[count_++] = {axis - (all.greatest[i] + slack) * middle_, 0};
      planes_[count_++] = {(all.least[i] - slack) * middle_ - axis, 0};
    }
    planes_[count_++] = {-middle_, 0};
    if (ends) planes_[count_++] = {middle_, farthest};
  }

  static constexpr std::size_t kBlock = 16;  ///< directions that are culled together
  /// Returns the slopes of a triangle, for comparison with blocks; nullopt: all directions of a block may meet it.
  [[nodiscard]] std::optional<Slopes> slopes_around(const std::array<glm::dvec3, 3>& corners) const {
    if (count_ == 0) return std::nullopt;
    Slopes slopes;
    for (const glm::dvec3& corner : corners) {
      const std::optional<glm::dvec2> slope = slope_of(corner);
      if (!slope) return std::nullopt;
      slopes.add(*slope);
    }
    return slopes;
  }
  /// Returns bounds of the slopes of a block of directions, which begins at index kBlock · number.
  [[nodiscard]] const Slopes& block(std::size_t number) const { return blocks_[number]; }

  /// Returns whether a part of the box may be on the inner side of all planes.
  [[nodiscard]] bool touches(const glm::vec3& lower, const glm::vec3& upper) const {
    const glm::dvec3 from = glm::dvec3(lower) - p_, to = glm::dvec3(upper) - p_;
    for (std::size_t i = 0; i < count_; ++i) {
      const auto& [normal, offset] = planes_[i];
      const glm::dvec3 low = glm::min(normal * from, normal * to);
      const glm::dvec3 size = glm::max(glm::abs(normal * from), glm::abs(normal * to));
      if (low.x + low.y + low.z > offset + 0x1p-30 * (size.x + size.y + size.z + offset)) return false;
    }
    return true;
  }

 private:
  struct Plane {
    glm::dvec3 normal{0};
    double offset = 0;  // inside: normal · (x − p) ≤ offset
  };
  /// Returns the slopes of a direction; nullopt if it does not point forward enough.
  [[nodiscard]] std::optional<glm::dvec2> slope_of(const glm::dvec3& direction) const {
    const double along = glm::dot(direction, middle_);
    if (!(along > 0x1p-20 * glm::length(direction))) return std::nullopt;
    return glm::dvec2(glm::dot(direction, axes_[0]), glm::dot(direction, axes_[1])) / along;
  }

  glm::dvec3 p_, middle_{0};
  std::array<glm::dvec3, 2> axes_{};
  std::array<Plane, 6> planes_;
  std::size_t count_ = 0, slopes_ = 0;
  std::vector<Slopes> blocks_;
};

/// One thread's work on one pixel.
class PixelFilter {
 public:
  struct Question {
    const SceneFloats& scene;
    const TriangleTree& tree;
    const ViewSamples& samples;
    const Light& light;
    bool holes;
  };
  explicit PixelFilter(const Question& question)
      : scene_(question.scene),
        tree_(question.tree),
        samples_(question.samples),
        light_(question.light),
        holes_(question.holes),
        points_(question.light.sample_count()) {}

  /// Filters a pixel's mask. Returns whether transmittances changed.
  bool filter(std::size_t pixel, std::span<std::uint32_t> mask, std::span<float> transmittances, AlphaCounts& counts) {
    if (!is_receiver(scene_, light_, samples_, pixel)) return false;
    find_directions(pixel, mask);
    if (lit_.empty()) return false;
    find_triangles(pixel);
    if (triangles_.empty()) return false;
    ends_.assign(lit_.size(), {});
    open_ = lit_.size();
    for (const std::uint32_t triangle : triangles_) {
      if (open_ != 0) pass(pixel, triangle, *pyramid_);
    }
    return write(mask, transmittances, counts);
  }

 private:
  /// State of one light sample's ray.
  struct SegmentEnd {
    double left = 1;       // fraction left after translucent surfaces
    bool dimmed = false;   // a translucent surface was met
    bool by_mask = false;  // texels of a MASK surface were tested
    bool stopped = false;  // a texel of a MASK surface stops the ray
  };

  /// Returns whether all rays are equal, for a sun of one direction: only the first light sample is tested.
  [[nodiscard]] bool has_one_direction() const { return light_.sun && light_.sun->tangent == 0; }

  void find_directions(std::size_t pixel, std::span<const std::uint32_t> mask) {
    lit_.clear();
    directions_.clear();
    const glm::vec3& p = samples_.p[pixel];
    if (std::ranges::all_of(mask, [](std::uint32_t word) { return word == 0; })) return;
    light_points_for(light_, p, points_.data());
    for (std::uint32_t word = 0; word < mask.size(); ++word) {
      for (std::uint32_t left = mask[word]; left != 0; left &= left - 1) {
        lit_.push_back(32 * word + static_cast<std::uint32_t>(std::countr_zero(left)));
        directions_.push_back(direction_to(light_, p, points_[lit_.back()]));
        if (has_one_direction()) return;
      }
    }
  }

  void find_triangles(std::size_t pixel) {
    triangles_.clear();
    const auto carrier = static_cast<std::uint32_t>(samples_.triangle[pixel]);
    pyramid_.emplace(glm::dvec3(samples_.p[pixel]), directions_, !light_.sun);
    tree_.for_each_in(*pyramid_, [&](std::uint32_t i) {
      const std::uint32_t triangle = scene_.alphas.casters[i];
      if (!holes_ && alpha_mode(scene_, triangle) == scenes::Alpha::Mode::mask) return;
      if (may_filter(scene_, light_, carrier, triangle)) triangles_.push_back(triangle);
    });
    // Products are rounded: sorting makes them independent of the order in the file.
    std::ranges::sort(triangles_, [&](std::uint32_t a, std::uint32_t b) {
      return scene_.comes_before(a, b) || (!scene_.comes_before(b, a) && a < b);
    });
  }

  void pass(std::size_t pixel, std::uint32_t triangle, const Pyramid& pyramid) {
    const glm::vec3& p = samples_.p[pixel];
    const glm::dvec3 from(p);
    const std::array corners = scene_.corners(triangle);
    const std::array d{glm::dvec3(corners[0]) - from, glm::dvec3(corners[1]) - from, glm::dvec3(corners[2]) - from};
    const std::array edges{glm::cross(d[0], d[1]), glm::cross(d[1], d[2]), glm::cross(d[2], d[0])};
    // direction · (a × b) has a rounding error below 16 · 2⁻⁵³ · 6 of the product of the lengths
    // (visibility/certain_meeting).
    const double reach = std::max({glm::length(d[0]), glm::length(d[1]), glm::length(d[2])});
    const double error = 0x1p-46 * reach * reach;
    // p's height over the triangle, times twice its area; rounded like the products above.
    const double height = glm::dot(d[0], edges[1]), height_error = 4 * error * reach;
    const bool is_mask = alpha_mode(scene_, triangle) == scenes::Alpha::Mode::mask;
    const std::optional<Slopes> around = pyramid.slopes_around(d);
    for (std::size_t i = 0; i < lit_.size(); ++i) {
      if (around && i % Pyramid::kBlock == 0 && !around->touches(pyramid.block(i / Pyramid::kBlock))) {
        i += Pyramid::kBlock - 1;
        continue;
      }
      if (ends_[i].stopped) continue;
      const glm::dvec3& direction = directions_[i];
      const double ab = glm::dot(direction, edges[0]), bc = glm::dot(direction, edges[1]),
                   ca = glm::dot(direction, edges[2]);
      const double off = error * (std::abs(direction.x) + std::abs(direction.y) + std::abs(direction.z));
      if (std::min({ab, bc, ca}) < -off && std::max({ab, bc, ca}) > off) continue;
      // Descent of the segment; it ends below the plane if that exceeds p's height.
      const double drop = ab + bc + ca, drop_error = 4 * off;
      const bool inside = std::min({ab, bc, ca}) > off || std::max({ab, bc, ca}) < -off;
      const bool crosses = std::abs(height) > height_error && (height > 0) == (drop > 0) &&
                           (light_.sun || std::abs(drop) - std::abs(height) > drop_error + height_error);
      if (!(inside && crosses) && !segment_meets_triangle(p, points_[lit_[i]], corners, light_).meets) continue;
      const double left = transmittance_at(scene_, triangle, shares_from({bc, ca, ab}));
      SegmentEnd& end = ends_[i];
      if (is_mask) {
        end.by_mask = true;
        end.stopped = left == 0;
        if (end.stopped) --open_;
      } else {
        end.left *= left;
        end.dimmed = true;
      }
    }
  }

  bool write(std::span<std::uint32_t> mask, std::span<float> transmittances, AlphaCounts& counts) const {
    bool dims = false;
    const auto one = [&](const SegmentEnd& end, std::uint32_t sample) {
      counts.mask_pairs += end.by_mask ? 1 : 0;
      counts.blend_pairs += end.dimmed ? 1 : 0;
      if (end.stopped) mask[sample / 32] &= ~(1u << sample % 32);
      if (end.stopped || end.left == 1 || transmittances.empty()) return;
      if (!dims) std::ranges::fill(transmittances, 1.0f);
      dims = true;
      transmittances[sample] = static_cast<float>(end.left);
    };
    if (has_one_direction()) {
      for (std::uint32_t sample = 0; sample < light_.sample_count(); ++sample) one(ends_[0], sample);
    } else {
      for (std::size_t i = 0; i < lit_.size(); ++i) one(ends_[i], lit_[i]);
    }
    return dims;
  }

  const SceneFloats& scene_;
  const TriangleTree& tree_;
  const ViewSamples& samples_;
  const Light& light_;
  bool holes_;
  std::vector<glm::vec3> points_;
  std::vector<std::uint32_t> lit_;  // light samples whose bits are set, with their directions
  std::vector<glm::dvec3> directions_;
  std::optional<Pyramid> pyramid_;
  std::vector<std::uint32_t> triangles_;
  std::vector<SegmentEnd> ends_;
  std::size_t open_ = 0;  // number of these that are not stopped
};

}  // namespace

AlphaFilter::AlphaFilter(const SceneFloats& scene, bool holes)
    : scene_(scene), holes_(holes), tree_(make_tree_over_alphas(scene)) {}

bool AlphaFilter::dims(const Light& light) const {
  return std::ranges::any_of(scene_.alphas.casters, [&](std::uint32_t triangle) {
    return scene_.emits[triangle] != light.index && alpha_mode(scene_, triangle) == scenes::Alpha::Mode::blend;
  });
}

AlphaCounts AlphaFilter::filter(const ViewSamples& samples, const Light& light, std::size_t first,
                                const FilteredMasks& filtered) const {
  const std::size_t words = light.words_per_mask(), pairs = light.sample_count();
  const std::size_t pixels = filtered.masks.size() / words;
  PENUMBRA_ASSERT(filtered.transmittances.empty() ||
                      (filtered.transmittances.size() == pixels * pairs && filtered.dimmed.size() == pixels),
                  "{} transmittances for {} pixels of {}", filtered.transmittances.size(), pixels, pairs);
  struct Own {
    std::optional<PixelFilter> work;
    AlphaCounts counts;
  };
  tbb::enumerable_thread_specific<Own> threads;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, pixels, 32), [&](const auto& range) {
    Own& own = threads.local();
    if (!own.work) own.work.emplace(PixelFilter::Question{scene_, tree_, samples, light, holes_});
    for (std::size_t i = range.begin(); i != range.end(); ++i) {
      const auto transmittances =
          filtered.transmittances.empty() ? std::span<float>() : filtered.transmittances.subspan(i * pairs, pairs);
      const bool dims =
          own.work->filter(first + i, filtered.masks.subspan(i * words, words), transmittances, own.counts);
      if (!filtered.dimmed.empty()) filtered.dimmed[i] = dims ? 1 : 0;
    }
  });
  AlphaCounts counts;
  for (const Own& own : threads) {
    counts.mask_pairs += own.counts.mask_pairs;
    counts.blend_pairs += own.counts.blend_pairs;
  }
  return counts;
}

float dimmed_share(const Light& light, std::span<const std::uint32_t> mask, std::span<const float> transmittances,
                   const glm::vec3& n) {
  double sum = 0, all = 0;
  if (light.dome) {
    for (std::size_t sample = 0; sample < light.points.size(); ++sample) {
      const double cosine = std::max(0.0, glm::dot(glm::dvec3(n), glm::dvec3(light.points[sample])));
      all += cosine;
      if ((mask[sample / 32] >> sample % 32 & 1U) != 0) sum += cosine * double{transmittances[sample]};
    }
    return all > 0 ? static_cast<float>(sum / all) : 0.0F;
  }
  for (std::size_t word = 0; word < mask.size(); ++word) {
    for (std::uint32_t left = mask[word]; left != 0; left &= left - 1) {
      const std::size_t sample = 32 * word + static_cast<std::size_t>(std::countr_zero(left));
      sum += (light.weights.empty() ? 1.0 : light.weights[sample]) * double{transmittances[sample]};
    }
  }
  return static_cast<float>(light.weights.empty() ? sum / light.sample_count() : sum);
}

}  // namespace penumbra::visibility
