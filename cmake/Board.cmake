# SPDX-License-Identifier: MIT
# The image of a microcontroller: hal/board/ (common), hal/cortexm/ and the board's own folder, around libargus.a.
set(board_folder ${PROJECT_SOURCE_DIR}/hal/${ARGUS_BOARD})
if(NOT EXISTS ${board_folder}/port.c)
    file(GLOB ports RELATIVE ${PROJECT_SOURCE_DIR}/hal ${PROJECT_SOURCE_DIR}/hal/*/port.c)
    string(REPLACE "/port.c" "" ports "${ports}")
    message(FATAL_ERROR "ARGUS_BOARD=${ARGUS_BOARD}: no hal/${ARGUS_BOARD}/port.c; there are: ${ports}")
endif()

# The settings compiled in are the text of a file, which the image reads as it reads an operator's.
set(config_text "")
if(ARGUS_CONFIG)
    get_filename_component(config_file "${ARGUS_CONFIG}" ABSOLUTE BASE_DIR ${PROJECT_SOURCE_DIR})
    if(NOT EXISTS ${config_file})
        message(FATAL_ERROR "ARGUS_CONFIG=${ARGUS_CONFIG}: no such file")
    endif()
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${config_file})
    file(STRINGS ${config_file} config_lines)
    foreach(line IN LISTS config_lines)
        string(STRIP "${line}" line)
        string(REGEX REPLACE "([\"\\\\])" "\\\\\\1" line "${line}")
        # Remarks need no place in the image; a line that is left out is kept, so that lines are counted as in the file.
        if(line MATCHES "^[#;]")
            set(line "")
        endif()
        string(APPEND config_text "    \"${line}\\n\"\n")
    endforeach()
endif()
if(config_text STREQUAL "")
    set(config_text "    \"\"\n")
endif()
file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/built_config.c @ONLY CONTENT
     "#include \"board/memory.h\"\nconst char board_built_config[] =\n@config_text@;\n")

# Optimised as one program, which also writes one call graph of it. An archive of such objects is of use to gcc alone.
# The optimiser at the link notes its folder, too, which must not depend on where the tree was unpacked.
set(whole_program -flto -flto-partition=one -g -ffile-prefix-map=${PROJECT_SOURCE_DIR}/=)
set(call_graph "")
if(ARGUS_STACK_USAGE)
    set(call_graph -fstack-usage -fcallgraph-info=su,da)
endif()

file(GLOB board_sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/hal/board/*.c ${board_folder}/*.c)
set(portable_sources hal/posix/store.c hal/posix/crc32.c)
file(GLOB board_scripts CONFIGURE_DEPENDS ${board_folder}/*.ld)
if(board_scripts)
    file(GLOB cortexm_sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/hal/cortexm/*.c)
    list(APPEND board_sources ${cortexm_sources})
    # Called by what the optimiser makes of the rest, so it is no part of that; its loops stay loops.
    set(apart -fno-lto -fno-tree-loop-distribute-patterns)
    if(ARGUS_STACK_USAGE)
        list(APPEND apart -fcallgraph-info=su,da)
    endif()
    set_source_files_properties(${PROJECT_SOURCE_DIR}/hal/cortexm/copy.c PROPERTIES COMPILE_OPTIONS "${apart}")
endif()

# Telemetry and orders over CAN; only a port with a controller has can.c.
if(ARGUS_CAN)
    if(NOT EXISTS ${board_folder}/can.c)
        message(FATAL_ERROR "ARGUS_CAN: hal/${ARGUS_BOARD} has no CAN controller")
    endif()
    list(APPEND board_sources hal/board/can/bus.c)
    list(APPEND portable_sources hal/linux/can_telemetry.c hal/linux/gen_argus_dbc.c)
endif()

add_library(argus_board OBJECT ${board_sources} ${portable_sources} ${PROJECT_BINARY_DIR}/built_config.c)
target_include_directories(argus_board PUBLIC hal hal/include)
target_compile_definitions(argus_board PUBLIC HAL_STORE_RECORD_MAX=1536)
target_compile_definitions(argus PUBLIC ARGUS_WITHOUT_GUARD=1)
# No operating system, but memcpy() of a few bytes is a load, not a call.
target_compile_options(argus_board PRIVATE ${ARGUS_STRICT} -ffreestanding -fbuiltin)
target_link_libraries(argus_board PUBLIC argus PRIVATE argus_flags)
set_target_properties(argus_board PROPERTIES C_EXTENSIONS ON)
if(NOT board_scripts)
    return() # a port without a linker script compiles, and has no image
endif()
target_compile_options(argus PRIVATE ${whole_program})
target_compile_options(argus_board PRIVATE ${whole_program})

string(REPLACE "_" "-" image_name "argus-${ARGUS_BOARD}")
add_executable(argus_image $<TARGET_OBJECTS:argus_board>)
set_target_properties(argus_image PROPERTIES OUTPUT_NAME ${image_name} SUFFIX .elf LINK_DEPENDS
                      "${board_scripts};${PROJECT_SOURCE_DIR}/hal/cortexm/sections.ld")
target_link_libraries(argus_image PRIVATE argus)
target_link_options(argus_image PRIVATE ${whole_program} ${call_graph} -nostartfiles -specs=nano.specs -Wl,--gc-sections
                    -Wl,-L${PROJECT_SOURCE_DIR}/hal/cortexm -Wl,-T${board_scripts}
                    -Wl,-Map=${PROJECT_BINARY_DIR}/${image_name}.map -Wl,--print-memory-usage -Wl,--fatal-warnings
                    -Wl,--no-warn-rwx-segments)
add_custom_command(TARGET argus_image POST_BUILD VERBATIM
    COMMAND ${CMAKE_OBJCOPY} -O ihex $<TARGET_FILE:argus_image> ${PROJECT_BINARY_DIR}/${image_name}.hex
    COMMAND ${CMAKE_OBJCOPY} -O binary --gap-fill 0xFF $<TARGET_FILE:argus_image> ${PROJECT_BINARY_DIR}/${image_name}.bin
    COMMAND ${CMAKE_OBJCOPY} -O binary -j .vectors $<TARGET_FILE:argus_image> ${PROJECT_BINARY_DIR}/${image_name}.vectors.bin
    COMMAND ${CMAKE_OBJCOPY} -O binary -j .text -j .data $<TARGET_FILE:argus_image> ${PROJECT_BINARY_DIR}/${image_name}.body.bin)

# The manager as in the image, played a tape by tests/target/replay.c; its clock is the MPS2 board's.
if(ARGUS_BOARD STREQUAL "mps2_an386")
    add_executable(replay tests/target/replay.c tests/target/vectors.c hal/board/config.c hal/board/word.c
                   hal/posix/crc32.c)
    set_target_properties(replay PROPERTIES SUFFIX .elf C_EXTENSIONS ON)
    target_include_directories(replay PRIVATE hal hal/include)
    target_compile_options(replay PRIVATE ${whole_program})
    target_link_libraries(replay PRIVATE argus argus_flags)
    target_link_options(replay PRIVATE ${whole_program} -specs=rdimon.specs -Wl,--gc-sections
                        -Wl,-L${PROJECT_SOURCE_DIR}/tests/target -Wl,-T${PROJECT_SOURCE_DIR}/tests/target/mps2_an386.ld
                        -Wl,--no-warn-rwx-segments)
endif()

# A port without a Pioneer: the manager observes a ring of sonars (docs/porting.md).
if(ARGUS_BOARD STREQUAL "stm32f405")
    add_executable(hcsr04 examples/hcsr04/main.c examples/hcsr04/text.c hal/board/ring.c hal/board/word.c
                   hal/stm32f405/clock.c hal/stm32f405/usart.c hal/stm32f405/vectors.c ${cortexm_sources})
    set_target_properties(hcsr04 PROPERTIES SUFFIX .elf C_EXTENSIONS ON)
    target_include_directories(hcsr04 PRIVATE hal)
    target_compile_options(hcsr04 PRIVATE ${ARGUS_STRICT} -ffreestanding -fbuiltin ${whole_program})
    target_link_libraries(hcsr04 PRIVATE argus argus_flags)
    target_link_options(hcsr04 PRIVATE ${whole_program} -nostartfiles -specs=nano.specs -Wl,--gc-sections
                        -Wl,-L${PROJECT_SOURCE_DIR}/hal/cortexm -Wl,-T${board_scripts} -Wl,--fatal-warnings
                        -Wl,--no-warn-rwx-segments)
endif()
