// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/scene.hpp"

#include <nlohmann/json.hpp>

#include <array>
#include <cstdint>
#include <cstring>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

namespace penumbra::app {

/// A message of the 3D view, decoded as docs/view.md describes it.
struct SpaceAnswer {
  nlohmann::json header;
  std::map<std::string, std::vector<char>> bytes;

  explicit SpaceAnswer(const std::string& message) {
    std::uint32_t length = 0;
    std::memcpy(&length, message.data(), sizeof(length));
    if (length % 4 != 0) throw std::runtime_error("arrays do not begin at a multiple of four");
    header = nlohmann::json::parse(message.substr(4, length));
    std::size_t at = 4 + length;
    for (const auto& buffer : header["buffers"]) {
      const std::size_t size = 4 * buffer["count"].get<std::size_t>();
      bytes[buffer["name"]].assign(message.begin() + static_cast<std::ptrdiff_t>(at),
                                   message.begin() + static_cast<std::ptrdiff_t>(at + size));
      at += size;
    }
    if (at != message.size()) throw std::runtime_error("the message has other bytes than it says");
  }
  template <typename Number>
  [[nodiscard]] std::vector<Number> numbers(const std::string& name) const {
    std::vector<Number> made(bytes.at(name).size() / sizeof(Number));
    if (!made.empty()) std::memcpy(made.data(), bytes.at(name).data(), bytes.at(name).size());
    return made;
  }
  [[nodiscard]] std::vector<float> floats(const std::string& name) const { return numbers<float>(name); }
  [[nodiscard]] std::vector<std::uint32_t> indices(const std::string& name) const {
    return numbers<std::uint32_t>(name);
  }
};

/// A floor of 8 × 8 at height 0; on it, at height 1, a cube of size 1 around the y axis; above, at height 6, a square
/// light of 2 × 2.
inline scenes::Scene space_scene() {
  scenes::Scene scene;
  scene.soup.positions = {{-4, 0, -4}, {-4, 0, 4}, {4, 0, 4}, {4, 0, -4}};
  for (int i = 0; i < 8; ++i) scene.soup.positions.emplace_back(i & 1 ? 0.5 : -0.5, i & 2 ? 2 : 1, i & 4 ? 0.5 : -0.5);
  scene.soup.triangles = {{0, 1, 2}, {0, 2, 3}};
  for (const auto& [a, b, c, d] :
       {std::array{0U, 1U, 5U, 4U}, std::array{2U, 6U, 7U, 3U}, std::array{0U, 2U, 3U, 1U}, std::array{4U, 5U, 7U, 6U},
        std::array{0U, 4U, 6U, 2U}, std::array{1U, 3U, 7U, 5U}}) {
    scene.soup.triangles.push_back({a + 4, b + 4, c + 4});
    scene.soup.triangles.push_back({a + 4, c + 4, d + 4});
  }
  scene.soup.object.assign(14, 1);
  scene.soup.object[0] = scene.soup.object[1] = 0;
  scene.soup.source_face.assign(14, 0);
  scene.objects.resize(2);
  scene.objects[0].name = "floor";
  scene.objects[1].name = "block";
  scene.lights.resize(1);
  scene.lights[0].name = "key";
  scene.lights[0].shape = scenes::Rectangle{{0, 6, 0}, {1, 0, 0}, {0, 0, 1}};
  scene.cameras.resize(1);
  return scene;
}

}  // namespace penumbra::app
