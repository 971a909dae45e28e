// SPDX-License-Identifier: Apache-2.0
// Checks, in 64 bits, every property of an accessor that refers to its buffer: tinygltf checks almost none.

#include "import/gltf/gltf_accessor.hpp"

#include "base/error.hpp"

#include <fmt/ranges.h>
#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <span>
#include <string>

namespace penumbra::import {
namespace {

/// Equally spaced elements inside a buffer, all in range.
struct ElementView {
  const unsigned char* first = nullptr;
  std::size_t stride = 0;
  [[nodiscard]] const unsigned char* at(std::size_t i) const { return first + i * stride; }
};

struct ElementLayout {
  std::size_t count = 0, bytes = 0;
};

/// Returns `count` elements from `offset` on in buffer view number `view`; `place` is the view's owner, for messages.
ElementView view_elements(const tinygltf::Model& model, const std::string& place, int view, std::size_t offset,
                          ElementLayout layout) {
  if (view < 0 || static_cast<std::size_t>(view) >= model.bufferViews.size()) {
    throw InputError("{}: bufferView {} does not exist; there are {}", place, view, model.bufferViews.size());
  }
  const tinygltf::BufferView& window = model.bufferViews[static_cast<std::size_t>(view)];
  if (window.buffer < 0 || static_cast<std::size_t>(window.buffer) >= model.buffers.size()) {
    throw InputError("/bufferViews/{}: buffer {} does not exist; there are {}", view, window.buffer,
                     model.buffers.size());
  }
  const auto& data = model.buffers[static_cast<std::size_t>(window.buffer)].data;
  if (window.byteOffset > data.size() || window.byteLength > data.size() - window.byteOffset) {
    throw InputError("/bufferViews/{}: bytes {} to {} lie outside its buffer of {} bytes", view, window.byteOffset,
                     window.byteOffset + window.byteLength, data.size());
  }
  const std::size_t stride = window.byteStride == 0 ? layout.bytes : window.byteStride;
  if (stride < layout.bytes) {
    throw InputError("/bufferViews/{}: byteStride {} is less than an element's {} bytes", view, stride, layout.bytes);
  }
  const bool fits = layout.count == 0 || (offset <= window.byteLength && layout.bytes <= window.byteLength - offset &&
                                          layout.count - 1 <= (window.byteLength - offset - layout.bytes) / stride);
  if (!fits) {
    throw InputError("{}: {} elements of {} bytes from byte {} on do not fit into bufferView {} of {} bytes", place,
                     layout.count, layout.bytes, offset, view, window.byteLength);
  }
  return {layout.count == 0 ? nullptr : data.data() + window.byteOffset + offset, stride};
}

template <typename T>
double load(const unsigned char* from, bool normalized) {
  T value;
  std::memcpy(&value, from, sizeof(T));
  if constexpr (std::is_integral_v<T>) {
    // Normalised integers (glTF 2.0, "Accessor data types"): c / 127 for signed bytes and similarly for other types,
    // never below −1.
    if (normalized)
      return std::max(static_cast<double>(value) / static_cast<double>(std::numeric_limits<T>::max()), -1.0);
  }
  return static_cast<double>(value);
}

double load_component(const unsigned char* from, int type, bool normalized) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return load<std::int8_t>(from, normalized);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return load<std::uint8_t>(from, normalized);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return load<std::int16_t>(from, normalized);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return load<std::uint16_t>(from, normalized);
    case TINYGLTF_COMPONENT_TYPE_INT:
      return load<std::int32_t>(from, normalized);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return load<std::uint32_t>(from, normalized);
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
      return load<float>(from, normalized);
    default:
      return load<double>(from, normalized);
  }
}

std::size_t component_bytes(const std::string& place, int type) {
  const int bytes = tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(type));
  if (bytes <= 0) throw InputError("{}: componentType {} is unknown", place, type);
  return static_cast<std::size_t>(bytes);
}

bool is_index_type(int type) {
  return type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE || type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
         type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
}

