#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

/// Programs of this project that do one piece of work in a process of their own: `penumbra-import` reads foreign files,
/// `penumbra-repair` repairs meshes. helper_process.hpp is their side of it.
namespace penumbra::mesh {

class WireReader;

/// Such a program. It stands beside the file that holds this code, the program's or the library's, or in `../bin` from
/// there, or where an environment variable says.
struct HelperProgram {
  const char* file;        ///< "penumbra-import"
  const char* variable;    ///< "PENUMBRA_IMPORT_HELPER"
  const char* words;       ///< in messages: "the import helper"
  const char* built_with;  ///< in the message that it is missing: how it is built, if not always
};

/// ResourceError if the program is not there.
void require_helper(const HelperProgram& program);

/// First byte of a helper's answer, after its magic.
enum class HelperStatus : std::uint8_t {
  done = 0,           ///< what the helper is for follows
  bad_input = 1,      ///< a message follows: an exception, thrown over there
  out_of_memory = 2,  ///< nothing follows
};

inline constexpr char kHelperMagic[8] = {'P', 'N', 'B', 'R', 'I', 'M', 'P', '1'};

/// Reads the head of an answer; throws WireError.
HelperStatus get_status(WireReader& from);

/// Bytes that become more. Their memory grows by realloc, which moves pages of large blocks and not what is in them.
class GrowingBytes {
 public:
  /// At least `least` bytes behind those that are there; throws std::bad_alloc.
  std::span<std::byte> room(std::size_t least);
  /// So many of the room are there now.
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
  std::vector<std::string> arguments;  ///< one of them is this process's number: the helper ends with it
  std::vector<int> files;              ///< open files of this process: the helper's kFirstHelperFile and so on
  std::optional<std::chrono::milliseconds> time = {};
  std::uint64_t output_bytes = ~std::uint64_t{0};
};
inline constexpr int kFirstHelperFile = 3;

struct HelperEnding {
  enum class How { by_itself, out_of_time, too_much_output };
  How how = How::by_itself;
  int status = 0;  ///< as waitpid gives it
  GrowingBytes output;
  std::string errors;  ///< the first few KiB of what it wrote to stderr

  /// "; it said: …": the first line of these (what follows is a library's stack trace at best); empty if it said
  /// nothing.
  [[nodiscard]] std::string first_line() const;
};

/// Runs a helper to its end, or to that of its time or output. Its standard input is a pipe that this process never
/// writes to and whose end is its own end: it ends with this process at the latest, and with the thread that called
/// this function. ResourceError if it is missing or cannot be started.
HelperEnding run_helper(const HelperProgram& program, const HelperRun& run);

}  // namespace penumbra::mesh
