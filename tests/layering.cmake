# SPDX-License-Identifier: Apache-2.0
# cmake -DROOT=… -P layering.cmake: fails on an include that runs against the arrows of ARCHITECTURE.md, on a quoted
# include that does not start at the root, and on a library that is included outside the room it is kept in.
# cmake -DSELF_TEST=folder -P layering.cmake: plants one violation of each kind and expects to catch it.
cmake_minimum_required(VERSION 3.25)

# The rooms that each room may include, apart from itself. A room is a folder; one named with a slash is a room inside
# another, and a folder that is not named here belongs to the room around it. Families (volumes/…, vsm, maps) never
# include one another.
set(may_base)
set(may_network base)
set(may_mesh base)
set(may_mesh/diagnosis mesh base)
set(may_repair mesh base)
set(may_mesh/shapes mesh/diagnosis mesh base)
set(may_scenes mesh base)
set(may_scenes/formats scenes mesh/shapes mesh base)
set(may_import/gltf/emitters scenes mesh base)
set(may_import/gltf import/gltf/emitters scenes/formats scenes mesh base)
set(may_import import/gltf import/gltf/emitters scenes/formats scenes mesh base)
set(may_visibility scenes mesh/diagnosis mesh base)
set(may_visibility/tree visibility scenes mesh base)
set(may_visibility/skies visibility scenes base)
set(may_visibility/lights visibility/skies visibility/tree visibility scenes mesh base)
set(may_visibility/masks visibility/skies visibility base)
set(may_visibility/alpha visibility/tree visibility scenes mesh base)
set(may_visibility/seen visibility scenes mesh base)
set(all_visibility visibility/seen visibility/alpha visibility/masks visibility/lights visibility/skies visibility/tree visibility)
set(may_areas ${all_visibility} scenes mesh base)
set(may_render/opengl base)
set(may_render render/opengl ${all_visibility} scenes mesh base)
set(may_engines/vectors ${all_visibility} scenes mesh base)
set(may_engines/pairs ${all_visibility} scenes mesh base)
set(may_engines/device render ${all_visibility} scenes mesh base)
set(may_engines engines/device engines/vectors render ${all_visibility} scenes mesh base)
set(may_volumes/wedges ${all_visibility} scenes/formats scenes mesh base)
set(may_volumes/edges ${all_visibility} scenes mesh base)
set(may_volumes/edges/device volumes/edges engines/device render ${all_visibility} scenes mesh base)
set(may_volumes/edges/vectors volumes/edges engines/vectors ${all_visibility} scenes mesh base)
set(signed_edges volumes/edges/device volumes/edges/vectors volumes/edges)
set(may_volumes/raster volumes/edges/device volumes/edges volumes/wedges render ${all_visibility} scenes mesh base)
set(may_volumes/soft engines/pairs volumes/raster volumes/edges volumes/wedges render ${all_visibility} scenes mesh base)
# Two methods of signed edges, which do not include each other: their common code is in volumes/edges.
set(may_volumes/scatter areas ${signed_edges} engines engines/device engines/vectors render ${all_visibility} scenes mesh base)
set(may_volumes/counters ${signed_edges} volumes/raster volumes/wedges engines engines/device engines/vectors render ${all_visibility} scenes mesh base)
set(may_volumes volumes/scatter volumes/counters volumes/soft engines render ${all_visibility} scenes mesh base)
set(may_vsm engines engines/device engines/vectors engines/pairs render ${all_visibility} scenes mesh base)
set(may_maps/host render/opengl render ${all_visibility} scenes mesh base)
set(may_maps/products maps/host render/opengl render ${all_visibility} scenes mesh base)
set(may_maps/products/lists ${may_maps/products} maps/products)
set(may_maps/filters maps/products maps/host render ${all_visibility} scenes mesh base)
set(may_maps/sampling maps/products/lists maps/products maps/host render ${all_visibility} scenes mesh base)
set(may_maps/single_shadow maps/products maps/host render/opengl render ${all_visibility} scenes mesh base)
set(may_maps/screen maps/host render ${all_visibility} scenes mesh base)
set(may_maps/backprojection maps/products maps/host render ${all_visibility} scenes mesh base)
foreach(room patches contours soft_shadow_map)
  set(may_maps/backprojection/${room} ${may_maps/backprojection} maps/backprojection)
