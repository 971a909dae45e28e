// SPDX-License-Identifier: Apache-2.0
// Shadow volumes compared with the exact count: at every pixel, the number of triangles that the open segment from p to
// the light's centre meets, each triangle tested separately with exact predicates.

#include "tests/agreement/differences.hpp"
#include "tests/agreement/lattice.hpp"
#include "tests/unit/mesh/shuffled.hpp"
#include "tests/unit/shipped_scene.hpp"

#include "mesh/shapes/broken_meshes.hpp"
#include "volumes/soft/methods.hpp"
#include "volumes/raster/volume_count.hpp"

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <cmath>
#include <filesystem>

namespace penumbra::volumes {
namespace {

using visibility::SceneFloats;
using visibility::ViewSamples;
using Kind = VolumeCount::Kind;

struct Counted {
  std::vector<std::int32_t> counts;
  std::vector<Kind> kinds;
  VolumeCount::Totals totals;
  glm::vec3 center{0};
};

/// A scene in the form that methods get.
struct Picture {
  Picture(const scenes::Scene& scene, const render::Device& device, std::uint32_t width, std::uint32_t height,
          std::size_t camera = 0)
      : floats(visibility::make_scene_floats(scene)),
        light(visibility::make_light(scene, 0, floats.origin, {1, 0, 0, visibility::SamplePattern::grid, 0})),
        samples(render::VisibilityBuffer(device, floats)
                    .render(visibility::make_camera(scene.cameras.at(camera), floats.origin, width, height))) {}

  SceneFloats floats;
  visibility::Light light;
  ViewSamples samples;
};

/// Counts of a picture's pixels by outcome.
struct Tally {
  std::size_t counted = 0, boundary = 0, doubtful = 0, shadowed = 0;
  std::int32_t largest = 0;
  std::size_t wrong = 0;
  std::string first_wrong;
};

class HardVolume : public tests::DeviceTest {
 protected:
  static void SetUpTestSuite() {
    DeviceTest::SetUpTestSuite();
    beyond_ = std::make_unique<VolumeCount>(device(), CountVariant::z_fail);
    before_ = std::make_unique<VolumeCount>(device(), CountVariant::z_pass);
  }
  static void TearDownTestSuite() {
    beyond_.reset();
    before_.reset();
    DeviceTest::TearDownTestSuite();
  }

  static Counted run(const Picture& picture, CountVariant variant = CountVariant::z_fail, std::uint32_t rows = 0) {
    VolumeCount& volumes = variant == CountVariant::z_fail ? *beyond_ : *before_;
    volumes.prepare_mesh(picture.floats);
    volumes.prepare_light(picture.light);
    volumes.prepare_view(picture.samples);
    Counted result;
    rows = rows == 0 ? volumes.max_tile_rows() : rows;
    for (std::uint32_t row = 0; row < picture.samples.height; row += rows) {
      volumes.count({row, std::min(rows, picture.samples.height - row)});
      result.counts.insert(result.counts.end(), volumes.counts().begin(), volumes.counts().end());
      result.kinds.insert(result.kinds.end(), volumes.kinds().begin(), volumes.kinds().end());
    }
    result.totals = volumes.totals();
    result.center = volumes.center();
    return result;
  }

  /// Returns the hard count of a segment by an exact decision for each triangle.
  static std::int32_t exact_count(const Picture& picture, std::size_t pixel, const glm::vec3& l) {
    const auto carrier = static_cast<std::uint32_t>(picture.samples.triangle[pixel]);
    const glm::vec3& p = picture.samples.p[pixel];
    const glm::vec3 lower = glm::min(p, l), upper = glm::max(p, l);
    std::int32_t count = 0;
    for (std::uint32_t i = 0; i < picture.floats.triangles.size(); ++i) {
      const auto [a, b, c] = picture.floats.corners(i);
      const glm::vec3 low = glm::min(a, glm::min(b, c)), high = glm::max(a, glm::max(b, c));
      if (low.x > upper.x || low.y > upper.y || low.z > upper.z) continue;
      if (high.x < lower.x || high.y < lower.y || high.z < lower.z) continue;
      if (!visibility::may_occlude(picture.floats, picture.light, carrier, i)) continue;
      count += visibility::segment_meets_triangle(p, l, {a, b, c}, picture.light).meets ? 1 : 0;
    }
    return count;
  }

