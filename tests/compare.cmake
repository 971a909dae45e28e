# Error metrics, pictures and reports; form factors, and the beauty that is made of them. No device.
penumbra_test(compare
  SOURCES
  agreement/radiance_near_light.cpp
  analytic/form_factor_closed_forms.cpp
  analytic/radiance_exact.cpp
  unit/compare_beauty.cpp
  unit/compare_error_budget.cpp
  unit/compare_metrics.cpp
  unit/compare_picture.cpp
  unit/compare_report.cpp
  unit/compare_report_data.cpp
  unit/compare_stats.cpp
  unit/compare_surface.cpp
  unit/compare_visible_light.cpp
  LIBRARIES penumbra_compare penumbra_reference nlohmann_json::nlohmann_json TBB::tbb ZLIB::ZLIB)
