// SPDX-License-Identifier: Apache-2.0
// For shaders of both rasterisers: Vulkan's, as SPIR-V, and OpenGL's, as text (PENUMBRA_OPENGL). Structs of push
// constants must have the same layout in scalar and in std140: no vec3 except at multiples of 16 bytes, and padding to
// whole 16 bytes before a member that follows a struct.
#ifndef PENUMBRA_BOTH
#define PENUMBRA_BOTH
#ifdef PENUMBRA_OPENGL
#define PUSH_CONSTANTS layout(std140, binding = 0) uniform
#define STORAGE(n) layout(std430, binding = n)
#define VERTEX uint(gl_VertexID)
#define INSTANCE uint(gl_InstanceID)
#else
#define PUSH_CONSTANTS layout(scalar, push_constant) uniform
#define STORAGE(n) layout(scalar, binding = n)
#define VERTEX uint(gl_VertexIndex)
#define INSTANCE uint(gl_InstanceIndex)
#endif

// Positions, three floats each, at binding 0: OpenGL would give a vec3 sixteen bytes.
#ifdef PENUMBRA_OPENGL
STORAGE(0) readonly buffer Corners { float coordinates[]; };
vec3 corner_at(uint i) { return vec3(coordinates[3 * i], coordinates[3 * i + 1], coordinates[3 * i + 2]); }
#else
STORAGE(0) readonly buffer Corners { vec3 corners[]; };
vec3 corner_at(uint i) { return corners[i]; }
#endif
#endif
