# SPDX-License-Identifier: Apache-2.0
# Tests the program as a user meets it: exit codes, messages, files.
penumbra_test(cli FULL *EveryTriple* SHARDS Part/RenderTogether=2 Part/CompareTogether=2
  SOURCES
  cli/alpha.cpp
  cli/asked_samples.cpp
  cli/bake.cpp
  cli/instances.cpp
  cli/bad_input.cpp
  cli/compare.cpp
  cli/compare_further.cpp
  cli/studio.cpp
  cli/sweep.cpp
  cli/covering_array.cpp
  cli/depth_of_field.cpp
  cli/emitters.cpp
  cli/error_budget.cpp
  cli/explain.cpp
  cli/far_lights.cpp
  cli/form_factor_dust.cpp
  cli/method_answers.cpp
  cli/slow_methods.cpp
  cli/exact_by_default.cpp
  cli/exr_layers.cpp
  cli/farm.cpp
  cli/farm_slurm.cpp
  cli/farm_tasks.cpp
  cli/animated_meshes.cpp cli/frames.cpp
  cli/habit.cpp
  cli/help_lines.cpp
  cli/image_methods.cpp
  cli/inspect.cpp
  cli/interpolated_areas.cpp
  cli/mean_bands.cpp
  cli/interrupt.cpp
  cli/light_cutoff.cpp
  cli/lights.cpp
  cli/options.cpp
  cli/options_together.cpp
  cli/options_together_support.cpp
  cli/pixel_filters.cpp
  cli/program.cpp
  cli/public_scenes.cpp
  cli/public_cases.cpp
  cli/render.cpp
  cli/shifted_lens.cpp
  cli/tables.cpp
  cli/wedges.cpp
  cli/without_vulkan.cpp
  cli/moments.cpp
  LIBRARIES penumbra_app penumbra_mesh penumbra_visibility penumbra_base nlohmann_json::nlohmann_json ZLIB::ZLIB)
target_compile_definitions(cli_test PRIVATE PENUMBRA_PROGRAM="$<TARGET_FILE:penumbra>"
  PENUMBRA_PUBLIC_CASES="${CMAKE_CURRENT_SOURCE_DIR}/public_cases")
add_dependencies(cli_test penumbra)
if(PENUMBRA_WITH_CGAL_GPL)
  target_compile_definitions(cli_test PRIVATE PENUMBRA_WITH_CGAL_GPL)
  add_dependencies(cli_test penumbra-repair)
endif()
