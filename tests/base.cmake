# EXR and PNG, files that appear whole or not at all, and names that are nearly right.
find_package(OpenEXR REQUIRED)
penumbra_test(base
  SOURCES unit/did_you_mean.cpp unit/exr.cpp unit/image.cpp
  LIBRARIES penumbra_base OpenEXR::OpenEXR)
