# Installs the library, its headers, the program and a package that find_package(taut) finds.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

get_target_property(taut_type taut TYPE)
set(TAUT_IS_SHARED $<EQUAL:0,1>)
if(taut_type STREQUAL "SHARED_LIBRARY")
  set(TAUT_IS_SHARED TRUE)
else()
  set(TAUT_IS_SHARED FALSE)
endif()
get_property(TAUT_PRIVATE_DEPENDENCIES GLOBAL PROPERTY TAUT_PRIVATE_DEPENDENCIES)

install(TARGETS taut EXPORT tautTargets FILE_SET HEADERS)
if(TAUT_BUILD_APPS)
  install(TARGETS taut_app)
endif()
install(EXPORT tautTargets NAMESPACE taut:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/taut)
configure_package_config_file(cmake/tautConfig.cmake.in ${CMAKE_CURRENT_BINARY_DIR}/tautConfig.cmake
  INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/taut)
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/tautConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/tautConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/tautConfigVersion.cmake
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/taut)
