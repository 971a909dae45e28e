// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/diagnosis/diagnosis.hpp"

#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>

namespace penumbra::visibility {

/// Quality of a method's results for an unrepaired mesh (`penumbra inspect`).
enum class Verdict {
  exact,         ///< each result is correct for the triangles as stored
  conservative,  ///< wrong on one known side only
  approximate,
  refused,
};
const char* name_of(Verdict verdict);

struct MeshVerdict {
  Verdict verdict = Verdict::refused;
  std::string reason;
};

/// A property of `count` parts of the mesh: "needles, which may be thinner than a texel".
struct Remark {
  std::uint64_t count = 0;
  std::string_view what;
};

/// Returns the sentence, followed by each remark whose count is not 0: "sentence; needles, which …: 5". The effect of
/// rounding to scene floats comes last: it is the same for every method.
std::string reason_with(std::string_view sentence, const mesh::Diagnosis& mesh, std::initializer_list<Remark> remarks);

}  // namespace penumbra::visibility
