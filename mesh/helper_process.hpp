#pragma once

#include "mesh/helper.hpp"
#include "mesh/import_wire.hpp"

#include <cstdint>
#include <optional>

/// A helper's own side: what its main() does first and last (helper.hpp is the asker's side).
namespace penumbra::mesh {

/// Who asked, and what the work may cost. Without a limit of memory the work may use threads.
struct HelperTerms {
  std::uint64_t asker = 0;  ///< the number of the process that asked
  std::optional<std::uint64_t> milliseconds = {};
  std::optional<std::uint64_t> memory_bytes = {};
};

/// Sees to it that this process ends with the one that asked, takes everything from it that it does not need, and
/// returns where the answer goes: what libraries print to standard output goes to standard error from here on. Ends the
/// process if that fails.
int begin_helper(const HelperTerms& terms);

/// The head of an answer.
WireWriter answer_head(HelperStatus status);

}  // namespace penumbra::mesh
