#pragma once

/// Penumbra: how much of an area light each visible point sees. Everything that the library offers:
///   scene.hpp     meshes, lights, cameras      renderer.hpp  pictures by any method, kept from call to call
///   picture.hpp   the numbers of a picture     methods.hpp   which methods there are
///   compare.hpp   methods against a reference  inspect.hpp   what is wrong with a mesh
///   wedges.hpp    penumbra wedges              own_method.hpp  methods of the calling program
///   error.hpp     what can be thrown
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

/// The version of the library, as `penumbra --version` prints it.
PENUMBRA_API std::string version();

}  // namespace penumbra
