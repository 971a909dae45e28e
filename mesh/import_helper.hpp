#pragma once

#include "mesh/import.hpp"

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace penumbra::mesh {

/// What the helper is asked to do: `penumbra-import KIND MILLISECONDS BYTES FILE FLAGS…`.
struct HelperJob {
  std::string kind;  ///< "mesh" or "gltf"
  std::filesystem::path file;
  std::vector<std::string> flags;
};

/// First byte of a helper's answer, after its magic.
enum class HelperStatus : std::uint8_t {
  done = 0,           ///< the payload follows
  bad_input = 1,      ///< a message follows: an InputError, thrown over there
  out_of_memory = 2,  ///< nothing follows
};

inline constexpr char kHelperMagic[8] = {'P', 'N', 'B', 'R', 'I', 'M', 'P', '1'};

/// Runs `penumbra-import` on a foreign file, in a process of its own, and returns the payload of its answer.
///
/// The helper stands beside the running program, or where the environment's PENUMBRA_IMPORT_HELPER says. It is started
/// with posix_spawn, not forked: this program has threads (TBB, Vulkan drivers), whose locks a forked copy would
/// inherit locked. InputError: the file is bad, or reading it crashed, hung or exceeded `limits`. ResourceError: the
/// helper is missing or cannot be started.
std::vector<std::byte> run_import_helper(const HelperJob& job, const ImportLimits& limits);

/// Throws InputError unless `file` is a readable regular file that is not empty.
void require_regular_file(const std::filesystem::path& file);

}  // namespace penumbra::mesh
