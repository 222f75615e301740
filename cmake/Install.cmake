# SPDX-License-Identifier: MIT
# What `cmake --install` brings, and the target `uninstall`, which takes it away again.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

# The library: header, static and shared, for CMake and for pkg-config.
install(FILES firmware/include/argus/argus.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/argus)
install(TARGETS argus EXPORT argus_targets)
if(TARGET argus_shared)
    install(TARGETS argus_shared EXPORT argus_targets)
endif()
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/argus)
install(EXPORT argus_targets NAMESPACE argus:: FILE argusTargets.cmake DESTINATION ${package_dir})
configure_package_config_file(cmake/argusConfig.cmake.in ${PROJECT_BINARY_DIR}/argusConfig.cmake
                              INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/argusConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/argusConfig.cmake ${PROJECT_BINARY_DIR}/argusConfigVersion.cmake
        DESTINATION ${package_dir})
# From where the file lies up to the prefix, so that the whole may be moved.
file(RELATIVE_PATH up_to_prefix /p/${CMAKE_INSTALL_LIBDIR}/pkgconfig /p)
configure_file(cmake/argus.pc.in ${PROJECT_BINARY_DIR}/argus.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/argus.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)

# What reads its frames and packets.
install(FILES tools/argus.dbc tools/argus.lua DESTINATION ${CMAKE_INSTALL_DATADIR}/argus)

if(TARGET argusd)
    install(TARGETS argusd)
    install(FILES docs/argusd.conf.example DESTINATION ${CMAKE_INSTALL_DOCDIR})
    # systemd wants the whole path of the program, which is known when it is installed.
    install(CODE "
        set(bindir \"\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_BINDIR}\")
        configure_file(\"${PROJECT_SOURCE_DIR}/hal/linux/argusd.service.in\"
                       \"${PROJECT_BINARY_DIR}/argusd.service\" @ONLY)")
    install(FILES ${PROJECT_BINARY_DIR}/argusd.service DESTINATION lib/systemd/system)
endif()
if(TARGET argus_sim)
    install(TARGETS argus_sim)
endif()
install(FILES docs/man/argusd.1 docs/man/argusctl.1 docs/man/argus-sim.1 docs/man/argus-log.1
        DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)

add_custom_target(uninstall COMMAND ${CMAKE_COMMAND} -DMANIFEST=${PROJECT_BINARY_DIR}/install_manifest.txt
                                    -P ${PROJECT_SOURCE_DIR}/cmake/Uninstall.cmake VERBATIM)
