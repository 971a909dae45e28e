// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Penumbra computes the visible fraction of an area light at each visible point. Contents of the library:
///   scene.hpp     meshes, lights, cameras      renderer.hpp  pictures by any method; keeps data between calls
///   picture.hpp   the numbers of a picture     methods.hpp   list of methods
///   compare.hpp   methods against a reference  inspect.hpp   defects of a mesh
///   wedges.hpp    penumbra wedges              own_method.hpp  methods of the calling program
///   error.hpp     exceptions
#include <penumbra/compare.hpp>
#include <penumbra/error.hpp>
#include <penumbra/inspect.hpp>
#include <penumbra/methods.hpp>
#include <penumbra/own_method.hpp>
#include <penumbra/picture.hpp>
#include <penumbra/renderer.hpp>
#include <penumbra/scene.hpp>
#include <penumbra/wedges.hpp>

namespace penumbra {

/// Returns the version of the library, as printed by `penumbra --version`.
PENUMBRA_API std::string version();

}  // namespace penumbra
