# Compiles scenarios/ into the program, so that `plica run drosophila` needs no other files: scenarios as text, tables of
# scenarios/data/ as bytes (compilers limit the length of a string), and experiments of scenarios/living/ and scenarios/paper/.
file(GLOB scenario_files CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/scenarios/*.toml)
set(builtin_scenarios_cpp ${CMAKE_BINARY_DIR}/generated/builtin_scenarios.cpp)
set(entries "")
foreach(file ${scenario_files})
  get_filename_component(name ${file} NAME_WE)
  file(READ ${file} text)
  string(APPEND entries "    {\"${name}\", R\"TOML(${text})TOML\"},\n")
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${file})
endforeach()
file(GLOB table_files CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/scenarios/data/*.csv)
set(tables "")
set(table_bytes "")
foreach(file ${table_files})
  get_filename_component(name ${file} NAME_WE)
  file(READ ${file} bytes HEX)
  string(REGEX REPLACE "([0-9a-f][0-9a-f])" "'\\\\x\\1'," bytes ${bytes})
  string(APPEND table_bytes "const char ${name}[] = {${bytes}};\n")
  string(APPEND tables "    {\"${name}\", {${name}, sizeof ${name}}},\n")
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${file})
endforeach()
# Experiments with their scenarios and parameter samples; and the work of built-in scenarios.
file(GLOB experiment_files CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR}/scenarios
  ${PROJECT_SOURCE_DIR}/scenarios/work.csv
  ${PROJECT_SOURCE_DIR}/scenarios/living/*.toml ${PROJECT_SOURCE_DIR}/scenarios/living/*.csv
  ${PROJECT_SOURCE_DIR}/scenarios/paper/*.toml ${PROJECT_SOURCE_DIR}/scenarios/paper/*.csv)
set(files "")
foreach(path ${experiment_files})
  file(READ ${PROJECT_SOURCE_DIR}/scenarios/${path} text)
  string(APPEND files "    {\"${path}\", R\"FILE(${text})FILE\"},\n")
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/scenarios/${path})
endforeach()
file(CONFIGURE OUTPUT ${builtin_scenarios_cpp} CONTENT [[
// Generated from scenarios/*.toml by cmake/builtin_scenarios.cmake.
#include "scenario/builtin.hpp"

namespace plica {
namespace {

@table_bytes@
}  // namespace

const std::vector<BuiltinTable>& builtin_tables() {
  static const std::vector<BuiltinTable> tables = {
@tables@  };
  return tables;
}

const std::vector<BuiltinScenario>& builtin_scenarios() {
  static const std::vector<BuiltinScenario> scenarios = {
@entries@  };
  return scenarios;
}

const std::vector<BuiltinFile>& builtin_experiment_files() {
  static const std::vector<BuiltinFile> files = {
@files@  };
  return files;
}

}  // namespace plica
]] @ONLY)
