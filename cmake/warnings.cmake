# SPDX-License-Identifier: Apache-2.0
# Every target of Penumbra links this: warnings are errors, in g++ 12 and clang 14.
add_library(penumbra_warnings INTERFACE)
target_compile_options(penumbra_warnings INTERFACE -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Werror)
# Results must not depend on whether the compiler contracts a*b+c: p is defined by plain double arithmetic.
target_compile_options(penumbra_warnings INTERFACE -ffp-contract=off)
# g++ 12's SLP vectoriser drops the rounding of neighbouring double → float → double conversions, by which scene floats
# are made.
target_compile_options(penumbra_warnings INTERFACE $<$<CXX_COMPILER_ID:GNU>:-fno-tree-slp-vectorize>)
# g++ 12 at -O3 falsely warns of overlapping copies in std::string's own operator+ (GCC bug 105651), in Penumbra and in
# libraries alike.
target_compile_options(penumbra_warnings INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>)
# With sanitizers, g++ falsely reports uninitialised values (GCC's manual, -fsanitize=address).
if(PENUMBRA_SANITIZE)
  target_compile_options(penumbra_warnings INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
endif()
