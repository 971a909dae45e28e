#pragma once

#include <nlohmann/json_fwd.hpp>

#include <cstddef>
#include <string>
#include <vector>

namespace penumbra::scenes {

/// What a file holds that was taken out of its document before it was parsed. The scene's warnings and refusals come
/// of it.
struct TakenOut {
  /// A target of KHR_animation_pointer that is no node's translation, rotation, scale or weights.
  struct Pointer {
    std::string target;  ///< a JSON pointer
    std::size_t clip;    ///< the number of the animation that has it
    bool operator==(const Pointer&) const = default;
  };
  std::vector<Pointer> pointers;          ///< each once
  std::size_t channels_without_node = 0;  ///< animation channels that glTF 2.0 (3.11) says to ignore
  bool no_utf8 = false;                   ///< names with bytes that are no UTF-8, for which there is '?' now
  std::vector<std::string> compressed;    ///< primitives that exist in compressed form alone; only if lenient
};

/// Changes what glTF 2.0 or three.js allows and tinygltf refuses into what means the same:
/// - animation channels without a node go; those that point to a node's transform (KHR_animation_pointer) name it;
/// - a plus sign in a file's name stays one;
/// - data URIs get a media type that tinygltf knows, and no percent signs or blanks within their base64, and buffers
/// the length of their data URI, which may be longer than
///   `byteLength`;
/// - primitives compressed with Draco that have an uncompressed copy are that; those without are refused (InputError by
///   the primitive's place), or taken out if `lenient`.
/// Refuses files of which no part can be read without their compression (EXT_meshopt_compression).
/// Returns whether the document changed. `file` is its name, for messages.
bool mend_gltf(nlohmann::json& document, const std::string& file, bool lenient, TakenOut& taken_out);

}  // namespace penumbra::scenes
