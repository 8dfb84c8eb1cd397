# Rules for `cmake --install` and for the packages built by experiments/package.sh: a Debian package that depends on
# Debian's libraries, and an archive (PKM_BUNDLE) that includes them.
if(NOT PKM_BUNDLE)  # for the archive's users, other compilers and libraries apply: build from source
  include(CMakePackageConfigHelpers)
  set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/pkmopt)
  write_basic_package_version_file(pkmopt-config-version.cmake COMPATIBILITY SameMinorVersion)
  # One file of targets for each component of find_package(), so that the others' dependencies need not be installed.
  foreach(library core mechanisms optimisers io program pkmopt c)
    set(target pkmopt_${library})
    if(library STREQUAL pkmopt)
      set(target pkmopt)
    endif()
    if(NOT TARGET ${target} OR (library MATCHES "^(program|c)$" AND NOT PKM_PROGRAM))
      continue()
    endif()
    install(TARGETS ${target} EXPORT pkmopt-${library})
    install(EXPORT pkmopt-${library} NAMESPACE pkmopt:: FILE pkmopt-${library}.cmake DESTINATION ${package_folder})
  endforeach()
  # This folder is in the users' include path, so that #include lines are the same as in this repository.
  install(CODE "set(SOURCE ${PROJECT_SOURCE_DIR})\nset(PROGRAM ${PKM_PROGRAM})
set(HEADERS \${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_INCLUDEDIR}/pkmopt)")
  install(SCRIPT engine/install_headers.cmake)
  configure_file(engine/pkmopt-config.cmake.in pkmopt-config.cmake @ONLY)
  install(FILES ${CMAKE_CURRENT_BINARY_DIR}/pkmopt-config.cmake ${CMAKE_CURRENT_BINARY_DIR}/pkmopt-config-version.cmake
          DESTINATION ${package_folder})
endif()

# The C interface; the Python package that uses it, for Debian's Python or in a folder of the archive; the functions for
# MATLAB and Octave, whose MEX file users compile by pkmopt.build.
if(TARGET pkmopt_c)
  set(python_folder $<IF:$<BOOL:${PKM_BUNDLE}>,python,lib/python3/dist-packages>)
  install(DIRECTORY bindings/python/pkmopt DESTINATION ${python_folder} FILES_MATCHING PATTERN *.py PATTERN py.typed
          PATTERN __pycache__ EXCLUDE)
  install(DIRECTORY bindings/matlab DESTINATION $<IF:$<BOOL:${PKM_BUNDLE}>,.,${CMAKE_INSTALL_DATADIR}/pkmopt>
          FILES_MATCHING PATTERN *.m PATTERN *.[ch])
  install(FILES bindings/c/pkmopt.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
  install(FILES bindings/c/example.c DESTINATION ${CMAKE_INSTALL_DOCDIR})
  file(RELATIVE_PATH to_prefix /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
  configure_file(bindings/c/pkmopt.pc.in pkmopt.pc @ONLY)
  install(FILES ${CMAKE_CURRENT_BINARY_DIR}/pkmopt.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
endif()

set(studies ${CMAKE_INSTALL_DATADIR}/pkmopt)
install(DIRECTORY experiments DESTINATION ${studies} FILES_MATCHING
  REGEX "\\.(toml|md|svg|png)$"
  REGEX "\\.(sh|sbatch)$" PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE
    GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE
  PATTERN experiments/*.sh EXCLUDE PATTERN pictures/*.sh EXCLUDE PATTERN app EXCLUDE)

# The documentation pages, with a link to the studies, so that relative links between them work as in the repository.
install(FILES LICENSE README.md CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR} FILES_MATCHING PATTERN *.md PATTERN _static EXCLUDE)
file(RELATIVE_PATH from_pages /${CMAKE_INSTALL_DOCDIR} /${studies}/experiments)
file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/pages)
file(CREATE_LINK ${from_pages} ${PROJECT_BINARY_DIR}/pages/experiments SYMBOLIC)
install(FILES ${PROJECT_BINARY_DIR}/pages/experiments DESTINATION ${CMAKE_INSTALL_DOCDIR})

# Copyright files of the libraries that are compiled into the program.
foreach(part libhdf5-dev libcli11-dev nlohmann-json3-dev libeigen3-dev librandom123-dev)
  install(FILES /usr/share/doc/${part}/copyright DESTINATION ${CMAKE_INSTALL_DOCDIR}/licences RENAME ${part} OPTIONAL)
endforeach()
if(PKM_HAS_PAGE)
  cmake_path(GET PKM_PLOTLY PARENT_PATH plotly)
  install(FILES ${plotly}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR}/licences RENAME plotly.js)
endif()

if(NOT PKM_PROGRAM)
  return()
endif()
set(programs pkmopt_app pkmopt_check_proof)
# Debian requires an address. The domain .invalid is reserved for non-existent addresses; see docs/help.md for contacts.
set(CPACK_PACKAGE_CONTACT "pkmopt authors <pkmopt@pkmopt.invalid>")
if(NOT PKM_BUNDLE)
  install(TARGETS ${programs} RUNTIME)
  install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} RENAME copyright)  # the name that Debian requires
  string(TIMESTAMP now "%a, %d %b %Y %H:%M:%S +0000" UTC)
  file(CONFIGURE OUTPUT debian/changelog @ONLY CONTENT [[
pkmopt (@PROJECT_VERSION@) stable; urgency=medium

  * See CHANGELOG.md for the changes.

 -- @CPACK_PACKAGE_CONTACT@  @now@
]])
  execute_process(COMMAND gzip -9nf ${CMAKE_CURRENT_BINARY_DIR}/debian/changelog COMMAND_ERROR_IS_FATAL ANY)
  install(FILES ${CMAKE_CURRENT_BINARY_DIR}/debian/changelog.gz DESTINATION ${CMAKE_INSTALL_DOCDIR})
  file(CONFIGURE OUTPUT debian/overrides @ONLY CONTENT [[
# The program, its library and the files to build with it are one package, whose scripts of CPack call ldconfig.
pkmopt: package-name-doesnt-match-sonames
pkmopt: link-to-shared-library-in-wrong-package
pkmopt: maintscript-calls-ldconfig
]])
  install(FILES ${CMAKE_CURRENT_BINARY_DIR}/debian/overrides DESTINATION ${CMAKE_INSTALL_DATADIR}/lintian/overrides
          RENAME pkmopt)
  file(CONFIGURE OUTPUT debian/triggers CONTENT "activate-noawait ldconfig\n")
  set(CPACK_DEBIAN_PACKAGE_CONTROL_EXTRA ${CMAKE_CURRENT_BINARY_DIR}/debian/triggers)
  set(CPACK_GENERATOR DEB)
else()  # experiments/package.sh packs the installed files, so that the archive is reproducible
  set(CPACK_GENERATOR TGZ)
  set(beside ${CMAKE_INSTALL_LIBDIR}/pkmopt)
  set_target_properties(${programs} PROPERTIES INSTALL_RPATH $ORIGIN/../${beside})
  set_target_properties(pkmopt_c PROPERTIES INSTALL_RPATH $ORIGIN/pkmopt)
  foreach(target IN LISTS programs ITEMS pkmopt_c)  # RPATH instead of RUNPATH: also used for dependencies of the libraries
    target_link_options(${target} PRIVATE LINKER:--disable-new-dtags)
  endforeach()
  install(TARGETS ${programs} pkmopt_c RUNTIME_DEPENDENCY_SET pkmopt_libraries RUNTIME LIBRARY)
  install(RUNTIME_DEPENDENCY_SET pkmopt_libraries DESTINATION ${beside}
    PRE_EXCLUDE_REGEXES "^(libc|libm|libdl|libpthread|librt|ld-linux.*)\\.so")  # provided by the system
  # Copyright files of the Debian packages from which these libraries are copied.
  install(CODE "set(beside ${beside})\nset(licences ${CMAKE_INSTALL_DOCDIR}/licences)")
  install(CODE [[
    file(REAL_PATH $ENV{DESTDIR}${CMAKE_INSTALL_PREFIX} prefix)  # the prefix may be relative
    file(GLOB libraries RELATIVE ${prefix}/${beside} ${prefix}/${beside}/*)
    foreach(library IN LISTS libraries)
      # A link may be one of the system's choice among several packages (libblas.so.3), so look for the file behind it.
      file(REAL_PATH ${prefix}/${beside}/${library} file)
      cmake_path(GET file FILENAME name)
      execute_process(COMMAND dpkg-query --search *-linux-gnu*/${name} /usr/lib/${name} OUTPUT_VARIABLE found ERROR_QUIET)
      string(REGEX MATCHALL "(^|\n)[^:\n]+" packages "${found}")
      foreach(package IN LISTS packages)
        string(STRIP "${package}" package)
        configure_file(/usr/share/doc/${package}/copyright ${prefix}/${licences}/${package} COPYONLY)
      endforeach()
    endforeach()]])
endif()

set(CPACK_PACKAGE_DESCRIPTION "pkmopt computes the workspace, coupling and forces of a parallel robot and
optimises its dimensions, with exact derivatives where closed forms exist.
The robot is built in or defined by a mechanism file.")
set(CPACK_PACKAGE_VENDOR pkmopt)
set(CPACK_VERBATIM_VARIABLES ON)
set(CPACK_STRIP_FILES ON)
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_PACKAGE_DEPENDS "python3:any")
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "python3-numpy")  # for `import pkmopt`
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "bash-completion, man-db, g++, cmake, pkg-config, libeigen3-dev, libhdf5-dev, libnlopt-dev, \
coinor-libipopt-dev, liblapack-dev, libtomlplusplus-dev, libxxhash-dev, zlib1g-dev, octave-dev")
include(CPack)
