# SPDX-License-Identifier: Apache-2.0
# Tests that run the built program.
function(clrt_command_test name)
  clrt_test(cli ${name} ${ARGN})
  target_compile_definitions(${name} PRIVATE CLRT_EXECUTABLE="$<TARGET_FILE:clrt>"
                                             CLRT_KERNELS_FOLDER="${PROJECT_SOURCE_DIR}/kernels")
  add_dependencies(${name} clrt)
endfunction()

clrt_command_test(exit_code_test)
clrt_command_test(information_test)
clrt_command_test(odd_input_test)
clrt_command_test(picture_file_test)
clrt_python_test(cli compare_command_test)
clrt_python_test(cli study_command_test $<TARGET_FILE:clrt>)