std::uint32_t load_index(const unsigned char* from, int type) {
  if (type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT) {
    std::uint32_t index = 0;
    std::memcpy(&index, from, sizeof index);
    return index;
  }
  return static_cast<std::uint32_t>(load_component(from, type, false));
}

/// Overwrites the elements that a sparse accessor lists. `store(i, bytes)` stores one at index i.
template <typename Store>
void apply_sparse(const tinygltf::Model& model, const std::string& place, const tinygltf::Accessor& accessor,
                  std::size_t element_bytes, Store store) {
  const auto& sparse = accessor.sparse;
  if (!sparse.isSparse) return;
  if (sparse.count < 0 || static_cast<std::size_t>(sparse.count) > accessor.count || sparse.indices.byteOffset < 0 ||
      sparse.values.byteOffset < 0) {
    throw InputError("{}/sparse: a count or offset is out of range (count {} of {})", place, sparse.count,
                     accessor.count);
  }
  if (!is_index_type(sparse.indices.componentType)) {
    throw InputError("{}/sparse/indices: componentType {}; expected 5121, 5123 or 5125", place,
                     sparse.indices.componentType);
  }
  const auto count = static_cast<std::size_t>(sparse.count);
  const ElementView places = view_elements(model, place + "/sparse/indices", sparse.indices.bufferView,
                                           static_cast<std::size_t>(sparse.indices.byteOffset),
                                           {count, component_bytes(place, sparse.indices.componentType)});
  const ElementView values = view_elements(model, place + "/sparse/values", sparse.values.bufferView,
                                           static_cast<std::size_t>(sparse.values.byteOffset), {count, element_bytes});
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t target = load_index(places.at(i), sparse.indices.componentType);
    if (target >= accessor.count) {
      throw InputError("{}/sparse/indices: it names element {} of {}", place, target, accessor.count);
    }
    store(target, values.at(i));
  }
}

std::string name_of_type(int type) {
  switch (type) {
    case TINYGLTF_TYPE_SCALAR:
      return "SCALAR";
    case TINYGLTF_TYPE_MAT4:
      return "MAT4";
    default:
      return fmt::format("VEC{}", tinygltf::GetNumComponentsInType(static_cast<unsigned>(type)));
  }
}

const tinygltf::Accessor& find_accessor(const tinygltf::Model& model, int number) {
  if (number < 0 || static_cast<std::size_t>(number) >= model.accessors.size()) {
    throw InputError("/accessors/{}: it does not exist; there are {}", number, model.accessors.size());
  }
  return model.accessors[static_cast<std::size_t>(number)];
}

/// Returns the number of components of all elements together; throws InputError if no memory holds them. Nothing else
/// limits the count of an accessor without a buffer view, and a product that overflows would allocate less memory than
/// its sparse entries then fill.
std::size_t number_count(const tinygltf::Accessor& accessor, std::size_t components, const std::string& place) {
  constexpr std::size_t kMost = std::numeric_limits<std::ptrdiff_t>::max() / sizeof(double);
  if (accessor.count > kMost / components) {
    throw InputError("{}/count: {} elements; no memory holds more than {}", place, accessor.count, kMost / components);
  }
  return accessor.count * components;
}

}  // namespace

