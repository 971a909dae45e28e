// SPDX-License-Identifier: Apache-2.0
// Fuzzes small adversarial scenes: compares every bit of every method that promises the truth with a judge that shares
// no code with them.
#include "tests/fuzz/bytes.hpp"
#include "tests/fuzz/soup_methods.hpp"

#include <cstdio>
#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  // Making drivers and pipelines takes far longer than judging a case.
  static const penumbra::render::Device device(penumbra::render::DeviceOptions{});
  static penumbra::fuzz::SoupMethods methods(device);
  const auto judged = penumbra::fuzz::read_soup_case({data, size});
  if (!judged) return 0;
  const penumbra::fuzz::SoupFindings found = methods.check(*judged);
  if (found.wrong == 0) return 0;
  std::fprintf(stderr, "%llu wrong, the first: %s\n", static_cast<unsigned long long>(found.wrong),
               found.first_wrong.c_str());
  std::abort();
}