  static Kind exact_kind(const Picture& picture, std::size_t pixel, const glm::vec3& l) {
    if (picture.samples.triangle[pixel] == ViewSamples::kBackground) return Kind::lit;
    const auto carrier = static_cast<std::uint32_t>(picture.samples.triangle[pixel]);
    if (!visibility::is_receiver(picture.floats, picture.light, carrier)) return Kind::lit;
    const bool above = visibility::above_horizon(picture.floats.corners(carrier), picture.samples.facing[pixel], l);
    const bool in_front = visibility::in_front_of_light(picture.light, picture.samples.p[pixel]);
    return above && in_front ? Kind::counted : Kind::dark;
  }

  static std::vector<std::int32_t> exact_counts(const Picture& picture, const glm::vec3& l) {
    std::vector<std::int32_t> counts(picture.samples.size());
    tbb::parallel_for(std::size_t{0}, counts.size(), [&](std::size_t pixel) {
      if (exact_kind(picture, pixel, l) == Kind::counted) counts[pixel] = exact_count(picture, pixel, l);
    });
    return counts;
  }

  /// Returns whether a neighbour of the pixel has another count.
  static bool at_boundary(const std::vector<std::int32_t>& counts, const ViewSamples& samples, std::size_t pixel) {
    const std::size_t x = pixel % samples.width, y = pixel / samples.width;
    return (x > 0 && counts[pixel - 1] != counts[pixel]) ||
           (x + 1 < samples.width && counts[pixel + 1] != counts[pixel]) ||
           (y > 0 && counts[pixel - samples.width] != counts[pixel]) ||
           (y + 1 < samples.height && counts[pixel + samples.width] != counts[pixel]);
  }

  static Tally compare(const Picture& picture) {
    const Counted found = run(picture);
    const std::vector<std::int32_t> exact = exact_counts(picture, found.center);
    Tally tally;
    tally.doubtful = found.totals.doubtful_pixels;
    for (std::size_t pixel = 0; pixel < exact.size(); ++pixel) {
      tally.counted += found.kinds[pixel] == Kind::counted ? 1 : 0;
      tally.boundary += at_boundary(exact, picture.samples, pixel) ? 1 : 0;
      tally.shadowed += exact[pixel] > 0 ? 1 : 0;
      tally.largest = std::max(tally.largest, exact[pixel]);
      if (found.counts[pixel] == exact[pixel] && found.kinds[pixel] == exact_kind(picture, pixel, found.center))
        continue;
      if (tally.wrong++ > 0) continue;
      tally.first_wrong = fmt::format("pixel {}: counted {}, exact {}, p {}", pixel, found.counts[pixel], exact[pixel],
                                      tests::text_of(picture.samples.p[pixel]));
    }
    return tally;
  }

  /// Expects that no pixel differs, that there was something to decide, and that the rasterised faces decided it: they
  /// left at most 1 % (or another given share) of the pixels at a boundary to the host.
  static void expect_exact(const std::string& name, const Picture& picture, double most_on_host = 0.01) {
    const Tally tally = compare(picture);
    fmt::print("{}: {} pixels counted, {} in shadow, {} at a boundary, largest count {}; {} counted on the host\n",
               name, tally.counted, tally.shadowed, tally.boundary, tally.largest, tally.doubtful);
    EXPECT_EQ(tally.wrong, 0U) << name << ": " << tally.first_wrong;
    EXPECT_GT(tally.boundary, 0U) << name;
    EXPECT_LE(static_cast<double>(tally.doubtful), most_on_host * static_cast<double>(tally.boundary)) << name;
  }

