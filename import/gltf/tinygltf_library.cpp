// SPDX-License-Identifier: Apache-2.0
// Compiles the code of tinygltf once, in another namespace (import/CMakeLists.txt has the reason), and without its
// image code, which this program does not use.
#include <nlohmann/json.hpp>

#define TINYGLTF_IMPLEMENTATION
#include <tiny_gltf.h>
