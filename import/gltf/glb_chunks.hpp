#pragma once

#include <string>
#include <string_view>

namespace penumbra::scenes {

/// What a GLB holds; views into its bytes.
struct GlbChunks {
  std::string_view json;
  std::string_view binary;  ///< empty: there is none
  /// As glTF 2.0 (4.4) asks: padded to multiples of four bytes, JSON first, then at most the binary chunk. What is not
  /// needs glb_of() before a strict parser takes it.
  bool strict = true;
};

/// Takes a GLB (version 2) apart, also one whose chunks are not padded, as some exporters write them, and one with
/// chunks of unknown types, which are ignored (glTF 2.0, 4.4.3.1). Throws InputError for one that is truncated or
/// damaged; `file` is its name.
GlbChunks glb_chunks(std::string_view bytes, const std::string& file);

/// A strict GLB of these chunks.
std::string glb_of(std::string_view json, std::string_view binary);

}  // namespace penumbra::scenes
