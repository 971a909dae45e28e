#pragma once

#include <string_view>

namespace penumbra::app {

/// Call once, first thing in main: after it, nothing that the caller of this program left out (standard streams that
/// are closed) or limits (the size of files, a reader that stops reading) ends the process by a signal; writing fails
/// instead, and costs an exit code. An exception that nobody catches ends the process with exit code 4 and a message.
/// Memory that is given back is kept (keep_freed_memory).
void prepare_process();

/// Wall-clock seconds since this process began, to a hundredth; since the first call where the system does not say.
double seconds_since_start();

/// Writes to stderr if that is possible; what cannot be said is not said, and is no error.
void say(std::string_view text) noexcept;

/// Says on stderr what the exception that is being handled means for the user; returns the exit code for it.
int explain_current_exception() noexcept;

/// Throws ResourceError if something that was printed to stdout did not get there.
void check_stdout();

}  // namespace penumbra::app
