# SPDX-License-Identifier: Apache-2.0
# Sets `name` to the C++ name of a shader: view_sample.comp → kViewSampleComp, in any folder.
get_filename_component(parts ${NAME} NAME)
string(REPLACE "." "_" parts ${parts})
string(REPLACE "_" ";" parts ${parts})
set(name k)
foreach(part ${parts})
  string(SUBSTRING ${part} 0 1 first)
  string(SUBSTRING ${part} 1 -1 rest)
  string(TOUPPER ${first} first)
  string(APPEND name ${first}${rest})
endforeach()
