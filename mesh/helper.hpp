// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

/// Programs of this project that do one piece of work in a separate process: `penumbra-import` reads foreign files,
/// `penumbra-repair` repairs meshes. helper_process.hpp is the helper's side.
namespace penumbra::mesh {

class WireReader;

/// A helper program. Found next to the file that holds this code (the program or the library), or in `../bin` from
/// there, or at the path in an environment variable.
struct HelperProgram {
  const char* file;        ///< "penumbra-import"
  const char* variable;    ///< "PENUMBRA_IMPORT_HELPER"
  const char* words;       ///< name in messages: "the import helper"
  const char* built_with;  ///< build option named in the message that the helper is missing, unless it is always built
};

/// Throws ResourceError if the program does not exist.
void require_helper(const HelperProgram& program);

/// First byte of a helper's answer, after its magic.
enum class HelperStatus : std::uint8_t {
  done = 0,           ///< the result follows
  bad_input = 1,      ///< a message follows: an exception in the helper
  out_of_memory = 2,  ///< nothing follows
};

inline constexpr char kHelperMagic[8] = {'P', 'N', 'B', 'R', 'I', 'M', 'P', '1'};

/// Reads the head of an answer; throws WireError.
HelperStatus get_status(WireReader& from);

/// A growing array of bytes. Grows by realloc, which remaps the pages of large blocks instead of copying.
class GrowingBytes {
 public:
  /// Returns at least `least` bytes of space behind the stored ones; throws std::bad_alloc.
  std::span<std::byte> room(std::size_t least);
  /// Appends the first `count` bytes of the space that room() returned.
  void add(std::size_t count) { size_ += count; }
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] std::span<const std::byte> all() const& { return {memory_.get(), size_}; }
  std::span<const std::byte> all() const&& = delete;

 private:
  struct Free {
    void operator()(std::byte* memory) const { std::free(memory); }
  };
  std::unique_ptr<std::byte, Free> memory_;
  std::size_t size_ = 0, capacity_ = 0;
};

/// One call of a helper.
struct HelperRun {
  std::vector<std::string> arguments;  ///< one must be this process's number: the helper ends with this process
  std::vector<int> files;              ///< open files of this process, which become the helper's kFirstHelperFile and
                                       ///< so on
  std::optional<std::chrono::milliseconds> time = {};
  std::uint64_t output_bytes = ~std::uint64_t{0};
  /// Called ten times a second while the helper works; its exception ends the helper. May be null.
  const std::function<void()>* step = nullptr;
};
inline constexpr int kFirstHelperFile = 3;

struct HelperEnding {
  enum class How { by_itself, out_of_time, too_much_output };
  How how = How::by_itself;
  int status = 0;  ///< as waitpid reports it
  GrowingBytes output;
  std::string errors;  ///< the first few KiB of the helper's output to stderr

  /// Returns "; it said: …" with the first line of `errors` (later lines are at best a library's stack trace); empty if
  /// `errors` is.
  [[nodiscard]] std::string first_line() const;
};

/// Runs a helper until it ends, or reaches the limit of time or output. Its standard input is a pipe that this process
/// never writes to and that closes when this process ends: the helper ends with this process at the latest, and with
/// the thread that called this function. Throws ResourceError if the helper is missing or cannot be started.
HelperEnding run_helper(const HelperProgram& program, const HelperRun& run);

}  // namespace penumbra::mesh
