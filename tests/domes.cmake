# Domes: every method that does them against closed forms, against one another and against the exact decision. No device.
penumbra_test(domes
  SOURCES
  agreement/domes.cpp
  analytic/dome_closed_forms.cpp
  unit/dome_samples.cpp
  LIBRARIES penumbra_volumes penumbra_vsm penumbra_reference penumbra_compare penumbra_scenes)
