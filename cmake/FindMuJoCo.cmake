# MuJoCo's C library out of the pinned Python wheel (it ships headers and the shared library, but no CMake package).
# Defines the imported target MuJoCo::MuJoCo. Looks beside MuJoCo_ROOT, else asks PIROUETTE_PYTHON.

if(NOT MuJoCo_ROOT AND PIROUETTE_PYTHON)
  execute_process(
    COMMAND
      ${PIROUETTE_PYTHON} -c
      "import importlib.util as u, os; print(os.path.dirname(u.find_spec('mujoco').origin))"
    OUTPUT_VARIABLE MuJoCo_ROOT
    OUTPUT_STRIP_TRAILING_WHITESPACE
    ERROR_QUIET
  )
endif()

find_path(MuJoCo_INCLUDE_DIR mujoco/mujoco.h HINTS ${MuJoCo_ROOT}/include)
file(GLOB _mujoco_libraries ${MuJoCo_ROOT}/libmujoco.so* ${MuJoCo_ROOT}/lib/libmujoco.so*)
if(_mujoco_libraries)
  list(GET _mujoco_libraries 0 _mujoco_library)
  set(MuJoCo_LIBRARY ${_mujoco_library} CACHE FILEPATH "MuJoCo's shared library")
else()
  find_library(MuJoCo_LIBRARY mujoco)
endif()

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(MuJoCo REQUIRED_VARS MuJoCo_LIBRARY MuJoCo_INCLUDE_DIR)

if(MuJoCo_FOUND AND NOT TARGET MuJoCo::MuJoCo)
  add_library(MuJoCo::MuJoCo SHARED IMPORTED)
  set_target_properties(
    MuJoCo::MuJoCo
    PROPERTIES
      IMPORTED_LOCATION ${MuJoCo_LIBRARY}
      INTERFACE_INCLUDE_DIRECTORIES ${MuJoCo_INCLUDE_DIR}
  )
endif()
