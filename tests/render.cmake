# SPDX-License-Identifier: Apache-2.0
# Tests of devices and buffers, and of the visibility buffer, compared with its definition.
penumbra_test(render
  SOURCES
  unit/render/buffer.cpp unit/render/device.cpp unit/render/group_order.cpp unit/render/scan_conversion.cpp
  unit/render/visibility_buffer.cpp
  # The shared fixture mentions view-sample mapping, hence the link to penumbra_vsm.
  LIBRARIES penumbra_selftest penumbra_vsm penumbra_reference penumbra_scenes TBB::tbb)
penumbra_shaders(render_test unit/render/group_order.comp)
# The second rasteriser's replacement in builds without it.
penumbra_test(opengl_absent SOURCES unit/opengl_absent.cpp LIBRARIES penumbra_opengl_absent)
