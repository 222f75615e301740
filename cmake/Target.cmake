# SPDX-License-Identifier: MIT
# Unit tests that run on another machine than this one: on a board in QEMU, where semihosting is their terminal, their
# files and their end, or in QEMU's user mode.
file(GLOB target_hal CONFIGURE_DEPENDS hal/board/*.c)
add_library(argus_hal STATIC ${target_hal} hal/posix/store.c hal/posix/crc32.c hal/fake/fake_store.c)
target_include_directories(argus_hal PUBLIC hal hal/include)
target_compile_options(argus_hal PRIVATE ${ARGUS_STRICT})
target_link_libraries(argus_hal PUBLIC argus PRIVATE argus_flags)
set_target_properties(argus_hal PROPERTIES C_EXTENSIONS ON)

if(ARGUS_TARGET STREQUAL "user")
    return() # Linux programs of another processor: the toolchain says how they are run
endif()
set(script ${PROJECT_SOURCE_DIR}/tests/target/${ARGUS_TARGET}.ld)
if(NOT EXISTS ${script})
    message(FATAL_ERROR "ARGUS_TARGET=${ARGUS_TARGET}: no tests/target/${ARGUS_TARGET}.ld")
endif()
add_library(target_vectors OBJECT ${PROJECT_SOURCE_DIR}/tests/target/vectors.c)
set(CMAKE_CROSSCOMPILING_EMULATOR ${PROJECT_SOURCE_DIR}/tests/target/run ${ARGUS_TARGET})
link_libraries(target_vectors)
add_link_options(--specs=rdimon.specs -Wl,-L${PROJECT_SOURCE_DIR}/tests/target -Wl,-T${script} -Wl,--gc-sections -Wl,--no-warn-rwx-segments)
