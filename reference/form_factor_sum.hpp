#pragma once

#include "reference/area_sweep.hpp"
#include "visibility/light_texture.hpp"
#include "visibility/seen_light.hpp"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <gmpxx.h>

#include <array>
#include <optional>
#include <span>
#include <utility>

// Inside reference/ only: form factors of what the sweep finds uncovered.

namespace penumbra::reference {

/// A trapezoid of the light's plane with sides along t: at s0 from low0 to high0, at s1 from low1 to high1.
struct Trapezoid {
  double s0, s1, low0, low1, high0, high1;
};

/// Adds up form factors of parts of a light, times the texels that they lie on.
class FormFactorSum {
 public:
  /// Both must outlive it. No texture: every texel is 1.
  FormFactorSum(const visibility::SeenLight& seen, const std::optional<visibility::LightTexture>& texture)
      : seen_(seen), texture_(texture ? &*texture : nullptr) {}

  /// With a texture, within one column of texels.
  void add(const Trapezoid& part);
  /// All of the light that is above the horizon; with a texture texel by texel.
  void add_whole();
  [[nodiscard]] const glm::dvec3& sum() const { return sum_; }

 private:
  void add_texels(const std::array<glm::dvec2, 4>& corners);

  const visibility::SeenLight& seen_;
  const visibility::LightTexture* texture_;
  glm::dvec3 sum_{0};
};

/// A measure of the sweep (area_sweep.hpp) that measures what Measure does, and on the way hands each trapezoid on.
template <typename Number, typename Measure>
class FormFactorMeasure {
 public:
  static constexpr bool kNeedsEnds = true;

  FormFactorMeasure(Measure measure, FormFactorSum& sum) : measure_(std::move(measure)), sum_(&sum) {}

  void add_breaks(std::vector<Number>& breaks) const { measure_.add_breaks(breaks); }
  void enter_strip(const Number& middle) { measure_.enter_strip(middle); }
  void enter_slab(const Number& from, const Number& to) {
    from_ = to_double(from);
    to_ = to_double(to);
  }
  [[nodiscard]] Number between(const ActiveEdge<Number>& low, const ActiveEdge<Number>& high) const {
    sum_->add({from_, to_, to_double(low.from), to_double(low.to), to_double(high.from), to_double(high.to)});
    return measure_.between(low, high);
  }

 private:
  static double to_double(double value) { return value; }
  static double to_double(const mpq_class& value) { return value.get_d(); }

  Measure measure_;
  FormFactorSum* sum_;
  double from_ = 0, to_ = 0;  // the slab
};

}  // namespace penumbra::reference
