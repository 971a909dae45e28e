#pragma once

#include <fmt/format.h>

#include <stdexcept>
#include <string>
#include <utility>

namespace penumbra {

/// What the process returns to the shell; the meaning of each number never changes.
enum class ExitCode {
  done = 0,
  answer_is_no = 1,  ///< the job ran and the answer is no (validation failed, --max-rmse exceeded)
  usage = 2,         ///< wrong usage
  input = 3,         ///< bad input: file, line or JSON pointer, what is wrong, what would be right
  resource = 4,      ///< device or resource: no device, out of memory, disk full, lost
  interrupted = 130,
};

/// Something the user can act on. The message says what is wrong, where, and what would be right.
/// Caught once, in main. What only we can act on is an assertion, not an Error.
class Error : public std::runtime_error {
 public:
  Error(ExitCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
  [[nodiscard]] ExitCode code() const noexcept { return code_; }

 private:
  ExitCode code_;
};

/// A command line that cannot be meant (exit code 2).
class UsageError : public Error {
 public:
  template <typename... Args>
  explicit UsageError(fmt::format_string<Args...> format, Args&&... args)
      : Error(ExitCode::usage, fmt::format(format, std::forward<Args>(args)...)) {}
};

/// A file or scene that cannot be used as it is (exit code 3).
class InputError : public Error {
 public:
  template <typename... Args>
  explicit InputError(fmt::format_string<Args...> format, Args&&... args)
      : Error(ExitCode::input, fmt::format(format, std::forward<Args>(args)...)) {}
};

/// The machine says no: device, memory, disk (exit code 4).
class ResourceError : public Error {
 public:
  template <typename... Args>
  explicit ResourceError(fmt::format_string<Args...> format, Args&&... args)
      : Error(ExitCode::resource, fmt::format(format, std::forward<Args>(args)...)) {}
};

}  // namespace penumbra
