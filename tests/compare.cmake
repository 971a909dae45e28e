# SPDX-License-Identifier: Apache-2.0
# Tests of error metrics, pictures and reports, of form factors, and of the beauty that is computed from them. No
# device.
find_package(hwy REQUIRED)
penumbra_test(compare
  SOURCES
  agreement/radiance_near_light.cpp
  analytic/form_factor_closed_forms.cpp
  analytic/radiance_exact.cpp
  analytic/whole_form_factors.cpp
  unit/compare/beauty.cpp
  unit/compare/error_budget.cpp
  unit/compare/error_plot.cpp
  unit/compare/eye.cpp
  unit/compare/metrics.cpp
  unit/compare/picture.cpp
  unit/compare/report.cpp
  unit/compare/report_data.cpp
  unit/compare/report_text.cpp
  unit/compare/stats.cpp
  unit/compare/surface.cpp
  unit/compare/visible_light.cpp
  LIBRARIES penumbra_compare penumbra_reference nlohmann_json::nlohmann_json TBB::tbb ZLIB::ZLIB hwy::hwy)
