# Every target of ours links this: warnings are errors, in g++ 12 and clang 14.
add_library(penumbra_warnings INTERFACE)
target_compile_options(penumbra_warnings INTERFACE -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Werror)
# Results must not depend on whether the compiler contracts a*b+c: p is defined by plain double arithmetic.
target_compile_options(penumbra_warnings INTERFACE -ffp-contract=off)
