// SPDX-License-Identifier: Apache-2.0
// penumbra-repair: repairs one mesh in a separate process; the only program here that contains CGAL's GPL packages. Not
// for users: penumbra starts it, passes the mesh as a file and reads its answer from its standard output
// (mesh/repair.cpp).

#include "base/error.hpp"
#include "base/memory.hpp"
#include "mesh/helper_process.hpp"
#include "mesh/input_file.hpp"
#include "mesh/repair_wire.hpp"
#include "repair/run_repair.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <charconv>
#include <cstdio>
#include <new>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

namespace {

using namespace penumbra;

struct Answer {
  mesh::WireWriter head, payload;
  mesh::Repaired repaired;  ///< data that the payload refers to without copying
};

Answer message(mesh::HelperStatus status) {
  return {mesh::answer_head(status), {}, {}};
}

Answer answer_for(int request) {
  try {
    const std::string content = mesh::read_content(request, "the mesh");
    mesh::WireReader from(std::as_bytes(std::span(content)));
    const mesh::RepairRequest asked = mesh::get_repair_request(from);
    Answer answer = message(mesh::HelperStatus::done);
    answer.repaired = repair::run_repair(asked.soup, asked.options);
    mesh::put_repaired(answer.payload, answer.repaired);
    return answer;
  } catch (const std::bad_alloc&) {
    return message(mesh::HelperStatus::out_of_memory);
  } catch (const std::exception& error) {
    Answer answer = message(mesh::HelperStatus::bad_input);
    answer.payload.put_string(error.what());
    return answer;
  }
}

}  // namespace

int main(int argc, char** argv) {
  mesh::HelperTerms terms;
  const std::string_view asker = argc == 2 ? argv[1] : "";
  const auto [end, error] = std::from_chars(asker.data(), asker.data() + asker.size(), terms.asker);
  if (asker.empty() || error != std::errc() || end != asker.data() + asker.size()) {
    fmt::print(stderr, "penumbra-repair repairs meshes for penumbra; it is not meant to be called by hand.\n");
    return static_cast<int>(ExitCode::usage);
  }
  const int output = mesh::begin_helper(terms);
  keep_freed_memory();
  const Answer answer = answer_for(mesh::kFirstHelperFile);
  const bool told = mesh::write_all(output, answer.head) && mesh::write_all(output, answer.payload);
  _exit(told ? 0 : static_cast<int>(ExitCode::resource));
}
