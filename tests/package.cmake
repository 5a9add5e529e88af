# What an embedder relies on: the C interface, exported symbols, the installed package, and the program of the README.

enable_language(C)

add_executable(c_interface_test c_interface_test.c)
set_target_properties(c_interface_test PROPERTIES C_STANDARD 99 C_STANDARD_REQUIRED ON C_EXTENSIONS OFF)
target_compile_options(c_interface_test PRIVATE -Wall -Wextra -pedantic -Werror)
target_link_libraries(c_interface_test PRIVATE fastccd::shared m)
add_test(NAME c_interface_test COMMAND c_interface_test)

# Debian's interpreter first: it is the one that Debian's numpy is for.
find_program(FASTCCD_PYTHON NAMES python3 PATHS /usr/bin NO_DEFAULT_PATH)
find_program(FASTCCD_PYTHON NAMES python3)
if(FASTCCD_PYTHON)
  execute_process(COMMAND ${FASTCCD_PYTHON} -c "import numpy" RESULT_VARIABLE no_numpy OUTPUT_QUIET ERROR_QUIET)
endif()
if(NOT FASTCCD_PYTHON OR no_numpy)
  message(WARNING "NOT TESTED: the C interface from Python, for want of python3 with numpy")
elseif(NOT CMAKE_CROSSCOMPILING)
  add_test(NAME ctypes_test COMMAND ${FASTCCD_PYTHON} ${CMAKE_CURRENT_SOURCE_DIR}/ctypes_test.py $<TARGET_FILE:fastccd_shared>)
endif()
