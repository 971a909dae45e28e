// SPDX-License-Identifier: Apache-2.0
#include "base/parallel.hpp"
#include "engines/vectors/clusters.hpp"
#include "visibility/scene_floats.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <cstddef>
#include <cstdint>

namespace penumbra::vectors {
namespace {

/// Makes triangles, a third of them needles: the edges from their first corner are parallel but for 2⁻³⁰.
visibility::SceneFloats some_needles(std::uint32_t count) {
  visibility::SceneFloats floats;
  for (std::uint32_t i = 0; i < count; ++i) {
    const auto x = static_cast<float>(i);
    const float aside = i % 3 == 0 ? 0x1p-30F : 1.0F;
    for (const glm::vec3& corner : {glm::vec3(x, 0, 0), glm::vec3(x + 1, 1, 0), glm::vec3(x + 1, 1, aside)})
      floats.positions.push_back(corner);
    floats.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return floats;
}

TEST(KnownNormals, OfNeedlesNoneIsKnown) {
  constexpr std::uint32_t kCount = 3000;
  const visibility::SceneFloats floats = some_needles(kCount);
  const KnownNormals normals(floats);
  std::atomic<std::uint32_t> wrong = 0;
  for (int turn = 0; turn < 2; ++turn) {  // the second round finds what the first stored, on all cores
    for_each_index(2 * std::size_t{kCount}, [&](std::size_t i) {
      const auto triangle = static_cast<std::uint32_t>(i % kCount);
      if (normals.is_known(triangle) != (triangle % 3 != 0)) ++wrong;
    });
  }
  EXPECT_EQ(wrong, 0);
}

}  // namespace
}  // namespace penumbra::vectors
