# `cpack -G DEB` makes whit_VERSION_ARCHITECTURE.deb of what `cmake --install` installs; cmake/debian.cmake puts it in the
# form that Debian wants.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME whit)
set(CPACK_PACKAGE_CONTACT "The whit authors <maintainers@users.noreply.h-seed-3c3d807f.example>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
    OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
# One package, of what is the program's: the Python module is the wheel's.
set(CPACK_COMPONENTS_ALL whit)
set(CPACK_COMPONENTS_GROUPING ALL_COMPONENTS_IN_ONE)
set(CPACK_DEB_COMPONENT_INSTALL ON)

set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PACKAGE_DESCRIPTION "fast and exact renderer of pbrt-v3 scenes
whit renders scene files of pbrt-v3, and glTF models, by Whitted's integrator
or by path tracing, with Embree. It says how exact a picture is, what an
accuracy costs in time for the scene at hand, which settings are wasted, and
whether two pictures differ by more than their noise.

The program needs a processor with AVX2 (x86-64-v3, made since 2013).")
# Of the program and its modules: it looks at all of the package's files.
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_PRE_BUILD_SCRIPTS ${CMAKE_SOURCE_DIR}/cmake/debian.cmake)
set(CPACK_WHIT_ARCH ${WHIT_ARCH})
set(CPACK_WHIT_SOURCE_DIR ${CMAKE_SOURCE_DIR})
include(CPack)
