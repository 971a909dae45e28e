// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

namespace penumbra {

/// Adds `add_method` to the module: shadow methods implemented by Python functions.
void define_own_methods(pybind11::module_& module);

}  // namespace penumbra
