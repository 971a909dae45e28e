// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <string>
#include <vector>

namespace tinygltf {
class Model;
}

namespace penumbra::import {

/// All components of all elements of an accessor, one element after the other.
struct Numbers {
  std::vector<double> values;
  std::size_t components = 1;
  [[nodiscard]] std::size_t count() const { return values.size() / components; }
};

/// Treatment of numbers that are not finite.
enum class NotFinite { refuse, keep };

/// Reads an accessor whose elements have one of these types (TINYGLTF_TYPE_…). Its components may have any type, and
/// may be normalised, strided, sparse, or all zero (no buffer view). `what` names the accessor in messages. Throws
/// InputError with the accessor's or the view's place if they do not fit the buffer, or (NotFinite::refuse) if one is
/// not finite.
Numbers read_numbers(const tinygltf::Model& model, int accessor, std::initializer_list<int> types, const char* what,
                     NotFinite not_finite = NotFinite::refuse);

/// Reads the vertices of a POSITION accessor, including those that are not finite: no triangle may use them.
std::vector<glm::dvec3> read_positions(const tinygltf::Model& model, int accessor);

/// Returns all bytes of a buffer view, owned by the model; `place` is the view's owner, for messages.
std::span<const unsigned char> read_view(const tinygltf::Model& model, int view, const std::string& place);

/// Reads an index accessor: unsigned integers of 1, 2 or 4 bytes.
std::vector<std::uint32_t> read_indices(const tinygltf::Model& model, int accessor);

}  // namespace penumbra::import
