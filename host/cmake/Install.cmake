# find_package(clshade) gives clshade::clshade: the library without the command line.
include(CMakePackageConfigHelpers)

add_library(clshade_library INTERFACE)
add_library(clshade::clshade ALIAS clshade_library)
set_target_properties(clshade_library PROPERTIES EXPORT_NAME clshade)

set(exported clshade_library)
foreach(component ${CLSHADE_COMPONENTS})
  target_link_libraries(clshade_library INTERFACE clshade_${component})
  list(APPEND exported clshade_${component})
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/host/${component}/
          DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/clshade/host/${component} FILES_MATCHING PATTERN "*.h")
endforeach()
install(DIRECTORY ${PROJECT_SOURCE_DIR}/kernels/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/clshade/kernels
        FILES_MATCHING PATTERN "*.h")
install(DIRECTORY ${PROJECT_SOURCE_DIR}/kernels/ DESTINATION ${CMAKE_INSTALL_DATADIR}/clshade/kernels
        FILES_MATCHING PATTERN "*.cl" PATTERN "*.h")
install(TARGETS ${exported} EXPORT clshadeTargets
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(TARGETS clshade_program RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(EXPORT clshadeTargets NAMESPACE clshade:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/clshade)

configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/clshadeConfig.cmake.in
  ${PROJECT_BINARY_DIR}/clshadeConfig.cmake INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/clshade)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/clshadeConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/clshadeConfig.cmake ${PROJECT_BINARY_DIR}/clshadeConfigVersion.cmake
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/clshade)
