# Toolchain file for 64-bit ARM with Debian's cross compiler, see scripts/arm64. ROTROCC_SYSROOT is the
# folder with Debian's libraries for arm64; without it, they are those that apt installed beside the host's.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_C_COMPILER aarch64-linux-gnu-gcc)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)
set(CMAKE_LIBRARY_ARCHITECTURE aarch64-linux-gnu)

if(ROTROCC_SYSROOT)
  set(CMAKE_SYSROOT ${ROTROCC_SYSROOT})
  set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
  set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
  set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
  set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
  list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES ROTROCC_SYSROOT)
  set(CMAKE_CROSSCOMPILING_EMULATOR qemu-aarch64 -L ${ROTROCC_SYSROOT})
endif()
