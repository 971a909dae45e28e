// SPDX-License-Identifier: Apache-2.0
// Fuzzes the OFF reader with any text: the result is an InputError, or a mesh in which everything is in range.
#include "base/error.hpp"
#include "import/off.hpp"
#include "tests/fuzz/bytes.hpp"
#include "tests/fuzz/imported.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    penumbra::fuzz::check_imported(
        penumbra::import::read_off_text({reinterpret_cast<const char*>(data), size}, "fuzz.off"));
  } catch (const penumbra::InputError&) {
  }
  return 0;
}
