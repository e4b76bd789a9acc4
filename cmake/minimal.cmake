# plica_minimal, for tests/minimal_test.py: the program without VTK, HDF5 and the report's page, linked from the same objects
# except those that these options change. Its own objects come first, so the linker does not take plica_core's.
file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/generated/no_report_template.cpp CONTENT "#include \"show/report.cpp\"\n")
add_executable(plica_minimal $<TARGET_OBJECTS:plica_app> src/measure/surface_distance_none.cpp src/record/archive_none.cpp src/show/picture_none.cpp
  src/tissue/files/files_none.cpp ${CMAKE_BINARY_DIR}/generated/no_report_template.cpp)
target_link_libraries(plica_minimal PRIVATE plica_options Eigen3::Eigen fmt::fmt nlohmann_json::nlohmann_json $<LINK_ONLY:plica_core>)
target_link_options(plica_minimal PRIVATE -Wl,--as-needed)  # so that VTK and HDF5 are not loaded
