// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/method.hpp"

namespace penumbra::visibility {

/// A method that may use another value than the default of an option that was not given.
class ChangesDefaults {
 public:
  /// Returns these options with the values that are used, since the device cannot do the defaults. The host writes them
  /// wherever it writes the user's options.
  [[nodiscard]] virtual MethodOptions changed_defaults() const = 0;

 protected:
  ~ChangesDefaults() = default;
};

/// Returns the options that the method itself changed; of other methods none.
inline MethodOptions changed_defaults(const Method& method) {
  const auto* const changes = dynamic_cast<const ChangesDefaults*>(&method);
  return changes == nullptr ? MethodOptions() : changes->changed_defaults();
}

}  // namespace penumbra::visibility
