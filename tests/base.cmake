# EXR, PNG and JPEG, files that appear whole or not at all, and names that are nearly right.
find_package(JPEG REQUIRED)
find_package(OpenEXR REQUIRED)
penumbra_test(base
  SOURCES unit/did_you_mean.cpp unit/exr.cpp unit/image.cpp unit/jpeg.cpp
  LIBRARIES penumbra_base JPEG::JPEG OpenEXR::OpenEXR)
