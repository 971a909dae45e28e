// SPDX-License-Identifier: Apache-2.0
#pragma once

// Support for tests of glTF scenes: a scene of made-up bytes, read or refused.

#include "scenes/formats/gltf_reader.hpp"
#include "tests/unit/import/gltf_file.hpp"

#include <gmock/gmock.h>

#include <cstdint>
#include <string>
#include <vector>

namespace penumbra::scenes {

class GltfReader : public test::FileTest {
 protected:
  Scene read(test::Gltf& gltf) const { return read_gltf(write("scene.glb", gltf.glb())); }
  std::string refusal(test::Gltf& gltf) const {
    const auto path = write("scene.glb", gltf.glb());
    std::string message = test::input_error([&] { read_gltf(path); });
    EXPECT_THAT(message, ::testing::HasSubstr(path.string()));
    return message;
  }
  static std::vector<glm::dvec3> corners(const Scene& scene, std::size_t triangle) {
    std::vector<glm::dvec3> all;
    for (const std::uint32_t index : scene.soup.triangles[triangle]) all.push_back(scene.soup.positions[index]);
    return all;
  }
};

}  // namespace penumbra::scenes
