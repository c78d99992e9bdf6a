# SPDX-License-Identifier: Apache-2.0
# Every kernel file by its path below kernels/. cmake/embed_kernels.cmake puts their text into the library;
# a test compares them with the folder. A new file is found by the next build.
file(GLOB_RECURSE CLRT_KERNEL_FILES CONFIGURE_DEPENDS RELATIVE ${CMAKE_CURRENT_LIST_DIR}
     ${CMAKE_CURRENT_LIST_DIR}/*.h ${CMAKE_CURRENT_LIST_DIR}/*.cl)
