# `cmake --install`: program, libraries, headers, data and a package that find_package(pirouette) finds.
include(CMakePackageConfigHelpers)

set(_package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/pirouette)

install(
  TARGETS pirouette_controller pirouette_runtime pirouette_config pirouette_world pirouette_study
  EXPORT pirouetteTargets
)
install(EXPORT pirouetteTargets NAMESPACE pirouette:: DESTINATION ${_package_dir})
# The wheels' shared libraries stay where they are. CMake's own INSTALL_RPATH_USE_LINK_PATH leaves out
# what lies inside the source tree, as .venv does.
set_target_properties(
  pirouette_program
  pirouette_controller
  pirouette_runtime
  pirouette_config
  pirouette_world
  pirouette_study
  PROPERTIES
    INSTALL_RPATH
      "$ORIGIN;$ORIGIN/../${CMAKE_INSTALL_LIBDIR};$<TARGET_FILE_DIR:MuJoCo::MuJoCo>;$<TARGET_FILE_DIR:eiquadprog::eiquadprog>"
)
install(TARGETS pirouette_program)

# Without those that show MuJoCo or toml++, which are for this tree only.
install(
  DIRECTORY src/pirouette
  DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
  FILES_MATCHING
  PATTERN "*.hpp"
  PATTERN "config/*_reader.hpp" EXCLUDE
  PATTERN "study/*_reader.hpp" EXCLUDE
  PATTERN "config/toml_node.hpp" EXCLUDE
  PATTERN "model/mujoco.hpp" EXCLUDE
  PATTERN "model/robot_map.hpp" EXCLUDE
  PATTERN "model/robot_reader.hpp" EXCLUDE
  PATTERN "model/*_finder.hpp" EXCLUDE
  PATTERN "model/spec_repair.hpp" EXCLUDE
  PATTERN "plant/scene.hpp" EXCLUDE
  PATTERN "plant/spawn.hpp" EXCLUDE
)
install(
  FILES ${PROJECT_BINARY_DIR}/include/pirouette/version.hpp
  DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/pirouette
)
install(DIRECTORY config experiments robots DESTINATION ${CMAKE_INSTALL_DATADIR}/pirouette)
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/pirouette)

# pkg-config: pirouette-controller for a robot, pirouette for everything.
foreach(package pirouette pirouette-controller)
  configure_file(cmake/${package}.pc.in ${PROJECT_BINARY_DIR}/${package}.pc.in @ONLY)
  file(
    GENERATE OUTPUT
    ${PROJECT_BINARY_DIR}/${package}.pc
    INPUT ${PROJECT_BINARY_DIR}/${package}.pc.in
  )
  install(FILES ${PROJECT_BINARY_DIR}/${package}.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
endforeach()

configure_package_config_file(
  cmake/pirouetteConfig.cmake.in
  ${PROJECT_BINARY_DIR}/pirouetteConfig.cmake
  INSTALL_DESTINATION ${_package_dir}
)
write_basic_package_version_file(
  ${PROJECT_BINARY_DIR}/pirouetteConfigVersion.cmake
  COMPATIBILITY SameMinorVersion
)
install(
  FILES
    ${PROJECT_BINARY_DIR}/pirouetteConfig.cmake
    ${PROJECT_BINARY_DIR}/pirouetteConfigVersion.cmake
    cmake/FindMuJoCo.cmake
  DESTINATION ${_package_dir}
)
