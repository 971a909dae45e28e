// SPDX-License-Identifier: Apache-2.0
// Numbers of binary PLY bodies, of either byte order. Usual layouts (three coordinates of one type, lists of 32-bit
// corners) are taken in bulk; all else is left to number().

#include "import/ply_binary.hpp"

#include <algorithm>
#include <cmath>

namespace penumbra::import {

template <typename Number>
Number BinaryNumbers::take() {
  if (bytes_.size() < sizeof(Number)) fail("the file ends in the middle of an element; it is truncated");
  const auto value = load<Number>(bytes_.data(), swap_);
  bytes_.remove_prefix(sizeof(Number));
  return value;
}

double BinaryNumbers::number(PlyType type) {
  switch (type) {
    case PlyType::int8:
      return take<std::int8_t>();
    case PlyType::uint8:
      return take<std::uint8_t>();
    case PlyType::int16:
      return take<std::int16_t>();
    case PlyType::uint16:
      return take<std::uint16_t>();
    case PlyType::int32:
      return take<std::int32_t>();
    case PlyType::uint32:
      return take<std::uint32_t>();
    case PlyType::int64:
      return static_cast<double>(take<std::int64_t>());
    case PlyType::uint64:
      return static_cast<double>(take<std::uint64_t>());
    case PlyType::float32:
      return static_cast<double>(take<float>());
    default:
      return take<double>();
  }
}

std::int64_t BinaryNumbers::load_length(const char* from, PlyType type, bool swap) {
  switch (type) {
    case PlyType::int8:
      return load<std::int8_t>(from, swap);
    case PlyType::uint8:
      return load<std::uint8_t>(from, swap);
    case PlyType::int16:
      return load<std::int16_t>(from, swap);
    case PlyType::uint16:
      return load<std::uint16_t>(from, swap);
    case PlyType::int32:
      return load<std::int32_t>(from, swap);
    case PlyType::uint32:
      return load<std::uint32_t>(from, swap);
    case PlyType::int64:
    case PlyType::uint64:  // values that are too large become negative
      return load<std::int64_t>(from, swap);
    default:
      return -1;  // the header refuses these types
  }
}

template <typename Number>
std::uint64_t BinaryNumbers::take_places(std::array<std::size_t, 3> offsets, std::size_t stride, std::uint64_t most,
                                         std::vector<glm::dvec3>& positions) {
  most = std::min<std::uint64_t>(most, bytes_.size() / stride);
  std::uint64_t taken = 0;
  for (; taken < most; ++taken) {
    const char* const at = bytes_.data() + taken * stride;
    const auto coordinate = [&](std::size_t axis) {
      return static_cast<double>(load<Number>(at + offsets[axis], swap_));
    };
    const glm::dvec3 p(coordinate(0), coordinate(1), coordinate(2));
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) break;
    positions.push_back(p);
  }
  bytes_.remove_prefix(taken * stride);
  return taken;
}

std::uint64_t BinaryNumbers::take_vertices(const PlyElement& element, std::array<std::size_t, 3> axes,
                                           std::uint64_t most, std::vector<glm::dvec3>& positions) {
  std::array<std::size_t, 3> offsets{};
  std::size_t stride = 0;
  for (std::size_t i = 0; i < element.properties.size(); ++i) {
    if (element.properties[i].is_list) return 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (axes[axis] == i) offsets[axis] = stride;
    }
    stride += size_of(element.properties[i].type);
  }
  const PlyType type = element.properties[axes[0]].type;
  if (element.properties[axes[1]].type != type || element.properties[axes[2]].type != type) return 0;
  if (type == PlyType::float32) return take_places<float>(offsets, stride, most, positions);
  if (type == PlyType::float64) return take_places<double>(offsets, stride, most, positions);
  return 0;
}

}  // namespace penumbra::import
