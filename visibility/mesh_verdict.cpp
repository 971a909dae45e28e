// SPDX-License-Identifier: Apache-2.0
// Makes the text of a method's verdict on a mesh: a sentence of the method, then the counts of the defects that matter
// to it. Not from a paper; docs/defects.md has the verdicts of all methods.

#include "visibility/mesh_verdict.hpp"

#include <fmt/format.h>

namespace penumbra::visibility {

const char* name_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::exact:
      return "exact";
    case Verdict::conservative:
      return "conservative";
    case Verdict::approximate:
      return "approximate";
    case Verdict::refused:
      return "refused";
  }
  return "?";
}

std::string reason_with(std::string_view sentence, const mesh::Diagnosis& mesh, std::initializer_list<Remark> remarks) {
  std::string reason(sentence);
  const auto add = [&](const Remark& remark) {
    if (remark.count > 0) reason += fmt::format("; {}: {}", remark.what, remark.count);
  };
  for (const Remark& remark : remarks) add(remark);
  add({mesh.vertices_lost, "vertices that fall on others in single precision"});
  add({mesh.triangles_lost, "triangles that lose their area in single precision and cast nothing"});
  return reason;
}

}  // namespace penumbra::visibility
