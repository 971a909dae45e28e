// SPDX-License-Identifier: Apache-2.0
// Source of the targets that own the precompiled headers (precompiled.cmake): contains no code of its own.
