# SPDX-License-Identifier: MIT
# What `cmake --install` brings, and the target `uninstall`, which takes it away again.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

# The library: header, static and shared, for CMake and for pkg-config.
install(FILES firmware/include/argus/argus.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/argus COMPONENT dev)
install(TARGETS argus EXPORT argus_targets ARCHIVE COMPONENT dev)
if(TARGET argus_shared)
    install(TARGETS argus_shared EXPORT argus_targets LIBRARY COMPONENT lib NAMELINK_COMPONENT dev)
endif()
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/argus)
install(EXPORT argus_targets NAMESPACE argus:: FILE argusTargets.cmake DESTINATION ${package_dir} COMPONENT dev)
configure_package_config_file(cmake/argusConfig.cmake.in ${PROJECT_BINARY_DIR}/argusConfig.cmake
                              INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/argusConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/argusConfig.cmake ${PROJECT_BINARY_DIR}/argusConfigVersion.cmake
        DESTINATION ${package_dir} COMPONENT dev)
# From where the file lies up to the prefix, so that the whole may be moved.
file(RELATIVE_PATH up_to_prefix /p/${CMAKE_INSTALL_LIBDIR}/pkgconfig /p)
configure_file(cmake/argus.pc.in ${PROJECT_BINARY_DIR}/argus.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/argus.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT dev)

# A manual page as it is, or packed where the packages of a distribution want it so.
function(install_manual name component)
    set(page ${PROJECT_SOURCE_DIR}/docs/man/${name}.1)
    if(ARGUS_DEB)
        # Without name and time inside, so that the same sources make the same file.
        set(packed ${PROJECT_BINARY_DIR}/deb/${name}.1.gz)
        execute_process(COMMAND gzip -9nc ${page} OUTPUT_FILE ${packed} COMMAND_ERROR_IS_FATAL ANY)
        set(page ${packed})
    endif()
    install(FILES ${page} DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT ${component})
endfunction()

# What reads its frames and packets.
install(FILES tools/argus.dbc tools/argus.lua DESTINATION ${CMAKE_INSTALL_DATADIR}/argus COMPONENT tools)

if(ARGUS_DEB)
    file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/deb)
endif()

if(TARGET argusd)
    install(TARGETS argusd RUNTIME COMPONENT argusd)
    if(NOT ARGUS_DEB)
        install(FILES docs/argusd.conf.example DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT argusd)
    endif()
    # systemd wants whole paths, which are known when it is installed.
    install(CODE "
        set(bindir \"\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_BINDIR}\")
        set(defaultsfile \"\${CMAKE_INSTALL_PREFIX}/etc/default/argusd\")
        if(CMAKE_INSTALL_PREFIX STREQUAL \"/usr\")
            set(defaultsfile /etc/default/argusd)
        endif()
        configure_file(\"${PROJECT_SOURCE_DIR}/hal/linux/argusd.service.in\"
                       \"${PROJECT_BINARY_DIR}/argusd.service\" @ONLY)" COMPONENT argusd)
    install(FILES ${PROJECT_BINARY_DIR}/argusd.service DESTINATION lib/systemd/system COMPONENT argusd)
    install(FILES hal/linux/60-argus.rules DESTINATION lib/udev/rules.d COMPONENT argusd)
    install_manual(argusd argusd)
    install(FILES tools/argus.bash-completion DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions
            RENAME argusd COMPONENT argusd)
endif()
if(TARGET argus_sim)
    install(TARGETS argus_sim COMPONENT emulator)
endif()
file(GLOB pages RELATIVE ${PROJECT_SOURCE_DIR}/docs/man CONFIGURE_DEPENDS docs/man/*.1)
list(REMOVE_ITEM pages argusd.1)
foreach(page IN LISTS pages)
    string(REPLACE ".1" "" name ${page})
    install_manual(${name} tools)
endforeach()

# Into a wheel: beside the modules that load them, or run it.
if(TARGET argus_shared)
    add_custom_target(wheel_parts DEPENDS argus_shared argus_sim)
    if(TARGET argusd)
        add_dependencies(wheel_parts argusd)
        install(TARGETS argusd RUNTIME DESTINATION argus_tools COMPONENT python EXCLUDE_FROM_ALL)
        if(ARGUS_STATIC)
            install(FILES cmake/argusd-licences.txt DESTINATION argus_tools COMPONENT python EXCLUDE_FROM_ALL)
        endif()
    endif()
    install(FILES $<TARGET_FILE:argus_shared> DESTINATION hil_sim/core RENAME libargus.so COMPONENT python EXCLUDE_FROM_ALL
            PERMISSIONS OWNER_READ OWNER_WRITE GROUP_READ WORLD_READ)
    install(FILES $<TARGET_FILE:argus_sim> DESTINATION hil_sim/sonar COMPONENT python EXCLUDE_FROM_ALL
            PERMISSIONS OWNER_READ OWNER_WRITE GROUP_READ WORLD_READ)
endif()

if(DEFINED SKBUILD_DATA_DIR) # ... and where ros2 launch looks, below each folder of AMENT_PREFIX_PATH
    set(share ${SKBUILD_DATA_DIR}/share)
    configure_file(cmake/ros/package.xml.in ${PROJECT_BINARY_DIR}/ros/package.xml @ONLY)
    file(WRITE ${PROJECT_BINARY_DIR}/ros/argus_ros "")
    install(FILES ${PROJECT_BINARY_DIR}/ros/argus_ros DESTINATION ${share}/ament_index/resource_index/packages
            COMPONENT python EXCLUDE_FROM_ALL)
    install(FILES ${PROJECT_BINARY_DIR}/ros/package.xml DESTINATION ${share}/argus_ros COMPONENT python EXCLUDE_FROM_ALL)
    install(DIRECTORY tools/argus_ros/launch tools/argus_ros/config DESTINATION ${share}/argus_ros
            COMPONENT python EXCLUDE_FROM_ALL)
endif()

if(ARGUS_DEB)
    include(cmake/Deb.cmake)
endif()

add_custom_target(uninstall COMMAND ${CMAKE_COMMAND} -DMANIFEST=${PROJECT_BINARY_DIR}/install_manifest.txt
                                    -P ${PROJECT_SOURCE_DIR}/cmake/Uninstall.cmake VERBATIM)
