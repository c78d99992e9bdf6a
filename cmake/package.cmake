# SPDX-License-Identifier: Apache-2.0
# What `cmake --install` installs beside the programs, and the Debian package: `cpack` in the build folder writes
# clrt_VERSION_ARCH.deb (needs dpkg-dev and file, to find the libraries it depends on).

# The man pages are made from the programs' own --help.
find_package(Python3 COMPONENTS Interpreter)
if(Python3_FOUND)
  set(CLRT_MAN_PAGES)
  foreach(program clrt clrt-merge clrt-bench clrt-stability clrt-agree clrt-compare clrt-study clrt-mitsuba clrt-cycles clrt-slurm)
    set(page ${CMAKE_BINARY_DIR}/${program}.1)
    if(TARGET ${program})
      set(path $<TARGET_FILE:${program}>)
    elseif(EXISTS ${PROJECT_SOURCE_DIR}/tools/${program})
      set(path ${PROJECT_SOURCE_DIR}/tools/${program})
    else() # not built, for want of a library
      continue()
    endif()
    add_custom_command(OUTPUT ${page}
      COMMAND Python3::Interpreter ${PROJECT_SOURCE_DIR}/tools/manpage.py ${path} ${PROJECT_VERSION} > ${page}
      DEPENDS $<TARGET_NAME_IF_EXISTS:${program}> ${path} ${PROJECT_SOURCE_DIR}/tools/manpage.py
      VERBATIM)
    list(APPEND CLRT_MAN_PAGES ${page})
  endforeach()
  add_custom_target(man_page ALL DEPENDS ${CLRT_MAN_PAGES})
  install(FILES ${CLRT_MAN_PAGES} DESTINATION share/man/man1)
else()
  message(STATUS "clrt: python3 not found, no man page")
endif()

install(DIRECTORY scenes DESTINATION share/clrt)
install(FILES README.md CHANGELOG.md DESTINATION share/doc/clrt)
install(FILES LICENSE DESTINATION share/doc/clrt RENAME copyright)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME clrt)
set(CPACK_PACKAGE_VENDOR "clrt developers")
set(CPACK_PACKAGE_CONTACT "clrt developers <clrt@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "renders Wavefront OBJ and glTF scenes on any OpenCL device")
set(CPACK_PACKAGE_DESCRIPTION "clrt turns a Wavefront OBJ or a glTF file into a physically based picture by running OpenCL kernels \
on the CPU (PoCL) or a GPU: ray casting, Whitted ray tracing and path tracing.")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# An OpenCL device: PoCL brings the CPU and the compiler it needs; any vendor's driver does as well.
set(CPACK_DEBIAN_PACKAGE_DEPENDS "pocl-opencl-icd | opencl-icd")
# What clrt-agree, clrt-compare and clrt-study need.
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS
  "python3, python3-numpy, python3-scipy, python3-openimageio, python3-xxhash, python3-matplotlib, \
python3-jinja2")
include(CPack)
