# Installs the libraries, headers, shaders and programs, and the package that find_package(chiaro) reads.
# Included after every room, when CHIARO_INSTALLED_TARGETS and CHIARO_INSTALLED_PROGRAMS are complete.
include(CMakePackageConfigHelpers)

get_property(installed_targets GLOBAL PROPERTY CHIARO_INSTALLED_TARGETS)
get_property(installed_programs GLOBAL PROPERTY CHIARO_INSTALLED_PROGRAMS)
set(package_dir "${CMAKE_INSTALL_LIBDIR}/cmake/chiaro")
set(header_dir "${CMAKE_INSTALL_INCLUDEDIR}/chiaro")

# What a consumer must find again: one line per imported target that an installed library links, private ones included,
# because the libraries are static. A target that no line knows stops the configuration, so the package cannot rot.
if(CHIARO_BUILD_PRECOMPUTE)
  get_directory_property(embree_version DIRECTORY "${PROJECT_SOURCE_DIR}/precompute" DEFINITION embree_VERSION)
  string(REGEX MATCH "^[0-9]+" embree_major "${embree_version}")
endif()
set(finders
  "^glm::" "find_dependency(glm)"
  "^Threads::Threads$" "find_dependency(Threads)"
  "^embree$" "find_dependency(embree ${embree_major} CONFIG)"
  "^Eigen3::" "find_dependency(Eigen3)"
  "^Ceres::" "find_dependency(Ceres)"
  "^BLAS::" "set(BLA_VENDOR OpenBLAS)\nfind_dependency(BLAS)"
  "^OpenMesh(Core|Tools)$" "find_dependency(OpenMesh)"
  "^(OpenEXR|Imath)::" "find_dependency(OpenEXR CONFIG)"
  "^LibLZMA::" "find_dependency(LibLZMA)"
  "^nlohmann_json::" "find_dependency(nlohmann_json)"
  "^TinyGLTF::" "find_dependency(TinyGLTF)"
  "^CLI11::" "find_dependency(CLI11)"
  "^glfw$" "find_dependency(glfw3)"
  "^ZLIB::ZLIB$" "find_dependency(ZLIB)")

function(chiaro_dependency_line item out)
  set(line "")
  if(item MATCHES "^PkgConfig::(.+)$")
    set(module "${CMAKE_MATCH_1}")
    # The prefix of pkg_check_modules names the target; the module's own name may differ (xxhash is libxxhash).
    set(name "${${module}_MODULE_NAME}")
    if(NOT name)
      set(name "${module}")
    endif()
    set(line "find_dependency(PkgConfig)\npkg_check_modules(${module} REQUIRED QUIET IMPORTED_TARGET ${name})")
  else()
    list(LENGTH finders count)
    math(EXPR last "${count} - 1")
    foreach(i RANGE 0 ${last} 2)
      math(EXPR j "${i} + 1")
      list(GET finders ${i} pattern)
      if(item MATCHES "${pattern}")
        list(GET finders ${j} line)
      endif()
    endforeach()
    if(NOT line AND item MATCHES "::")
      message(FATAL_ERROR "cmake/ChiaroInstall.cmake: an installed library links ${item}: add how find_package finds it to 'finders'")
    endif()
  endif()
  set(${out} "${line}" PARENT_SCOPE)
endfunction()

set(CHIARO_DEPENDENCIES "")
foreach(target IN LISTS installed_targets)
  get_target_property(links ${target} INTERFACE_LINK_LIBRARIES)
  foreach(item IN LISTS links)
    string(REGEX REPLACE "^\\$<LINK_ONLY:(.+)>$" "\\1" item "${item}")
    if(NOT item MATCHES "^chiaro(::|_)")
      chiaro_dependency_line("${item}" line)
      list(APPEND CHIARO_DEPENDENCIES ${line})
    endif()
  endforeach()
endforeach()
list(REMOVE_DUPLICATES CHIARO_DEPENDENCIES)
list(JOIN CHIARO_DEPENDENCIES "\n" CHIARO_DEPENDENCIES)

install(TARGETS ${installed_targets} EXPORT chiaroTargets ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}")
if(installed_programs)
  install(TARGETS ${installed_programs} RUNTIME DESTINATION "${CMAKE_INSTALL_BINDIR}")
endif()
install(EXPORT chiaroTargets NAMESPACE chiaro:: DESTINATION "${package_dir}")

set(rooms shaders assets)
if(CHIARO_BUILD_PRECOMPUTE)
  list(APPEND rooms precompute)
endif()
if(CHIARO_BUILD_RUNTIME)
  list(APPEND rooms runtime)
endif()
foreach(room IN LISTS rooms)
  # The lobe maths is GLSL text that the C++ headers include. What only the programs use stays behind.
  install(DIRECTORY "${PROJECT_SOURCE_DIR}/${room}/" DESTINATION "${header_dir}/${room}"
    FILES_MATCHING PATTERN "*.h" PATTERN "*.glsl"
    REGEX "/(shaders/parity|shaders/stage|precompute/report|precompute/program|runtime/parity|runtime/viewer)$" EXCLUDE)
endforeach()
# The runtime carries its shaders inside; these are for reading, and for CHIARO_SHADER_PATH.
install(DIRECTORY "${PROJECT_SOURCE_DIR}/shaders" DESTINATION "${CMAKE_INSTALL_DATADIR}/chiaro"
  FILES_MATCHING PATTERN "*.glsl" PATTERN "*.vert" PATTERN "*.frag" PATTERN "*.comp" REGEX "/shaders/parity$" EXCLUDE)
install(FILES "${PROJECT_SOURCE_DIR}/LICENSE" "${PROJECT_SOURCE_DIR}/README.md" DESTINATION "${CMAKE_INSTALL_DOCDIR}")

configure_package_config_file("${PROJECT_SOURCE_DIR}/cmake/chiaroConfig.cmake.in" "${PROJECT_BINARY_DIR}/chiaroConfig.cmake"
  INSTALL_DESTINATION "${package_dir}")
write_basic_package_version_file("${PROJECT_BINARY_DIR}/chiaroConfigVersion.cmake" COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/chiaroConfig.cmake" "${PROJECT_BINARY_DIR}/chiaroConfigVersion.cmake" DESTINATION "${package_dir}")
