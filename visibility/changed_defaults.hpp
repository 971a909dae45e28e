// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/method.hpp"

namespace penumbra::visibility {

/// A method that may replace the default of an option that the user did not give.
class ChangesDefaults {
 public:
  /// Returns the options whose defaults the device does not support, with the values used instead. The host writes them
  /// wherever it writes the user's options.
  [[nodiscard]] virtual MethodOptions changed_defaults() const = 0;

 protected:
  ~ChangesDefaults() = default;
};

/// Returns the options that the method itself changed; none for other methods.
inline MethodOptions changed_defaults(const Method& method) {
  const auto* const changes = dynamic_cast<const ChangesDefaults*>(&method);
  return changes == nullptr ? MethodOptions() : changes->changed_defaults();
}

}  // namespace penumbra::visibility
