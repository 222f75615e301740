# SPDX-License-Identifier: MIT
# The Debian packages that cpack makes: argusd, argus-tools, libargusMAJOR.MINOR and libargus-dev.
set(abi ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
set(deb_dir ${PROJECT_SOURCE_DIR}/cmake/deb)
set(made ${PROJECT_BINARY_DIR}/deb)
set(control ${made}/control)

set(CPACK_PACKAGE_NAME argus)
set(CPACK_PACKAGE_VENDOR Argus)
set(CPACK_PACKAGE_CONTACT "${ARGUS_MAINTAINER}")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "") # each package has its own
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_ALL argusd tools lib dev)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_ENABLE_COMPONENT_DEPENDS OFF)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
    OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)

# The licence, as Debian writes it: a blank and a dot for an empty line.
file(STRINGS LICENSE licence_lines)
list(POP_FRONT licence_lines)
set(argus_licence "")
foreach(line IN LISTS licence_lines)
    if(line MATCHES "^Copyright \\(c\\) (.*)$")
        set(argus_copyright "Copyright: ${CMAKE_MATCH_1}")
    elseif(line)
        string(APPEND argus_licence " ${line}\n")
    elseif(argus_licence)
        string(APPEND argus_licence " .\n")
    endif()
endforeach()
string(STRIP "${argus_licence}" argus_licence)
string(PREPEND argus_licence " ")
configure_file(${deb_dir}/copyright.in ${made}/copyright @ONLY)

# The project's address, where pyproject.toml has one.
file(STRINGS ${PROJECT_SOURCE_DIR}/pyproject.toml homepage REGEX "^Homepage = \"[^\"]+\"")
if(homepage)
    string(REGEX REPLACE "^Homepage = \"([^\"]+)\".*" "\\1" CPACK_DEBIAN_PACKAGE_HOMEPAGE "${homepage}")
endif()

# Each package: its name, section, what it says of itself, and what every Debian package documents.
function(argus_deb component name section summary text)
    string(TOUPPER ${component} upper)
    foreach(field IN ITEMS NAME SECTION)
        string(TOLOWER ${field} value)
        set(CPACK_DEBIAN_${upper}_PACKAGE_${field} ${${value}} PARENT_SCOPE)
    endforeach()
    set(CPACK_DEBIAN_${upper}_FILE_NAME DEB-DEFAULT PARENT_SCOPE)
    set(CPACK_DEBIAN_${upper}_DESCRIPTION "${summary}\n${text}" PARENT_SCOPE)
    set(doc ${made}/${name})
    configure_file(${deb_dir}/changelog.in ${doc}/changelog @ONLY)
    # Without name and time inside, so that the same sources make the same file.
    execute_process(COMMAND gzip -9nf ${doc}/changelog COMMAND_ERROR_IS_FATAL ANY)
    install(FILES ${made}/copyright DESTINATION share/doc/${name} COMPONENT ${component})
    install(FILES ${doc}/changelog.gz DESTINATION share/doc/${name} COMPONENT ${component})
    if(EXISTS ${deb_dir}/${component}.lintian-overrides)
        install(FILES ${deb_dir}/${component}.lintian-overrides DESTINATION share/lintian/overrides RENAME ${name}
                COMPONENT ${component})
    endif()
endfunction()

set(about "Argus keeps an ARCOS robot (Pioneer P3-DX and its kin) driving safely when
its sonars fail: it finds those that are dead or report wrong values, and
works round them.
")
argus_deb(argusd argusd misc "fault manager for the sonars of a mobile robot" "${about}
This is the program for the onboard computer, with its unit for systemd.")
argus_deb(tools argus-tools misc "emulator of a mobile robot, and reader of its logs" "${about}
This is argus-sim, an emulated robot whose sonars fail on demand, argus-log,
and the Python module argus with both, the robot's protocol, and the fault
manager itself.")
argus_deb(lib libargus${abi} libs "fault manager for the sonars of a mobile robot, library" "${about}
This is the library, for programs that bring their own wire and clock.")
argus_deb(dev libargus-dev libdevel "fault manager for sonars of a mobile robot, for developers" "${about}
This is what programs are built with: the header, the library, and what CMake
and pkg-config want.")

set(CPACK_DEBIAN_ARGUSD_PACKAGE_DEPENDS "adduser")
set(CPACK_DEBIAN_ARGUSD_PACKAGE_SUGGESTS "argus-tools")
set(CPACK_DEBIAN_ARGUSD_PACKAGE_CONTROL_EXTRA
    "${control}/conffiles;${deb_dir}/argusd/postinst;${deb_dir}/argusd/prerm;${deb_dir}/argusd/postrm")
set(CPACK_DEBIAN_TOOLS_PACKAGE_DEPENDS
    "python3 (>= 3.11), python3-numpy, python3-yaml, python3-serial, python3-matplotlib, python3-rich")
set(CPACK_DEBIAN_TOOLS_PACKAGE_SUGGESTS "argusd, python3-can, python3-aiohttp")
set(CPACK_DEBIAN_TOOLS_PACKAGE_CONTROL_EXTRA "${deb_dir}/argus-tools/postinst;${deb_dir}/argus-tools/prerm")
set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS "libargus${abi} (= ${PROJECT_VERSION})")
set(CPACK_DEBIAN_DEV_PACKAGE_SHLIBDEPS OFF)

# The dynamic linker's list of libraries, and who needs this one.
file(WRITE ${control}/shlibs "libargus ${abi} libargus${abi} (>= ${PROJECT_VERSION})\n")
file(WRITE ${control}/triggers "activate-noawait ldconfig\n")
set(CPACK_DEBIAN_LIB_PACKAGE_CONTROL_EXTRA "${control}/shlibs;${control}/triggers")

# What the operator may change: dpkg asks before it replaces such a file.
file(WRITE ${control}/conffiles "/etc/argus/argusd.conf\n/etc/default/argusd\n")
# Every setting is there and is a remark: one that is written, as the rate of the line, outdoes what a link says.
file(READ docs/argusd.conf.example settings)
string(REGEX REPLACE "\n([a-z])" "\n#\\1" settings "${settings}")
file(CONFIGURE OUTPUT ${made}/argusd.conf CONTENT "${settings}" @ONLY)
install(FILES ${made}/argusd.conf DESTINATION /etc/argus COMPONENT argusd)
install(FILES ${deb_dir}/argusd/default DESTINATION /etc/default RENAME argusd COMPONENT argusd)

# The tools, as pip would install them from the wheel.
install(DIRECTORY ${ARGUS_DEB}/lib/ DESTINATION lib/python3/dist-packages COMPONENT tools)
install(DIRECTORY ${ARGUS_DEB}/bin/ DESTINATION bin COMPONENT tools USE_SOURCE_PERMISSIONS)
install(DIRECTORY ${ARGUS_DEB}/share/ DESTINATION share COMPONENT tools)
file(GLOB programs RELATIVE ${ARGUS_DEB}/bin ${ARGUS_DEB}/bin/*)
list(REMOVE_ITEM programs argus-log)
install(FILES tools/argus.bash-completion DESTINATION share/bash-completion/completions RENAME argus-log COMPONENT tools)
file(MAKE_DIRECTORY ${made}/links)
foreach(name IN LISTS programs)
    file(CREATE_LINK argus-log ${made}/links/${name} SYMBOLIC)
    install(FILES ${made}/links/${name} DESTINATION share/bash-completion/completions COMPONENT tools)
endforeach()

include(CPack)
