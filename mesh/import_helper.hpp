// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/helper.hpp"
#include "mesh/import.hpp"
#include "mesh/input_file.hpp"

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace penumbra::mesh {

/// Arguments of the helper: `penumbra-import KIND MILLISECONDS BYTES ASKER FILE FLAGS…`. FILE is only a name: the
/// helper receives the file and its folder as the open descriptors below.
struct HelperJob {
  std::string kind;  ///< "mesh", "scene", "texture" or "sky"
  const InputFile& input;
  std::vector<std::string> flags;
};
inline constexpr int kInputDescriptor = kFirstHelperFile;
inline constexpr int kFolderDescriptor = kFirstHelperFile + 1;

struct HelperAnswer {
  std::vector<std::filesystem::path> sources;  ///< files that were opened, including `job.input`
  GrowingBytes bytes;
  std::size_t payload_at = 0;  ///< offset in the bytes
  [[nodiscard]] std::span<const std::byte> payload() const& { return bytes.all().subspan(payload_at); }
  std::span<const std::byte> payload() const&& = delete;
};

/// Runs `penumbra-import` on a foreign file, in a separate process, and returns its answer.
///
/// Throws InputError if the file is bad, or if reading it crashed, hung or exceeded `limits`; ResourceError if the
/// helper is missing or cannot be started, or if the file needs more memory than this machine has left, which is less
/// than `limits`.
HelperAnswer run_import_helper(const HelperJob& job, const ImportLimits& limits);

}  // namespace penumbra::mesh
