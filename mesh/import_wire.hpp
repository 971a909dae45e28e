// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

/// The format of the import helper's answers. Both ends are one build on one machine, so numbers are sent in their
/// memory representation; but a hostile file may have compromised the sender, so the reader checks everything.
namespace penumbra::mesh {

struct ImportedMesh;
struct TriangleSoup;

class WireWriter {
 public:
  template <typename T>
  void put(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    append(&value, sizeof(T));
  }
  template <typename T>
  void put_array(std::span<const T> values) {
    static_assert(std::is_trivially_copyable_v<T>);
    put<std::uint64_t>(values.size());
    append(values.data(), values.size_bytes());
  }
  /// Writes an array without copying: the values must stay unchanged until pieces() has been used.
  template <typename T>
  void put_array_in_place(std::span<const T> values) {
    static_assert(std::is_trivially_copyable_v<T>);
    put<std::uint64_t>(values.size());
    if (!values.empty()) in_place_.push_back({bytes_.size(), std::as_bytes(values)});
  }
  /// Writes an array of the values value(0), value(1) …
  template <typename T, typename Value>
  void put_values(std::size_t count, const Value& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    put<std::uint64_t>(count);
    const std::size_t first = bytes_.size();
    bytes_.resize(first + count * sizeof(T));
    for (std::size_t i = 0; i < count; ++i) {
      const T one = value(i);
      std::memcpy(&bytes_[first + i * sizeof(T)], &one, sizeof(T));
    }
  }
  void put_string(std::string_view text) { put_array(std::span<const char>(text)); }
  void put_strings(std::span<const std::string> texts) {
    put<std::uint64_t>(texts.size());
    for (const std::string& text : texts) put_string(text);
  }
  /// Returns the number of bytes written.
  [[nodiscard]] std::uint64_t size() const;
  /// Returns everything written, in order; valid until the next put.
  [[nodiscard]] std::vector<std::span<const std::byte>> pieces() const;
  /// Returns everything written as one array.
  [[nodiscard]] std::vector<std::byte> bytes() const;

 private:
  struct InPlace {
    std::size_t after;  ///< position in bytes_
    std::span<const std::byte> values;
  };
  void append(const void* data, std::size_t size) {
    if (size == 0) return;
    const auto* first = static_cast<const std::byte*>(data);
    bytes_.insert(bytes_.end(), first, first + size);
  }
  std::vector<std::byte> bytes_;
  std::vector<InPlace> in_place_;
};

/// Writes everything in `from` to the descriptor `to`; returns false if that fails.
bool write_all(int to, const WireWriter& from);

/// The answer is not one that an intact helper sends.
struct WireError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Reads values in the order in which WireWriter wrote them. Never reads past the end, and never allocates more than
/// the remaining bytes: a count is compared with them before memory is reserved.
class WireReader {
 public:
  explicit WireReader(std::span<const std::byte> bytes) : rest_(bytes) {}
  explicit WireReader(std::vector<std::byte>&& bytes) = delete;  // the bytes must outlive the reader

  template <typename T>
  T get() {
    static_assert(std::is_trivially_copyable_v<T> && !std::is_same_v<T, bool>);
    T value;
    std::memcpy(&value, take(sizeof(T)).data(), sizeof(T));
    return value;
  }
  bool get_bool() {
    const auto value = get<std::uint8_t>();
    if (value > 1) throw WireError("a flag is neither 0 nor 1");
    return value == 1;
  }
  template <typename T>
  std::vector<T> get_array() {
    const auto source = get_array_in_place<T>();
    std::vector<T> values(source.size() / sizeof(T));
    if (!source.empty()) std::memcpy(values.data(), source.data(), source.size());
    return values;
  }
  /// Returns the bytes of an array, which may be unaligned.
  template <typename T>
  std::span<const std::byte> get_array_in_place() {
    static_assert(std::is_trivially_copyable_v<T>);
    const auto count = get<std::uint64_t>();
    if (count > rest_.size() / sizeof(T)) throw WireError("an array is longer than the answer");
    return take(count * sizeof(T));
  }
  std::string get_string();  ///< made printable: see printable()
  std::vector<std::string> get_strings();
  std::vector<std::string> get_raw_strings();  ///< for paths, which may hold any bytes: not for display
  [[nodiscard]] std::size_t remaining() const { return rest_.size(); }
  void expect_end() const {
    if (!rest_.empty()) throw WireError("there is more than expected");
  }

 private:
  std::span<const std::byte> take(std::size_t size) {
    if (size > rest_.size()) throw WireError("it ends too early");
    const auto front = rest_.first(size);
    rest_ = rest_.subspan(size);
    return front;
  }
  std::span<const std::byte> rest_;
};

/// Returns `text` with control characters (a hostile file must not control the terminal) and ill-formed UTF-8 (JSON
/// writers throw on it) as escapes such as "\xe9", from which a user can tell which file or object is meant.
std::string printable(std::string_view text);

/// A run of `count` numbers that begins with `first`; each next number is larger by the list's step.
struct NumberRun {
  std::uint32_t first = 0, count = 0;
};

/// Writes a soup, which must stay unchanged until the writer's pieces have been used. Compact: positions that fit
/// single precision are sent as such, and object and face numbers that stay the same or count up are sent as runs.
void put_soup(WireWriter& to, const TriangleSoup& soup);
/// Checks that every index is in range, every position finite and the arrays of one length; throws WireError.
TriangleSoup get_soup(WireReader& from);

void put_mesh(WireWriter& to, const ImportedMesh& mesh);  ///< as put_soup
ImportedMesh get_mesh(WireReader& from);                  ///< as get_soup

}  // namespace penumbra::mesh