 private:
  // Kept between pictures: making the passes costs more than a small picture.
  static inline std::unique_ptr<VolumeCount> beyond_, before_;
};

TEST_F(HardVolume, CountsAreExactOnShippedScenes) {
  for (const char* name :
       {"broken", "bunny", "contact", "fusion", "large-penumbra", "parallel-square", "room", "self-shadow", "thin"}) {
    expect_exact(name, Picture(tests::shipped_scene(name), device(), 56, 40));
  }
}

TEST_F(HardVolume, CountsAreExactOnShippedScenesFull) {
  for (const auto& entry : std::filesystem::directory_iterator(PENUMBRA_SCENES)) {
    const std::string name = entry.path().stem().string();
    if (entry.path().extension() != ".json" || name.ends_with(".schema")) continue;
    expect_exact(name, Picture(tests::shipped_scene(name), device(), 160, 120));
  }
}

TEST_F(HardVolume, CountsAreExactOnFlawedMeshes) {
  for (const char* defect : {"hole", "flipped-patch", "inside-out", "duplicate-face", "opposite-face", "t-junction",
                             "needle", "fin", "gap", "unmerged"}) {
    const scenes::Scene scene = tests::with_a_floor(mesh::make_broken_mesh({{defect}, 2, {0, 1, 0}, 1}).soup);
    expect_exact(defect, Picture(scene, device(), 56, 40));
  }
  for (std::uint32_t seed = 1; seed <= 3; ++seed) {
    const mesh::TriangleSoup soup = mesh::make_lattice_soup({32 * seed, 1 + seed % 4, seed, {0, 1.5, 0}, 1});
    expect_exact(fmt::format("soup {}", seed), Picture(tests::with_a_floor(soup), device(), 56, 40));
  }
}

TEST_F(HardVolume, CountsAreExactWhereEverythingCoincides) {
  std::size_t counted = 0, doubtful = 0;
  for (std::uint32_t seed = 1; seed <= 24; ++seed) {
    tests::LatticeSoup soup(seed, 2);
    visibility::SampleRequest request;
    const scenes::Scene scene = tests::lattice_scene(soup, request);
    for (std::size_t camera = 0; camera < scene.cameras.size(); ++camera) {
      const Tally tally = compare(Picture(scene, device(), 33, 25, camera));
      EXPECT_EQ(tally.wrong, 0U) << "seed " << seed << ", camera " << camera << ": " << tally.first_wrong;
      counted += tally.counted;
      doubtful += tally.doubtful;
    }
  }
  fmt::print("{} pixels counted, {} on the host\n", counted, doubtful);
  EXPECT_GT(counted, 1000U);
  EXPECT_GT(doubtful, 0U);  // otherwise this test has missed its purpose
}

/// The occluder's shadow on the floor is the square, scaled by two from the light's centre: a closed form.
TEST_F(HardVolume, ASquareThrowsASquare) {
  const Picture picture(tests::shipped_scene("parallel-square"), device(), 200, 150);
  const auto method = make_hard_volume(device(), {});
  method->prepare_mesh(picture.floats);
  method->prepare_light(picture.light);
  method->prepare_view(picture.samples);
  ASSERT_EQ(method->max_tile_rows(), picture.samples.height);
  method->evaluate({0, picture.samples.height});
  std::vector<float> visibility(picture.samples.size());
  method->read_visibility(visibility);
  std::size_t dark = 0;
  for (std::size_t i = 0; i < visibility.size(); ++i) {
    if (picture.samples.triangle[i] < 0 ||
        picture.floats.object[static_cast<std::size_t>(picture.samples.triangle[i])] != 0)
      continue;
    const glm::dvec3 p = glm::dvec3(picture.samples.p[i]) + picture.floats.origin;
    const double distance = std::max(std::abs(p.x), std::abs(p.z)) - 1;
    if (std::abs(distance) < 1e-6) continue;  // p is off the floor by rounding, at most 2⁻²⁴ · 4
    EXPECT_EQ(visibility[i], distance < 0 ? 0.0F : 1.0F) << "pixel " << i;
    dark += distance < 0 ? 1 : 0;
  }
  EXPECT_GT(dark, 1000U);
}

/// A floor, `layers` squares over it, and a camera between the lowest square and the floor.
scenes::Scene stack(int layers, const glm::dvec3& eye) {
  scenes::Scene scene;
  tests::add_object(scene, "floor", tests::quad({0, 0, 0}, {4, 0, 0}, {0, 0, -4}));
  for (int i = 0; i < layers; ++i) {
    tests::add_object(scene, "layer", tests::quad({0, 1 + i / 512.0, 0}, {0.5, 0, 0}, {0, 0, -0.5}));
  }
  scene.lights.push_back(tests::ceiling_light(4, 0.5));
  scene.cameras.push_back(tests::camera(eye, {0, 0, 0.25}, 70));
  return scene;
}

/// Volumes are searched in the part of the scene that a shifted lens shows.
TEST_F(HardVolume, AShiftedLens) {
  for (const glm::dvec2& shift : {glm::dvec2(0.35, -0.2), glm::dvec2(-0.5, 0.15)}) {
    scenes::Scene scene = stack(3, {2, 1.5, 2});
    const glm::dvec3 forward = glm::normalize(scene.cameras[0].target - scene.cameras[0].eye),
                     right = glm::normalize(glm::cross(forward, scene.cameras[0].up));
    const double height = 2 * std::tan(glm::radians(35.0));
    scene.cameras[0].shift = shift;
    // The camera turns the other way, so that the middle stays in sight.
    scene.cameras[0].target =
        scene.cameras[0].eye + forward - height * shift.x * right - height * shift.y * glm::cross(right, forward);
    const Tally tally = compare(Picture(scene, device(), 48, 36));
    EXPECT_EQ(tally.wrong, 0U) << tally.first_wrong;
    EXPECT_EQ(tally.largest, 3);
    EXPECT_GT(tally.shadowed, 50U);
  }
}

TEST_F(HardVolume, ACountOf256DoesNotWrap) {
  for (const int layers :
       {255, 256, 257, 600}) {  // 512 triangles in 256 layers; each segment meets one of the two in a layer
    const Picture picture(stack(layers, {2, 1.5, 2}), device(), 48, 36);
    const Tally tally = compare(picture);
    EXPECT_EQ(tally.wrong, 0U) << tally.first_wrong;
    EXPECT_EQ(tally.largest, layers);
  }
}

TEST_F(HardVolume, TheCameraMayBeInAVolume) {
  const Picture picture(stack(3, {0.1, 0.5, 0.2}), device(), 48, 36);
  const Counted beyond = run(picture), before = run(picture, CountVariant::z_pass);
  const std::vector<std::int32_t> exact = exact_counts(picture, beyond.center);
  EXPECT_EQ(beyond.counts, exact);
  // z-pass starts from 0 at the camera, which is inside three volumes: every count is too small by three.
  std::size_t counted = 0, in_shadow = 0, lit = 0;
  for (std::size_t pixel = 0; pixel < exact.size(); ++pixel) {
    if (beyond.kinds[pixel] != Kind::counted) continue;
    ++counted;
    EXPECT_EQ(before.counts[pixel], exact[pixel] - 3) << "pixel " << pixel;
    in_shadow += exact[pixel] > 0 && before.counts[pixel] == 0 ? 1 : 0;
    lit += exact[pixel] == 0 && before.counts[pixel] != 0 ? 1 : 0;
  }
  fmt::print("z-pass with the camera in shadow: of {} pixels {} lit that are dark, {} dark that are lit\n", counted,
             in_shadow, lit);
  EXPECT_GT(in_shadow, 100U);
  EXPECT_GT(lit, 100U);
}

/// A camera that looks along the light's direction sees the far ends of volumes: directions in which the shadow never
/// ends.
TEST_F(HardVolume, TheFarEndIsCounted) {
  const scenes::Scene broken = tests::with_a_floor(mesh::make_broken_mesh({{"hole", "fin"}, 2, {0, 1.5, 0}, 1}).soup);
  for (const glm::dvec3& eye : {glm::dvec3(0.5, 6, 0.5), glm::dvec3(0.3, 4, 0.8), glm::dvec3(1.5, 2.5, -0.5)}) {
    scenes::Scene scene = broken;
    scene.cameras[0] = tests::camera(eye, {0.1, 0, 0.05}, 80);
    scene.cameras[0].up = {0, 0, -1};
    const Picture picture(scene, device(), 56, 40);
    EXPECT_GT(run(picture).totals.far_ends_on_screen, 0U);
    expect_exact(fmt::format("from ({}, {}, {})", eye.x, eye.y, eye.z), picture);
  }
}

/// Meshes so close that p, rounded to float32, moves by part of a pixel and often across an edge of its triangle: the
/// carrier and triangles coplanar with it must still not be counted, and its neighbours must be counted exactly.
TEST_F(HardVolume, CloseUpsWhereRoundingMovesPoints) {
  for (const double cell : {1.6e-5, 4e-6}) {
    const glm::dvec3 middle(1.3, 0.7, -0.4);
    std::mt19937 random(11);
    constexpr int kCells = 24;
    std::vector<glm::dvec3> grid;
    for (int i = 0; i <= kCells; ++i) {
      for (int j = 0; j <= kCells; ++j) {
        grid.push_back(middle +
                       cell * glm::dvec3(i - kCells / 2, 0.5 * static_cast<double>(random() % 3), j - kCells / 2));
      }
    }
    std::vector<tests::Corners> bumps;
    for (std::size_t i = 0; i + kCells + 2 < grid.size(); ++i) {
      if (i % (kCells + 1) == kCells) continue;
      bumps.push_back({grid[i], grid[i + 1], grid[i + kCells + 2]});
      bumps.push_back({grid[i], grid[i + kCells + 1], grid[i + kCells + 2]});
    }
    scenes::Scene scene;
    tests::add_object(scene, "floor", tests::quad({0, 0, 0}, {2, 0, 0}, {0, 0, -2}));
    tests::add_object(scene, "bumps", bumps);
    scene.lights.push_back(tests::ceiling_light(2, 0.5));
    scene.cameras.push_back(tests::camera(middle + cell * glm::dvec3(3, 30, 8), middle, 40));
    expect_exact(fmt::format("cells of {}", cell), Picture(scene, device(), 96, 72), 2);
  }
}

TEST_F(HardVolume, ZPassIsExactWhereTheCameraIsLit) {
  for (const char* name : {"fusion", "contact", "thin"}) {
    const Picture picture(tests::shipped_scene(name), device(), 56, 40);
    const Counted beyond = run(picture), before = run(picture, CountVariant::z_pass);
    EXPECT_EQ(beyond.counts, before.counts) << name;
  }
}

TEST_F(HardVolume, FacesThroughTheEyeDoNoHarm) {
  // The eye is on a side face of the volumes, on an edge, and in a cap's plane.
  for (const glm::dvec3& eye :
       {glm::dvec3(0.625, 0.25, 0.25), glm::dvec3(0.5, 1, 0.25), glm::dvec3(2, 1, 2), glm::dvec3(0, 3.5, 0.125)}) {
    scenes::Scene scene = stack(2, eye);
    scene.cameras[0].up = {0.1, 1, 0.3};
    const Tally tally = compare(Picture(scene, device(), 40, 30));
    EXPECT_EQ(tally.wrong, 0U) << tally.first_wrong;
    EXPECT_GT(tally.counted, 100U);
  }
}

TEST_F(HardVolume, NeitherOrderNorWindingNorTilesChangeAByte) {
  scenes::Scene scene = tests::with_a_floor(mesh::make_broken_mesh({{"fin", "hole"}, 3, {0, 1, 0}, 1}).soup);
  const Counted first = run(Picture(scene, device(), 64, 48));
  const Counted tiled = run(Picture(scene, device(), 64, 48), CountVariant::z_fail, 7);
  EXPECT_EQ(first.counts, tiled.counts);
  std::mt19937 random(7);
  for (int round = 0; round < 3; ++round) {
    tests::shuffle_order(scene.soup, random);
    tests::shuffle_corners(scene.soup, random);
    const Counted other = run(Picture(scene, device(), 64, 48));
    EXPECT_EQ(first.counts, other.counts);
    EXPECT_EQ(first.kinds, other.kinds);
  }
}

TEST_F(HardVolume, DisksEllipsesAndPolygonsHaveACenterToo) {
  scenes::Scene scene = stack(2, {2, 1.5, 2});
  scene.lights[0].shape = scenes::Disk{{0.25, 4, 0}, {0, -1, 0}, 0.5};
  const Picture disk(scene, device(), 48, 36);
  EXPECT_EQ(run(disk).center, disk.light.center);
  expect_exact("disk", disk);
  scene.lights[0].shape = scenes::Ellipse{{0.25, 4, 0}, {0.5, 0, 0}, {0, 0, 0.25}};
  const Picture ellipse(scene, device(), 48, 36);
  EXPECT_EQ(run(ellipse).counts, run(disk).counts);                            // they have the same centre
  scene.lights[0].shape = scenes::Polygon{{{0, 4, 0}, {3, 4, 0}, {0, 4, 3}}};  // centroid (1, 4, 1)
  const Picture polygon(scene, device(), 48, 36);
  // Both the result and the corners are rounded to float32: a few times 2⁻²⁴ · 4.
  EXPECT_NEAR(glm::length(glm::dvec3(run(polygon).center) + polygon.floats.origin - glm::dvec3(1, 4, 1)), 0, 1e-6);
  expect_exact("polygon", polygon);
}

TEST_F(HardVolume, OptionsAndLightsThatItCannotDoAreRefused) {
  EXPECT_THROW(make_hard_volume(device(), {{"variant", "z"}}), UsageError);
  EXPECT_THROW(make_hard_volume(device(), {{"bias", "1"}}), UsageError);
  scenes::Scene scene = stack(1, {2, 1.5, 2});
  scene.lights[0].shape = scenes::Sphere{{0, 4, 0}, 0.5};
  const Picture picture(scene, device(), 8, 8);
  const auto method = make_hard_volume(device(), {{"variant", "z-pass"}});
  method->prepare_mesh(picture.floats);
  EXPECT_THROW(method->prepare_light(picture.light), InputError);
}

}  // namespace
}  // namespace penumbra::volumes
