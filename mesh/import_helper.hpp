#pragma once

#include "mesh/import.hpp"
#include "mesh/input_file.hpp"

#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace penumbra::mesh {

/// What the helper is asked to do: `penumbra-import KIND MILLISECONDS BYTES ASKER FILE FLAGS…`. FILE is only a name:
/// the helper finds the file and its folder opened, as the descriptors below. ASKER is this process's number; the
/// helper's standard input is a pipe that this process never writes to and whose end is its own end.
struct HelperJob {
  std::string kind;  ///< "mesh", "gltf" or "texture"
  const InputFile& input;
  std::vector<std::string> flags;
};
inline constexpr int kInputDescriptor = 3;
inline constexpr int kFolderDescriptor = 4;

/// First byte of a helper's answer, after its magic.
enum class HelperStatus : std::uint8_t {
  done = 0,           ///< the files that were opened follow, then the payload
  bad_input = 1,      ///< a message follows: an InputError, thrown over there
  out_of_memory = 2,  ///< nothing follows
};

inline constexpr char kHelperMagic[8] = {'P', 'N', 'B', 'R', 'I', 'M', 'P', '1'};

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

struct HelperAnswer {
  std::vector<std::filesystem::path> sources;  ///< files that were opened on the way, `job.input` among them
  GrowingBytes bytes;
  std::size_t payload_at = 0;  ///< of the bytes
  [[nodiscard]] std::span<const std::byte> payload() const& { return bytes.all().subspan(payload_at); }
  std::span<const std::byte> payload() const&& = delete;
};

/// Runs `penumbra-import` on a foreign file, in a process of its own, and returns its answer.
///
/// The helper stands beside the running program, or where the environment's PENUMBRA_IMPORT_HELPER says. It is started
/// with posix_spawn, not forked: this program has threads (TBB, Vulkan drivers), whose locks a forked copy would
/// inherit locked. It ends with this process at the latest, and with the thread that called this one. InputError: the
/// file is bad, or reading it crashed, hung or exceeded `limits`. ResourceError: the helper is missing or cannot be
/// started, or this machine has less memory left than `limits` and the file needs more than that.
HelperAnswer run_import_helper(const HelperJob& job, const ImportLimits& limits);

}  // namespace penumbra::mesh
