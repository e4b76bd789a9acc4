# Bundles viewer/ with npm's packages (viewer/package-lock.json) into pages: of runs and of a study, for plica_core, and of the studio, for the Python package.
set(viewer_dir ${PROJECT_SOURCE_DIR}/viewer)
set(report_template ${CMAKE_BINARY_DIR}/generated/report_template.html)
set(study_template ${CMAKE_BINARY_DIR}/generated/study_template.html)
set(studio_page ${CMAKE_BINARY_DIR}/generated/studio_page.html)
find_program(PLICA_NPM npm)
find_program(PLICA_NODE node)
if(NOT PLICA_NPM OR NOT PLICA_NODE)
  message(FATAL_ERROR "report.html needs Node and npm: apt-get install nodejs npm, or configure with -DPLICA_WITH_VIEWER=OFF")
endif()
file(GLOB_RECURSE viewer_sources CONFIGURE_DEPENDS ${viewer_dir}/src/*)

# npm's record of what it installed. The packages' own scripts are not needed.
set(installed ${viewer_dir}/node_modules/.package-lock.json)
add_custom_command(OUTPUT ${installed}
  COMMAND ${PLICA_NPM} ci --ignore-scripts --no-audit --no-fund --loglevel=error
  COMMAND ${CMAKE_COMMAND} -E touch ${installed}
  DEPENDS ${viewer_dir}/package.json ${viewer_dir}/package-lock.json
  WORKING_DIRECTORY ${viewer_dir}
  COMMENT "Installing the viewer's packages (npm ci)" VERBATIM)
add_custom_command(OUTPUT ${report_template} ${study_template} ${studio_page}
  COMMAND ${PLICA_NODE} ${viewer_dir}/build.mjs ${report_template} ${study_template} ${studio_page}
  DEPENDS ${installed} ${viewer_dir}/build.mjs ${viewer_sources}
  COMMENT "Bundling the reports' pages" VERBATIM)
add_custom_target(report_template DEPENDS ${report_template} ${study_template} ${studio_page})
add_dependencies(plica_outer report_template)
set_source_files_properties(${PROJECT_SOURCE_DIR}/src/show/report.cpp PROPERTIES
  COMPILE_DEFINITIONS "PLICA_REPORT_TEMPLATE=\"${report_template}\";PLICA_STUDY_TEMPLATE=\"${study_template}\""
  OBJECT_DEPENDS "${report_template};${study_template}")
