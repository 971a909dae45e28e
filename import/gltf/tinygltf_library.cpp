// SPDX-License-Identifier: Apache-2.0
// The code of tinygltf, compiled once, in another namespace (import/CMakeLists.txt has the reason). Without its image
// code, which this program does not use.
#include <nlohmann/json.hpp>

#define TINYGLTF_IMPLEMENTATION
#include <tiny_gltf.h>
