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

namespace penumbra::scenes {

/// All components of all elements of an accessor, one after the other.
struct Numbers {
  std::vector<double> values;
  std::size_t components = 1;
  [[nodiscard]] std::size_t count() const { return values.size() / components; }
};

/// What becomes of numbers that are not finite.
enum class NotFinite { refuse, keep };

/// Elements of one of these types (TINYGLTF_TYPE_…), components of any type, normalized or not, strided, sparse, or all
/// zero (no buffer view); `what` they are, for messages. InputError with the accessor's or the view's place if they do
/// not fit the buffer, or (NotFinite::refuse) one is not finite.
Numbers read_numbers(const tinygltf::Model& model, int accessor, std::initializer_list<int> types, const char* what,
                     NotFinite not_finite = NotFinite::refuse);

/// A POSITION accessor's vertices, also those that are not finite: perhaps no triangle uses them.
std::vector<glm::dvec3> read_positions(const tinygltf::Model& model, int accessor);

/// All bytes of a buffer view; `place` says whose it is. They live in the model.
std::span<const unsigned char> read_view(const tinygltf::Model& model, int view, const std::string& place);

/// An index accessor's numbers: unsigned integers of 1, 2 or 4 bytes.
std::vector<std::uint32_t> read_indices(const tinygltf::Model& model, int accessor);

}  // namespace penumbra::scenes
