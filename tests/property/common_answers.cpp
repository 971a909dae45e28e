// SPDX-License-Identifier: Apache-2.0
// Tests answers for all points of a box against single rays in double: rays of clear directions meet nothing, those of
// blocked directions meet something, from points anywhere in the box.

#include "reference/common_answers.hpp"

#include "tests/unit/visibility/scenes.hpp"
#include "visibility/certain_meeting.hpp"
#include "visibility/float_meeting.hpp"

#include <gtest/gtest.h>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <random>

namespace penumbra::reference {
namespace {

using visibility::SceneFloats;

constexpr std::size_t kDirections = 64;
constexpr std::uint32_t kNowhere = 0xfffffffeU;  // number of a plane in which no triangle lies

/// Small triangles on a lattice, with a floor and, in most soups, a wall.
scenes::Scene lattice_room(std::mt19937& random) {
  std::uniform_int_distribution<int> place(-6, 6), step(-2, 2);
  scenes::Scene scene;
  tests::add_object(scene, "floor", tests::quad({0, -6, 0}, {8, 0, 0}, {0, 0, -8}));
  if (random() % 4 != 0) tests::add_object(scene, "wall", tests::quad({7, 0, 0}, {0, 8, 0}, {0, 0, 8}));
  std::vector<tests::Corners> soup;
  const std::size_t count = 1 + random() % 40;
  while (soup.size() < count) {
    const glm::dvec3 a(place(random), place(random), place(random));
    const auto near = [&] { return a + glm::dvec3(step(random), step(random), step(random)); };
    soup.push_back({a, near(), near()});
  }
  tests::add_object(scene, "soup", soup);
  return scene;
}

std::vector<glm::vec3> some_directions(std::mt19937& random) {
  std::uniform_int_distribution<int> step(-3, 3);  // many are parallel to axes, or pass through corners
  std::vector<glm::vec3> directions;
  while (directions.size() < kDirections) {
    const glm::vec3 direction(step(random), step(random), step(random));
    if (direction != glm::vec3(0)) directions.push_back(glm::normalize(direction));
  }
  return directions;
}

/// Certain outcomes of a ray: it meets a triangle outside the plane `own`, or it misses all of them. Both are false if
/// rounding leaves it open.
struct Ray {
  bool meets = false, misses = true;
};
Ray ray_of(const SceneFloats& floats, std::uint32_t own, const glm::vec3& p, const glm::vec3& direction) {
  Ray ray;
  for (std::uint32_t i = 0; i < floats.triangles.size(); ++i) {
    if (floats.casts_shadow[i] == 0 || floats.plane[i] == own) continue;
    const std::optional<bool> meets = visibility::ray_certainly_meets(p, direction, floats.corners(i));
    ray.meets = ray.meets || meets.value_or(false);
    ray.misses = ray.misses && !meets.value_or(true);
  }
  return ray;
}

class CommonAnswersProperty : public testing::TestWithParam<std::uint32_t> {};

TEST_P(CommonAnswersProperty, HoldForEveryPointOfTheBox) {
  std::mt19937 random(GetParam());
  const SceneFloats floats = visibility::make_scene_floats(lattice_room(random));
  const std::vector<glm::vec3> directions = some_directions(random);
  const CommonAnswers answers(floats, directions);
  std::uniform_real_distribution<float> real(0, 1);
  std::size_t clear_count = 0, blocked_count = 0, clear_missed = 0, rays_missed = 0;
  for (int box_number = 0; box_number < 40; ++box_number) {
    // Boxes on the floor, whose plane is then their own plane; some other boxes anywhere, as large as a triangle or a
    // point.
    const bool on_floor = box_number % 2 == 0;
    const float size = box_number % 8 == 3 ? 0 : 2 * real(random);
    const glm::vec3 floor(floats.corners(0)[0]);
    const std::uint32_t own = on_floor ? floats.plane[0] : kNowhere;
    visibility::Bounds box;
    box.lower = {12 * real(random) - 6, on_floor ? floor.y : 12 * real(random) - 6, 12 * real(random) - 6};
    box.upper = box.lower + glm::vec3(size, on_floor ? 0 : size * real(random), size);
    std::vector<std::uint32_t> clear(kDirections / 32, ~0U), blocked(kDirections / 32, 0);
    answers.keep_clear(box, own, clear);
    answers.add_blocked(box, blocked);
    for (std::size_t j = 0; j < kDirections; ++j) {
      const bool is_clear = ((clear[j / 32] >> (j % 32)) & 1U) != 0;
      const bool is_blocked = ((blocked[j / 32] >> (j % 32)) & 1U) != 0;
      ASSERT_FALSE(is_clear && is_blocked) << j;
      clear_count += is_clear ? 1 : 0;
      blocked_count += is_blocked ? 1 : 0;
      bool all_miss = true;
      for (int point = 0; point < 9; ++point) {
        glm::vec3 p;  // corners, and points in between
        for (int axis = 0; axis < 3; ++axis) {
          const float share = point < 8 ? static_cast<float>((point >> axis) & 1) : real(random);
          p[axis] = std::min(box.upper[axis], box.lower[axis] + share * (box.upper[axis] - box.lower[axis]));
        }
        const Ray ray = ray_of(floats, own, p, directions[j]);
        EXPECT_FALSE(is_clear && ray.meets) << "box " << box_number << ", direction " << j;
        // A box on the floor: the floor neither makes directions unclear nor blocks them.
        EXPECT_FALSE(is_blocked && !ray.meets) << "box " << box_number << ", direction " << j;
        all_miss = all_miss && ray.misses;
      }
      rays_missed += all_miss ? 1 : 0;
      clear_missed += all_miss && is_clear ? 1 : 0;
    }
  }
  EXPECT_GT(clear_count, 100U);
  EXPECT_GT(4 * clear_missed, rays_missed)
      << "of " << rays_missed << " directions that meet nothing, too few are found";
  if (floats.triangles.size() > 42) {
    EXPECT_GT(blocked_count, 10U);
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, CommonAnswersProperty, testing::Range(0U, 40U));

}  // namespace
}  // namespace penumbra::reference
