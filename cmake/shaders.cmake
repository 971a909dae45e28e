# SPDX-License-Identifier: Apache-2.0
find_program(GLSLANG glslangValidator REQUIRED)
find_program(SPIRV_VAL spirv-val REQUIRED)

# penumbra_shader_output(file ending path output): sets the file's path from the root, and the path of its generated
# output.
function(penumbra_shader_output source ending path output)
  file(RELATIVE_PATH from_root ${PROJECT_SOURCE_DIR} ${CMAKE_CURRENT_SOURCE_DIR}/${source})
  set(made ${PROJECT_BINARY_DIR}/shaders/${from_root}.${ending})
  get_filename_component(folder ${made} DIRECTORY)
  file(MAKE_DIRECTORY ${folder})
  set(${path} ${from_root} PARENT_SCOPE)
  set(${output} ${made} PARENT_SCOPE)
endfunction()

# penumbra_embedded(target header…): builds the target with these headers on its include path. They are a separate
# target: commands of `target` itself would wait for the libraries that it links, and the objects of all targets that
# link it would wait for these commands.
function(penumbra_embedded target)
  get_property(count GLOBAL PROPERTY PENUMBRA_EMBEDDED)
  math(EXPR count "0${count} + 1")
  set_property(GLOBAL PROPERTY PENUMBRA_EMBEDDED ${count})
  add_custom_target(${target}_embedded_${count} DEPENDS ${ARGN})
  add_dependencies(${target} ${target}_embedded_${count})
  target_include_directories(${target} PRIVATE ${PROJECT_BINARY_DIR}/shaders)
endfunction()

# penumbra_shaders(target file.comp [file.frag …])
# Compiles GLSL to SPIR-V with glslang (true dependencies through a depfile), validates it with spirv-val and embeds
# it as "<folder>/<name>.<stage>.spv.hpp" with `inline constexpr std::uint32_t k<Name><Stage>[]`, on the target's include path.
function(penumbra_shaders target)
  set(headers)
  foreach(source ${ARGN})
    penumbra_shader_output(${source} spv path spirv)
    set(header ${spirv}.hpp)
    add_custom_command(
      OUTPUT ${spirv} ${header}  # the depfile names the SPIR-V: it must come first, or ninja rebuilds every time
      COMMAND ${GLSLANG} --quiet -V --target-env vulkan1.3 -I${PROJECT_SOURCE_DIR} --depfile ${spirv}.d
              -o ${spirv} ${CMAKE_CURRENT_SOURCE_DIR}/${source}
      COMMAND ${SPIRV_VAL} --target-env vulkan1.3 --scalar-block-layout ${spirv}
      COMMAND ${CMAKE_COMMAND} -DSPIRV=${spirv} -DHEADER=${header} -DNAME=${source} -P ${PROJECT_SOURCE_DIR}/cmake/embed.cmake
      DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${source} ${PROJECT_SOURCE_DIR}/cmake/embed.cmake
      DEPFILE ${spirv}.d
      COMMENT "shader ${path}"
      VERBATIM)
    list(APPEND headers ${header})
  endforeach()
  penumbra_embedded(${target} ${headers})
endfunction()

# penumbra_opengl_shaders(target file.vert …)
# Embeds the same sources for OpenGL, as text: includes are resolved, PENUMBRA_OPENGL is defined, and glslang checks the
# result as GLSL 4.50. Embedded as "<folder>/<name>.<stage>.glsl.hpp" with `inline constexpr std::string_view
# k<Name><Stage>Text`.
function(penumbra_opengl_shaders target)
  set(headers)
  foreach(source ${ARGN})
    penumbra_shader_output(${source} glsl.hpp path header)
    add_custom_command(
      OUTPUT ${header}
      COMMAND ${CMAKE_COMMAND} -DGLSLANG=${GLSLANG} -DROOT=${PROJECT_SOURCE_DIR} -DSOURCE=${CMAKE_CURRENT_SOURCE_DIR}/${source}
              -DHEADER=${header} -DNAME=${source} -P ${PROJECT_SOURCE_DIR}/cmake/embed_glsl.cmake
      DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${source} ${PROJECT_SOURCE_DIR}/cmake/embed_glsl.cmake
      DEPFILE ${header}.d
      COMMENT "OpenGL shader ${path}"
      VERBATIM)
    list(APPEND headers ${header})
  endforeach()
  penumbra_embedded(${target} ${headers})
endfunction()
