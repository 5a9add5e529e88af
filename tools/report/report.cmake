# What `fastccd report` needs beyond the rest of the command.

option(FASTCCD_PEERS "Compare with FCL and Bullet in `fastccd report`, as far as they are installed" OFF)
add_subdirectory(peers)

string(TOUPPER "${CMAKE_BUILD_TYPE}" build_type)
string(STRIP "${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_${build_type}} -ffp-contract=off" flags)
set_property(SOURCE report/machine.cpp APPEND PROPERTY COMPILE_DEFINITIONS "FASTCCD_BUILD_FLAGS=\"${flags}\"")

set(commit_header ${CMAKE_CURRENT_BINARY_DIR}/commit/fastccd_commit.hpp)
add_custom_target(fastccd_commit BYPRODUCTS ${commit_header}
  COMMAND ${CMAKE_COMMAND} -DSOURCE=${PROJECT_SOURCE_DIR} -DHEADER=${commit_header} -P ${CMAKE_CURRENT_SOURCE_DIR}/report/commit.cmake)
add_dependencies(fastccd_commands fastccd_commit)

# The number of intervals of a search, for its table, is not in the public headers.
set_property(SOURCE report/hard_cases.cpp APPEND PROPERTY INCLUDE_DIRECTORIES ${PROJECT_SOURCE_DIR}/kernels ${PROJECT_SOURCE_DIR}/scalar)

target_include_directories(fastccd_commands PRIVATE ${CMAKE_CURRENT_BINARY_DIR}/commit)
target_link_libraries(fastccd_commands PRIVATE fastccd_hard_pairs)
if(FASTCCD_PEERS)
  set_property(SOURCE report/speed_and_error.cpp APPEND PROPERTY COMPILE_DEFINITIONS FASTCCD_HAVE_PEERS)
  target_link_libraries(fastccd_commands PRIVATE fastccd_peers)
endif()
