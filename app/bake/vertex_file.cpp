// SPDX-License-Identifier: Apache-2.0
// Averages values at vertices and writes them as PLY.

#include "app/bake/vertex_file.hpp"

#include "base/atomic_file.hpp"
#include "base/image.hpp"
#include "session/pictures/picture_format.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <span>

namespace penumbra::app {
namespace {

static_assert(std::endian::native == std::endian::little, "the bytes are written as they lie in memory");

template <typename T>
void append(std::vector<std::byte>& bytes, const T& value) {
  const auto more = std::as_bytes(std::span(&value, 1));
  bytes.insert(bytes.end(), more.begin(), more.end());
}

std::string header_of(std::size_t vertices, std::size_t faces, const std::vector<VertexLight>& lights) {
  std::string text = fmt::format(
      "ply\nformat binary_little_endian 1.0\ncomment Penumbra: V and irradiance at vertices\nelement vertex {}\n"
      "property double x\nproperty double y\nproperty double z\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\n"
      "property float V\nproperty float irradiance_r\nproperty float irradiance_g\nproperty float irradiance_b\n",
      vertices);
  for (const VertexLight& light : lights) {
    std::string name = light.layer;
    std::ranges::replace(name, ' ', '_');
    for (const char* const part : {"V", "r", "g", "b"}) text += fmt::format("property float {}_{}\n", name, part);
  }
  return text + fmt::format("element face {}\nproperty list uchar int vertex_indices\nend_header\n", faces);
}

}  // namespace

std::vector<VertexLight> values_at_vertices(const VertexPoints& points, const session::RenderedFrame& frame,
                                            const session::Session& session) {
  std::vector<VertexLight> lights;
  const std::vector<std::string> layers = session::layer_names(session.lights);
  std::vector<double> weights(points.vertices.size());
  const auto each = [&](const auto& add) {
    for (std::size_t i = 0; i < points.weights.size(); ++i) {
      if (session.samples.triangle[i] == visibility::ViewSamples::kBackground) continue;  // a triangle without area
      add(points.triangles[i / 3][i % 3], i, points.weights[i]);
    }
  };
  each([&](std::size_t vertex, std::size_t, double weight) { weights[vertex] += weight; });
  for (std::size_t light = 0; light < layers.size(); ++light) {
    std::vector<double> visible(weights.size());
    std::vector<glm::dvec3> received(weights.size(), glm::dvec3(0));
    each([&](std::size_t vertex, std::size_t i, double weight) {
      visible[vertex] += weight * double{frame.visibility[light][i]};
      if (!frame.beauty[light].empty()) received[vertex] += weight * glm::dvec3(frame.beauty[light][i]);
    });
    VertexLight& values = lights.emplace_back(VertexLight{layers[light], {}, {}});
    for (std::size_t vertex = 0; vertex < weights.size(); ++vertex) {
      const double share = weights[vertex] > 0 ? 1 / weights[vertex] : 0;
      values.visibility.push_back(static_cast<float>(visible[vertex] * share));
      values.irradiance.emplace_back(received[vertex] * share);
    }
  }
  return lights;
}

void write_vertex_ply(const std::filesystem::path& file, const std::vector<glm::dvec3>& positions,
                      const VertexPoints& points, const std::vector<VertexLight>& lights) {
  std::vector<glm::vec3> sum(points.vertices.size(), glm::vec3(0));
  float brightest = 0;
  for (std::size_t i = 0; i < sum.size(); ++i) {
    for (const VertexLight& light : lights) sum[i] += light.irradiance[i];
    brightest = std::max({brightest, sum[i].x, sum[i].y, sum[i].z});
  }
  const float exposure = brightest > 0 ? 1 / brightest : 1;
  std::vector<std::byte> bytes;
  const std::string header = header_of(points.vertices.size(), points.triangles.size(), lights);
  for (const char c : header) append(bytes, c);
  for (std::size_t i = 0; i < sum.size(); ++i) {
    const glm::dvec3& p = positions[points.vertices[i]];
    for (const double x : {p.x, p.y, p.z}) append(bytes, x);
    for (const float x : {sum[i].x, sum[i].y, sum[i].z}) append(bytes, srgb_byte(x * exposure));
    append(bytes, lights.front().visibility[i]);
    for (const float x : {sum[i].x, sum[i].y, sum[i].z}) append(bytes, x);
    for (const VertexLight& light : lights) {
      append(bytes, light.visibility[i]);
      for (const float x : {light.irradiance[i].x, light.irradiance[i].y, light.irradiance[i].z}) append(bytes, x);
    }
  }
  for (const mesh::Triangle& triangle : points.triangles) {
    append(bytes, std::uint8_t{3});
    for (const std::uint32_t vertex : triangle) append(bytes, static_cast<std::int32_t>(vertex));
  }
  write_file_atomically(file, std::span<const std::byte>(bytes));
}

}  // namespace penumbra::app
