# Installs the program, the floors as static libraries, their headers, and a CMake package, so that others can link them:
#   find_package(followthrough REQUIRED)
#   target_link_libraries(mine PRIVATE followthrough::ft_baker)
# Includes are written as inside the project: #include "io/cache/cache.h". tests/install builds such a consumer.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/followthrough)
set(package_targets ft_flags)
foreach(folder baker/core io collision solvers baker)
  get_property(targets DIRECTORY ${CMAKE_SOURCE_DIR}/${folder} PROPERTY BUILDSYSTEM_TARGETS)
  list(APPEND package_targets ${targets})
endforeach()
foreach(target ${package_targets})
  get_target_property(kind ${target} TYPE)
  if(kind MATCHES "^(STATIC_LIBRARY|INTERFACE_LIBRARY|EXECUTABLE)$")
    install(TARGETS ${target} EXPORT followthrough-targets)
  endif()
endforeach()

install(DIRECTORY baker io collision solvers DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/followthrough
        FILES_MATCHING PATTERN "*.h")
install(EXPORT followthrough-targets NAMESPACE followthrough:: DESTINATION ${package_folder})
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/followthrough-config.cmake.in
  ${CMAKE_BINARY_DIR}/followthrough-config.cmake INSTALL_DESTINATION ${package_folder})
write_basic_package_version_file(${CMAKE_BINARY_DIR}/followthrough-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/followthrough-config.cmake ${CMAKE_BINARY_DIR}/followthrough-config-version.cmake
        DESTINATION ${package_folder})
