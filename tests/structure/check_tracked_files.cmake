# Fails when a tracked file names a path of the machine it was written on, or is over 1 MiB.
# cmake -DROOT=<checkout> -P check_tracked_files.cmake
cmake_minimum_required(VERSION 3.25)

set(git git -c safe.directory=* -C "${ROOT}")
execute_process(COMMAND ${git} rev-parse --show-toplevel RESULT_VARIABLE code OUTPUT_VARIABLE top ERROR_QUIET
  OUTPUT_STRIP_TRAILING_WHITESPACE)
if(NOT code EQUAL 0)
  message(STATUS "SKIPPED: ${ROOT} is not a git checkout")
  return()
endif()
set(wrong "")

execute_process(COMMAND ${git} ls-files OUTPUT_VARIABLE files COMMAND_ERROR_IS_FATAL ANY OUTPUT_STRIP_TRAILING_WHITESPACE)
string(REPLACE "\n" ";" files "${files}")
foreach(path IN LISTS files)
  if(EXISTS "${ROOT}/${path}")
    file(SIZE "${ROOT}/${path}" bytes)
    if(bytes GREATER 1048576)
      list(APPEND wrong "${path}: ${bytes} bytes, more than 1 MiB")
    endif()
  endif()
endforeach()

# The folder the checkout stands in, where its name is the machine's own and not one that any text may use.
cmake_path(GET top PARENT_PATH parent)
set(patterns "/home/[a-z_]" "/Users/[A-Za-z]")
if(NOT parent MATCHES "^/?$|^/(tmp|usr|usr/src|opt|srv|mnt|src|var/tmp|root|home)$")
  list(APPEND patterns "${parent}/")
endif()
foreach(pattern IN LISTS patterns)
  # The checker and its test have to spell the patterns.
  execute_process(COMMAND ${git} grep -nIE -e "${pattern}" -- . ":!tests/structure/check_tracked_files*.cmake"
    OUTPUT_VARIABLE hits RESULT_VARIABLE code ERROR_VARIABLE error OUTPUT_STRIP_TRAILING_WHITESPACE)
  if(code EQUAL 0)
    list(APPEND wrong "a path of one machine (${pattern}):\n${hits}")
  elseif(NOT code EQUAL 1)
    message(FATAL_ERROR "git grep failed: ${error}")
  endif()
endforeach()

list(LENGTH files count)
if(wrong)
  list(JOIN wrong "\n  " text)
  message(FATAL_ERROR "tracked files that should not be so:\n  ${text}")
endif()
message(STATUS "${count} tracked files are small and name no machine")
