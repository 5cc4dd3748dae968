# Installs the library, its headers, the program and a package that find_package(taut) finds.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(TAUT_STATIC_DEPENDENCIES "")
get_target_property(taut_type taut TYPE)
if(taut_type STREQUAL "STATIC_LIBRARY")
  set(TAUT_STATIC_DEPENDENCIES Threads fmt PNG)
  if(TAUT_THREADS)
    list(APPEND TAUT_STATIC_DEPENDENCIES TBB)
  endif()
  get_property(taut_zlib GLOBAL PROPERTY TAUT_ZLIB)
  if(taut_zlib)
    list(APPEND TAUT_STATIC_DEPENDENCIES ZLIB)
  endif()
endif()

install(TARGETS taut EXPORT tautTargets FILE_SET HEADERS)
if(TAUT_BUILD_APPS)
  # Modules of the library are opened by name.
  set_target_properties(taut_app PROPERTIES INSTALL_RPATH "$ORIGIN/../${CMAKE_INSTALL_LIBDIR}")
  install(TARGETS taut_app)
endif()
install(EXPORT tautTargets NAMESPACE taut:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/taut)
configure_package_config_file(cmake/tautConfig.cmake.in ${CMAKE_CURRENT_BINARY_DIR}/tautConfig.cmake
  INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/taut)
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/tautConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/tautConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/tautConfigVersion.cmake
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/taut)
