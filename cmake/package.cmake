# SPDX-License-Identifier: Apache-2.0
# `cpack` in the build folder makes a Debian package of the files installed by `cmake --install`: programs, library,
# headers, Python module, manual pages, completions. Its dependencies are determined by dpkg-shlibdeps from the files.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME penumbra)
set(CPACK_PACKAGE_CONTACT "The Penumbra maintainers <maintainers@users.noreply.example>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "Exact and approximate soft shadows from area lights")
set(CPACK_PACKAGE_DESCRIPTION "Penumbra says how much of an area light each visible point sees: exactly, by geometry, and by the
published shadow-volume, view-sample and image-based methods, on the same points, so that each method's error can be measured. It renders,
compares, bakes lightmaps, and says what is wrong with a mesh.")
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${PROJECT_BINARY_DIR})
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "mesa-vulkan-drivers, libegl-mesa0, libgl1-mesa-dri, python3-numpy")
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "glmark2-data")  # the mesh of scenes/bunny.json
include(CPack)
