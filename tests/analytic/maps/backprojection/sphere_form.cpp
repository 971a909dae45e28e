// SPDX-License-Identifier: Apache-2.0
// Tests backproject with form=sphere (bounding spheres of texels in front of a sphere, or of a disk of the light's area
// that faces the receiver) against all texels in double, closed forms and rays.

#include "render/compute_pass.hpp"
#include "tests/analytic/maps/backprojection/lens.comp.spv.hpp"
#include "tests/analytic/maps/backprojection_scenes.hpp"
#include "tests/analytic/maps/centre_maps.hpp"
#include "tests/unit/ray_traced_masks.hpp"

#include <array>

namespace penumbra::tests {
namespace {

constexpr double kPi = std::numbers::pi;

/// The solid angle that two cones share; a and b are their half-angles, `apart` is the angle between their axes
/// (Tovchigrechko and Vakser 2001).
double shared_cap(double a, double b, double apart) {
  if (apart >= a + b) return 0;
  if (apart <= std::abs(a - b)) return 2 * kPi * (1 - std::cos(std::min(a, b)));
  const auto angle = [](double cosine) { return std::acos(std::clamp(cosine, -1.0, 1.0)); };
  const double ca = std::cos(a), cb = std::cos(b), cd = std::cos(apart);
  const double sa = std::sin(a), sb = std::sin(b), sd = std::sin(apart);
  return 2 * (kPi - angle((cd - ca * cb) / (sa * sb)) - ca * angle((cb - cd * ca) / (sd * sa)) -
              cb * angle((ca - cd * cb) / (sd * sb)));
}

/// Returns the share of a disk of radius 1 on one side of a line at distance t from its middle.
double segment(double t) {
  t = std::clamp(t, -1.0, 1.0);
  return 0.5 + (t * std::sqrt(1 - t * t) + std::asin(t)) / kPi;
}

/// Sums over all texels of a light's maps of one face, one by one.
class SphereTwin {
 public:
  SphereTwin(const render::Device& device, const Stage& stage, std::uint32_t size)
      : stage_(&stage),
        maps_(device, stage, size, {0, 0}, {.all_casters = true}),
        texels_(maps_.read()),
        radius_(std::sqrt(stage.light.area / kPi)) {
    EXPECT_EQ(maps_.fitted.faces, 1U);
  }
  /// Returns the larger side of a texel at depth 1.
  [[nodiscard]] double texel() const {
    const glm::dvec2 extent = maps_.fitted.views.front().side[0].upper - maps_.fitted.views.front().side[0].lower;
    return std::max(extent.x, extent.y) / maps_.size;
  }
  /// Returns V of a receiver below all casters.
  [[nodiscard]] double visibility(std::size_t pixel) const {
    const auto& side = maps_.fitted.views.front().side[0];
    const double far = maps_.fitted.views.front().far;
    const glm::dvec3 e = maps_.basis.local(stage_->samples.p[pixel]);
    const glm::dvec2 lower = side.lower, texel = (glm::dvec2(side.upper) - lower) / static_cast<double>(maps_.size);
    const bool ball = stage_->light.kind == visibility::LightKind::sphere;
    const double light = ball ? std::asin(radius_ / glm::length(e)) : std::atan(radius_ / glm::length(e));
    double sum = 0;
    for (std::size_t i = 0; i < texels_.size(); ++i) {
      if (texels_[i] == 1) continue;
      const glm::dvec2 at = lower + (glm::dvec2(i % maps_.size, i / maps_.size) + 0.5) * texel;
      const double depth = static_cast<double>(texels_[i]) * far;
      const glm::dvec3 to = depth * glm::dvec3(at, 1) - e;
      const double angle = std::asin(0.5 * glm::length(texel) * depth / glm::length(to));
      const double apart = std::atan2(glm::length(glm::cross(to, -e)), glm::dot(to, -e));
      sum += shared_cap(light, angle, apart) / (2 * kPi * (1 - std::cos(light)));
    }
    return 1 - std::min(sum, 1.0);
  }

