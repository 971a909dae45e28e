#pragma once

#include "compare/report.hpp"

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

/// The numbers that the report carries for its script: deflated, as base64. compare/page/data.js unpacks what is packed
/// here; tests/unit/compare/report_data.cpp unpacks it too.
namespace penumbra::compare {

/// As they are. (Masks are packed by Deflated itself, as they come.)
std::string pack_bytes(std::span<const std::byte> bytes);

/// Every bit of them: four planes of bytes, the most significant first, so that alike bytes stand together.
std::string pack_floats(std::span<const float> values);

/// Linear radiance, scan lines of `width` pixels, to 1/512 of a stop (0.14 %) over 127 stops, so that any exposure can
/// be shown: a code a colour, 0 for black (and what is no positive number), c for 2^((c − 1) / 256 − 64). Packed are
/// green, red less green, blue less green, each less its left neighbour modulo 2^16, as planes of bytes: where light
/// fades over one colour that is nearly all zeros.
std::string pack_radiance(std::uint32_t width, std::span<const glm::vec3> linear);

/// Does the entry carry V of each pixel under every light?
bool has_packed_numbers(const ReportEntry& entry);
/// Without numbers of the reference there is no viewer.
bool report_data_is_empty(const ReportInput& in);

/// All that the script works on, as elements of the page: a JSON object `report-data` and the packed numbers that it
/// names. Its `entries` are the reference, the rays, and the methods, as far as has_packed_numbers().
std::string report_data_html(const ReportInput& in);

}  // namespace penumbra::compare
