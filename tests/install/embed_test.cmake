# Installs the build to a prefix of its own, then configures, builds and runs examples/embed against it.
file(REMOVE_RECURSE ${WORK_DIR})
set(_prefix ${WORK_DIR}/prefix)
file(COPY ${EXAMPLE_DIR} DESTINATION ${WORK_DIR})

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
run(
  ${CMAKE_COMMAND} -S ${WORK_DIR}/embed -B ${WORK_DIR}/build -G ${GENERATOR}
  -DCMAKE_MAKE_PROGRAM=${MAKE_PROGRAM}
  -DCMAKE_CXX_COMPILER=${CXX_COMPILER}
  -DCMAKE_BUILD_TYPE=Release
  -DCMAKE_PREFIX_PATH=${_prefix}
)
run(${CMAKE_COMMAND} --build ${WORK_DIR}/build)

# The prefix was chosen at installation, so the data folder compiled in is another one.
set(ENV{PIROUETTE_DATA_DIR} ${_prefix}/share/pirouette)
run(${WORK_DIR}/build/embed)
message(STATUS "embed: ${output}")
run(${_prefix}/bin/pirouette config dump)
