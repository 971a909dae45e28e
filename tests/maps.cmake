# SPDX-License-Identifier: Apache-2.0
# Tests of the image-based family, compared with closed forms and with second implementations of its intermediate
# results.
penumbra_test(maps FULL MapsTable.*
  SOURCES
  analytic/maps/adaptive_light.cpp
  analytic/maps/adaptive_light_maps.cpp
  analytic/maps/box_means.cpp
  analytic/maps/closed_form.cpp
  analytic/maps/degenerate.cpp
  analytic/maps/dome_suns.cpp
  analytic/maps/every_light.cpp analytic/maps/every_light_holes.cpp
  analytic/maps/filters_robust.cpp
  analytic/maps/forward_map.cpp
  analytic/maps/formulas.cpp
  analytic/maps/history.cpp
  analytic/maps/identities.cpp
  analytic/maps/layers.cpp
  analytic/maps/left_out.cpp
  analytic/maps/light_identities.cpp
  analytic/maps/light_tree.cpp
  analytic/maps/list_bounds.cpp
  analytic/maps/list_geometry.cpp
  analytic/maps/layered_attenuation.cpp
  analytic/maps/lists.cpp
  analytic/maps/map_fit_forms.cpp
  analytic/maps/map_fits.cpp
  analytic/maps/method.cpp
  analytic/maps/moments.cpp
  analytic/maps/silhouette_map.cpp
  analytic/maps/texel_widths.cpp
  analytic/maps/vssm_windows.cpp
  analytic/maps/pcf.cpp
  analytic/maps/pcf_forms.cpp
  analytic/maps/predicates.cpp
  analytic/maps/prefilter.cpp
  analytic/maps/products.cpp
  analytic/maps/pyramids.cpp
  analytic/maps/rasterisers.cpp
  analytic/maps/receiver_plane.cpp
  analytic/maps/repairs.cpp
  analytic/maps/resolution_table.cpp
  analytic/maps/shapes.cpp
  analytic/maps/single_shadow.cpp
  analytic/maps/single_shadow_twins.cpp
  analytic/maps/slices.cpp
  analytic/maps/backprojection/backproject.cpp
  analytic/maps/backprojection/bitmask.cpp
  analytic/maps/backprojection/bitmask_predicates.cpp
  analytic/maps/backprojection/contour.cpp
  analytic/maps/backprojection/contour_variants.cpp
  analytic/maps/backprojection/contour_texture.cpp
  analytic/maps/backprojection/contour_claims.cpp
  analytic/maps/backprojection/fusion.cpp
  analytic/maps/backprojection/horizon.cpp
  analytic/maps/backprojection/layer_rays.cpp
  analytic/maps/backprojection/light_table.cpp
  analytic/maps/backprojection/packet_costs.cpp
  analytic/maps/backprojection/peel.cpp
  analytic/maps/backprojection/soft_shadow_map.cpp
  analytic/maps/backprojection/soft_shadow_map_errors.cpp
  analytic/maps/backprojection/sphere_form.cpp
  analytic/maps/backprojection/subsampled.cpp
  analytic/maps/backprojection/umbra.cpp
  analytic/maps/backprojection/view_fits.cpp
  LIBRARIES penumbra_selftest penumbra_maps penumbra_scenes penumbra_volumes penumbra_vsm penumbra_reference TBB::tbb)
penumbra_shaders(maps_test analytic/maps/backprojection/lens.comp analytic/maps/box_means.comp analytic/maps/box_windows.comp)
target_compile_definitions(maps_test PRIVATE PENUMBRA_DOCS="${PROJECT_SOURCE_DIR}/docs")
