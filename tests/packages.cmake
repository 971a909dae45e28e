# SPDX-License-Identifier: Apache-2.0
# The Debian package and the tarball, tried in bare systems that debootstrap makes: as root alone, and with a mirror of Debian.
add_test(NAME packages.try COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/packages/try.sh ${PROJECT_BINARY_DIR} ${PROJECT_BINARY_DIR}/package_systems)
set_tests_properties(packages.try PROPERTIES LABELS full TIMEOUT 3600 RUN_SERIAL ON SKIP_RETURN_CODE 77)
# Tests what the packages' scripts do with a build of one program, and with a GPU that fails: words stand for programs.
add_test(NAME packages.without_repair COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/packages/without_repair.sh)
add_test(NAME packages.gpu_verdict COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/packages/gpu_verdict.sh)
set_tests_properties(packages.without_repair packages.gpu_verdict PROPERTIES LABELS quick)
