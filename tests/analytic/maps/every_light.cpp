// SPDX-License-Identifier: Apache-2.0
// Tests suns and spheres with methods whose maps handle only planar lights (maps/host/every_light.hpp), against closed
// forms and exact areas.

#include "tests/analytic/maps/every_light.hpp"
#include "maps/host/lamp_disks.hpp"
#include "maps/host/sun_space.hpp"

#include <glm/trigonometric.hpp>

#include <random>

namespace penumbra::tests::every_light {
namespace {

// Directions (σ, −1) from p cross the height h at x + h σ_x: a segment of the sun's disk, beyond the edge, is hidden.
class HalfASun : public EveryLight {
 protected:
  static void expect_segments(const std::vector<Entry>& entries, std::uint32_t samples) {
    constexpr double kHeight = 0.5, kEdge = 0.1, kAngle = 20;
    scenes::Scene scene = floor_under(shaped(scenes::Sun{{0, -1, 0}, kAngle}));
    scene.objects[0].casts_shadow = false;
    add_quad(scene, {kEdge - 1, kHeight, 0}, {1, 0, 0}, {0, 0, -1.6}).receives_shadow = false;
    const Stage stage(scene, 40, 1, light_samples(samples), over_floor(40, 1, kEdge, 0.2));
    const double reach = kHeight * std::tan(glm::radians(kAngle / 2));
    for (const Entry& entry : entries) {
      const Masks found = run_entry(entry, stage);
      double worst = 0;
      for (std::size_t i = 0; i < stage.samples.size(); ++i) {
        const double x = static_cast<double>(stage.samples.p[i].x) + stage.floats.origin.x;
        const double t = std::clamp((x - kEdge) / reach, -1.0, 1.0);
        const double expected = 0.5 + (t * std::sqrt(1 - t * t) + std::asin(t)) / std::numbers::pi;
        worst = std::max(worst, std::abs(static_cast<double>(found.visibility[i]) - expected));
      }
      fmt::print("half a sun, {}: off by {:.4f}\n", entry.name, worst);
      // A texel is 3.2 / 512 wide and moves the edge by up to half of that: V is off by 0.023, 2 / pi of the shift over
      // the reach. Methods that replace the disk by boxes, taps or light samples are off by more.
      const bool outlines = entry.name == "contour" || entry.name == "packet" || entry.name == "backproject";
      EXPECT_LT(worst, outlines ? 0.023 : 0.07) << entry.name;
    }
  }
};

TEST_F(HalfASun, IsHiddenByAHalfPlane) {
  expect_segments(some_methods("512", {"pcss", "vssm", "contour", "backproject", "soft-shadow-map"}), 64);
}

TEST_F(HalfASun, IsHiddenByAHalfPlaneInEveryMethodFull) {
  std::vector<Entry> soft = all_methods("512");
  std::erase_if(soft, [](const Entry& one) { return one.name == "pcf" || one.name.starts_with("shadow-map"); });
  expect_segments(soft, 256);
}

// A disk so far away that its rays are parallel to the sun's within a degree: the maps are the same except for where
// texels begin, and so are the penumbrae.
TEST_F(EveryLight, FoilsSeeASunAsAFarDisk) {
  constexpr double kFar = 400, kAngle = 24;
  const glm::dvec3 direction = glm::normalize(glm::dvec3(0.2, 1, -0.1));
  const auto stage_of = [&](const scenes::LightShape& shape) {
    scenes::Scene scene = floor_under(shaped(shape));
    scene.objects[0].casts_shadow = false;
    add_quad(scene, {0.2, 0.6, 0.1}, {0.5, 0.05, 0}, {0, 0, -0.5}).receives_shadow = false;
    return on_the_floor(scene, 24, 16);
  };
  const Stage sun = stage_of(scenes::Sun{-direction, kAngle}),
              disk = stage_of(scenes::Disk{kFar * direction, -direction, kFar * std::tan(glm::radians(kAngle / 2))});
  for (const Entry& entry : foils("256")) {
    const Masks of_sun = run_entry(entry, sun), of_disk = run_entry(entry, disk);
    const double off = error(of_sun, of_disk);
    fmt::print("sun, {}: {:.4f} from a far disk\n", entry.name, off);
    // arvo floods the picture, which is coarse here.
    EXPECT_LT(off, entry.name == "arvo" ? 0.08 : 0.02) << entry.name;
    EXPECT_GT(std::ranges::count_if(of_sun.visibility, [](float v) { return v > 0.1F && v < 0.9F; }), 5) << entry.name;
    EXPECT_GT(std::ranges::count_if(of_sun.visibility, [](float v) { return v < 0.1F; }), 10) << entry.name;
  }
}

// SunSpace promises that a ray to the sun becomes a segment to the disk's point, that planes stay planes, and that what
// is linear over a triangle is again linear after weighting.
TEST_F(EveryLight, SunSpaceTakesRaysToSegments) {
  scenes::Scene scene = floor_under(shaped(scenes::Sun{{0.3, -1, -0.45}, 12}));
  Leaf().add_to(scene);
  const Stage stage = on_the_floor(scene, 4, 16);
  const maps::SunSpace space(stage.floats, stage.light);
  EXPECT_NEAR(space.light().radius / -static_cast<double>(space.light().center.z), std::tan(glm::radians(6.0)), 1e-6);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> within(-1.2, 1.2), along(0.1, 1.5), share(0, 1);
  const auto mapped = [&](const glm::dvec3& p, const glm::dvec3& n) {
    visibility::ViewSamples one;
    one.width = one.height = 1;
    one.triangle = {0};
    one.p = {glm::vec3(p)};
    one.n = {glm::vec3(n)};
    const visibility::ViewSamples to = space.mapped(one);
    return std::pair(glm::dvec3(to.p[0]), glm::dvec3(to.n[0]));
  };
  for (int i = 0; i < 200; ++i) {
    const glm::dvec3 p(within(random), within(random), within(random)),
        n = glm::normalize(glm::dvec3(within(random), 2, within(random)));
    const std::size_t j = static_cast<std::size_t>(i) % stage.light.points.size();
    const auto [from, normal] = mapped(p, n);
    const glm::dvec3 q = mapped(p + along(random) * glm::dvec3(stage.light.points[j]), n).first,
                     to(space.light().points[j]);
    const double t = glm::dot(q - from, to - from) / glm::dot(to - from, to - from);
    EXPECT_GT(t, 0);
    EXPECT_LT(t, 1);
    EXPECT_LT(glm::length(q - from - t * (to - from)), 4e-6);
    const glm::dvec3 aside = glm::normalize(glm::cross(n, glm::dvec3(0.3, 0.1, 1)));
    EXPECT_NEAR(glm::dot(normal, mapped(p + 0.5 * aside, n).first - from), 0, 2e-6);
    // A point above the horizon in one space is above it in the other.
    EXPECT_EQ(glm::dot(n, glm::dvec3(stage.light.points[j])) > 0, glm::dot(normal, to - from) > 0);
  }
  // Barycentric weights over the leaf's first triangle.
  const visibility::SceneFloats& floats = space.scene();
  const visibility::Triangle corners = floats.triangles[2];
  for (int i = 0; i < 20; ++i) {
    const double a = share(random), b = (1 - a) * share(random), c = 1 - a - b;
    glm::dvec3 q(0);
    glm::dvec2 place(0);
    const std::array shares{a, b, c};
    for (std::size_t k = 0; k < 3; ++k) {
      q += shares[k] * glm::dvec3(stage.floats.positions[corners[k]]);
      place += shares[k] * stage.floats.alphas.places[corners[k]];
    }
    const glm::dvec3 to = mapped(q, {0, 1, 0}).first, x(floats.positions[corners[0]]), y(floats.positions[corners[1]]),
                     z(floats.positions[corners[2]]), m = glm::cross(y - x, z - x);
    const std::array there{glm::dot(glm::cross(y - to, z - to), m) / glm::dot(m, m),
                           glm::dot(glm::cross(z - to, x - to), m) / glm::dot(m, m),
                           glm::dot(glm::cross(x - to, y - to), m) / glm::dot(m, m)};
    glm::dvec3 weighted(0);
    for (std::size_t k = 0; k < 3; ++k) {
      const double weight = floats.alphas.weights[corners[k]];
      weighted += there[k] * glm::dvec3(weight * floats.alphas.places[corners[k]], weight);
    }
    EXPECT_LT(glm::length(glm::dvec2(weighted) / weighted.z - place), 1e-5);
  }
}

// Checks the figures that lamp_disks.hpp states, over evenly spread directions, and that each point is in the beam of
// its disk.
TEST_F(EveryLight, LampDisksFaceWhatTheyLight) {
  scenes::Scene scene = floor_under(shaped(scenes::Sphere{{0, 2, 0}, 0.3}));
  const Stage stage = on_the_floor(scene, 4);
  const maps::LampDisks lamp(stage.light);
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  double farthest = 0, narrower = 0;
  constexpr int kDirections = 20000;
  std::vector<visibility::Light> disks;
  for (std::uint32_t i = 0; i < maps::LampDisks::kCount; ++i) disks.push_back(lamp.disk(i));
  for (int i = 0; i < kDirections; ++i) {
    const glm::dvec3 direction = glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
    const visibility::Light& disk = disks[lamp.number_of(stage.light.center + glm::vec3(2.0 * direction))];
    const glm::dvec3 u = glm::dvec3(disk.center_u) - glm::dvec3(disk.center),
                     v = glm::dvec3(disk.center_v) - glm::dvec3(disk.center);
    const double cosine = glm::dot(glm::normalize(glm::cross(u, v)), direction);
    farthest = std::max(farthest, glm::degrees(std::acos(cosine)));
    narrower += (1 - cosine) / kDirections;
    EXPECT_NEAR(glm::length(u), 0.3, 1e-6);
    const visibility::Light::Beam& beam = *disk.beam;
    const glm::dvec2 at =
        glm::dvec2(glm::dot(direction, beam.a), glm::dot(direction, beam.b)) / glm::dot(direction, beam.w);
    EXPECT_TRUE(at.x > beam.lower.x - 1e-6 && at.x < beam.upper.x + 1e-6 && at.y > beam.lower.y - 1e-6 &&
                at.y < beam.upper.y + 1e-6);
  }
  fmt::print("lamp disks: up to {:.2f} degrees off, on average {:.4f} narrower\n", farthest, narrower);
  EXPECT_LT(farthest, 22);
  EXPECT_LT(1 - std::cos(glm::radians(farthest)), 0.07);
  EXPECT_LT(narrower, 0.02);
}

/// A spherical lamp above a floor that surrounds it, and a disk of its size: a method's error is about the same for
/// both.
class Balls : public EveryLight {
 protected:
  static Stage stage_of(const scenes::LightShape& shape) {
    scenes::Scene scene = floor_under(shaped(shape));
    add_quad(scene, {0.2, 0.7, 0.1}, {0.4, 0.05, 0}, {0, 0, -0.4});
    return on_the_floor(scene, 20, 64);
  }
  static void expect_disks(const std::vector<Entry>& entries) {
    const Stage ball = stage_of(scenes::Sphere{{0, 2, 0}, 0.25}),
                disk = stage_of(scenes::Disk{{0, 2, 0}, {0, -1, 0}, 0.25});
    const Masks of_ball = exact(ball), of_disk = exact(disk);
    for (const Entry& entry : entries) {
      const Masks found = run_entry(entry, ball);
      const double off = error(found, of_ball), as_disk = error(run_entry(entry, disk), of_disk);
      fmt::print("sphere {}: {:.4f}, disk {:.4f}\n", entry.name, off, as_disk);
      // This bound is wider for windows of a fixed number of texels, and for slices parallel to a disk that faces
      // sideways.
      const bool by_map = entry.name == "pcf" || entry.name == "occlusion-textures";
      EXPECT_LT(off, (by_map ? 2 : 1.3) * as_disk + 0.008) << entry.name;
      const Masks in_tiles = run_entry(entry, ball, 7);
      EXPECT_EQ(in_tiles.visibility, found.visibility);
      EXPECT_EQ(in_tiles.words, found.words);
    }
  }
};

TEST_F(Balls, AreAsGoodAsDisks) {
  expect_disks(some_methods("128", {"pcss", "bitmask"}));
}

TEST_F(Balls, AreAsGoodAsDisksInFoils) {
  std::vector<Entry> entries = foils("128");
  const auto knows_none = [](const Entry& one) { return !one.given.spheres; };
  const Entry arvo = *std::ranges::find_if(entries, knows_none);
  std::erase_if(entries, knows_none);
  expect_disks(entries);
  EXPECT_THROW(run_entry(arvo, stage_of(scenes::Sphere{{0, 2, 0}, 0.25})), InputError);
}

// All view samples are in one of the lamp's pyramids: its disk's maps are made once, however many tiles are evaluated,
// and the counters show it.
TEST_F(Balls, ADiskIsMadeOnce) {
  scenes::Scene scene = floor_under(shaped(scenes::Sphere{{0, 2, 0}, 0.25}));
  add_quad(scene, {0.2, 0.7, 0.1}, {0.4, 0.05, 0}, {0, 0, -0.4});
  const Stage ball(scene, 6, 6, light_samples(16), over_floor(6, 6, 0.9, 0.04));
  const maps::LampDisks lamp(ball.light);
  for (const glm::vec3& p : ball.samples.p) ASSERT_EQ(lamp.number_of(p), lamp.number_of(ball.samples.p.front()));
  ASSERT_NE(lamp.number_of(ball.samples.p.front()), 0U) << "the disk that is there before anything is asked";
  const auto method = maps::for_every_light(maps::make_pcss(device(), {{"size", "64"}}));
  method->prepare_mesh(ball.floats);
  for (int light = 0; light < 2; ++light) {
    method->prepare_light(ball.light);
    method->prepare_view(ball.samples);
    std::vector<float> all, rows;
    for (const std::uint32_t count : {6U, 1U}) {
      for (std::uint32_t row = 0; row < 6; row += count) {
        method->evaluate({row, count});
        std::vector<float> found(std::size_t{6} * count);
        method->read_visibility(found);
        (count == 6 ? all : rows).insert((count == 6 ? all : rows).end(), found.begin(), found.end());
      }
    }
    EXPECT_EQ(all, rows);
    EXPECT_EQ(method->counters().at("lampDisks"), 1U);
    EXPECT_EQ(method->counters().at("maps"), 1U);
  }
}

TEST_F(Balls, AreAsGoodAsDisksInEveryMethodFull) {
  std::vector<Entry> entries = all_methods("128");
  std::erase_if(entries, [](const Entry& one) { return one.name == "convolution"; });  // uses one plane for all casters
  expect_disks(entries);
}

// One instance with several lights in turn: earlier lights change nothing.
TEST_F(EveryLight, LightsFollowOneAnother) {
  const std::array shapes{scenes::LightShape(scenes::Sun{{-0.2, -1, 0.1}, 6}),
                          scenes::LightShape(scenes::Rectangle{{0, 4, 0}, {0.3, 0, 0}, {0, 0, 0.3}}),
                          scenes::LightShape(scenes::Sphere{{0, 2, 0}, 0.25}),
                          scenes::LightShape(scenes::Sun{{0.4, -1, 0.1}, 0}),
                          scenes::LightShape(scenes::Sun{{-0.2, -1, 0.1}, 17})};
  const auto method = maps::for_every_light(maps::make_pcss(device(), {{"size", "128"}}));
  std::vector<Stage> stages;
  for (const scenes::LightShape& shape : shapes) {
    scenes::Scene scene = floor_under(shaped(shape));
    Leaf().add_to(scene);
    stages.push_back(on_the_floor(scene, 12, 16));
  }
  const visibility::SceneFloats& floats = stages[0].floats;
  method->prepare_mesh(floats);
  for (const std::size_t i : {0U, 1U, 0U, 4U, 2U, 3U, 2U, 4U, 1U}) {
    method->prepare_light(stages[i].light);
    method->prepare_view(stages[i].samples);
    method->evaluate({0, 12});
    std::vector<float> found(stages[i].samples.size());
    method->read_visibility(found);
    EXPECT_EQ(found, run_entry({"pcss", maps::make_pcss, {{"size", "128"}}}, stages[i]).visibility) << i;
  }
}

}  // namespace
}  // namespace penumbra::tests::every_light
