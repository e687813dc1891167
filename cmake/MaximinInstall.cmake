# Installs every floor and exports it for find_package(Maximin [COMPONENTS floor...]).
# A floor is a component with an export of its own, so that who asks for theory alone needs Eigen alone.
# proofs_check/checker is no floor: of it the programs alone are installed.
include(CMakePackageConfigHelpers)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/Maximin)

# MAXIMIN_COMPONENTS: one block for each floor, from the ground up, of what it stands on.
get_property(floors GLOBAL PROPERTY MAXIMIN_FLOORS)
set(MAXIMIN_COMPONENTS "")
foreach(floor IN LISTS floors)
  install(TARGETS maximin_${floor} EXPORT Maximin_${floor})
  install(EXPORT Maximin_${floor} NAMESPACE maximin:: FILE Maximin_${floor}.cmake DESTINATION ${package_dir})
  get_property(folder GLOBAL PROPERTY MAXIMIN_FOLDER_${floor})
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/${folder}/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/maximin/${folder}
    FILES_MATCHING PATTERN "*.hpp" PATTERN checker EXCLUDE)

  get_property(links GLOBAL PROPERTY MAXIMIN_LINK_${floor})
  set(lower_floors "")
  get_property(packages GLOBAL PROPERTY MAXIMIN_PACKAGES_${floor})
  foreach(link IN LISTS links)
    if(link MATCHES "^maximin::(.+)$")
      list(APPEND lower_floors ${CMAKE_MATCH_1})
    elseif(link MATCHES "^([^:]+)::")
      set(package ${CMAKE_MATCH_1})
      get_property(version GLOBAL PROPERTY MAXIMIN_PACKAGE_${package})
      list(APPEND packages "${package} ${version}")
    endif()
  endforeach()
  string(APPEND MAXIMIN_COMPONENTS "list(APPEND _maximin_floors ${floor})\n"
    "set(_maximin_floors_under_${floor} \"${lower_floors}\")\n"
    "set(_maximin_packages_of_${floor} \"${packages}\")\n")
endforeach()

configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/MaximinConfig.cmake.in
  ${PROJECT_BINARY_DIR}/MaximinConfig.cmake INSTALL_DESTINATION ${package_dir})
# Before 1.0 a minor version may change any interface.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/MaximinConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/MaximinConfig.cmake ${PROJECT_BINARY_DIR}/MaximinConfigVersion.cmake
  DESTINATION ${package_dir})
# For the packages that ship no CMake package of their own.
install(FILES ${PROJECT_SOURCE_DIR}/cmake/FindFLINT.cmake ${PROJECT_SOURCE_DIR}/cmake/FindGMP.cmake
  DESTINATION ${package_dir}/modules)
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