 private:
  const Stage* stage_;
  CentreMaps maps_;
  std::vector<float> texels_;
  double radius_;
};

class SphereForm : public MapsTest {
 protected:
  static Masks spheres(const Stage& stage, std::uint32_t size, const char* search = "hsm") {
    return run(maps::make_backproject, stage,
               {{"form", "sphere"}, {"size", fmt::format("{}", size)}, {"search", search}});
  }
  /// A half-plane at half the light's height; its edge is at x = 0.1.
  static scenes::Scene under_a_half_plane() {
    scenes::Scene scene = bare_floor(1, 0.4);
    add_quad(scene, {-0.45, 2.5, 0}, {0.55, 0, 0}, {0, 0, -0.6}).receives_shadow = false;
    return scene;
  }
};

// The two segments on either side of the common chord of two disks: r² (a − sin a cos a), where cos a is the chord's
// distance over r.
TEST_F(SphereForm, TwoDisksShareTheirSegments) {
  std::vector<glm::vec3> disks;
  for (const float r : {0.02F, 0.3F, 1.0F}) {
    for (const float s : {0.01F, 0.4F, 1.0F, 30.0F}) {
      for (const float share : {-0.5F, 0.01F, 0.1F, 0.5F, 0.9F, 0.99F, 1.2F}) {  // from nested disks to disjoint ones
        disks.emplace_back(r, s, std::abs(r - s) + 2 * share * std::min(r, s));
        if (disks.back().z < 0) disks.pop_back();
      }
    }
  }
  const render::Buffer asked = render::make_buffer<glm::vec3>(device(), "disks", disks),
                       areas(device(), "areas", disks.size() * sizeof(float));
  const render::ComputePass pass(device(), {.name = "lens", .spirv = shaders::kLensComp});
  render::Commands commands(device());
  pass.record(commands, std::span<const std::byte>(), std::vector<render::BufferReference>{asked, areas},
              (disks.size() + 63) / 64);
  commands.submit();
  std::vector<float> found(disks.size());
  areas.read<float>(found);
  for (std::size_t i = 0; i < disks.size(); ++i) {
    const double r = disks[i].x, s = disks[i].y, d = disks[i].z, small = std::min(r, s);
    double expected = d >= r + s ? 0 : kPi * small * small;
    if (d < r + s && d > std::abs(r - s)) {
      const auto behind = [](double radius, double away) {
        const double angle = std::acos(std::clamp(away / radius, -1.0, 1.0));
        return radius * radius * (angle - std::sin(angle) * std::cos(angle));
      };
      const double chord = (d * d + r * r - s * s) / (2 * d);
      expected = behind(r, chord) + behind(s, d - chord);
    }
    // In floats, centres are off by 2^-24 of the larger radius, along a chord of up to twice the smaller one.
    EXPECT_NEAR(found[i], expected, 1e-4 * kPi * small * small + 4e-7 * std::max(r, s) * small)
        << r << " " << s << " " << d;
  }
}

// The twin uses caps on the sphere, in double. The shader uses disks in a stereographic projection: areas are off by a
// factor of up to 1 / cos^4 of half the light's angle, and borders are floats. 2 % of a sphere's radius are 4 % of what
// it hides.
TEST_F(SphereForm, IsTheSumOfAllCapsOneByOne) {
  constexpr std::uint32_t kSize = 40;
  for (const auto& shape : {decltype(scenes::AreaLight::shape)(scenes::Sphere{{0, 5, 0}, 0.5}),
                            decltype(scenes::AreaLight::shape)(scenes::Disk{{0, 5, 0}, {0, -1, 0}, 0.7}),
                            decltype(scenes::AreaLight::shape)(scenes::Rectangle{{0, 5, 0}, {1, 0, 0}, {0, 0, 0.2}})}) {
    scenes::Scene scene = bare_floor(1, 1.5);
    add_quad(scene, {-0.2, 3, 0.1}, {0.12, 0.02, 0}, {0, 0.01, 0.1}).receives_shadow = false;
    add_quad(scene, {0.3, 1.5, -0.2}, {0.1, 0, 0}, {0, 0.03, 0.2}).receives_shadow = false;
    scene.lights.front().shape = shape;
    const Stage stage = on_floor(scene, 16, light_samples(1));
    const SphereTwin twin(device(), stage, kSize);
    const double light = std::atan(std::sqrt(stage.light.area / kPi) / 5);
    const Masks found = spheres(stage, kSize);
    double worst = 0;
    std::size_t partly = 0;
    for (std::size_t i = 0; i < stage.samples.size(); ++i) {
      const double expected = twin.visibility(i);
      worst = std::max(worst, std::abs(static_cast<double>(found.visibility[i]) - expected));
      partly += expected < 0.98 && expected > 0.02 ? 1 : 0;
    }
    const double bound = 1 / std::pow(std::cos(light / 2), 4) - 1 + 1e-4;
    fmt::print("caps one by one: off by {:.5f} of {:.5f}, {} pixels in penumbra\n", worst, bound, partly);
    EXPECT_LT(worst, bound);
    EXPECT_LT(bound, 0.012);
    EXPECT_GT(partly, 30U);
    EXPECT_EQ(spheres(stage, kSize, "none").visibility, found.visibility);
    EXPECT_EQ(spheres(stage, kSize, "mssm").visibility, found.visibility);
  }
}

// A disk or a sphere behind a half-plane: the hidden part is a segment of the disk that the receiver sees, and bounding
// spheres hide pi / 2 times as much, over the cosine at which texels are seen.
TEST_F(SphereForm, AHalfPlaneHidesASegmentTimesHalfPi) {
  constexpr std::uint32_t kSize = 1024;
  constexpr double kRadius = 0.5, kEdge = 0.1;
  std::vector<double> places;
  for (int i = 0; i < 48; ++i) places.push_back(-0.3 + 0.7 * i / 47);
  for (const bool ball : {false, true}) {
    scenes::Scene scene = under_a_half_plane();
    if (ball) {
      scene.lights.front().shape = scenes::Sphere{{0, 5, 0}, kRadius};
    } else {
      scene.lights.front().shape = scenes::Disk{{0, 5, 0}, {0, -1, 0}, kRadius};
    }
    const Stage stage = along_floor(scene, places, light_samples(1024));
    const SphereTwin twin(device(), stage, 64);
    // A texel is f = 2.5 · 5 / 2.5 times as wide on the light; the edge is off by half a texel along a chord 2 r long.
    // Spheres on the light's border (2 pi r / texel in a ring two texels wide) are each counted with an error of at
    // most a tenth. The cosine differs by 0.1 · tan over the light, at |x| <= 0.4 of 5.
    const double texel = twin.texel() * 62 / (kSize - 2) * 5;
    const double bound =
        kPi / 2 * (texel * 2 * kRadius / 2 + 0.1 * 4 * kPi * kRadius * texel) / (kPi * kRadius * kRadius) +
        kPi / 2 * 0.1 * 0.08;
    const Masks found = spheres(stage, kSize), traced = trace(stage);
    double worst = 0, rays = 0;
    std::size_t partly = 0;
    for (std::size_t i = 0; i < places.size(); ++i) {
      const double x = places[i], away = std::hypot(x, 5);
      const double angle = std::atan2(-x, 5) - std::atan2(kEdge - x, 2.5);  // from the edge to the light's middle
      const double seen_under = ball ? kRadius / std::sqrt(away * away - kRadius * kRadius) : kRadius / away;
      const double hidden = segment(-std::tan(angle) / seen_under), grown = kPi / 2 * away / 5;
      const double v = found.visibility[i];
      worst = std::max(worst, std::abs(v - std::max(0.0, 1 - grown * hidden)));
      // An edge passes one row of the 1024 samples at a time, a 32nd of the disk's width.
      const double by_rays = std::max(0.0, 1 - grown * (1 - static_cast<double>(traced.visibility[i])));
      rays = std::max(rays, std::abs(v - by_rays));
      partly += v > 0 && v < 1 ? 1 : 0;
    }
    fmt::print("{} behind a half-plane: off by {:.4f} of {:.4f}, and by {:.4f} of pi / 2 times the rays' share\n",
               ball ? "sphere" : "disk", worst, bound, rays);
    RecordProperty(ball ? "sphere" : "disk", fmt::format("{:.4f} of {:.4f}", worst, bound));
    EXPECT_LT(worst, bound);
    EXPECT_LT(bound, 0.05);
    EXPECT_LT(rays, bound + kPi / 2 / 32);
    EXPECT_GT(partly, 12U);
  }
}

// A strip is replaced by a disk of its area: what shades that disk beside the strip counts, too.
TEST_F(SphereForm, AStripsDiskIsShadedBesideTheStrip) {
  constexpr double kEdge = 0.06;  // appears at z = 0.12 on the light
  scenes::Scene scene = bare_floor(1, 0.4);
  scene.lights.front() = rectangle_light({0, 5, 0}, {1, 0, 0}, {0, 0, 0.05});
  add_quad(scene, {0, 2.5, kEdge + 0.4}, {0.6, 0, 0}, {0, 0, -0.4}).receives_shadow = false;
  const Stage stage(scene, 12, 12, light_samples(1), grid_samples(12, {0, 0, 0}, {0.1, 0, 0}, {0, 0, 0.02}, {0, 1, 0}));
  const double radius = std::sqrt(0.2 / kPi);
  const Masks found = spheres(stage, 1024), patches = run(maps::make_backproject, stage, {{"size", "1024"}});
  const SphereTwin twin(device(), stage, 64);
  const double texel = twin.texel() * 62 / 1022 * 5,
               bound = kPi / 2 * (texel * radius + 0.1 * 4 * kPi * radius * texel) / (kPi * radius * radius) + 0.01;
  double worst = 0;
  for (std::size_t i = 0; i < stage.samples.size(); ++i) {
    const double z = static_cast<double>(stage.samples.p[i].z) + stage.floats.origin.z;
    const double on_light = z + (kEdge - z) * 2;
    const double expected = 1 - kPi / 2 * segment(-on_light / radius);
    worst = std::max(worst, std::abs(static_cast<double>(found.visibility[i]) - expected));
    EXPECT_EQ(patches.visibility[i], 1.0F) << "the strip itself is in plain view";
    EXPECT_LT(found.visibility[i], 0.9F);
  }
  fmt::print("a strip's disk: off by {:.4f} of {:.4f}\n", worst, bound);
  EXPECT_LT(worst, bound);
}

// A lamp between a floor and a ceiling, with boards on both sides: it has maps on both sides, and V is the same above
// and below.
TEST_F(SphereForm, ALampShinesAllAround) {
  scenes::Scene scene;
  add_quad(scene, {0, 0, 0}, {3, 0, 0}, {0, 0, -3});
  add_quad(scene, {0, 5, 0}, {3, 0, 0}, {0, 0, 3});
  add_quad(scene, {0, 1.5, 0}, {0.4, 0, 0}, {0, 0, 0.4}).receives_shadow = false;
  add_quad(scene, {0, 3.5, 0}, {0.4, 0, 0}, {0, 0, 0.4}).receives_shadow = false;
  add_quad(scene, {3, 2.5, 0}, {0, 2.5, 0}, {0, 0, 3});
  scene.lights.push_back(ceiling_light(5, 1));
  scene.lights.front().shape = scenes::Sphere{{0, 2.5, 0}, 0.3};
  scene.cameras.push_back(camera({0, 2.5, 7}, {0, 2.5, 0}));
  // Places below the lamp, above it, beside it at its own height, and within it.
  const auto places = [&](const visibility::SceneFloats& floats, const visibility::PinholeCamera& /*camera*/) {
    visibility::ViewSamples samples;
    samples.width = 24;
    samples.height = 2;
    const auto add = [&](std::int32_t triangle, const glm::dvec3& p, const glm::dvec3& n) {
      const auto corners = floats.corners(static_cast<std::uint32_t>(triangle));
      const glm::dvec3 winding = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
      samples.triangle.push_back(triangle);
      samples.p.emplace_back(p - floats.origin);
      samples.n.emplace_back(n);
      samples.depth.push_back(1);
      samples.facing.push_back(glm::dot(winding, n) > 0 ? 1 : -1);
    };
    for (int i = 0; i < 22; ++i) add(0, {0.1 * i, 0, 0.05}, {0, 1, 0});
    add(8, {3, 2.5, 0.5}, {-1, 0, 0});
    add(8, {0.1, 2.5, 0}, {-1, 0, 0});
    for (int i = 0; i < 22; ++i) add(2, {0.1 * i, 5, 0.05}, {0, -1, 0});
    add(8, {3, 2.5, -0.5}, {-1, 0, 0});
    add(8, {3, 2.4, -0.5}, {-1, 0, 0});
    return samples;
  };
  const Stage stage(scene, 24, 2, light_samples(256), places);
  const Masks found = spheres(stage, 256), traced = trace(stage);
  std::size_t partly = 0;
  for (std::size_t i = 0; i < 22; ++i) {
    EXPECT_NEAR(found.visibility[i], found.visibility[24 + i], 2e-3) << i;  // sides are rasterised separately
    // Bounding spheres hide up to pi / 2 of what is hidden, over the cosine.
    const double hidden = 1 - static_cast<double>(traced.visibility[i]),
                 cosine = 2.5 / std::hypot(0.1 * static_cast<double>(i), 2.5);
    EXPECT_LE(found.visibility[i], traced.visibility[i] + 0.04F) << i;
    EXPECT_GE(static_cast<double>(found.visibility[i]), 1 - kPi / 2 / cosine * hidden - 0.08) << i;
    partly += found.visibility[i] > 0.05F && found.visibility[i] < 0.95F ? 1 : 0;
  }
  EXPECT_GT(partly, 3U);
  EXPECT_EQ(found.visibility[22], 1.0F) << "at the lamp's height nothing of its maps is in front";
  EXPECT_EQ(found.visibility[23], 0.0F) << "in the lamp";
  EXPECT_EQ(found.visibility[46], 1.0F);
  EXPECT_EQ(found.visibility[47], 1.0F);
}

// The horizon cuts the disk that the receiver sees; nothing else hides the lamp.
TEST_F(SphereForm, TheHorizonCutsALampAsItIsSeen) {
  scenes::Scene scene = bare_floor(1);
  for (const double x : {-0.6, 0.2, 0.5}) {
    add_quad(scene, {x, 1.5, 0}, {0.3, 1.4, 0}, {0.2, 0, 0.5}).casts_shadow = false;
  }
  scene.lights.front().shape = scenes::Sphere{{0, 5, 0}, 1.2};
  scene.cameras.front() = camera({3, 3, 2}, {0, 1.5, 0}, 60);
  const Stage stage(scene, 24, 24, light_samples(1));
  const Masks found = spheres(stage, 16);
  std::size_t cut = 0;
  for (std::size_t i = 0; i < stage.samples.size(); ++i) {
    if (stage.samples.triangle[i] < 0) continue;
    const glm::vec3& p = stage.samples.p[i];
    const visibility::LightFrame disk = visibility::light_frame_from(stage.light, p);
    const glm::dvec3 n = stage.samples.n[i];
    const double over = glm::dot(n, disk.center - glm::dvec3(p)),
                 rise = std::hypot(glm::dot(n, disk.u), glm::dot(n, disk.v));
    const double expected = segment(over / rise);
    EXPECT_NEAR(found.visibility[i], expected, 2e-5) << i;  // a closed form in float
    cut += expected > 0 && expected < 1 ? 1 : 0;
  }
  EXPECT_GT(cut, 20U);
}

// form=sphere refuses textures, which caps cannot weight; form=patch refuses spheres, which have no plane for patches.
TEST_F(SphereForm, PatchesRefuseSpheresAndSpheresTextures) {
  scenes::Scene scene = under_a_half_plane();
  scene.lights.front().texture = scenes::Texture{"", 2, 1, {{0, 0, 0}, {1, 1, 1}}};
  const Stage textured = along_floor(scene, {0.0}, light_samples(4));
  scene.lights.front().texture.reset();
  scene.lights.front().shape = scenes::Sphere{{0, 5, 0}, 0.5};
  const Stage lamp = along_floor(scene, {0.0}, light_samples(4));
  const auto refuses = [&](const char* form, const Stage& stage) {
    const auto method = maps::make_backproject(device(), {{"form", form}, {"size", "16"}});
    method->prepare_mesh(stage.floats);
    try {
      method->prepare_light(stage.light);
      return false;
    } catch (const InputError&) {
      return true;
    }
  };
  EXPECT_TRUE(refuses("patch", lamp));
  EXPECT_FALSE(refuses("sphere", lamp));
  EXPECT_TRUE(refuses("sphere", textured));
  EXPECT_FALSE(refuses("patch", textured));
}

}  // namespace
}  // namespace penumbra::tests