endforeach()
list(APPEND may_maps/backprojection/soft_shadow_map maps/backprojection/patches)  # self=backproject
set(may_maps maps/host maps/filters maps/sampling maps/single_shadow maps/screen maps/backprojection/patches maps/backprojection/contours maps/backprojection/soft_shadow_map engines render ${all_visibility} scenes mesh base)
set(may_hybrids volumes/soft volumes/raster maps/filters maps/host engines render ${all_visibility} scenes mesh base)
set(may_selftest maps/products/lists maps/products maps/host vsm engines/vectors volumes/scatter volumes/counters volumes/raster ${signed_edges} volumes/wedges render/opengl render
    ${all_visibility} scenes mesh/shapes mesh base)
set(may_reference areas engines render ${all_visibility} scenes mesh base)
set(may_compare ${all_visibility} scenes mesh base)
set(may_session/process render base)
set(may_session session/process network compare reference areas engines engines/vectors hybrids maps vsm volumes volumes/wedges render/opengl render ${all_visibility}
    scenes/formats scenes mesh/diagnosis mesh base)
foreach(room pictures comparison inspect wedges)
  set(may_session/${room} ${may_session} session)
endforeach()
list(APPEND may_session/comparison session/pictures)
set(all_session session/pictures session/comparison session/inspect session/wedges session/process session)
set(may_app/process ${may_session/process} session/process)
set(may_app app/process selftest ${all_session} ${may_session})
foreach(room bake commands compare farm inspect serve sweep view wedges)
  set(may_app/${room} ${may_app} app)
endforeach()
list(APPEND may_app/sweep app/compare)
list(APPEND may_app/view app/inspect)
list(APPEND may_app/serve app/view)
set(may_library ${all_session} compare render ${all_visibility}
    scenes/formats scenes mesh base)
set(may_python)
set(may_bench app/process ${all_session} ${may_session} volumes/raster volumes/edges mesh/shapes)
set(rooms base network mesh mesh/diagnosis mesh/shapes repair scenes scenes/formats import import/gltf import/gltf/emitters visibility
    visibility/tree visibility/skies visibility/lights
    visibility/masks visibility/alpha visibility/seen areas render/opengl render engines/device engines/vectors engines/pairs engines
    volumes/wedges volumes/edges/device volumes/edges/vectors volumes/edges volumes/raster volumes/soft volumes/counters volumes/scatter volumes vsm maps/host maps/products maps/products/lists
    maps/filters maps/sampling maps/single_shadow maps/screen maps/backprojection maps/backprojection/patches maps/backprojection/contours
    maps/backprojection/soft_shadow_map maps hybrids selftest reference compare
    session/process session session/pictures session/comparison session/inspect session/wedges app/process app app/bake app/commands app/compare app/sweep app/view app/serve app/farm app/inspect app/wedges library python bench)
set(may_tests import ${rooms})
list(APPEND rooms tests)

# Rooms that may include a library's headers, as may the rooms inside them; all other rooms exchange only plain structs
# with them. No .hpp may include these headers, except those that say "Internal to this room" or "Inside <room>/ only".
set(kept_vulkan render)
set(kept_spirv_cross render)
set(kept_EGL render/opengl)
set(kept_GL render/opengl)
set(kept_CGAL mesh repair visibility)  # packages under the GPL only in repair, which unit/repair/licence.py tests
set(kept_OpenMesh mesh)
set(kept_embree3 reference bench)
set(kept_assimp import)
set(kept_pugixml import)
set(kept_minizip tests)
set(kept_tiny_gltf import scenes/formats)
set(kept_valijson tests)
set(kept_OpenEXR base)
set(kept_libdeflate base)
set(kept_png base)
set(kept_jpeglib base)
set(kept_CLI app)
set(kept_boost network)
set(kept_gmpxx volumes areas)
set(kept_hwy visibility/lights visibility/seen visibility/tree engines/vectors engines/pairs volumes/edges volumes/scatter volumes/counters vsm tests)
set(libraries vulkan spirv_cross EGL GL CGAL OpenMesh embree3 assimp pugixml minizip tiny_gltf valijson OpenEXR libdeflate png jpeglib CLI boost gmpxx hwy)

# room_of(folder result): sets result to the innermost room that is the folder or contains it; to nothing if none does.
function(room_of folder result)
  while(folder AND NOT folder IN_LIST rooms)
    cmake_path(GET folder PARENT_PATH folder)
  endwhile()
  set(${result} "${folder}" PARENT_SCOPE)
endfunction()

# keeps(library room result): sets result to whether the room may include the library's headers.
function(keeps library room result)
  set(${result} FALSE PARENT_SCOPE)
  while(room)
    if(room IN_LIST kept_${library})
      set(${result} TRUE PARENT_SCOPE)
    endif()
    cmake_path(GET room PARENT_PATH room)
  endwhile()
