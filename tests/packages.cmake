# The Debian package and the tarball, tried in bare systems that debootstrap makes: as root alone, and with a mirror of Debian.
add_test(NAME packages.try COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/packages/try.sh ${PROJECT_BINARY_DIR} ${PROJECT_BINARY_DIR}/package_systems)
set_tests_properties(packages.try PROPERTIES LABELS full TIMEOUT 3600 RUN_SERIAL ON SKIP_RETURN_CODE 77)
