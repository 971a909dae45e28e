# The image-based family against closed forms and the twins of its products.
penumbra_test(maps FULL MapsTable.*
  SOURCES
  analytic/maps_closed_form.cpp
  analytic/maps_method.cpp
  analytic/maps_products.cpp
  analytic/maps_resolution_table.cpp
  LIBRARIES penumbra_maps)
target_include_directories(maps_test PRIVATE ${PROJECT_BINARY_DIR}/shaders)
