# Puts the files of scenarios/ into the program, so that `plica run drosophila` needs no files beside it; and the tables
# of scenarios/data/, as bytes, since compilers limit the length of a text.
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

}  // namespace plica
]] @ONLY)
