// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/helper.hpp"
#include "mesh/import_wire.hpp"

#include <cstdint>
#include <optional>

/// A helper's own side: first and last steps of its main() (helper.hpp is the parent's side).
namespace penumbra::mesh {

/// Process number of the parent, and limits on the work. Without a limit of memory the work may use threads.
struct HelperTerms {
  std::uint64_t asker = 0;  ///< the parent's process number
  std::optional<std::uint64_t> milliseconds = {};
  std::optional<std::uint64_t> memory_bytes = {};
};

/// Makes this process end with its parent, drops every right that it does not need, and returns the descriptor for the
/// answer: from here on libraries' output to standard output goes to standard error. Ends the process if that fails.
int begin_helper(const HelperTerms& terms);

/// Returns the head of an answer.
WireWriter answer_head(HelperStatus status);

}  // namespace penumbra::mesh
