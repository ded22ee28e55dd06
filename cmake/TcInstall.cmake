# What `make install` puts where. The program finds the library by a relative run path, and both find the helper
# programs in ../libexec/tetcast, so the whole tree may be moved.
include(CMakePackageConfigHelpers)

set(tc_helpers)
foreach(helper tetcast-read tetcast-convexify tetcast-image tetcast-edit)
  if(TARGET ${helper})
    list(APPEND tc_helpers ${helper})
  endif()
endforeach()

install(TARGETS tetcast RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(TARGETS tetcast_lib LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}
  PUBLIC_HEADER DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(TARGETS ${tc_helpers} RUNTIME DESTINATION ${CMAKE_INSTALL_LIBEXECDIR}/tetcast)
if(TARGET tetcast-read-more) # beside tetcast-read, which loads it
  install(TARGETS tetcast-read-more LIBRARY DESTINATION ${CMAKE_INSTALL_LIBEXECDIR}/tetcast)
endif()

file(GLOB tc_man CONFIGURE_DEPENDS docs/man/*.1)
install(FILES ${tc_man} DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
install(FILES README.md LICENSE NOTICE CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR})

# pkg-config: paths relative to the file itself
file(RELATIVE_PATH tc_pc_to_prefix ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig ${CMAKE_INSTALL_PREFIX})
configure_file(cmake/tetcast.pc.in ${PROJECT_BINARY_DIR}/tetcast.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/tetcast.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)

# find_package(tetcast) gives tetcast::tetcast
set(tc_cmake_dir ${CMAKE_INSTALL_LIBDIR}/cmake/tetcast)
configure_package_config_file(cmake/tetcastConfig.cmake.in ${PROJECT_BINARY_DIR}/tetcastConfig.cmake
  INSTALL_DESTINATION ${tc_cmake_dir} PATH_VARS CMAKE_INSTALL_INCLUDEDIR CMAKE_INSTALL_LIBDIR)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/tetcastConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/tetcastConfig.cmake ${PROJECT_BINARY_DIR}/tetcastConfigVersion.cmake
  DESTINATION ${tc_cmake_dir})
