// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Marks symbols for programs that link libpenumbra; all others in the library are hidden.
#define PENUMBRA_API __attribute__((visibility("default")))
/// Marks a hidden member of an exported class.
#define PENUMBRA_HIDDEN __attribute__((visibility("hidden")))
