# SPDX-License-Identifier: Apache-2.0
# Tries the Debian package and the tarball in bare systems made by debootstrap: only as root, and if a mirror of Debian
# is reachable.
add_test(NAME packages.try COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/packages/try.sh ${PROJECT_BINARY_DIR} ${PROJECT_BINARY_DIR}/package_systems)
set_tests_properties(packages.try PROPERTIES LABELS full TIMEOUT 3600 RUN_SERIAL ON SKIP_RETURN_CODE 77)
# Tests what the packages' scripts do with a build of one program only, and with a failing GPU. Small scripts stand in
# for the programs.
add_test(NAME packages.without_repair COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/packages/without_repair.sh)
add_test(NAME packages.gpu_verdict COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/packages/gpu_verdict.sh)
set_tests_properties(packages.without_repair packages.gpu_verdict PROPERTIES LABELS quick)