endfunction()

# check(root result): sets result to a list of complaints, one for each wrong include.
function(check root result)
  set(complaints)
  set(folders ${rooms})
  list(TRANSFORM folders REPLACE "/.*" "")  # top-level folders only: they include those inside
  list(REMOVE_DUPLICATES folders)
  foreach(top ${folders})
    file(GLOB_RECURSE files RELATIVE ${root} ${root}/${top}/*.hpp ${root}/${top}/*.cpp ${root}/${top}/*.h
         ${root}/${top}/*.comp ${root}/${top}/*.vert ${root}/${top}/*.frag ${root}/${top}/*.glsl)
    foreach(file ${files})
      cmake_path(GET file PARENT_PATH folder)
      room_of("${folder}" room)
      file(STRINGS ${root}/${file} internal REGEX "Internal to (this room|(${room}|${top})/)|Inside (${room}|${top})/ only" LIMIT_COUNT 1)
      file(STRINGS ${root}/${file} includes REGEX "^[ \t]*#[ \t]*include")
      foreach(line ${includes})
        if(line MATCHES "include[ \t]*\"([^\"]+)\"")
          set(path ${CMAKE_MATCH_1})
          cmake_path(GET path PARENT_PATH target)
          room_of("${target}" target)
          if(path MATCHES "\\.spv\\.hpp$" AND target STREQUAL room)
            # a shader of this room, embedded by the build
          elseif(NOT target)
            list(APPEND complaints "${file}: \"${path}\": a quoted include starts at the root with a room's name")
          elseif(NOT target STREQUAL room AND NOT target IN_LIST may_${room})
            string(REPLACE ";" ", " allowed "${may_${room}}")
            list(APPEND complaints "${file}: includes \"${path}\", but ${room} may depend only on: ${allowed}")
          elseif(target STREQUAL tests AND NOT room STREQUAL tests)
            list(APPEND complaints "${file}: includes \"${path}\": tests are included by tests only")
          endif()
        elseif(line MATCHES "include[ \t]*<([A-Za-z0-9_]+)[./]")
          set(library ${CMAKE_MATCH_1})
          if(library IN_LIST libraries AND NOT room STREQUAL tests)
            keeps(${library} ${room} kept)
            if(NOT kept)
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
  file(WRITE ${SELF_TEST}/base/a.hpp "#include \"mesh/soup.hpp\"\n")            # against the direction of an arrow
  file(WRITE ${SELF_TEST}/vsm/a.cpp "#include \"maps/filters/methods.hpp\"\n")          # one family includes another
  file(WRITE ${SELF_TEST}/mesh/a.cpp "#include \"soup.hpp\"\n")                 # a path that does not start at the root
  file(WRITE ${SELF_TEST}/vsm/b.comp "  #  include \"session/runner.hpp\"\n")       # a wrong include in a shader
  file(WRITE ${SELF_TEST}/maps/host/a.cpp "#include <vulkan/vulkan_raii.hpp>\n")     # a library outside its room
  file(WRITE ${SELF_TEST}/reference/a.hpp "#include <embree3/rtcore.h>\n")      # a library in a header
  file(WRITE ${SELF_TEST}/mesh/a.hpp "#include \"mesh/diagnosis/diagnosis.hpp\"\n")     # a room includes a room inside it that depends on it
  file(WRITE ${SELF_TEST}/volumes/edges/a.hpp "#include \"volumes/scatter/a.hpp\"\n")  # one room of a family includes another
  file(WRITE ${SELF_TEST}/volumes/counters/a.hpp "#include \"volumes/scatter/vectors/scatter.hpp\"\n")  # siblings: neither may include the other
  file(WRITE ${SELF_TEST}/volumes/scatter/a.hpp "#include \"volumes/counters/depth_counters.hpp\"\n")
  file(WRITE ${SELF_TEST}/app/fine.cpp "#include \"base/error.hpp\"\n#include <vector>\n#include <CLI/CLI.hpp>\n")
  check(${SELF_TEST} complaints)
  list(LENGTH complaints count)
  if(NOT count EQUAL 10)
    list(JOIN complaints "\n  " text)
    message(FATAL_ERROR "expected 10 complaints, got ${count}:\n  ${text}")
  endif()
  return()
endif()

check(${ROOT} complaints)
if(complaints)
  list(JOIN complaints "\n  " text)
  message(FATAL_ERROR "the layering is broken:\n  ${text}")
endif()
