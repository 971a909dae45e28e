// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace penumbra::app {

/// Prepares the process; to be called once, first in main. Afterwards closed standard streams, a limit on the size of
/// files, or a reader that stops reading do not end the process by a signal; writing fails instead, with an exit code.
/// An uncaught exception ends the process with exit code 4 and a message. Freed memory is kept (keep_freed_memory).
void prepare_process();

/// Writes to stderr if possible; failures are ignored.
void say(std::string_view text) noexcept;

/// Writes a message about the current exception to stderr; returns its exit code.
int explain_current_exception() noexcept;

/// Throws ResourceError if text printed to stdout could not be written.
void check_stdout();

}  // namespace penumbra::app
