# Installs the build to a prefix of its own, then configures, builds and runs every C++ project of examples/ against it,
# from outside the tree; adds a robot to the installed data, which the installed program must find; asks pkg-config.
file(REMOVE_RECURSE ${WORK_DIR})
set(_prefix ${WORK_DIR}/prefix)

function(run)
  execute_process(
    COMMAND ${ARGN}
    OUTPUT_VARIABLE _output
    ERROR_VARIABLE _output
    RESULT_VARIABLE _code
  )
  if(NOT _code EQUAL 0)
    message(FATAL_ERROR "${ARGN}\n${_output}")
  endif()
  set(output "${_output}" PARENT_SCOPE)
endfunction()

run(${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix ${_prefix})
set(_robot ${_prefix}/share/pirouette/robots/mini_cheetah/mini_cheetah.xml)
foreach(example robot_loop mujoco_loop)
  file(COPY ${EXAMPLES_DIR}/${example} DESTINATION ${WORK_DIR})
  set(_build ${WORK_DIR}/${example}/build)
  run(
    ${CMAKE_COMMAND} -S ${WORK_DIR}/${example} -B ${_build} -G ${GENERATOR}
    -DCMAKE_MAKE_PROGRAM=${MAKE_PROGRAM}
    -DCMAKE_CXX_COMPILER=${CXX_COMPILER}
    -DCMAKE_BUILD_TYPE=Release
    -DCMAKE_PREFIX_PATH=${_prefix}
  )
  run(${CMAKE_COMMAND} --build ${_build})
  run(${_build}/${example} ${_robot})
  message(STATUS "${example}: ${output}")
endforeach()

# What goes on a robot brings no TOML, no scene and no trial.
foreach(file build.ninja CMakeFiles/robot_loop.dir/link.txt)
  if(EXISTS ${WORK_DIR}/robot_loop/build/${file})
    file(STRINGS ${WORK_DIR}/robot_loop/build/${file} _other REGEX "pirouette_(config|world|study)")
    if(_other)
      message(FATAL_ERROR "robot_loop links more than it asked for: ${_other}")
    endif()
  endif()
endforeach()

# No PIROUETTE_DATA_DIR: the installed program looks beside itself.
set(_robots ${_prefix}/share/pirouette/robots)
file(MAKE_DIRECTORY ${_robots}/added)
configure_file(${_robot} ${_robots}/added/added.xml COPYONLY)
unset(ENV{PIROUETTE_DATA_DIR})
run(${_prefix}/bin/pirouette spin --robot added --turns 0.1 --quiet --out ${WORK_DIR}/added)

foreach(package pirouette pirouette-controller)
  set(ENV{PKG_CONFIG_PATH} ${_prefix}/${LIBDIR}/pkgconfig)
  execute_process(
    COMMAND pkg-config --cflags ${package}
    OUTPUT_VARIABLE _flags
    RESULT_VARIABLE _code
  )
  if(_code MATCHES "^[0-9]+$" AND NOT _flags MATCHES "include")
    message(FATAL_ERROR "pkg-config --cflags ${package}: ${_flags}")
  endif()
endforeach()
