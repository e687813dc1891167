# Installs every floor and exports it for find_package(Maximin).
get_property(floors GLOBAL PROPERTY MAXIMIN_FLOORS)
foreach(floor IN LISTS floors)
  install(TARGETS maximin_${floor} EXPORT MaximinTargets)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/${floor}/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/maximin/${floor}
    FILES_MATCHING PATTERN "*.hpp")
endforeach()
