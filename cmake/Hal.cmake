# SPDX-License-Identifier: MIT
# The hardware layer for POSIX and Linux, what boards share (for its tests), and argusd, the onboard program.
file(GLOB hal_sources CONFIGURE_DEPENDS hal/posix/*.c hal/linux/*.c hal/fake/*.c hal/board/*.c)
list(FILTER hal_sources EXCLUDE REGEX "/main\\.c$")
file(GLOB argusd_sources CONFIGURE_DEPENDS hal/linux/argusd/*.c)
list(FILTER argusd_sources EXCLUDE REGEX "/main\\.c$")

# A static library needs a source; the tree may hold headers only.
if(NOT hal_sources)
    file(WRITE ${PROJECT_BINARY_DIR}/empty.c "typedef int argus_empty_t;\n")
    set(hal_sources ${PROJECT_BINARY_DIR}/empty.c)
endif()
add_library(argus_hal STATIC ${hal_sources})
target_include_directories(argus_hal PUBLIC ${PROJECT_SOURCE_DIR}/hal/include ${PROJECT_SOURCE_DIR}/hal)
target_compile_options(argus_hal PRIVATE ${ARGUS_STRICT})
set(THREADS_PREFER_PTHREAD_FLAG ON)
find_package(Threads REQUIRED)
target_link_libraries(argus_hal PUBLIC argus Threads::Threads PRIVATE argus_flags)
# gnu11: the POSIX declarations are visible without a feature macro in every file.
set_target_properties(argus_hal PROPERTIES C_EXTENSIONS ON)

# What checks the settings that are compiled into a board's image.
add_executable(board_config tools/board_config.c)
target_compile_options(board_config PRIVATE ${ARGUS_STRICT})
target_link_libraries(board_config PRIVATE argus_hal argus argus_flags)

if(NOT EXISTS ${PROJECT_SOURCE_DIR}/hal/linux/argusd/main.c)
    return()
endif()
if(NOT ARGUS_ARGUSD)
    message(STATUS "argusd: not built, because ARGUS_ARGUSD=OFF")
    return()
endif()
if(ARGUS_STATIC)
    set(CMAKE_FIND_LIBRARY_SUFFIXES .a)
endif()

# Everything but main() is a library, so that unit tests can reach it.
add_library(argusd_parts STATIC ${argusd_sources})
target_include_directories(argusd_parts PUBLIC ${PROJECT_SOURCE_DIR}/hal/linux/argusd)
# --auto-baud reads and writes packets before there is a manager, --inject rewrites those that go to it: both use the wire
# part of the firmware, which is usable alone.
set_source_files_properties(hal/linux/argusd/guards.c hal/linux/argusd/probe.c hal/linux/argusd/inject.c PROPERTIES INCLUDE_DIRECTORIES ${PROJECT_SOURCE_DIR}/firmware)
target_compile_options(argusd_parts PRIVATE ${ARGUS_STRICT})
target_link_libraries(argusd_parts PUBLIC argus_hal argus PRIVATE argus_flags)
if(ARGUS_TUI)
    set(CURSES_NEED_WIDE TRUE)
    find_package(Curses QUIET)
    if(CURSES_FOUND)
        target_compile_definitions(argusd_parts PUBLIC ARGUS_TUI=1)
        target_include_directories(argusd_parts SYSTEM PUBLIC ${CURSES_INCLUDE_DIRS})
        target_link_libraries(argusd_parts PUBLIC ${CURSES_LIBRARIES})
        if(ARGUS_STATIC) # a static library does not say itself that it needs this one
            find_library(TINFO_LIBRARY NAMES tinfow tinfo)
            if(TINFO_LIBRARY)
                target_link_libraries(argusd_parts PUBLIC ${TINFO_LIBRARY})
            endif()
        endif()
    elseif(ARGUS_TUI STREQUAL "AUTO")
        message(STATUS "argusd: built without its screen; apt-get install libncurses-dev adds it")
    else()
        message(FATAL_ERROR "the screen of argusd needs curses: apt-get install libncurses-dev (or -DARGUS_TUI=OFF)")
    endif()
endif()

add_executable(argusd hal/linux/argusd/main.c)
target_compile_options(argusd PRIVATE ${ARGUS_STRICT})
target_link_libraries(argusd PRIVATE argusd_parts argus_flags)
set_target_properties(argusd argusd_parts PROPERTIES C_EXTENSIONS ON)
if(ARGUS_STATIC)
    target_link_options(argusd PRIVATE -static-pie)
endif()
