# EXR and PNG, and files that appear whole or not at all.
find_package(OpenEXR REQUIRED)
penumbra_test(base
  SOURCES unit/exr.cpp unit/image.cpp
  LIBRARIES penumbra_base OpenEXR::OpenEXR)
