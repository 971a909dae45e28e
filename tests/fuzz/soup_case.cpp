// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/soup_case.hpp"

#include "base/error.hpp"
#include "tests/fuzz/bytes.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace penumbra::fuzz {
namespace {

using Corners = std::array<glm::dvec3, 3>;

class Reader {
 public:
  explicit Reader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  SoupCase read() {
    SoupCase made;
    range_ = 1 + static_cast<int>(below(4));
    const auto request = read_light(made.scene);
    add_object(made.scene, triangles(2 + below(14)));
    if (below(2) == 0) {
      add_object(made.scene, triangles(1 + below(3)));
      // This object casts no shadow, or is the light's body, which does not hide its own light.
      if (below(2) == 0) {
        made.scene.objects.back().casts_shadow = false;
      } else {
        made.scene.objects.back().emits = 0;
      }
    }
    made.floats = visibility::make_scene_floats(made.scene);
    made.light = visibility::make_light(made.scene, 0, made.floats.origin, request);
    read_samples(made);
    return made;
  }

 private:
  std::uint32_t below(std::uint32_t end) { return bytes_.take<std::uint8_t>() % end; }
  double lattice() { return static_cast<double>(below(static_cast<std::uint32_t>(2 * range_ + 1))) - range_; }
  glm::dvec3 lattice_point() {
    const double x = lattice(), y = lattice(), z = lattice();
    return {x, y, z};
  }

  glm::dvec3 point() {
    static constexpr std::array kSizes = {0x1p-10, 0x1p-24, 0x1p-40, 0x1p10};
    glm::dvec3 at = lattice_point();
    switch (below(10)) {
      case 0:
        return at * kSizes[below(kSizes.size())];
      case 1:  // an ulp off the lattice
        at[static_cast<int>(below(3))] += (below(2) == 0 ? 1 : -1) * 0x1p-22;
        return at;
      case 2:  // in the light's plane, on the light or outside it
        return center_ + 0.5 * (static_cast<double>(below(9)) - 4) * u_ +
               0.5 * (static_cast<double>(below(9)) - 4) * v_;
      case 3:
        return at / 3.0;
      default:
        return at;
    }
  }

  visibility::SampleRequest read_light(scenes::Scene& scene) {
    // Only three layouts, because shaders are compiled for each.
    static constexpr std::array<std::pair<std::uint32_t, std::uint32_t>, 3> kLayouts = {{{3, 3}, {1, 5}, {5, 4}}};
    center_ = lattice_point();
    if (below(3) != 0) center_.y += range_ + 1;
    u_ = 0.5 * lattice_point();
    v_ = 0.5 * lattice_point();
    if (glm::cross(u_, v_) == glm::dvec3(0)) {
      u_ = {1, 0, 0};
      v_ = {0, 0, 1};
    }
    if (below(8) == 0) {  // coordinates that are not exact in float
      u_ /= 3.0;
      v_ /= 7.0;
    }
    scene.lights.emplace_back();
    scene.lights[0].name = "light";
    scene.lights[0].two_sided = below(3) == 0;
    const bool disk = below(5) == 0;
    if (disk) {
      scene.lights[0].shape = scenes::Disk{center_, glm::cross(u_, v_), 0.5 + 0.5 * below(4)};
    } else {
      scene.lights[0].shape = scenes::Rectangle{center_, u_, v_};
    }
    const auto [rows, columns] = kLayouts[disk ? 0 : below(kLayouts.size())];
    const auto pattern = below(2) == 0 ? visibility::SamplePattern::grid : visibility::SamplePattern::rows;
    return {rows * columns, rows, columns, pattern, 0};
  }

  /// Returns triangles, each with some relation to an earlier one, or with none.
  std::vector<Corners> triangles(std::uint32_t count) {
    std::vector<Corners> soup;
    while (soup.size() < count) {
      Corners now{point(), point(), point()};
      const Corners old = soup.empty() ? now : soup[below(static_cast<std::uint32_t>(soup.size()))];
      switch (below(12)) {
        case 0:
          now = old;
          break;
        case 1:
          now = {old[1], old[0], old[2]};
          break;
        case 2:
        case 3:
          now = {old[1], old[0], now[2]};
          break;
        case 4:
          now = {old[1], old[2], old[1] + old[2] - old[0]};  // completes a parallelogram
          break;
        case 5:
          now[2] = below(2) == 0 ? now[0] : 2.0 * now[1] - now[0];  // without area
          break;
        case 6:
          now[2] = now[0] + now[2] * 0x1p-20;  // a needle
          break;
        case 7:
          for (glm::dvec3& corner : now)
            corner -= glm::dot(corner - center_, normal()) * normal();  // in the light's plane
          break;
        default:
          break;
      }
      soup.push_back(now);
    }
    return soup;
  }

  [[nodiscard]] glm::dvec3 normal() const { return glm::normalize(glm::cross(u_, v_)); }

  static void add_object(scenes::Scene& scene, const std::vector<Corners>& soup) {
    for (const Corners& corners : soup) {
      const auto first = static_cast<std::uint32_t>(scene.soup.positions.size());
      scene.soup.positions.insert(scene.soup.positions.end(), corners.begin(), corners.end());
      scene.soup.source_face.push_back(static_cast<std::uint32_t>(scene.soup.source_face.size()));
      scene.soup.triangles.push_back({first, first + 1, first + 2});
      scene.soup.object.push_back(static_cast<std::uint32_t>(scene.objects.size()));
    }
    scene.objects.emplace_back();
    scene.objects.back().name = "soup";
  }

  /// Reads view samples on corners, edges and inside: a + s (b − a) + t (c − a) with s and t multiples of ¼.
  void read_samples(SoupCase& made) {
    visibility::ViewSamples& samples = made.samples;
    samples.width = 8;
    samples.height = 2;
    for (std::uint32_t i = 0; i < samples.width * samples.height; ++i) {
      const std::uint32_t triangle = below(static_cast<std::uint32_t>(made.floats.triangles.size()));
      const std::uint32_t s = below(5), t = below(5 - s);
      const auto facing = static_cast<std::int8_t>(below(2) == 0 ? 1 : -1);
      const auto [a, b, c] = made.floats.corners(triangle);
      const glm::dvec3 ab = glm::dvec3(b) - glm::dvec3(a), ac = glm::dvec3(c) - glm::dvec3(a), n = glm::cross(ab, ac);
      const bool sees = made.floats.plane[triangle] != visibility::SceneFloats::kNoPlane && glm::length(n) > 0;
      samples.triangle.push_back(sees ? static_cast<std::int32_t>(triangle) : visibility::ViewSamples::kBackground);
      samples.p.push_back(sees ? glm::vec3(glm::dvec3(a) + 0.25 * s * ab + 0.25 * t * ac) + 0.0F : glm::vec3(0));
      samples.n.push_back(sees ? glm::vec3(glm::normalize(n) * static_cast<double>(facing)) + 0.0F : glm::vec3(0));
      samples.depth.push_back(sees ? 1.0F : 0.0F);
      samples.facing.push_back(sees ? facing : std::int8_t{0});
    }
  }

  Bytes bytes_;
  int range_ = 1;
  glm::dvec3 center_{0}, u_{1, 0, 0}, v_{0, 0, 1};
};

}  // namespace

std::optional<SoupCase> read_soup_case(std::span<const std::uint8_t> bytes) {
  try {
    return Reader(bytes).read();
  } catch (const InputError&) {
    return std::nullopt;  // a light without area in float32, say: no method was asked
  }
}

}  // namespace penumbra::fuzz
