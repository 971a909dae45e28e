// The source of the targets that own the precompiled headers (precompiled.cmake): it has nothing of its own.
