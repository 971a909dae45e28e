# SPDX-License-Identifier: Apache-2.0
# Runs every method under AddressSanitizer and UndefinedBehaviorSanitizer, in a separate build.
add_test(NAME sanitizers.smoke
         COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/sanitizers/smoke.sh ${PROJECT_SOURCE_DIR} ${PROJECT_BINARY_DIR}/sanitizers)
set_tests_properties(sanitizers.smoke PROPERTIES LABELS full RUN_SERIAL ON TIMEOUT 7200)
add_test(NAME style.temporaries
         COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/style/temporaries.sh ${PROJECT_SOURCE_DIR} ${PROJECT_BINARY_DIR})
set_tests_properties(style.temporaries PROPERTIES LABELS full RUN_SERIAL ON TIMEOUT 7200)
