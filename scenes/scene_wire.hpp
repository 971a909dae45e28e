// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/import_wire.hpp"
#include "scenes/instances.hpp"
#include "scenes/scene.hpp"

namespace penumbra::scenes {

/// Writes a whole scene into the import helper's answer.
void put_scene(mesh::WireWriter& to, const Scene& scene);

/// Reads a scene and checks everything that Scene requires (indices in range, numbers finite, at least one light and
/// one camera); throws mesh::WireError.
Scene get_scene(mesh::WireReader& from);

/// Writes the scene's instances, after the scene; both must not change until the writer's pieces have been used.
void put_instances(mesh::WireWriter& to, const Instances& instances);
/// Reads the instances of `scene`, which was read before; checks everything that Instances requires, and throws
/// mesh::WireError.
Instances get_instances(mesh::WireReader& from, const Scene& scene);

/// Writes a picture, without its name in the scene.
void put_texture(mesh::WireWriter& to, const Texture& texture);
/// Reads a picture and checks that the number of texels fits its size; throws mesh::WireError.
Texture get_texture(mesh::WireReader& from);

}  // namespace penumbra::scenes
