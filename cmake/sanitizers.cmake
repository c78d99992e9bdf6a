# SPDX-License-Identifier: Apache-2.0
# Address and undefined-behaviour sanitizers for host code; the first finding ends the process.
#
# CLRT_SANITIZE=ON builds everything with them. OpenCL drivers leak on purpose, so run the tests with
# ASAN_OPTIONS=detect_leaks=0. In every other build the tests in tests/fuzz compile the readers once more with them.
option(CLRT_SANITIZE "Build with address and undefined-behaviour sanitizers" OFF)
set(CLRT_SANITIZER_OPTIONS -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer)

if(CLRT_SANITIZE)
  add_compile_options(${CLRT_SANITIZER_OPTIONS} -g1 -UNDEBUG)
  add_link_options(${CLRT_SANITIZER_OPTIONS})
endif()
