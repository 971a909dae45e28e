#pragma once

#include "mesh/diagnosis/diagnosis.hpp"

#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>

namespace penumbra::visibility {

/// What a method makes of a mesh as it stands (`penumbra inspect`).
enum class Verdict {
  exact,         ///< each answer is that of the triangles as they stand
  conservative,  ///< wrong on one known side only
  approximate,
  refused,
};
const char* name_of(Verdict verdict);

struct MeshVerdict {
  Verdict verdict = Verdict::refused;
  std::string reason;
};

/// Something that holds of `count` parts of the mesh: "needles, which may be thinner than a texel".
struct Remark {
  std::uint64_t count = 0;
  std::string_view what;
};

/// The sentence, and after it each remark whose count is not 0: "sentence; needles, which …: 5". What rounding to scene
/// floats costs comes last: it is the same for every method.
std::string reason_with(std::string_view sentence, const mesh::Diagnosis& mesh, std::initializer_list<Remark> remarks);

}  // namespace penumbra::visibility
