// SPDX-License-Identifier: Apache-2.0
// Repairs a mesh in the process `penumbra-repair`, the only program that contains CGAL's GPL packages. The request
// travels through a file in memory, the answer through a pipe.

#include "mesh/repair.hpp"

#include "base/descriptor.hpp"
#include "base/error.hpp"
#include "mesh/helper.hpp"
#include "mesh/repair_wire.hpp"

#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <new>
#include <string>
#include <system_error>

namespace penumbra::mesh {
namespace {

constexpr HelperProgram kRepair{"penumbra-repair", "PENUMBRA_REPAIR_HELPER", "the repair helper",
                                " (target penumbra-repair; not with -DPENUMBRA_WITH_CGAL_GPL=OFF)"};

/// Writes the repair request to a file in memory.
Descriptor file_of(const WireWriter& request) {
  Descriptor file(::memfd_create("penumbra-repair", MFD_CLOEXEC));
  if (!file.is_open() || !write_all(file.get(), request)) {
    throw ResourceError("cannot hand the mesh to {}: {}", kRepair.words, std::generic_category().message(errno));
  }
  return file;
}

void require_good_ending(const HelperEnding& ending) {
  if (WIFSIGNALED(ending.status)) {
    throw ResourceError("{} crashed (signal {}), which is its own fault, whatever is wrong with the mesh{}",
                        kRepair.words, WTERMSIG(ending.status), ending.first_line());
  }
  if (WEXITSTATUS(ending.status) != 0) {
    throw ResourceError("{} gave up (exit code {}){}", kRepair.words, WEXITSTATUS(ending.status), ending.first_line());
  }
}

}  // namespace

void require_repair() {
  require_helper(kRepair);
}

Repaired repair(const TriangleSoup& soup, const RepairOptions& options) {
  if (!(options.weld >= 0) || !std::isfinite(options.weld)) {
    throw UsageError("a welding distance of {} is invalid; give a length of 0 or more", options.weld);
  }
  WireWriter request;
  put_repair_request(request, soup, options);
  const Descriptor file = file_of(request);
  const HelperEnding ending = run_helper(kRepair, {{std::to_string(::getpid())}, {file.get()}});
  require_good_ending(ending);
  try {
    WireReader from(ending.output.all());
    const HelperStatus status = get_status(from);
    if (status == HelperStatus::out_of_memory) throw std::bad_alloc();
    if (status == HelperStatus::bad_input) throw ResourceError("{}: {}", kRepair.words, from.get_string());
    Repaired repaired = get_repaired(from);
    from.expect_end();
    return repaired;
  } catch (const WireError& error) {
    throw ResourceError("the answer of {} is damaged ({})", kRepair.words, error.what());
  }
}

}  // namespace penumbra::mesh
