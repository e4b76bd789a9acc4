# `cmake --install`, and a Debian package: cmake --build build/release --target package. The program contains its scenarios
# and the report's page; the packages it requires follow from what it links.
include(GNUInstallDirs)
install(TARGETS plica RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(FILES README.md CHANGELOG.md CITATION.cff DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} RENAME copyright)
install(DIRECTORY scenarios DESTINATION ${CMAKE_INSTALL_DOCDIR})

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_CONTACT "The plica authors <maintainers@plica.invalid>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "simulator of how sheets of living cells fold")
set(CPACK_DEBIAN_PACKAGE_DESCRIPTION "plica simulates how a sheet of living cells folds, cell by cell and in three dimensions.
A scenario specifies which cells contract, how strongly and when; results are an
interactive report, pictures, and tables of depths, areas and speeds.")
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_DEPENDS libopenblas0-serial)  # the variant without threads: docs/developers/dependencies.md
# For pictures without a screen.
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "xvfb, libgl1-mesa-dri")
set(CPACK_STRIP_FILES ON)
include(CPack)
