# How a room's library and a program are declared: one place for the language level and the warnings.
include(GNUInstallDirs)
find_package(Threads REQUIRED)

set(CHIARO_WARNINGS -Wall -Wextra -Wconversion -Wshadow -Wno-unknown-pragmas)
if(CHIARO_WARNINGS_AS_ERRORS)
  list(APPEND CHIARO_WARNINGS -Werror)
endif()

function(chiaro_configure_target target)
  target_compile_features(${target} PUBLIC cxx_std_20)
  set_target_properties(${target} PROPERTIES CXX_EXTENSIONS OFF POSITION_INDEPENDENT_CODE ON)
  # Bit-for-bit results across builds: no fused multiply-add behind our back, no fast-math.
  target_compile_options(${target} PRIVATE ${CHIARO_WARNINGS} -ffp-contract=off)
  if(CHIARO_SANITIZE)
    set(sanitize "-fsanitize=${CHIARO_SANITIZE}" -fno-sanitize-recover=all -fno-omit-frame-pointer)
    target_compile_options(${target} PRIVATE ${sanitize})
    target_link_options(${target} PUBLIC ${sanitize})
  endif()
endfunction()

# chiaro_add_library(<room> SOURCES ... PUBLIC ... PRIVATE ...) makes chiaro_<room> and chiaro::<room>.
function(chiaro_add_library room)
  cmake_parse_arguments(arg "" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  add_library(chiaro_${room} STATIC ${arg_SOURCES})
  add_library(chiaro::${room} ALIAS chiaro_${room})
  set_target_properties(chiaro_${room} PROPERTIES EXPORT_NAME ${room})
  chiaro_configure_target(chiaro_${room})
  target_include_directories(chiaro_${room} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/chiaro>)
  target_link_libraries(chiaro_${room} PUBLIC ${arg_PUBLIC} PRIVATE ${arg_PRIVATE})
  set_property(GLOBAL APPEND PROPERTY CHIARO_INSTALLED_TARGETS chiaro_${room})
endfunction()

# chiaro_add_program(<name> SOURCES ... LIBRARIES ...)
function(chiaro_add_program name)
  cmake_parse_arguments(arg "" "" "SOURCES;LIBRARIES" ${ARGN})
  add_executable(${name} ${arg_SOURCES})
  chiaro_configure_target(${name})
  target_compile_definitions(${name} PRIVATE CHIARO_VERSION="${PROJECT_VERSION}")
  target_link_libraries(${name} PRIVATE ${arg_LIBRARIES})
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}/bin")
  set_property(GLOBAL APPEND PROPERTY CHIARO_INSTALLED_PROGRAMS ${name})
endfunction()
