// SPDX-License-Identifier: Apache-2.0
// Shapes put together from boxes and cylinders: fence, room, bars.

#include "mesh/shapes/shape_builder.hpp"

#include "base/assert.hpp"

#include <utility>

namespace penumbra::mesh {

using namespace builder;

ShapeSize shape_size(const FenceShape& fence) {
  const std::uint64_t boxes = std::uint64_t{fence.posts} + fence.rails;
  return checked({12 * boxes, 8 * boxes});
}

TriangleSoup make_fence(const FenceShape& fence) {
  PENUMBRA_ASSERT(fence.posts >= 2, "{}", fence.posts);
  TriangleSoup soup = soup_with_room(shape_size(fence));
  const double left = fence.base.x - fence.width / 2, half = fence.thickness / 2;
  for (std::uint32_t i = 0; i < fence.posts; ++i) {
    const double x = left + half + (fence.width - fence.thickness) * i / (fence.posts - 1);
    add_box(soup, {x - half, fence.base.y, fence.base.z},
            {x + half, fence.base.y + fence.height, fence.base.z + 2 * half});
  }
  for (std::uint32_t i = 0; i < fence.rails; ++i) {  // behind the posts, evenly spaced over the height
    const double y = fence.base.y + fence.height * (i + 1) / (fence.rails + 1);
    add_box(soup, {left, y - half, fence.base.z - 2 * half}, {left + fence.width, y + half, fence.base.z});
  }
  return finish(std::move(soup));
}

ShapeSize shape_size(const RoomShape& room) {
  const std::uint64_t bars = std::uint64_t{room.vertical_bars} + room.horizontal_bars;
  return checked({44 + 12 * bars, 24 + 8 * bars});
}

TriangleSoup make_room(const RoomShape& room) {
  require_room(shape_size(room));
  if (room.window_width >= room.size.x || room.window_sill + room.window_height >= room.size.y) {
    throw InputError("the window ({} wide, {} high, sill at {}) does not fit into a wall {} wide and {} high",
                     room.window_width, room.window_height, room.window_sill, room.size.x, room.size.y);
  }
  TriangleSoup soup;
  const glm::dvec3 low = room.base - glm::dvec3(room.size.x / 2, 0, room.size.z / 2), high = low + room.size;
  const glm::dvec3 thickness(room.thickness);
  const double outside = low.z - room.thickness, inside = low.z;  // the two faces of the window's wall
  const double left = room.base.x - room.window_width / 2, right = left + room.window_width;
  const double sill = room.base.y + room.window_sill, lintel = sill + room.window_height;

  // Two nested boxes, the inner one inside out. Their sides at −Z are frames around the window, joined through the wall
  // by four jambs. Loops are in the order of kBoxSides.back().
  const std::uint32_t outer = add_box_corners(soup, low - thickness, high + thickness);
  const std::uint32_t inner = add_box_corners(soup, low, high);
  const auto add_window_loop = [&](double z) {
    const std::uint32_t first = add_vertex(soup, {left, sill, z});
    add_vertex(soup, {left, lintel, z});
    add_vertex(soup, {right, lintel, z});
    add_vertex(soup, {right, sill, z});
    return first;
  };
  const std::uint32_t outer_window = add_window_loop(outside), inner_window = add_window_loop(inside);
  for (unsigned side = 0; side < 5; ++side) {
    const auto& [a, b, c, d] = kBoxSides[side];
    add_quad(soup, outer + a, outer + b, outer + c, outer + d);
    add_quad(soup, inner + d, inner + c, inner + b, inner + a);
  }
  for (unsigned i = 0; i < 4; ++i) {
    const unsigned next = (i + 1) % 4, corner = kBoxSides.back()[i], next_corner = kBoxSides.back()[next];
    add_quad(soup, outer + corner, outer + next_corner, outer_window + next, outer_window + i);
    add_quad(soup, outer_window + i, outer_window + next, inner_window + next, inner_window + i);
    add_quad(soup, inner_window + i, inner_window + next, inner + next_corner, inner + corner);
  }

  // Bars in the middle of the wall's thickness; their ends reach into the masonry so that no light passes. The
  // horizontal ones lie behind the vertical ones: no two share a face.
  const double middle = (outside + inside) / 2, half = room.bar / 2;
  for (std::uint32_t i = 0; i < room.vertical_bars; ++i) {
    const double x = left + room.window_width * (i + 1) / (room.vertical_bars + 1);
    add_box(soup, {x - half, sill - half, middle}, {x + half, lintel + half, middle + room.bar});
  }
  for (std::uint32_t i = 0; i < room.horizontal_bars; ++i) {
    const double y = sill + room.window_height * (i + 1) / (room.horizontal_bars + 1);
    add_box(soup, {left - half, y - half, middle - room.bar * 1.25},
            {right + half, y + half, middle - room.bar * 0.25});
  }
  return finish(std::move(soup));
}

ShapeSize shape_size(const BarsShape& bars) {
  const std::uint64_t segments = bars.segments, count = bars.count;
  return checked({4 * segments * count, (2 * segments + 2) * count});
}

TriangleSoup make_bars(const BarsShape& bars) {
  TriangleSoup soup = soup_with_room(shape_size(bars));
  TriangleSoup bar =
      make_cylinder({.center = glm::dvec3(0), .radius = bars.radius, .height = bars.length, .segments = bars.segments});
  for (glm::dvec3& position : bar.positions) {  // a quarter turn about X: Y becomes Z
    position = glm::dvec3(position.x, -position.z, position.y);
  }
  for (std::uint32_t i = 0; i < bars.count; ++i) {
    TriangleSoup placed = bar;
    const double x = bars.spacing * (i - (bars.count - 1) / 2.0);
    for (glm::dvec3& position : placed.positions) position += bars.center + glm::dvec3(x, 0, 0);
    append(soup, placed);
  }
  return finish(std::move(soup));
}

}  // namespace penumbra::mesh
