# Builds the programs with one half of the engine left out, and proves that the half's libraries are neither needed nor linked.
# cmake -DSOURCE=<checkout> -DSCRATCH=<folder> -DGENERATOR=... -DCOMPILER=... -DOPTION=CHIARO_BUILD_... -DPROGRAM=<name>
#       -DBUILD_TYPE=Release -DFLAGS=<its flags> -DABSENT=<regex of libraries> -DHIDDEN=<comma list of packages made unfindable> -P configure_without_test.cmake
cmake_minimum_required(VERSION 3.25)

set(hide "")
string(REPLACE "," ";" HIDDEN "${HIDDEN}")
foreach(package IN LISTS HIDDEN)
  list(APPEND hide "-DCMAKE_DISABLE_FIND_PACKAGE_${package}=ON")
endforeach()
string(TOUPPER "${BUILD_TYPE}" type)
file(REMOVE_RECURSE "${SCRATCH}")
execute_process(COMMAND "${CMAKE_COMMAND}" -S "${SOURCE}" -B "${SCRATCH}" -G "${GENERATOR}" "-DCMAKE_CXX_COMPILER=${COMPILER}"
  "-DCMAKE_BUILD_TYPE=${BUILD_TYPE}" "-DCMAKE_CXX_FLAGS_${type}=${FLAGS}" "-D${OPTION}=OFF" -DCHIARO_BUILD_TESTS=OFF ${hide} OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND "${CMAKE_COMMAND}" --build "${SCRATCH}" --parallel 2 OUTPUT_VARIABLE log RESULT_VARIABLE code)
if(NOT code EQUAL 0)
  message(FATAL_ERROR "the build with ${OPTION}=OFF failed:\n${log}")
endif()
execute_process(COMMAND "${SCRATCH}/bin/${PROGRAM}" --version COMMAND_ERROR_IS_FATAL ANY)
file(GET_RUNTIME_DEPENDENCIES EXECUTABLES "${SCRATCH}/bin/${PROGRAM}" RESOLVED_DEPENDENCIES_VAR libraries
  UNRESOLVED_DEPENDENCIES_VAR missing)
list(LENGTH libraries count)
if(count EQUAL 0)
  message(FATAL_ERROR "no library was read from ${PROGRAM}")
endif()
foreach(library IN LISTS libraries missing)
  if(library MATCHES "${ABSENT}")
    message(FATAL_ERROR "${PROGRAM} built with ${OPTION}=OFF still needs ${library}")
  endif()
endforeach()
message(STATUS "${PROGRAM} needs ${count} libraries, none of them ${ABSENT}")
file(REMOVE_RECURSE "${SCRATCH}")
