# Fails when a file includes what its room may not: cmake -DROOT=<checkout> -P check_includes.cmake
#
#   room                 other rooms it may include    only here
#   shaders              none                          GLM
#   assets               shaders
#   precompute           shaders, assets               Embree, in precompute/embree alone
#   precompute/report    shaders, assets, precompute, runtime
#   runtime              shaders, assets               OpenGL, EGL, GLFW, ImGui
#   tests                everything; nothing includes tests
cmake_minimum_required(VERSION 3.25)

set(rooms shaders assets precompute runtime tests)
set(embree_headers "^embree[0-9]*/")
set(gl_headers "^(epoxy|GL|GLES[0-9]*|EGL|KHR|GLFW|glad|X11)/|^imgui|^backends/imgui")
set(violations "")
set(checked 0)

# The part of the tree a file belongs to; the report program is a room of its own.
function(room_of path out)
  string(REGEX MATCH "^[^/]+" room "${path}")
  if(path MATCHES "^precompute/report/")
    set(room "report")
  endif()
  set(${out} "${room}" PARENT_SCOPE)
endfunction()

set(may_include_shaders shaders)
set(may_include_assets assets shaders)
set(may_include_precompute precompute assets shaders)
set(may_include_report report precompute runtime assets shaders)
set(may_include_runtime runtime assets shaders)
set(may_include_tests tests report precompute runtime assets shaders)

file(GLOB_RECURSE files RELATIVE "${ROOT}" LIST_DIRECTORIES false
  "${ROOT}/shaders/*" "${ROOT}/assets/*" "${ROOT}/precompute/*" "${ROOT}/runtime/*" "${ROOT}/tests/*")
list(FILTER files INCLUDE REGEX "\\.(h|hpp|cpp|cc|c|inl|glsl|vert|frag|comp|geom)$")
list(SORT files)

foreach(path IN LISTS files)
  math(EXPR checked "${checked} + 1")
  room_of("${path}" room)
  file(STRINGS "${ROOT}/${path}" lines REGEX "^[ \t]*#[ \t]*include[ \t]*[<\"]")
  set(first "")
  foreach(line IN LISTS lines)
    string(REGEX REPLACE "^[ \t]*#[ \t]*include[ \t]*([<\"])([^>\"]*)[>\"].*$" "\\1\\2" quoted "${line}")
    string(SUBSTRING "${quoted}" 0 1 quote)
    string(SUBSTRING "${quoted}" 1 -1 included)
    if(first STREQUAL "")
      set(first "${included}")
    endif()
    set(says "${path} includes ${included}")

    room_of("${included}" target)
    string(REGEX MATCH "^[^/]+/" top "${included}")
    string(REGEX REPLACE "/$" "" top "${top}")
    if(included MATCHES "(^|/)\\.\\./" OR included MATCHES "^/")
      list(APPEND violations "${says}: name it from the checkout root")
    elseif(top IN_LIST rooms)
      if(NOT target IN_LIST may_include_${room})
        list(APPEND violations "${says}: ${room} may not include ${target}")
      elseif(NOT EXISTS "${ROOT}/${included}")
        list(APPEND violations "${says}: there is no such file")
      endif()
    elseif(room STREQUAL "tests")
      # Tests may use any library, and files that their build makes.
    elseif(quote STREQUAL "\"")
      list(APPEND violations "${says}: our own files are named from the checkout root, others in <>")
    elseif(included MATCHES "${embree_headers}" AND NOT path MATCHES "^precompute/embree/")
      list(APPEND violations "${says}: only precompute/embree may see Embree")
    elseif(included MATCHES "${gl_headers}" AND NOT room STREQUAL "runtime")
      list(APPEND violations "${says}: only runtime may see OpenGL and windows")
    endif()
  endforeach()

  # A header that needs help fails at once when its own source includes it first.
  string(REGEX REPLACE "\\.cpp$" ".h" own_header "${path}")
  if(path MATCHES "\\.cpp$" AND EXISTS "${ROOT}/${own_header}" AND NOT first STREQUAL own_header)
    list(APPEND violations "${path}: its first include must be ${own_header}, not '${first}'")
  endif()
endforeach()

if(checked EQUAL 0)
  message(FATAL_ERROR "no source file under '${ROOT}'")
endif()
if(violations)
  list(JOIN violations "\n  " text)
  message(FATAL_ERROR "includes that break the house rules:\n  ${text}")
endif()
message(STATUS "${checked} files keep the house rules")
