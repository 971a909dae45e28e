// tinygltf's code, compiled once, here, and under another namespace (import/CMakeLists.txt says why). Images are left
// out: nobody here looks at them.
#include <nlohmann/json.hpp>

#define TINYGLTF_IMPLEMENTATION
#include <tiny_gltf.h>
