# SPDX-License-Identifier: Apache-2.0
# CLRT_FAST_BUILD=ON builds from scratch in a third of the processor time: the files of a folder are compiled as one, so
# that templates are compiled once a folder, and the libraries' headers are read once. tools/build switches it on.
#
# Every file must compile by itself as well, to which the test host.files_alone holds them. Those of a folder may not
# give one name to two things: state what both mean in a header, name apart what differs.
option(CLRT_FAST_BUILD "Compile the files of a folder together, with precompiled headers" OFF)

# Headers that most files read and that take long to read.
set(CLRT_SLOW_HEADERS <algorithm> <filesystem> <functional> <map> <memory> <optional> <set> <string> <vector>
                      <fmt/format.h> <glm/glm.hpp> <nlohmann/json.hpp> <spdlog/spdlog.h>
                      ${PROJECT_SOURCE_DIR}/src/device/opencl.h)

# clrt_unite_folders(TARGET): one unit a folder. To be called after the target's last source, in the folder that adds it.
function(clrt_unite_folders target)
  if(NOT CLRT_FAST_BUILD)
    return()
  endif()
  get_target_property(sources ${target} SOURCES)
  list(FILTER sources INCLUDE REGEX "\\.cpp$")
  foreach(source IN LISTS sources)
    cmake_path(ABSOLUTE_PATH source)
    cmake_path(GET source PARENT_PATH folder)
    cmake_path(GET folder FILENAME folder)
    set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${folder})
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
endfunction()

# clrt_precompile(TARGET HEADERS...): reads these headers once for all files of the target.
function(clrt_precompile target)
  if(CLRT_FAST_BUILD)
    target_precompile_headers(${target} PRIVATE ${ARGN})
  endif()
endfunction()

# clrt_precompiled_as(TARGET OTHER): takes over what was precompiled for another target.
function(clrt_precompiled_as target other)
  if(CLRT_FAST_BUILD)
    target_precompile_headers(${target} REUSE_FROM ${other})
  endif()
endfunction()
