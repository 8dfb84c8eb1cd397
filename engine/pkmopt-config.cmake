# What find_package(pkmopt) runs: finds again what the static library links to, then defines pkmopt::pkmopt.
if(NOT CMAKE_C_COMPILER_LOADED)  # HDF5 is looked for with the C compiler
  set(${CMAKE_FIND_PACKAGE_NAME}_FOUND FALSE)
  set(${CMAKE_FIND_PACKAGE_NAME}_NOT_FOUND_MESSAGE "pkmopt needs the language C too: project(... LANGUAGES C CXX)")
  return()
endif()
include(CMakeFindDependencyMacro)
find_dependency(Eigen3 3.4 NO_MODULE)
find_dependency(OpenMP COMPONENTS CXX)
find_dependency(HDF5 1.10 COMPONENTS C)
find_dependency(tomlplusplus 3.3)
find_dependency(PkgConfig)
pkg_check_modules(xxhash QUIET REQUIRED IMPORTED_TARGET libxxhash)
include(${CMAKE_CURRENT_LIST_DIR}/pkmopt-targets.cmake)
