# SPDX-License-Identifier: Apache-2.0
# Tests the report's page in headless Chromium, driven by Python's standard library through the browser's own pipe.
find_package(Python3 REQUIRED COMPONENTS Interpreter)
add_test(NAME browser.report
         COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/browser/report_page.py $<TARGET_FILE:penumbra>
                 ${PROJECT_SOURCE_DIR}/scenes/room.json ${PROJECT_BINARY_DIR}/report_photographs)
set_tests_properties(browser.report PROPERTIES LABELS full TIMEOUT 900)
add_test(NAME browser.report_numbers
         COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/browser/report_numbers.py $<TARGET_FILE:penumbra>
                 ${PROJECT_SOURCE_DIR}/scenes/room.json ${PROJECT_BINARY_DIR}/report_photographs)
set_tests_properties(browser.report_numbers PROPERTIES LABELS full TIMEOUT 900)
add_test(NAME browser.pages_open COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/browser/pages_open.py $<TARGET_FILE:penumbra>)
set_tests_properties(browser.pages_open PROPERTIES LABELS quick TIMEOUT 300)
