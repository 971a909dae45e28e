// SPDX-License-Identifier: Apache-2.0
// Compares each bit of layer-rays with a ray that is tested against every texel, wall and column of the layers. Without
// walls the surfaces are those of bitmask's patches. Errors shrink with every layer, and are large where a layer is
// missing.

#include "reference/methods.hpp"
#include "tests/analytic/maps/backprojection_scenes.hpp"
#include "tests/analytic/maps/centre_maps.hpp"

#include <random>

namespace penumbra::tests {
namespace {

using visibility::MethodOptions;

/// The layers of a map with one window, in double; every caster is well above every receiver.
class RayTwin {
 public:
  RayTwin(const render::Device& device, const Stage& stage, std::uint32_t size, std::uint32_t layers, double gap,
          bool solid)
      : stage_(stage), gap_(gap), solid_(solid), size_(size) {
    const selftest::CentreMaps maps(device, stage, size, {0, 0}, {.layers = layers, .whole_light = true});
    const maps::gpu::LightView& view = maps.fitted.views.front();
    EXPECT_EQ(maps.fitted.faces, 1U);
    basis_ = maps.basis;
    lower_ = view.side[0].lower;
    texel_ = (glm::dvec2(view.side[0].upper) - lower_) / static_cast<double>(size);
    const std::vector<float> stored = maps.read();
    depths_.resize(std::size_t{size} * size);
    for (std::size_t k = 0; k < stored.size(); ++k) {
      if (stored[k] < 1) depths_[k % depths_.size()].push_back(static_cast<double>(view.far) * stored[k]);
    }
  }

  /// Returns whether light sample j, moved by `off`, is hidden from pixel i.
  [[nodiscard]] bool hidden(std::size_t i, std::uint32_t j, const glm::dvec2& off) const {
    const glm::dvec3 e = basis_.local(stage_.samples.p[i]);
    const glm::dvec3 direction = basis_.local(stage_.light.points[j]) + glm::dvec3(off, 0) - e;
    for (std::uint32_t y = 0; y < size_; ++y) {
      for (std::uint32_t x = 0; x < size_; ++x) {
        if (meets_piece(e, direction, x, y) || (solid_ && meets_column(e, direction, x, y))) return true;
        if (x + 1 < size_ && meets_wall(e, direction, {x, y}, {x + 1, y}, 0)) return true;
        if (y + 1 < size_ && meets_wall(e, direction, {x, y}, {x, y + 1}, 1)) return true;
      }
    }
    return false;
  }

 private:
  using Cell = std::array<std::uint32_t, 2>;
  [[nodiscard]] const std::vector<double>& at(const Cell& cell) const { return depths_[cell[1] * size_ + cell[0]]; }
  [[nodiscard]] glm::dvec2 corner(std::uint32_t x, std::uint32_t y) const { return lower_ + glm::dvec2(x, y) * texel_; }

  [[nodiscard]] bool meets_piece(const glm::dvec3& e, const glm::dvec3& direction, std::uint32_t x,
                                 std::uint32_t y) const {
    const glm::dvec2 from = corner(x, y), to = corner(x + 1, y + 1);
    return std::ranges::any_of(at({x, y}), [&](double depth) {
      const glm::dvec2 q = glm::dvec2(e + direction * ((depth - e.z) / direction.z)) / depth;
      return q.x >= from.x && q.x <= to.x && q.y >= from.y && q.y <= to.y;
    });
  }

  /// Returns whether the ray passes through a texel's pyramid between the ends of a column.
  [[nodiscard]] bool meets_column(const glm::dvec3& e, const glm::dvec3& direction, std::uint32_t x,
                                  std::uint32_t y) const {
    const glm::dvec2 from = corner(x, y), to = corner(x + 1, y + 1);
    const std::vector<double>& depths = at({x, y});
    for (std::size_t k = 1; k < depths.size(); k += 2) {
      double first = (depths[k] - e.z) / direction.z, last = (depths[k - 1] - e.z) / direction.z;
      const auto keep = [&](const glm::dvec3& n) {  // n · q >= 0
        const double value = glm::dot(n, e), change = glm::dot(n, direction);
        if (change == 0 && value < 0) last = -1;
        if (change > 0) first = std::max(first, -value / change);
        if (change < 0) last = std::min(last, -value / change);
      };
      keep({1, 0, -from.x});
      keep({-1, 0, to.x});
      keep({0, 1, -from.y});
      keep({0, -1, to.y});
      if (first <= last) return true;
    }
    return false;
  }

