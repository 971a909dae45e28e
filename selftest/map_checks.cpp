// SPDX-License-Identifier: Apache-2.0
// Compares products of maps with their twins.

#include "selftest/map_checks.hpp"

#include "maps/host/map_fit.hpp"
#include "maps/products/nearest_caster.hpp"
#include "maps/products/nearest_ids.hpp"
#include "maps/products/slices.hpp"
#include "maps/products/summed_areas.hpp"
#include "selftest/raster_twin.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

namespace penumbra::selftest {
namespace {

/// Twin of NearestCaster.
std::array<float, 2> nearest_heights(const CentreMaps& maps, std::span<const float> depths) {
  std::array<float, 2> nearest{};
  nearest.fill(std::numeric_limits<float>::infinity());
  const maps::gpu::LightView& view = maps.fitted.views.front();
  for (std::size_t i = 0; i < depths.size(); ++i) {
    if (depths[i] == 1) continue;
    const auto row = static_cast<std::uint32_t>(i / maps.size), face = row / maps.size;
    const std::size_t side = face >= view.side[0].first_face + view.side[0].face_count ? 1 : 0;
    // Sideways faces of a hemicube have the height over the light's plane along their rows.
    const bool sideways = face != view.side[side].first_face;
    const float height = sideways ? (static_cast<float>(row % maps.size) + 0.5F) / static_cast<float>(maps.size) : 1.0F;
    nearest.at(side) = std::min(nearest.at(side), depths[i] * height * view.far);
  }
  return nearest;
}

/// Returns the nodes of a pyramid, each computed from its texels alone.
std::vector<glm::vec2> pyramid_nodes(const maps::gpu::PyramidHeader& header, std::uint32_t faces,
                                     std::span<const float> depths) {
  const std::uint32_t size = header.cells - 1;
  std::vector<glm::vec2> nodes;
  for (std::uint32_t level = 0; level <= header.top; ++level) {
    const std::uint32_t spacing = 1U << std::min(level, header.whole);
    for (std::uint32_t face = 0; face < faces; ++face) {
      for (std::uint32_t y = 0; y < header.cells; y += spacing) {
        for (std::uint32_t x = 0; x < header.cells; x += spacing) {
          glm::vec2 range(1, 0);
          // Cell x lies between the texels x − 1 and x; texels −1 and `size` are outside the map.
          const std::uint32_t width = 1U << level;
          for (std::uint32_t j = y; j <= std::min(y + width, header.cells); ++j) {
            for (std::uint32_t i = x; i <= std::min(x + width, header.cells); ++i) {
              const bool inside = i > 0 && j > 0 && i <= size && j <= size;
              const float depth = inside ? depths[(std::size_t{face} * size + j - 1) * size + i - 1] : 1.0F;
              range = {std::min(range.x, depth), std::max(range.y, depth)};
            }
          }
          nodes.push_back(range);
        }
      }
    }
  }
  return nodes;
}

}  // namespace

Check check_nearest_caster(const render::Device& device, const Stage& stage, std::uint32_t size) {
  Check check{.pass = "nearest caster", .against = "its twin", .rule = "bit by bit"};
  const CentreMaps maps(device, stage, size);
  maps::NearestCaster product(device);
  render::Commands commands(device);
  product.record(commands, maps.set(stage));
  commands.submit();
  std::array<float, 2> found{};
  product.buffer().read<float>(found);
  const std::array<float, 2> expected = nearest_heights(maps, maps.read());
  for (std::size_t side = 0; side < 2; ++side) {
    check.same(found.at(side), expected.at(side),
               [&] { return fmt::format("side {}: {}, not {}", side, found.at(side), expected.at(side)); });
  }
  return check;
}

Check check_nearest_ids(const render::Device& device, const Stage& stage, std::uint32_t size,
                        maps::Rasteriser rasteriser) {
  const bool opengl = rasteriser == maps::Rasteriser::opengl;
  Check check{.pass = fmt::format("nearest ids ({})", opengl ? "OpenGL" : "Vulkan"),
              .against = "the triangles in double",
              .rule = "a triangle that may be the nearest there"};
  const std::uint32_t bits = opengl ? device.opengl().info().subpixel_bits : device.limits().subpixel_bits;
  const CentreMaps maps(device, stage, size, {0, 0}, {.rasteriser = rasteriser});
  maps::NearestIds product(device, rasteriser);
  render::Commands commands(device);
  product.record(commands, maps.set(stage));
  commands.submit();
  std::vector<std::uint32_t> found(maps.texel_count());
  product.buffer().read<std::uint32_t>(found);
  const std::vector<std::uint32_t> ranks = visibility::ranks(stage.floats);
  std::vector<glm::vec3> corners;
  std::vector<std::uint32_t> ids;
  for (std::uint32_t i = 0; i < stage.floats.triangles.size(); ++i) {
    if (stage.floats.casts_shadow[i] == 0 || stage.floats.emits[i] == stage.light.index) continue;
    ids.push_back(ranks[i]);
    for (const glm::vec3& corner : stage.floats.corners(i)) corners.push_back(corner);
  }
  const maps::gpu::LightView& view = maps.fitted.views.front();
  std::vector<Surface> surfaces;
  for (std::uint32_t face = 0; face < maps.fitted.faces; ++face) {
    const RasterTwin twin(maps::face_push(view, maps.basis, face), size, std::ldexp(1.0, -static_cast<int>(bits)),
                          corners);
    for (std::uint32_t i = 0; i < size * size; ++i) {
      twin.find(i % size, i / size, surfaces);
      double limit = std::numeric_limits<double>::infinity();  // upper bound of the nearest depth
      for (const Surface& surface : surfaces) {
        if (surface.sure) limit = std::min(limit, surface.high);
      }
      // Surfaces within 2⁻²⁰ count as one; the product adds another rounding.
      limit *= 1 + 0x1p-20 + 0x1p-22;
      const std::uint32_t id = found[std::size_t{face} * size * size + i];
      const auto may_be = [&](const Surface& s) { return s.low <= limit && ids[s.triangle] == id; };
      const bool none = std::isinf(limit);
      ++check.compared;
      if (id == maps::gpu::kNoId ? none : std::ranges::any_of(surfaces, may_be)) continue;
      ++check.differing;
      check.fail([&] {
        return fmt::format("face {}, texel {}, {}: {} of {} surfaces", face, i % size, i / size, id, surfaces.size());
      });
    }
  }
  return check;
}

std::vector<std::uint32_t> summed_areas(std::span<const std::uint32_t> image, std::uint32_t size) {
  std::vector<std::uint32_t> sums(image.size());
  for (std::uint32_t y = 0; y < size; ++y) {
    std::uint32_t row = 0;
    for (std::uint32_t x = 0; x < size; ++x) {
      row += image[std::size_t{y} * size + x];
      sums[std::size_t{y} * size + x] = row + (y > 0 ? sums[std::size_t{y - 1} * size + x] : 0);
    }
  }
  return sums;
}

Check check_summed_areas(const render::Device& device, std::span<const std::uint32_t> images, std::uint32_t size) {
  Check check{.pass = "summed areas", .against = "its twin", .rule = "bit by bit"};
  const std::size_t texels = std::size_t{size} * size;
  const maps::SummedAreas pass(device);
  const render::Buffer buffer = render::make_buffer<std::uint32_t>(device, "images", images);
  render::Commands commands(device);
  pass.record(commands, buffer, static_cast<std::uint32_t>(images.size() / texels), size);
  commands.submit();
  std::vector<std::uint32_t> found(images.size());
  buffer.read<std::uint32_t>(found);
  for (std::size_t first = 0; first < images.size(); first += texels) {
    const std::vector<std::uint32_t> expected = summed_areas(images.subspan(first, texels), size);
    for (std::size_t i = 0; i < texels; ++i) {
      check.same(found[first + i], expected[i], [&] {
        return fmt::format("image {} of {}² texel {}: {}, not {}", first / texels, size, i, found[first + i],
                           expected[i]);
      });
    }
  }
  return check;
}

Check check_depth_pyramid(const render::Device& device, maps::PyramidKind kind, std::span<const float> depths,
                          std::uint32_t size, std::uint32_t faces) {
  Check check{.pass = "depth pyramids", .against = "its twin", .rule = "bit by bit"};
  const visibility::Light light{};
  const visibility::SceneFloats scene{};
  const maps::LightBasis basis{};
  const render::Buffer views(device, "views", sizeof(maps::gpu::LightView));
  const render::Buffer buffer = render::make_buffer<float>(device, "depths", depths);
  maps::DepthPyramid product(device, kind);
  render::Commands commands(device);
  product.record(commands, {views, buffer, faces, size, light, basis, scene});
  commands.submit();
  constexpr std::uint64_t kPlenty = std::uint64_t{1} << 40;
  const maps::gpu::PyramidHeader expected = maps::pyramid_header(kind, size, faces, kPlenty);
  maps::gpu::PyramidHeader header{};
  product.buffer().read<maps::gpu::PyramidHeader>(std::span(&header, 1));
  const auto name = [&] { return fmt::format("size {}, {} faces", size, faces); };
  check.same(header.whole, expected.whole, name);
  check.same(header.top, expected.top, name);
  check.same(header.cells, size + 1, name);
  for (std::uint32_t level = 0, first = 0; level <= expected.top; ++level) {
    check.same(header.first[level], first, name);
    const std::uint32_t side = (size >> std::min(level, expected.whole)) + 1;
    first += faces * side * side;
  }
  const std::vector<glm::vec2> twin = pyramid_nodes(expected, faces, depths);
  check.same<std::uint64_t>(maps::pyramid_bytes(expected, faces), twin.size() * sizeof(glm::vec2), name);
  std::vector<glm::vec2> nodes(twin.size());
  product.buffer().read<glm::vec2>(nodes, sizeof header);
  for (std::size_t i = 0; i < twin.size(); ++i) {
    check.same(nodes[i] == twin[i], true, [&] {
      return fmt::format("{}, node {}: {} … {}, not {} … {}", name(), i, nodes[i].x, nodes[i].y, twin[i].x, twin[i].y);
    });
  }
  return check;
}

Check check_slices(const render::Device& device, const Stage& stage, std::uint32_t size, std::uint32_t count,
                   maps::Rasteriser rasteriser) {
  const bool opengl = rasteriser == maps::Rasteriser::opengl;
  Check check{.pass = fmt::format("slices ({})", opengl ? "OpenGL" : "Vulkan"), .against = "the triangles in double"};
  const std::uint32_t bits = opengl ? device.opengl().info().subpixel_bits : device.limits().subpixel_bits;
  const double step = std::ldexp(1.0, -static_cast<int>(bits));
  check.rule = fmt::format("marked as covered, but where an edge is within {:g} texel of the centre", step);
  const CentreMaps maps(device, stage, size);
  maps::Slices product(device, {.count = count, .rasteriser = rasteriser});
  render::Commands commands(device);
  product.record(commands, maps.set(stage));
  commands.submit();
  std::vector<std::uint32_t> found(maps.texel_count());
  product.buffer().read<std::uint32_t>(found);
  const maps::gpu::SlicePlanes planes = maps::slice_planes(maps.set(stage), maps::SliceRule::equal, count);
  std::vector<glm::vec3> corners;
  for (std::uint32_t i = 0; i < stage.floats.triangles.size(); ++i) {
    if (stage.floats.casts_shadow[i] == 0 || stage.floats.emits[i] == stage.light.index) continue;
    for (const glm::vec3& corner : stage.floats.corners(i)) corners.push_back(corner);
  }
  const maps::gpu::LightView& view = maps.fitted.views.front();
  std::vector<Surface> surfaces;
  for (std::uint32_t face = 0; face < maps.fitted.faces; ++face) {
    const std::size_t side = face >= view.side[0].first_face + view.side[0].face_count ? 1 : 0;
    const bool sideways = face != view.side[side].first_face;
    const RasterTwin twin(maps::face_push(view, maps.basis, face), size, step, corners);
    const auto slice_of = [&](double height) -> std::uint32_t {
      for (std::uint32_t k = 0; k < count; ++k) {
        if (height <= static_cast<double>(planes.limit[side][k])) return 1U << k;
      }
      return 0;
    };
    for (std::uint32_t y = 0; y < size; ++y) {
      // Rows of a sideways face are heights over the light's plane at a depth of 1.
      const double along = static_cast<double>(view.far) * (sideways ? (y + 0.5) / size : 1.0);
      for (std::uint32_t x = 0; x < size; ++x) {
        twin.find(x, y, surfaces);
        std::uint32_t sure = 0, perhaps = 0;
        for (const Surface& surface : surfaces) {
          // Two more roundings of a float: the product, and the row.
          const std::uint32_t low = slice_of(surface.low * along * (1 - 0x1p-22)),
                              high = slice_of(surface.high * along * (1 + 0x1p-22));
          // Every slice from `low` to `high`; none beyond the last.
          perhaps |= low == 0 ? 0 : (high == 0 ? 0U : 2 * high) - low;
          if (surface.sure && low == high) sure |= low;
        }
        const std::uint32_t marked = found[(std::size_t{face} * size + y) * size + x];
        ++check.compared;
        if ((marked & ~perhaps) == 0 && (sure & ~marked) == 0) continue;
        ++check.differing;
        check.fail([&] {
          return fmt::format("face {}, texel {}, {}: {:#x}; surely {:#x}, perhaps {:#x}", face, x, y, marked, sure,
                             perhaps);
        });
      }
    }
  }
  return check;
}

}  // namespace penumbra::selftest
