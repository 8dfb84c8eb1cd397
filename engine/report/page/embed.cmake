# Embeds the page of `pkmopt report` into the library: the files of this folder, and Plotly from the npm registry in the
# version that package-lock.json pins. Without npm, pkmopt is built without `report`.
set(PKM_PAGE ${CMAKE_CURRENT_LIST_DIR})
set(pkm_page_build ${CMAKE_CURRENT_BINARY_DIR}/page)
set(PKM_PLOTLY ${pkm_page_build}/node_modules/plotly.js-dist-min/plotly.min.js)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${PKM_PAGE}/package-lock.json)

# Fetches Plotly unless the pinned version is already in the build folder. Sets `why` to "", or to the reason of a failure.
function(pkm_fetch_plotly why)
  set(${why} "" PARENT_SCOPE)
  set(lock ${pkm_page_build}/package-lock.json)
  execute_process(COMMAND ${CMAKE_COMMAND} -E compare_files ${PKM_PAGE}/package-lock.json ${lock}
                  RESULT_VARIABLE differs ERROR_QUIET)
  if(NOT differs AND EXISTS ${PKM_PLOTLY})
    return()
  endif()
  find_program(PKM_NPM npm)
  if(NOT PKM_NPM)
    set(${why} "npm is not installed" PARENT_SCOPE)
    return()
  endif()
  file(COPY ${PKM_PAGE}/package.json ${PKM_PAGE}/package-lock.json DESTINATION ${pkm_page_build})
  execute_process(COMMAND ${PKM_NPM} ci --silent --no-audit --no-fund --ignore-scripts
                  WORKING_DIRECTORY ${pkm_page_build} RESULT_VARIABLE failed OUTPUT_QUIET ERROR_QUIET)
  if(failed OR NOT EXISTS ${PKM_PLOTLY})
    file(REMOVE ${lock})
    set(${why} "npm could not fetch plotly.js-dist-min" PARENT_SCOPE)
  endif()
endfunction()

pkm_fetch_plotly(why)
if(why)
  message(WARNING "pkmopt is built without `pkmopt report`: ${why}. Make npm and its registry available, then configure "
                  "again.")
  return()
endif()

file(GLOB scripts CONFIGURE_DEPENDS ${PKM_PAGE}/*.js)
set(PKM_PAGE_SCRIPT "")
foreach(script IN LISTS scripts)
  string(APPEND PKM_PAGE_SCRIPT "  .incbin \"${script}\"\n")
endforeach()
configure_file(${PKM_PAGE}/embedded.cpp.in ${pkm_page_build}/embedded.cpp @ONLY)
set_source_files_properties(${pkm_page_build}/embedded.cpp PROPERTIES
  OBJECT_DEPENDS "${scripts};${PKM_PAGE}/page.html;${PKM_PAGE}/page.css;${PKM_PLOTLY}")
target_sources(pkmopt_io PRIVATE ${pkm_page_build}/embedded.cpp)
set(PKM_HAS_PAGE ON)
set_source_files_properties(engine/report/html_page.cpp PROPERTIES COMPILE_DEFINITIONS PKM_PAGE_EMBEDDED)
