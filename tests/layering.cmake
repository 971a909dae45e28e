# cmake -DROOT=… -P layering.cmake: fails on an include that runs against the arrows of ARCHITECTURE.md, on a quoted
# include that does not start at the root, and on a library that leaves the room it is kept in.
# cmake -DSELF_TEST=folder -P layering.cmake: plants one violation of each kind and expects to catch it.
cmake_minimum_required(VERSION 3.25)

# What each room may include beside itself. Families (volumes, vsm, maps) never include one another.
set(may_base)
set(may_mesh base)
set(may_scenes mesh base)
set(may_visibility scenes mesh base)
set(may_render visibility scenes mesh base)
set(may_native render visibility scenes mesh base)
set(may_volumes native render visibility scenes mesh base)
set(may_vsm native render visibility scenes mesh base)
set(may_maps render visibility scenes mesh base)
set(may_reference visibility scenes mesh base)
set(may_compare visibility scenes mesh base)
set(may_app compare reference maps vsm volumes native render visibility scenes mesh base)
set(may_bench app ${may_app})
set(may_tests app bench ${may_app})
set(rooms base mesh scenes visibility render native volumes vsm maps reference compare app bench tests)

# Which rooms may see a library's headers; everywhere else only plain structs cross. In no .hpp but those that say
# "Internal to this room" or "Inside <room>/ only".
set(kept_vulkan render)
set(kept_spirv_cross render)
set(kept_CGAL mesh visibility reference)
set(kept_OpenMesh mesh)
set(kept_embree3 visibility reference bench)
set(kept_assimp mesh)
set(kept_pugixml mesh)
set(kept_minizip mesh tests)
set(kept_tiny_gltf mesh scenes)
set(kept_valijson scenes)
set(kept_OpenEXR base)
set(kept_png base)
set(kept_CLI app)
set(kept_gmpxx volumes reference)
set(kept_hwy native volumes vsm)
set(libraries vulkan spirv_cross CGAL OpenMesh embree3 assimp pugixml minizip tiny_gltf valijson OpenEXR png CLI gmpxx hwy)

# check(root result): a list of complaints, one a wrong include.
function(check root result)
  set(complaints)
  foreach(room ${rooms})
    file(GLOB_RECURSE files RELATIVE ${root} ${root}/${room}/*.hpp ${root}/${room}/*.cpp ${root}/${room}/*.h
         ${root}/${room}/*.comp ${root}/${room}/*.vert ${root}/${room}/*.frag ${root}/${room}/*.glsl)
    foreach(file ${files})
      file(STRINGS ${root}/${file} internal REGEX "Internal to this room|Inside ${room}/ only" LIMIT_COUNT 1)
      file(STRINGS ${root}/${file} includes REGEX "^[ \t]*#[ \t]*include")
      foreach(line ${includes})
        if(line MATCHES "include[ \t]*\"([^\"]+)\"")
          set(path ${CMAKE_MATCH_1})
          string(REGEX MATCH "^[^/]+" target ${path})
          if(path MATCHES "\\.spv\\.hpp$" AND target STREQUAL room)
            # a shader of this room, embedded by the build
          elseif(NOT path MATCHES "/" OR NOT target IN_LIST rooms)
            list(APPEND complaints "${file}: \"${path}\": a quoted include starts at the root with a room's name")
          elseif(NOT target STREQUAL room AND NOT target IN_LIST may_${room})
            string(REPLACE ";" ", " allowed "${may_${room}}")
            list(APPEND complaints "${file}: includes \"${path}\", but ${room} may lean only on: ${allowed}")
          elseif(target STREQUAL tests AND NOT room STREQUAL tests)
            list(APPEND complaints "${file}: includes \"${path}\": tests are included by tests only")
          endif()
        elseif(line MATCHES "include[ \t]*<([A-Za-z0-9_]+)[./]")
          set(library ${CMAKE_MATCH_1})
          if(library IN_LIST libraries AND NOT room STREQUAL tests)
            if(NOT room IN_LIST kept_${library})
              string(REPLACE ";" ", " allowed "${kept_${library}}")
              list(APPEND complaints "${file}: includes <${library}…>, which is kept inside: ${allowed}")
            elseif(file MATCHES "\\.hpp$" AND NOT internal)
              list(APPEND complaints "${file}: <${library}…> in a header: its types stay inside .cpp files")
            endif()
          endif()
        endif()
      endforeach()
    endforeach()
  endforeach()
  set(${result} "${complaints}" PARENT_SCOPE)
endfunction()

if(SELF_TEST)
  file(REMOVE_RECURSE ${SELF_TEST})
  file(WRITE ${SELF_TEST}/base/a.hpp "#include \"mesh/soup.hpp\"\n")            # against the arrow
  file(WRITE ${SELF_TEST}/vsm/a.cpp "#include \"maps/pcss.hpp\"\n")             # one family on another
  file(WRITE ${SELF_TEST}/mesh/a.cpp "#include \"soup.hpp\"\n")                 # not from the root
  file(WRITE ${SELF_TEST}/vsm/b.comp "  #  include \"app/runner.hpp\"\n")       # in a shader
  file(WRITE ${SELF_TEST}/maps/a.cpp "#include <vulkan/vulkan_raii.hpp>\n")     # a library outside its room
  file(WRITE ${SELF_TEST}/reference/a.hpp "#include <embree3/rtcore.h>\n")      # a library in a header
  file(WRITE ${SELF_TEST}/app/fine.cpp "#include \"base/error.hpp\"\n#include <vector>\n#include <CLI/CLI.hpp>\n")
  check(${SELF_TEST} complaints)
  list(LENGTH complaints count)
  if(NOT count EQUAL 6)
    list(JOIN complaints "\n  " text)
    message(FATAL_ERROR "expected 6 complaints, got ${count}:\n  ${text}")
  endif()
  return()
endif()

check(${ROOT} complaints)
if(complaints)
  list(JOIN complaints "\n  " text)
  message(FATAL_ERROR "the layering is broken:\n  ${text}")
endif()
