// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <cstddef>
#include <string>
#include <vector>

namespace penumbra::import {

/// Parts of a file that were removed from its document before parsing; the scene reports them as warnings and errors.
struct TakenOut {
  /// A target of KHR_animation_pointer other than a node's translation, rotation, scale or weights.
  struct Pointer {
    std::string target;  ///< a JSON pointer
    std::size_t clip;    ///< index of the animation
    bool operator==(const Pointer&) const = default;
  };
  std::vector<Pointer> pointers;          ///< each once
  std::size_t channels_without_node = 0;  ///< animation channels that glTF 2.0 (3.11) requires to ignore
  bool no_utf8 = false;                   ///< names had bytes that are not UTF-8, now escapes such as \xe9
  std::vector<std::string> overruled;     ///< nodes with a matrix and also translation, rotation or scale
  std::vector<std::string> compressed;    ///< primitives that exist only in compressed form; filled only if lenient
};

/// Converts constructs that glTF 2.0 or three.js allows and tinygltf refuses into equivalent ones:
/// - animation channels without a node are removed; channels that point to a node's transform (KHR_animation_pointer)
///   get that node as their target;
/// - a plus sign in a file's name stays a plus sign;
/// - data URIs get a media type that tinygltf supports, and lose percent escapes and blanks within their base64;
///   buffers get the length of their data URI, which may be longer than `byteLength`;
/// - primitives compressed with Draco that have an uncompressed copy use the copy; those without are refused
///   (InputError with the primitive's place), or removed if `lenient`;
/// - if a node has both a matrix and translation, rotation or scale, which exclude each other (3.5.3), the matrix is
///   used.
/// Refuses files of which no part can be read without their compression (EXT_meshopt_compression). Returns whether the
/// document changed. `file` is its name, for messages.
bool mend_gltf(nlohmann::json& document, const std::string& file, bool lenient, TakenOut& taken_out);

}  // namespace penumbra::import
