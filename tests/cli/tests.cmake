# SPDX-License-Identifier: Apache-2.0
# Tests that run the built program.
function(clrt_command_test name)
  clrt_test(cli ${name} ${ARGN})
  target_compile_definitions(${name} PRIVATE CLRT_EXECUTABLE="$<TARGET_FILE:clrt>"
                                             CLRT_KERNELS_FOLDER="${PROJECT_SOURCE_DIR}/kernels")
  add_dependencies(${name} clrt)
endfunction()

clrt_command_test(error_report_test)
target_compile_definitions(error_report_test PRIVATE CLRT_SCENES_FOLDER="${PROJECT_SOURCE_DIR}/scenes"
                                                     CLRT_MERGE_EXECUTABLE="$<TARGET_FILE:clrt-merge>")
add_dependencies(error_report_test clrt-merge)
clrt_command_test(compile_time_test)
clrt_command_test(exit_code_test)
clrt_command_test(fault_test)
clrt_command_test(film_command_test)
target_compile_definitions(film_command_test PRIVATE CLRT_MERGE_EXECUTABLE="$<TARGET_FILE:clrt-merge>")
add_dependencies(film_command_test clrt-merge)
clrt_command_test(hit_layers_command_test)
clrt_command_test(information_test)
clrt_command_test(mtl_command_test)
clrt_command_test(odd_input_test)
find_program(CLRT_OCLGRIND oclgrind)
if(CLRT_OCLGRIND)
  clrt_command_test(oclgrind_test)
  target_compile_definitions(oclgrind_test PRIVATE CLRT_OCLGRIND="${CLRT_OCLGRIND}")
endif()
clrt_command_test(paths_command_test)
clrt_command_test(picture_file_test)
clrt_command_test(program_cache_cli_test)
clrt_command_test(same_bits_command_test)
target_compile_definitions(same_bits_command_test PRIVATE CLRT_SCENES_FOLDER="${PROJECT_SOURCE_DIR}/scenes")
clrt_command_test(replay_command_test)
clrt_command_test(time_limit_test)
# It compares with seconds of wall time, which are only its own while nothing else runs.
set_tests_properties(cli.time_limit_test PROPERTIES RUN_SERIAL TRUE)
if(TARGET clrt-bench)
  clrt_test(cli bench_command_test)
  target_compile_definitions(bench_command_test PRIVATE
    CLRT_EXECUTABLE="$<TARGET_FILE:clrt-bench>" CLRT_KERNELS_FOLDER="${PROJECT_SOURCE_DIR}/kernels"
    CLRT_SCENES_FOLDER="${PROJECT_SOURCE_DIR}/scenes" CLRT_BENCH_FOLDER="${PROJECT_SOURCE_DIR}/tools/bench")
  add_dependencies(bench_command_test clrt-bench)
endif()
clrt_test(cli stability_command_test clrt_stability_core)
target_compile_definitions(stability_command_test PRIVATE
  CLRT_EXECUTABLE="$<TARGET_FILE:clrt-stability>" CLRT_KERNELS_FOLDER="${PROJECT_SOURCE_DIR}/kernels")
add_dependencies(stability_command_test clrt-stability)
clrt_python_test(cli man_page_test $<TARGET_FILE:clrt> $<TARGET_FILE:clrt-merge> $<TARGET_FILE:clrt-stability>
  ${PROJECT_SOURCE_DIR}/tools/clrt-compare ${PROJECT_SOURCE_DIR}/tools/clrt-study)
clrt_python_test(cli compare_command_test)
clrt_python_test(cli installed_tools_test ${CMAKE_COMMAND} ${CMAKE_CPACK_COMMAND} ${CMAKE_BINARY_DIR})
set_tests_properties(cli.installed_tools_test PROPERTIES RESOURCE_LOCK build_folder) # cpack looks whether all is built
clrt_python_test(cli integrator_pairs_test $<TARGET_FILE:clrt>)
clrt_python_test(cli study_command_test $<TARGET_FILE:clrt>)
