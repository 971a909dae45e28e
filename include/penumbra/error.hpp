#pragma once

#include <penumbra/export.hpp>

#include <stdexcept>
#include <string>
#include <type_traits>

namespace penumbra {

/// What the command line returns to the shell; the meaning of each number never changes.
enum class ExitCode {
  done = 0,
  answer_is_no = 1,  ///< the job ran and the answer is no (validation failed, --max-rmse exceeded)
  usage = 2,         ///< wrong usage
  input = 3,         ///< bad input: file, line or JSON pointer, what is wrong, what would be right
  resource = 4,      ///< device or resource: no device, out of memory, disk full, lost
  interrupted = 130,
};

namespace detail {
template <typename... Args>
class Format;  // inside the library: base/error.hpp
}

/// Something that the user or the calling program can act on. The message says what is wrong, where, and what would be
/// right; it is the command line's. What only Penumbra's authors can act on is an assertion, not an Error.
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

/// A request that cannot be meant: an unknown method, option or name, or a number out of its range.
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

/// A file or scene that cannot be used as it is.
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

/// The machine refuses: no device, no memory, no room on the disk.
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
