// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace penumbra::import {

/// Content of a GLB file, as views into its bytes.
struct GlbChunks {
  std::string_view json;
  std::string_view binary;  ///< empty if there is none
  /// True if the layout follows glTF 2.0 (4.4): padded to multiples of four bytes, JSON first, then at most the binary
  /// chunk. Other files need glb_of() before a strict parser accepts them.
  bool strict = true;
};

/// Splits a GLB (version 2) into chunks. Accepts chunks without padding, as some exporters write them, and ignores
/// chunks of unknown types (glTF 2.0, 4.4.3.1). Throws InputError for a file that is truncated or damaged; `file` is
/// its name.
GlbChunks glb_chunks(std::string_view bytes, const std::string& file);

/// Returns a strict GLB of these chunks.
std::string glb_of(std::string_view json, std::string_view binary);

}  // namespace penumbra::import
