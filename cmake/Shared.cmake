# SPDX-License-Identifier: MIT
# libargus.so: the fault manager for other languages, with tools/core_shim.c; exports what the public header and the shim declare.
set(declaring ${PROJECT_SOURCE_DIR}/firmware/include/argus/argus.h ${PROJECT_SOURCE_DIR}/tools/core_shim.c)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${declaring})
set(names "")
foreach(source IN LISTS declaring)
    file(STRINGS ${source} lines REGEX "^[a-z][a-z0-9_ *]*[ *]argus_[a-z0-9_]+(\\(|\\[)")
    foreach(line IN LISTS lines)
        if(line MATCHES "^(static|typedef)")
            continue()
        endif()
        string(REGEX REPLACE "^.*[ *](argus_[a-z0-9_]+)(\\(|\\[).*$" "\\1" name "${line}")
        list(APPEND names "${name}")
    endforeach()
endforeach()
list(REMOVE_DUPLICATES names)
list(JOIN names ";\n    " names)
# Its symbol has the number of sonars in its name (argus.h, ARGUS_TAG).
string(REGEX REPLACE "(^|[^a-z_])argus_init([^a-z_]|$)" "\\1argus_init_for_${ARGUS_SONARS}_sonars\\2" names "${names}")
file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/argus.map CONTENT "{\nglobal:\n    @names@;\nlocal:\n    *;\n};\n" @ONLY)

# One compilation serves both libraries. Nobody replaces a function of ours, so position independence costs no inlining.
set_target_properties(argus PROPERTIES POSITION_INDEPENDENT_CODE ON)
target_compile_options(argus PRIVATE -fno-semantic-interposition)
add_library(argus_shared SHARED $<TARGET_OBJECTS:argus> tools/core_shim.c)
target_include_directories(argus_shared PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/firmware/include>
                                               $<INSTALL_INTERFACE:include>
                           PRIVATE firmware)
target_compile_definitions(argus_shared PUBLIC ARGUS_SONARS=${ARGUS_SONARS})
target_compile_options(argus_shared PRIVATE ${ARGUS_STRICT})
target_link_options(argus_shared PRIVATE -Wl,-z,relro,-z,now -Wl,--version-script=${PROJECT_BINARY_DIR}/argus.map)
target_link_libraries(argus_shared PRIVATE $<BUILD_INTERFACE:argus_flags>)
set_target_properties(argus_shared PROPERTIES OUTPUT_NAME argus VERSION ${PROJECT_VERSION}
                      SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR} POSITION_INDEPENDENT_CODE ON
                      LINK_DEPENDS ${PROJECT_BINARY_DIR}/argus.map
                      LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR})

if(ARGUS_ASSERTS)
    target_compile_definitions(argus_shared PRIVATE ARGUS_ASSERTS=1)
endif()

# libargus_sim.so: the emulator's echo model and its sub-steps in C. Neither contraction nor sincos, so that every number is the one that
# Python forms; the other options change no result, since nobody looks at errno or at the exception flags.
add_library(argus_sim SHARED hil_sim/sonar/kernel.c hil_sim/robot/report.c hil_sim/robot/ring.c
                              hil_sim/robot/tick.c hil_sim/sil/loop.c hil_sim/sil/sightings.c hil_sim/world/body.c
                              hil_sim/world/moving.c)
target_compile_options(argus_sim PRIVATE ${ARGUS_STRICT} -ffp-contract=off -fno-builtin-sin -fno-builtin-cos
                                         -fno-math-errno -fno-trapping-math $<$<CONFIG:Release>:-O3>)
target_link_options(argus_sim PRIVATE -Wl,-z,relro,-z,now)
target_link_libraries(argus_sim PRIVATE argus_flags m)
set_target_properties(argus_sim PROPERTIES POSITION_INDEPENDENT_CODE ON C_VISIBILITY_PRESET default
                      LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR})
