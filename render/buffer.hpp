// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/device.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>

namespace penumbra::render {

/// Memory kind of a buffer. `device`: fastest for shaders; upload and download use a staging copy unless the memory is
/// host-visible (unified memory, processors).
enum class BufferUse {
  storage,  ///< storage buffer, index and vertex buffer, transfer
  texels,   ///< uniform texel buffer of RGBA32UI (16-byte elements), and storage and transfer
};

/// A range of device memory. Move-only. Its contents after construction are undefined.
class Buffer {
 public:
  /// Throws ResourceError when `bytes` exceeds the device's limit (max_storage_buffer_range) or its free memory.
  Buffer(const Device& device, std::string name, std::uint64_t bytes, BufferUse use = BufferUse::storage);
  ~Buffer();
  Buffer(Buffer&&) noexcept;
  Buffer& operator=(Buffer&&) noexcept;

  [[nodiscard]] std::uint64_t bytes() const;
  [[nodiscard]] const std::string& name() const;

  /// Copies and waits. `offset` in bytes. (const: the object is unchanged; its device memory is written by passes,
  /// too.)
  void upload(std::span<const std::byte> data, std::uint64_t offset = 0) const;
  void download(std::span<std::byte> data, std::uint64_t offset = 0) const;
  template <typename T>
  void write(std::span<const T> values, std::uint64_t offset = 0) const {
    upload(std::as_bytes(values), offset);
  }
  template <typename T>
  void read(std::span<T> values, std::uint64_t offset = 0) const {
    download(std::as_writable_bytes(values), offset);
  }

  struct State;
  [[nodiscard]] State& state() const { return *state_; }  ///< for render/*.cpp only

 private:
  std::unique_ptr<State> state_;
};

/// Makes a buffer with exactly these elements, but at least one element large.
template <typename T>
Buffer make_buffer(const Device& device, std::string name, std::span<const T> values,
                   BufferUse use = BufferUse::storage) {
  Buffer buffer(device, std::move(name), values.empty() ? sizeof(T) : values.size_bytes(), use);
  if (!values.empty()) buffer.write(values);
  return buffer;
}

/// Makes `buffer` at least `bytes` large (content is lost when it grows); returns whether it grew.
bool grow(const Device& device, std::unique_ptr<Buffer>& buffer, const std::string& name, std::uint64_t bytes,
          BufferUse use = BufferUse::storage);

/// Buffers in the form that passes take: an initializer list, or a list made at run time.
using BufferReference = std::reference_wrapper<const Buffer>;
using BufferList = std::span<const BufferReference>;

}  // namespace penumbra::render
