// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/import.hpp"

#include <string>
#include <string_view>

namespace penumbra::import {

/// Reads an AMF file (ISO/ASTM 52915, version 1.2), as XML or zipped, in double precision. Does not use Assimp, whose
/// reader drops all but one of an object's volumes and takes degrees for radians.
///
/// Every object appears at the places that constellations give it, or untransformed if none names it. Curved triangles
/// (with normals or edges) are read as flat, and units are ignored. Throws InputError with the line.
mesh::ImportedMesh read_amf(std::string_view content, const std::string& file);

}  // namespace penumbra::import