  /// Whether the ray meets the wall on the border between two neighbouring texels along this axis.
  [[nodiscard]] bool meets_wall(const glm::dvec3& e, const glm::dvec3& direction, const Cell& one, const Cell& other,
                                int axis) const {
    const double border = corner(other[0], other[1])[axis];
    const double change = direction[axis] - border * direction.z;
    if (change == 0) return false;
    const double t = -(e[axis] - border * e.z) / change;
    const glm::dvec3 q = e + t * direction;
    if (t <= 0 || t >= 1 || q.z <= 0) return false;
    const double across = q[1 - axis] / q.z, begins = corner(one[0], one[1])[1 - axis];
    if (across < begins || across >= begins + texel_[1 - axis]) return false;
    const auto joins = [&](const std::vector<double>& a, const std::vector<double>& b) {
      for (const double before : a) {
        for (const double behind : b) {
          const auto between = [&](double depth) { return depth > before && depth < behind; };
          if (before > q.z || behind <= q.z) continue;
          // The layers next to the ray in both lists.
          if (std::ranges::any_of(a, [&](double d) { return between(d) && d <= q.z; })) continue;
          if (std::ranges::any_of(b, [&](double d) { return between(d) && d > q.z; })) continue;
          const double step = behind - before;
          if (step > gap_ * std::max(texel_.x, texel_.y) * before) continue;
          const auto last_before = std::ranges::find_if(b.rbegin(), b.rend(), [&](double d) { return d <= q.z; });
          const auto first_behind = std::ranges::find_if(a, [&](double d) { return d > q.z; });
          if (last_before != b.rend() && std::abs(*last_before - before) < step) continue;
          if (first_behind != a.end() && std::abs(*first_behind - behind) < step) continue;
          return true;
        }
      }
      return false;
    };
    return joins(at(one), at(other)) || joins(at(other), at(one));
  }

