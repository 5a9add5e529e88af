# What an embedder relies on: the library unloaded, called from Python, exported symbols, the installed package, and the program of
# the README.

add_executable(unload_test unload_test.c)
set_target_properties(unload_test PROPERTIES C_STANDARD 99)
target_include_directories(unload_test PRIVATE ${PROJECT_SOURCE_DIR}/kernels/include)
target_link_libraries(unload_test PRIVATE ${CMAKE_DL_LIBS})
add_test(NAME unload_test COMMAND unload_test $<TARGET_FILE:fastccd_shared>)

# The version is in two places.
file(STRINGS ${PROJECT_SOURCE_DIR}/kernels/include/fastccd/version.h version_line REGEX "define FASTCCD_VERSION \"")
if(NOT version_line MATCHES "\"${PROJECT_VERSION}\"")
  message(FATAL_ERROR "CMakeLists.txt says version ${PROJECT_VERSION}, version.h: ${version_line}")
endif()

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
  # Of random pairs 7.7 % are in contact.
  add_test(NAME readme_python_test COMMAND ${says} 0 "^0 is no error; 7[678]... contacts"
    ${FASTCCD_PYTHON} ${CMAKE_CURRENT_SOURCE_DIR}/consumer/pairs.py $<TARGET_FILE:fastccd_shared>)
endif()

add_test(NAME exported_symbols_test
  COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/exported_symbols_test.sh $<TARGET_FILE:fastccd_shared> ${CMAKE_CURRENT_SOURCE_DIR}/exported_symbols.txt)
add_test(NAME readme_program_test COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/readme_program_test.sh ${PROJECT_SOURCE_DIR})
if(NOT CMAKE_CROSSCOMPILING)
  add_test(NAME install_test
    COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/install_test.sh ${PROJECT_BINARY_DIR} ${CMAKE_CXX_COMPILER} ${CMAKE_C_COMPILER})
  add_test(NAME subdirectory_test COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/subdirectory_test.sh ${PROJECT_SOURCE_DIR} ${CMAKE_CXX_COMPILER})
  set_tests_properties(subdirectory_test PROPERTIES COST 1000)  # builds the library: to begin with, so that nothing waits for it at the end
  if(FASTCCD_TOOLS)
    add_test(NAME debian_package_test COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/debian_package_test.sh ${PROJECT_BINARY_DIR})
    # Both go through the installation of the build folder.
    set_tests_properties(install_test debian_package_test PROPERTIES RESOURCE_LOCK installation)
  endif()
endif()
