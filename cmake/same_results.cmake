# The same results on every processor. Compilers fuse multiplications and additions where the processor can,
# which rounds once instead of twice; so does Eigen, unless the compiler denies it.
add_compile_options(-ffp-contract=off)
if(CMAKE_SYSTEM_PROCESSOR MATCHES "^(aarch64|arm64)$")
  add_compile_options(-U__ARM_FEATURE_FMA)
endif()
