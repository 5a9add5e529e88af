# The library as others use it: static and shared, installed, found by CMake and by pkg-config, packed for Debian.
# fastccd::static, fastccd::shared, and fastccd::fastccd for whichever is meant, exist in the build tree and installed.

include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set_target_properties(fastccd PROPERTIES
  POSITION_INDEPENDENT_CODE ON CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON EXPORT_NAME static)
add_library(fastccd::static ALIAS fastccd)

# As part of another project, fastccd::fastccd is static unless BUILD_SHARED_LIBS; installed, it is shared unless the component
# static is asked for. Subprojects pay for the second library only if they ask for it.
if(FASTCCD_INSTALL OR BUILD_SHARED_LIBS)
  # The same objects; CMake wants to see a source as well. Until 1.0 a minor version may change the binary interface; the soname says so.
  add_library(fastccd_shared SHARED ${PROJECT_SOURCE_DIR}/kernels/include/fastccd/fastccd.h)
  add_library(fastccd::shared ALIAS fastccd_shared)
  target_link_libraries(fastccd_shared PRIVATE $<LINK_LIBRARY:WHOLE_ARCHIVE,fastccd>)
  target_include_directories(fastccd_shared INTERFACE $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/kernels/include>)
  target_compile_features(fastccd_shared INTERFACE cxx_std_20)
  set_target_properties(fastccd_shared PROPERTIES
    OUTPUT_NAME fastccd EXPORT_NAME shared LINKER_LANGUAGE CXX
    VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
  if(NOT APPLE)
    # Also hides what templates of the standard library leave behind.
    target_link_options(fastccd_shared PRIVATE LINKER:--version-script=${CMAKE_CURRENT_LIST_DIR}/exports.map)
    # It stays in memory after dlclose: threads of oneTBB, which goes with it otherwise, may still run then.
    target_link_options(fastccd_shared PRIVATE LINKER:-z,nodelete)
    set_target_properties(fastccd_shared PROPERTIES LINK_DEPENDS ${CMAKE_CURRENT_LIST_DIR}/exports.map)
  endif()
endif()
if(BUILD_SHARED_LIBS)
  add_library(fastccd::fastccd ALIAS fastccd_shared)
else()
  add_library(fastccd::fastccd ALIAS fastccd)
endif()
if(NOT FASTCCD_INSTALL)
  return()
endif()

set(cmake_dir ${CMAKE_INSTALL_LIBDIR}/cmake/fastccd)
install(DIRECTORY kernels/include/fastccd TYPE INCLUDE)
set(doc_dir ${CMAKE_INSTALL_DATAROOTDIR}/doc/fastccd)
if(PROJECT_IS_TOP_LEVEL)
  set(doc_dir ${CMAKE_INSTALL_DOCDIR})  # of another project, this is that one's
endif()
install(FILES LICENSE DESTINATION ${doc_dir} RENAME copyright)
foreach(linkage IN ITEMS static shared)
  set(target fastccd)
  if(linkage STREQUAL shared)
    set(target fastccd_shared)
  endif()
  install(TARGETS ${target} EXPORT fastccd-${linkage} INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
  install(EXPORT fastccd-${linkage} NAMESPACE fastccd:: DESTINATION ${cmake_dir})
endforeach()

configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/fastccd-config.cmake.in ${PROJECT_BINARY_DIR}/fastccd-config.cmake
  INSTALL_DESTINATION ${cmake_dir} NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/fastccd-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/fastccd-config.cmake ${PROJECT_BINARY_DIR}/fastccd-config-version.cmake DESTINATION ${cmake_dir})

# Not Requires.private: that has to be there even for those who link the shared library.
set(pc_private "-ltbb -lstdc++ -lm")
if(FASTCCD_EXACT)
  string(PREPEND pc_private "-lgmp ")
endif()
# Where the file lies decides the prefix, so that an installation can be moved.
file(RELATIVE_PATH pc_prefix ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig ${CMAKE_INSTALL_PREFIX})
foreach(dir IN ITEMS INCLUDEDIR LIBDIR)
  set(pc_${dir} "\${prefix}/${CMAKE_INSTALL_${dir}}")
  if(IS_ABSOLUTE "${CMAKE_INSTALL_${dir}}")
    set(pc_${dir} "${CMAKE_INSTALL_${dir}}")
  endif()
endforeach()
configure_file(${CMAKE_CURRENT_LIST_DIR}/fastccd.pc.in ${PROJECT_BINARY_DIR}/fastccd.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/fastccd.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)

if(PROJECT_IS_TOP_LEVEL)
  set(CPACK_GENERATOR DEB)
  set(CPACK_PACKAGE_NAME fastccd)
  set(CPACK_PACKAGE_CONTACT "the developers of fastccd")
  set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
  set(CPACK_STRIP_FILES ON)
  set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
  set(CPACK_DEBIAN_PACKAGE_SECTION libs)
  set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
  set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
  set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "libtbb-dev")  # for those who link the static library
  include(CPack)
endif()
