# Installs the build into a scratch prefix, then configures, builds and runs a program that knows only that prefix.
# cmake -DBUILD=<build folder> -DCONSUMER=<source> -DSCRATCH=<folder> -DGENERATOR=... -DCOMPILER=... -DPROGRAMS=a,b -P install_test.cmake
cmake_minimum_required(VERSION 3.25)

set(prefix "${SCRATCH}/prefix")
file(REMOVE_RECURSE "${SCRATCH}")
execute_process(COMMAND "${CMAKE_COMMAND}" --install "${BUILD}" --prefix "${prefix}" OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)

foreach(expected "include/chiaro/assets/scene/scene.h" "include/chiaro/shaders/cpp/lobe.h" "share/chiaro/shaders/lobe/sg.glsl"
    "share/doc/chiaro/LICENSE")
  if(NOT EXISTS "${prefix}/${expected}")
    message(FATAL_ERROR "${expected} was not installed")
  endif()
endforeach()
file(GLOB_RECURSE installed RELATIVE "${prefix}" "${prefix}/*")
foreach(path IN LISTS installed)
  if(path MATCHES "\\.cpp$|(^|/)tests/")
    message(FATAL_ERROR "${path} should not be installed")
  endif()
  if(path MATCHES "\\.cmake$")
    file(READ "${prefix}/${path}" text)
    string(FIND "${text}" "${BUILD}" at)
    if(NOT at EQUAL -1)
      message(FATAL_ERROR "${path} points into the build folder")
    endif()
  endif()
endforeach()

string(REPLACE "," ";" PROGRAMS "${PROGRAMS}")
foreach(program IN LISTS PROGRAMS)
  execute_process(COMMAND "${prefix}/bin/${program}" --version OUTPUT_VARIABLE version COMMAND_ERROR_IS_FATAL ANY)
  if(NOT version MATCHES "${VERSION}")
    message(FATAL_ERROR "${program} --version printed '${version}', expected ${VERSION}")
  endif()
endforeach()

execute_process(COMMAND "${CMAKE_COMMAND}" -S "${CONSUMER}" -B "${SCRATCH}/consumer" -G "${GENERATOR}"
  "-DCMAKE_CXX_COMPILER=${COMPILER}" "-DCMAKE_PREFIX_PATH=${prefix}"
  -DCMAKE_BUILD_TYPE=Release OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND "${CMAKE_COMMAND}" --build "${SCRATCH}/consumer" COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND "${SCRATCH}/consumer/consumer" OUTPUT_VARIABLE printed COMMAND_ERROR_IS_FATAL ANY)
message(STATUS "the consumer printed: ${printed}")
