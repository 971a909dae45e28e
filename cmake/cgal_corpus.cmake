# SPDX-License-Identifier: Apache-2.0
# Meshes of Debian's package libcgal-demo, unpacked once into the build tree: real meshes, many with defects.
# penumbra_cgal_corpus(target): defines PENUMBRA_CGAL_CORPUS for the target's code (a folder with meshes/*.off). Without
# the package the folder is empty, and the tests that need it fail with a message.
function(penumbra_cgal_corpus target)
  set(archive /usr/share/doc/libcgal-dev/data.tar.gz)
  set(folder ${PROJECT_BINARY_DIR}/cgal_corpus)
  if(NOT TARGET penumbra_cgal_corpus)
    file(MAKE_DIRECTORY ${folder})
    if(EXISTS ${archive})
      add_custom_command(OUTPUT ${folder}/unpacked
        COMMAND ${CMAKE_COMMAND} -E tar xzf ${archive}
        COMMAND ${CMAKE_COMMAND} -E touch ${folder}/unpacked
        DEPENDS ${archive} WORKING_DIRECTORY ${folder} COMMENT "Unpacking the meshes of libcgal-demo")
      add_custom_target(penumbra_cgal_corpus DEPENDS ${folder}/unpacked)
    else()
      add_custom_target(penumbra_cgal_corpus)
    endif()
  endif()
  add_dependencies(${target} penumbra_cgal_corpus)
  target_compile_definitions(${target} PRIVATE PENUMBRA_CGAL_CORPUS="${folder}/data")
endfunction()
