#pragma once

#include "mesh/import_wire.hpp"
#include "scenes/scene.hpp"

namespace penumbra::scenes {

/// A whole scene in the import helper's answer.
void put_scene(mesh::WireWriter& to, const Scene& scene);

/// Checks all that Scene promises (indices in range, numbers finite, at least one light and one camera); throws
/// mesh::WireError.
Scene get_scene(mesh::WireReader& from);

/// A picture, without the name that the scene calls it by.
void put_texture(mesh::WireWriter& to, const Texture& texture);
/// Checks that there are as many texels as the size says; throws mesh::WireError.
Texture get_texture(mesh::WireReader& from);

}  // namespace penumbra::scenes
