# Tests of the command and of what it is made of.

function(fastccd_add_tools_test name)
  fastccd_add_test(${name} ${name}.cpp)
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR})
  target_link_libraries(${name} PRIVATE fastccd_commands nlohmann_json::nlohmann_json ${GMP_LIBRARY})
endfunction()

foreach(test IN ITEMS npy_test rational_csv_test random_pairs_test mesh_io_test mesh_errors_test broad_phase_test make_scene_test progress_test)
  fastccd_add_tools_test(${test})
endforeach()
if(NOT FASTCCD_SANITIZE)
  fastccd_add_tools_test(random_counts_test)  # ten million pairs, and no call that others do not make
endif()
set(command_tests command_test command_errors_test held_command_test scene_command_test scene_command_errors_test separation_command_test output_file_test report_page_test)
if(NOT FASTCCD_SANITIZE)
  list(APPEND command_tests report_test)  # minutes of exact arithmetic; report_page_test runs the report itself
endif()
foreach(test IN LISTS command_tests)
  fastccd_add_tools_test(${test})
  add_dependencies(${test} fastccd_command)
  target_compile_definitions(${test} PRIVATE FASTCCD_COMMAND="$<TARGET_FILE:fastccd_command>")
  # JSON takes twice as long to compile with any optimisation, and these wait for the command. What is precompiled is for -O1.
  target_compile_options(${test} PRIVATE -O0)
  set_target_properties(${test} PROPERTIES DISABLE_PRECOMPILE_HEADERS ON)
endforeach()
if(FASTCCD_EXACT)
  target_compile_definitions(command_test PRIVATE FASTCCD_HAVE_EXACT)
endif()
