# SPDX-License-Identifier: Apache-2.0
# Tests of the live view: which requests its server lets in, its state and messages, packets for tev; then the program
# from outside, by a bare client (Python's standard library), and its page in headless Chromium.
penumbra_test(view
  SOURCES unit/view/file_watch.cpp unit/view/light_json.cpp unit/view/light_outline.cpp unit/view/live_state.cpp unit/view/pace.cpp unit/view/requests.cpp unit/view/space_meshes.cpp unit/view/space_shadows.cpp unit/view/tev_packets.cpp
  LIBRARIES penumbra_app penumbra_network nlohmann_json::nlohmann_json)
set(live ${CMAKE_CURRENT_SOURCE_DIR}/live)
add_test(NAME view.protocol COMMAND ${Python3_EXECUTABLE} ${live}/live_protocol.py $<TARGET_FILE:penumbra>)
add_test(NAME view.tev COMMAND ${Python3_EXECUTABLE} ${live}/tev_pictures.py $<TARGET_FILE:penumbra>)
add_test(NAME view.space COMMAND ${Python3_EXECUTABLE} ${live}/live_space.py $<TARGET_FILE:penumbra>)
add_test(NAME view.clients COMMAND ${Python3_EXECUTABLE} ${live}/live_clients.py $<TARGET_FILE:penumbra>)
set_tests_properties(view.protocol view.tev view.space view.clients PROPERTIES LABELS quick TIMEOUT 300)
add_test(NAME view.page
         COMMAND ${Python3_EXECUTABLE} ${live}/live_page.py $<TARGET_FILE:penumbra> ${PROJECT_SOURCE_DIR}/scenes
                 ${PROJECT_BINARY_DIR}/view_photographs)
add_test(NAME view.space_page
         COMMAND ${Python3_EXECUTABLE} ${live}/live_space_page.py $<TARGET_FILE:penumbra> ${PROJECT_SOURCE_DIR}/scenes
                 ${PROJECT_BINARY_DIR}/view_photographs)
add_test(NAME view.moving
         COMMAND ${Python_EXECUTABLE} ${live}/live_moving.py $<TARGET_FILE:penumbra> ${PROJECT_SOURCE_DIR}/scenes/bunny.json
                 ${PROJECT_BINARY_DIR}/view_photographs/moving.webp)
set_tests_properties(view.page view.space_page view.moving PROPERTIES LABELS full TIMEOUT 900)