  const Stage& stage_;
  double gap_;
  bool solid_;
  std::uint32_t size_;
  maps::LightBasis basis_;
  glm::dvec2 lower_{0}, texel_{0};
  std::vector<std::vector<double>> depths_;  ///< per texel, nearest first
};

/// A board that stands on edge under the light: twenty-five times as high as it is thick.
scenes::Scene upright_board() {
  scenes::Scene scene = bare_floor(0.8);
  const glm::dvec3 at(0, 1.75, 0), x(0.05, 0, 0), y(0, 1.25, 0), z(0, 0, 1.5);
  const auto pair = [&](const glm::dvec3& off, const glm::dvec3& u, const glm::dvec3& v) {
    add_quad(scene, at + off, u, v).receives_shadow = false;
    add_quad(scene, at - off, u, v).receives_shadow = false;
  };
  pair(x, y, z);
  pair(y, z, x);
  pair(z, x, y);
  return scene;
}

class MapsLayerRays : public MapsTest {
 protected:
  static Masks rays(const Stage& stage, const MethodOptions& options, const char* size = "48") {
    MethodOptions all{{"size", size}};
    for (const auto& [key, value] : options) all[key] = value;
    return run(maps::make_layer_rays, stage, all);
  }
  static double error(const Stage& stage, const Masks& found) {
    const Masks truth = tests::run(*reference::make_exact({}), stage);
    return rmse(
        stage, [](std::size_t) { return true; },
        [&](std::size_t i) { return static_cast<double>(found.visibility[i] - truth.visibility[i]); });
  }
};

// Rays within 1e-5 of a border may be decided either way; all others must agree with the twin.
TEST_F(MapsLayerRays, EachBitIsWhatALongWayThroughAllTexelsSays) {
  constexpr std::uint32_t kSize = 24;
  std::size_t by_walls = 0, by_columns = 0;
  for (const scenes::Scene& scene : {sphere_over_floor(1, 8), oblique_quad(0.3), upright_board()}) {
    const Stage stage = on_floor(scene, 10, light_samples(36));
    Masks before;
    for (const auto& [gap, solid] : {std::pair(0, false), std::pair(4, false), std::pair(4, true)}) {
      const RayTwin twin(device(), stage, kSize, 3, gap, solid);
      const Masks found =
          rays(stage, {{"layers", "3"}, {"gap", std::to_string(gap)}, {"solid", solid ? "on" : "off"}}, "24");
      std::size_t wrong = 0, near = 0, more = 0;
      for (std::size_t i = 0; i < stage.samples.size(); ++i) {
        for (std::uint32_t j = 0; j < 36; ++j) {
          more += !before.words.empty() && !found.visible(i, j) && before.visible(i, j) ? 1 : 0;
          if (twin.hidden(i, j, {0, 0}) != found.visible(i, j)) continue;
          const double d = 1e-5;
          bool on_border = false;
          for (const glm::dvec2& off : {glm::dvec2(d, 0), glm::dvec2(-d, 0), glm::dvec2(0, d), glm::dvec2(0, -d)}) {
            on_border = on_border || twin.hidden(i, j, off) != found.visible(i, j);
          }
          (on_border ? near : wrong) += 1;
        }
      }
      EXPECT_EQ(wrong, 0U) << "gap " << gap << (solid ? ", solid" : "");
      EXPECT_LT(near, 8U);
      (solid ? by_columns : by_walls) += more;
      before = found;
    }
  }
  EXPECT_GT(by_walls, 100U) << "no wall hides anything";
  EXPECT_GT(by_columns, 10U) << "no column hides anything";
}

// Without walls a texel hides what bitmask's patch hides: both methods find the same light samples, in a hemicube's
// upper face, too. (On sideways faces patches take a texel's slanted sides as seen from its middle.)
TEST_F(MapsLayerRays, WithoutWallsTheyAreJoinedPatches) {
  for (const scenes::Scene& scene : {sphere_over_floor(), square_above_plate(), oblique_quad(0.5), box_over_floor()}) {
    const Stage stage = on_floor(scene, 16, light_samples(64));
    const Masks found = rays(stage, {{"layers", "2"}, {"gap", "0"}}),
                patches = run(maps::make_bitmask, stage,
                              {{"size", "48"}, {"occluder", "patch"}, {"layers", "2"}, {"search", "none"}});
    std::size_t differing = 0, hidden = 0;
    for (std::size_t k = 0; k < found.words.size(); ++k) {
      differing += static_cast<std::size_t>(std::popcount(found.words[k] ^ patches.words[k]));
      hidden += static_cast<std::size_t>(std::popcount(~found.words[k]));
    }
    EXPECT_GT(hidden, 500U);
    EXPECT_LE(differing, 3U) << "of " << hidden;  // on a border, whose product may round either way
  }
}

// With all layers of one closed body V converges to the truth about as fast as texels shrink. With one layer it does
// not, since that lacks everything that the centre does not see (docs/predicates.md, E1).
TEST_F(MapsLayerRays, AllLayersConvergeAndOneDoesNot) {
  const Stage stage = on_floor(sphere_over_floor(1, 16), 14, light_samples(256));
  std::map<std::string, std::array<double, 3>> errors;
  const std::array<const char*, 3> sizes{"32", "96", "288"};
  for (const char* layers : {"1", "2"}) {
    for (std::size_t k = 0; k < 3; ++k) {
      errors[layers][k] =
          error(stage, rays(stage, {{"layers", layers}, {"gap", layers[0] == '1' ? "0" : "8"}}, sizes[k]));
    }
  }
  fmt::print("layers 1: {:.4f} {:.4f} {:.4f}; 2: {:.4f} {:.4f} {:.4f}\n", errors["1"][0], errors["1"][1],
             errors["1"][2], errors["2"][0], errors["2"][1], errors["2"][2]);
  EXPECT_GT(errors["1"][2], 0.8 * errors["1"][1]);
  EXPECT_LT(errors["2"][1], 0.5 * errors["2"][0]);
  EXPECT_LT(errors["2"][2], 0.6 * errors["2"][1]);
  EXPECT_LT(errors["2"][2], 0.2 * errors["1"][2]);
}

// Two layers know what one cannot: whether a whole or half a lower plate lies under the upper half plate.
TEST_F(MapsLayerRays, OneLayerHasOneImageAndTwoTellTheScenesApart) {
  const Stage gap = on_floor(plates_with_gap(true), 16, light_samples(64)),
              whole = on_floor(plates_with_gap(false), 16, light_samples(64));
  EXPECT_EQ(rays(gap, {{"layers", "1"}}).words, rays(whole, {{"layers", "1"}}).words);
  EXPECT_GT(error(whole, rays(whole, {{"layers", "1"}}, "128")), 0.05);
  EXPECT_LT(error(gap, rays(gap, {{"layers", "2"}}, "128")), 0.02);
  EXPECT_LT(error(whole, rays(whole, {{"layers", "2"}}, "128")), 0.02);
}

// The sides of a body that stands under the light cover no texel: only its inside hides rays that pass through both
// sides.
TEST_F(MapsLayerRays, TheSidesOfABoardAreItsInside) {
  const Stage stage = on_floor(upright_board(), 24, light_samples(256));
  const double surfaces = error(stage, rays(stage, {{"layers", "2"}}, "256")),
               full = error(stage, rays(stage, {{"layers", "2"}, {"solid", "on"}}, "256"));
  fmt::print("board: surfaces {:.4f}, solid {:.4f}\n", surfaces, full);
  EXPECT_LT(full, 0.4 * surfaces);
}

// A ray in a hemicube continues from face to face.
TEST_F(MapsLayerRays, InAHemicubeTheyAgreeWithTheExactPairs) {
  scenes::Scene scene = bare_floor(0.5, 1.5);
  add_quad(scene, {-1.5, 2.5, 0}, {0, 0, 1.5}, {0, 2.5, 0}).casts_shadow = false;  // a wall up to the light's plane
  add_quad(scene, {-0.8, 3.6, 0.2}, {0.3, 0.05, 0.1}, {0.05, 0.2, -0.3}).receives_shadow = false;
  add_quad(scene, {0.5, 2.6, 0.2}, {0.3, 0.1, 0.1}, {0.1, 0.1, -0.3}).receives_shadow = false;
  scene.cameras.front() = camera({1.5, 3, 1}, {-1, 1.5, 0}, 70);
  const Stage stage(scene, 24, 24, light_samples(64));
  const Masks found = rays(stage, {{"layers", "3"}}, "256");
  std::size_t pairs = 0, wrong = 0, hidden = 0;
  for (std::size_t i = 0; i < stage.samples.size(); ++i) {
    if (!visibility::is_receiver(stage.floats, stage.light, stage.samples, i)) continue;
    for (std::uint32_t j = 0; j < 64; ++j) {
      const bool visible = visibility::decide_pair(stage.floats, stage.samples, i, stage.light, j).outcome ==
                           visibility::PairOutcome::visible;
      ++pairs;
      hidden += visible ? 0 : 1;
      wrong += visible != found.visible(i, j) ? 1 : 0;
    }
  }
  fmt::print("hemicube: {} of {} pairs wrong, {} hidden\n", wrong, pairs, hidden);
  EXPECT_GT(hidden, pairs / 50);
  EXPECT_LT(wrong, pairs / 100);
}

}  // namespace
}  // namespace penumbra::tests
