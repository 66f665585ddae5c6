# `cmake --install`: program, libraries, headers, data and a package that find_package(pirouette) finds.
include(CMakePackageConfigHelpers)

set(_package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/pirouette)

install(
  TARGETS pirouette_controller pirouette_config pirouette_world pirouette_study
  EXPORT pirouetteTargets
)
install(EXPORT pirouetteTargets NAMESPACE pirouette:: DESTINATION ${_package_dir})
# The wheels' shared libraries stay where they are. CMake's own INSTALL_RPATH_USE_LINK_PATH leaves out
# what lies inside the source tree, as .venv does.
set_target_properties(
  pirouette_program
  PROPERTIES
    INSTALL_RPATH "$<TARGET_FILE_DIR:MuJoCo::MuJoCo>;$<TARGET_FILE_DIR:eiquadprog::eiquadprog>"
)
install(TARGETS pirouette_program)

# Without those that show MuJoCo or toml++.
install(
  DIRECTORY src/pirouette
  DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
  FILES_MATCHING
  PATTERN "*.hpp"
  PATTERN "config/*_reader.hpp" EXCLUDE
  PATTERN "study/*_reader.hpp" EXCLUDE
  PATTERN "config/toml_node.hpp" EXCLUDE
  PATTERN "model/robot_map.hpp" EXCLUDE
  PATTERN "plant/scene.hpp" EXCLUDE
  PATTERN "plant/spawn.hpp" EXCLUDE
)
install(DIRECTORY config experiments robots DESTINATION ${CMAKE_INSTALL_DATADIR}/pirouette)

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
