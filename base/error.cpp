// SPDX-License-Identifier: Apache-2.0
// Constructors and destructors of the errors that a user can act on; out of line, so that each type's virtual table is
// emitted once.

#include "base/error.hpp"

namespace penumbra {

Error::Error(ExitCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
Error::~Error() = default;

UsageError::UsageError(const std::string& message) : Error(ExitCode::usage, message) {}
UsageError::~UsageError() = default;

InputError::InputError(const std::string& message) : Error(ExitCode::input, message) {}
InputError::~InputError() = default;

ResourceError::ResourceError(const std::string& message) : Error(ExitCode::resource, message) {}
ResourceError::~ResourceError() = default;

}  // namespace penumbra
