// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <penumbra/export.hpp>

#include <stdexcept>
#include <string>
#include <type_traits>

namespace penumbra {

/// Exit codes of the command line; the meaning of each number never changes.
enum class ExitCode {
  done = 0,
  answer_is_no = 1,  ///< the job ran and its result is negative (validation failed, --max-rmse exceeded)
  usage = 2,         ///< wrong usage
  input = 3,         ///< invalid input: file, line or JSON pointer, the error, and the expected value
  resource = 4,      ///< device or resource: no device, out of memory, disk full, device lost
  interrupted = 130,
};

namespace detail {
template <typename... Args>
class Format;  // internal to the library: base/error.hpp
}

/// Error that the user or the calling program can correct. The message states the error, its location, and the expected
/// value; it is the command line's message. Errors that only Penumbra's authors can correct are assertions, not Error.
class PENUMBRA_API Error : public std::runtime_error {
 public:
  Error(ExitCode code, const std::string& message);
  Error(const Error&) noexcept = default;
  Error& operator=(const Error&) noexcept = default;
  ~Error() override;
  [[nodiscard]] ExitCode code() const noexcept { return code_; }

 private:
  ExitCode code_;
};

/// Invalid request: an unknown method, option or name, or a number out of its range.
class PENUMBRA_API UsageError : public Error {
 public:
  explicit UsageError(const std::string& message);
  template <typename... Args>
  requires(sizeof...(Args) > 0) PENUMBRA_HIDDEN
      explicit UsageError(detail::Format<std::type_identity_t<Args>...> format, Args&&... args);
  UsageError(const UsageError&) noexcept = default;
  UsageError& operator=(const UsageError&) noexcept = default;
  ~UsageError() override;
};

/// File or scene that cannot be used.
class PENUMBRA_API InputError : public Error {
 public:
  explicit InputError(const std::string& message);
  template <typename... Args>
  requires(sizeof...(Args) > 0) PENUMBRA_HIDDEN
      explicit InputError(detail::Format<std::type_identity_t<Args>...> format, Args&&... args);
  InputError(const InputError&) noexcept = default;
  InputError& operator=(const InputError&) noexcept = default;
  ~InputError() override;
};

/// Missing resource: no device, out of memory, disk full.
class PENUMBRA_API ResourceError : public Error {
 public:
  explicit ResourceError(const std::string& message);
  template <typename... Args>
  requires(sizeof...(Args) > 0) PENUMBRA_HIDDEN
      explicit ResourceError(detail::Format<std::type_identity_t<Args>...> format, Args&&... args);
  ResourceError(const ResourceError&) noexcept = default;
  ResourceError& operator=(const ResourceError&) noexcept = default;
  ~ResourceError() override;
};

}  // namespace penumbra