Numbers read_numbers(const tinygltf::Model& model, int number, std::initializer_list<int> types, const char* what,
                     NotFinite not_finite) {
  const tinygltf::Accessor& accessor = find_accessor(model, number);
  const std::string place = fmt::format("/accessors/{}", number);
  if (std::ranges::find(types, accessor.type) == types.end()) {
    std::string wanted;
    for (const int type : types) wanted += (wanted.empty() ? "" : " or ") + name_of_type(type);
    throw InputError("{}: {} must be of type {}", place, what, wanted);
  }
  const std::size_t bytes = component_bytes(place, accessor.componentType);
  Numbers numbers;
  numbers.components = static_cast<std::size_t>(tinygltf::GetNumComponentsInType(static_cast<unsigned>(accessor.type)));
  const std::size_t element_bytes = numbers.components * bytes;
  const auto store = [&](std::size_t i, const unsigned char* from) {
    for (std::size_t c = 0; c < numbers.components; ++c) {
      numbers.values[i * numbers.components + c] =
          load_component(from + c * bytes, accessor.componentType, accessor.normalized);
    }
  };
  if (accessor.bufferView < 0) {
    numbers.values.resize(number_count(accessor, numbers.components, place), 0.0);
  } else {
    // The view comes first: only a count that fits the buffer may be allocated.
    const ElementView view =
        view_elements(model, place, accessor.bufferView, accessor.byteOffset, {accessor.count, element_bytes});
    numbers.values.resize(number_count(accessor, numbers.components, place));
    if (accessor.componentType == TINYGLTF_COMPONENT_TYPE_FLOAT) {  // the usual case
      double* to = numbers.values.data();
      for (std::size_t i = 0; i < accessor.count; ++i) {
        const unsigned char* const from = view.at(i);
        for (std::size_t c = 0; c < numbers.components; ++c) *to++ = load<float>(from + c * sizeof(float), false);
      }
    } else {
      for (std::size_t i = 0; i < accessor.count; ++i) store(i, view.at(i));
    }
  }
  apply_sparse(model, place, accessor, element_bytes, store);
  for (std::size_t i = 0; not_finite == NotFinite::refuse && i < numbers.values.size(); ++i) {
    if (std::isfinite(numbers.values[i])) continue;
    const std::size_t element = i / numbers.components;
    const auto all = std::span(numbers.values).subspan(element * numbers.components, numbers.components);
    throw InputError("{}: {}: number {} is not finite: ({})", place, what, element, fmt::join(all, ", "));
  }
  return numbers;
}

std::vector<glm::dvec3> read_positions(const tinygltf::Model& model, int number) {
  const Numbers numbers = read_numbers(model, number, {TINYGLTF_TYPE_VEC3}, "positions", NotFinite::keep);
  std::vector<glm::dvec3> positions(numbers.count());
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const double* from = &numbers.values[3 * i];
    positions[i] = {from[0], from[1], from[2]};
  }
  return positions;
}

std::span<const unsigned char> read_view(const tinygltf::Model& model, int view, const std::string& place) {
  if (view < 0 || static_cast<std::size_t>(view) >= model.bufferViews.size())
    throw InputError("{}: bufferView {} does not exist; there are {}", place, view, model.bufferViews.size());
  const std::size_t size = model.bufferViews[static_cast<std::size_t>(view)].byteLength;
  return {view_elements(model, place, view, 0, {1, size}).first, size};
}

std::vector<std::uint32_t> read_indices(const tinygltf::Model& model, int number) {
  const tinygltf::Accessor& accessor = find_accessor(model, number);
  const std::string place = fmt::format("/accessors/{}", number);
  if (accessor.type != TINYGLTF_TYPE_SCALAR) throw InputError("{}: indices must be of type SCALAR", place);
  if (!is_index_type(accessor.componentType)) {
    throw InputError("{}: indices have componentType {}; expected 5121, 5123 or 5125", place, accessor.componentType);
  }
  const std::size_t bytes = component_bytes(place, accessor.componentType);
  std::vector<std::uint32_t> indices;
  if (accessor.bufferView < 0) {
    indices.resize(number_count(accessor, 1, place));
  } else {
    const ElementView view =
        view_elements(model, place, accessor.bufferView, accessor.byteOffset, {accessor.count, bytes});
    indices.resize(accessor.count);
    for (std::size_t i = 0; i < accessor.count; ++i) indices[i] = load_index(view.at(i), accessor.componentType);
  }
  apply_sparse(model, place, accessor, bytes, [&](std::size_t i, const unsigned char* from) {
    indices[i] = load_index(from, accessor.componentType);
  });
  return indices;
}

}  // namespace penumbra::import
