# Runs every command of trace_hashes.txt, compares the SHA-256 of its trace.npy with the one written there, and replays
# the run.
# Another compiler, C library or kind of processor rounds otherwise: there the test says so and is skipped.
#   PROGRAM: the program; HASH_FILE; WORK_DIR; COMPILER: name and version; UPDATE=ON writes the file instead.
cmake_host_system_information(RESULT _platform QUERY OS_PLATFORM)
execute_process(
  COMMAND getconf GNU_LIBC_VERSION
  OUTPUT_VARIABLE _libc
  OUTPUT_STRIP_TRAILING_WHITESPACE
  ERROR_QUIET
)
set(_fma "no FMA")
if(EXISTS /proc/cpuinfo)
  file(STRINGS /proc/cpuinfo _flags REGEX "^flags.* fma .* avx2 " LIMIT_COUNT 1)
  if(_flags)
    set(_fma "FMA, AVX2")
  endif()
endif()
set(_origin "${COMPILER}; ${_libc}; ${_platform} with ${_fma}")

file(STRINGS ${HASH_FILE} _lines REGEX "^[^#]")
list(POP_FRONT _lines _written)
if(NOT UPDATE AND NOT _written STREQUAL _origin)
  message(STATUS "skipped: the hashes are of \"${_written}\", this is \"${_origin}\"")
  return()
endif()

file(REMOVE_RECURSE ${WORK_DIR}/run) # of a test that was killed
set(_different "")
set(_updated "")
foreach(line IN LISTS _lines)
  string(REGEX MATCH "^([0-9a-f]+) (.*)$" _ "${line}")
  set(_expected ${CMAKE_MATCH_1})
  set(_command "${CMAKE_MATCH_2}")
  separate_arguments(_arguments UNIX_COMMAND "${_command}")
  execute_process(
    COMMAND ${PROGRAM} ${_arguments} --record --quiet --out ${WORK_DIR}/run
    ERROR_VARIABLE _error
    RESULT_VARIABLE _code
  )
  if(NOT EXISTS ${WORK_DIR}/run/trace.npy)
    message(FATAL_ERROR "pirouette ${_command}: no trace, exit code ${_code}\n${_error}")
  endif()
  file(SHA256 ${WORK_DIR}/run/trace.npy _hash)
  execute_process(
    COMMAND ${PROGRAM} replay ${WORK_DIR}/run
    OUTPUT_VARIABLE _replay
    ERROR_VARIABLE _replay
    RESULT_VARIABLE _code
  )
  if(NOT _code EQUAL 0)
    message(FATAL_ERROR "pirouette ${_command}: the replay differs, exit code ${_code}\n${_replay}")
  endif()
  file(REMOVE_RECURSE ${WORK_DIR}/run)
  string(APPEND _updated "${_hash} ${_command}\n")
  if(NOT _hash STREQUAL _expected)
    string(APPEND _different "\n  pirouette ${_command}")
  endif()
endforeach()

if(UPDATE)
  file(STRINGS ${HASH_FILE} _head REGEX "^#")
  string(REPLACE ";" "\n" _head "${_head}")
  file(WRITE ${HASH_FILE} "${_head}\n${_origin}\n${_updated}")
elseif(_different)
  message(FATAL_ERROR "These traces are no longer what they were, bit for bit:${_different}")
endif()
