#pragma once

/// Marks what a program that links libpenumbra may use; everything else in the library is hidden.
#define PENUMBRA_API __attribute__((visibility("default")))
/// Marks a part of a class that it may not.
#define PENUMBRA_HIDDEN __attribute__((visibility("hidden")))
