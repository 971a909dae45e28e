# The image-based family against closed forms and the twins of its products.
penumbra_test(maps FULL MapsTable.*
  SOURCES
  analytic/maps_adaptive_light.cpp
  analytic/maps_backproject.cpp
  analytic/maps_bitmask.cpp
  analytic/maps_closed_form.cpp
  analytic/maps_filters_robust.cpp
  analytic/maps_formulas.cpp
  analytic/maps_layers.cpp
  analytic/maps_contour.cpp
  analytic/maps_contour_claims.cpp
  analytic/maps_light_table.cpp
  analytic/maps_light_tree.cpp
  analytic/maps_lists.cpp
  analytic/maps_method.cpp
  analytic/maps_moments.cpp
  analytic/maps_pcf.cpp
  analytic/maps_predicates.cpp
  analytic/maps_prefilter.cpp
  analytic/maps_peel.cpp
  analytic/maps_products.cpp
  analytic/maps_pyramids.cpp
  analytic/maps_rasterisers.cpp
  analytic/maps_repairs.cpp
  analytic/maps_resolution_table.cpp
  analytic/maps_slices.cpp
  analytic/maps_soft_shadow_map.cpp
  analytic/maps_subsampled.cpp
  LIBRARIES penumbra_selftest penumbra_maps penumbra_scenes penumbra_vsm penumbra_reference TBB::tbb)
target_include_directories(maps_test PRIVATE ${PROJECT_BINARY_DIR}/shaders)
target_compile_definitions(maps_test PRIVATE PENUMBRA_DOCS="${PROJECT_SOURCE_DIR}/docs")
