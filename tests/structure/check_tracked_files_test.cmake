# The test of check_tracked_files.cmake, in scratch repositories.
# cmake -DCHECK=<check_tracked_files.cmake> -DSCRATCH=<folder> -P check_tracked_files_test.cmake
cmake_minimum_required(VERSION 3.25)

set(repository "${SCRATCH}/somewhere/repository")

function(verdict file content expected)
  file(REMOVE_RECURSE "${SCRATCH}")
  file(WRITE "${repository}/${file}" "${content}")
  execute_process(COMMAND git init -q "${repository}" COMMAND_ERROR_IS_FATAL ANY)
  execute_process(COMMAND git -c safe.directory=* -C "${repository}" add . COMMAND_ERROR_IS_FATAL ANY)
  execute_process(COMMAND "${CMAKE_COMMAND}" "-DROOT=${repository}" -P "${CHECK}"
    RESULT_VARIABLE code OUTPUT_VARIABLE text ERROR_VARIABLE text)
  if(code EQUAL 0)
    set(got accepted)
  else()
    set(got refused)
  endif()
  if(NOT got STREQUAL expected)
    message(FATAL_ERROR "${file} was ${got}, expected ${expected}:\n${text}")
  endif()
endfunction()

string(REPEAT "0123456789abcde\n" 65536 mebibyte)
verdict(good.txt "/usr/include and \"shaders/lobe/sg.glsl\"\n" accepted)
verdict(mebibyte.txt "${mebibyte}" accepted)
verdict(large.txt "${mebibyte}x" refused)
verdict(home.txt "see /home/someone/scene.glb\n" refused)
verdict(folder/neighbour.txt "see ${SCRATCH}/somewhere/data\n" refused)
message(STATUS "5 scratch repositories were judged rightly")
