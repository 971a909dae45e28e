// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

/// Numbers in the report for its script: deflated, as base64. compare/page/data.js unpacks them;
/// tests/unit/compare/report_data.cpp unpacks them, too.
namespace penumbra::compare {

/// Packs bytes unchanged. (Masks are packed by Deflated itself, as they arrive.)
std::string pack_bytes(std::span<const std::byte> bytes);

/// Packs floats without loss: four planes of bytes, the most significant first, so that similar bytes are adjacent.
std::string pack_floats(std::span<const float> values);

/// Packs linear radiance, scan lines of `width` pixels, to 1/512 of a stop (0.14 %) over 127 stops, so that any
/// exposure can be shown: one code for each colour, 0 for black (and for values that are not positive), c for 2^((c −
/// 1) / 256 − 64). Green, red minus green and blue minus green are packed, each minus its left neighbour modulo
/// 2^16, as planes of bytes: where light fades over one colour, nearly all of these are zero.
std::string pack_radiance(std::uint32_t width, std::span<const glm::vec3> linear);

/// Packs a picture that is similar to `reference` as differences, to 1/128 of a stop (0.54 %). Steps of four codes are
/// packed: for green, the steps from the reference's green; for red and blue, the steps from the reference's own value
/// moved by green's steps. A number of steps s becomes 2s for s >= 0 and −2s − 1 for s < 0, in planes of bytes.
std::string pack_radiance_over(std::span<const glm::vec3> reference, std::span<const glm::vec3> linear);

}  // namespace penumbra::compare
