# SPDX-License-Identifier: Apache-2.0
# Compares the ray caster with closed forms and exact predicates. No device.
penumbra_test(reference
  SOURCES
  analytic/ray_traced_closed_forms.cpp
  property/common_answers.cpp
  property/ray_traced_pairs.cpp
  property/ray_traced_scales.cpp
  unit/hiding_objects.cpp
  unit/ray_traced.cpp
  LIBRARIES penumbra_reference)
