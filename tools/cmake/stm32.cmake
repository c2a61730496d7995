# The image of a unit on a board: <unit>-<board>.elf, .hex and .bin in bin/, checked.
find_package(Python3 3.11 REQUIRED COMPONENTS Interpreter)

set(image ${FIRMWARE_UNIT}-${FIRMWARE_BOARD})
set(script ${PROJECT_SOURCE_DIR}/hal/stm32/stm32f405.ld)
set(unit_script ${PROJECT_SOURCE_DIR}/firmware/${FIRMWARE_UNIT}/image/image_ram.ld)
set(elf $<TARGET_FILE:unit_image>)
set(output ${CMAKE_RUNTIME_OUTPUT_DIRECTORY}/${image})

# A loader of the board has the beginning of the flash. The header has a form in which a line is what the compiler sees
# (rkm04_tools.board_form), or nothing is compiled.
set(board_header ${PROJECT_SOURCE_DIR}/hal/stm32/boards/${FIRMWARE_BOARD}/board.h)
file(STRINGS ${board_header} loader REGEX "^#define BOARD_LOADER_BYTES ")
string(REGEX REPLACE "^#define BOARD_LOADER_BYTES " "" loader_bytes "${loader}")
if(NOT loader_bytes)
    set(loader_bytes 0)
endif()

# The unit says how large its stack is.
set(image_header ${PROJECT_SOURCE_DIR}/firmware/${FIRMWARE_UNIT}/image/image.h)
file(STRINGS ${image_header} stack REGEX "^#define IMAGE_STACK_BYTES ")
string(REGEX REPLACE "^#define IMAGE_STACK_BYTES " "" stack_bytes "${stack}")

# And whether it is to be small rather than fast; the step interrupt is fast in any case. Asserts then have no words.
file(STRINGS ${image_header} small REGEX "^#define IMAGE_SMALL 1$")
if(small)
    # Of what -Os does, GCC 12 makes this code larger by these.
    set(small_options -Os -fno-tree-pre -fno-tree-forwprop -fno-code-hoisting
        -fno-tree-loop-im -fno-move-loop-invariants -fno-schedule-insns2)
    foreach(stage IN LISTS FIRMWARE_STAGES)
        string(REPLACE / _ library ${stage})
        target_include_directories(${library} BEFORE PRIVATE ${PROJECT_SOURCE_DIR}/hal/stm32/small)
        if(NOT library STREQUAL engine_step)
            target_compile_options(${library} PRIVATE ${small_options})
        endif()
    endforeach()
    target_include_directories(hal_stm32 BEFORE PRIVATE ${PROJECT_SOURCE_DIR}/hal/stm32/small)
    target_compile_options(hal_stm32 PRIVATE ${small_options})
    target_compile_definitions(engine_step PRIVATE STEP_SKIP_MAX=1U)
    # But for the steps, and for what a pulse that is to change waits for most.
    foreach(fast hal/stm32/stm32_step.c firmware/engine/path/path_divide.c firmware/engine/path/path_fixed.c
            firmware/engine/path/path_root.c firmware/positioning/registers/pos_table.c)
        get_filename_component(folder ${fast} DIRECTORY)
        set_source_files_properties(${PROJECT_SOURCE_DIR}/${fast}
            DIRECTORY ${PROJECT_SOURCE_DIR}/${folder} PROPERTIES COMPILE_OPTIONS -O2)
    endforeach()
    set_source_files_properties(${PROJECT_SOURCE_DIR}/firmware/engine/step/step_channel_change.c
        DIRECTORY ${PROJECT_SOURCE_DIR}/firmware/engine/step PROPERTIES COMPILE_OPTIONS -Os)
else()
    set_source_files_properties(${PROJECT_SOURCE_DIR}/hal/stm32/stm32_step.c
        DIRECTORY ${PROJECT_SOURCE_DIR}/hal/stm32 PROPERTIES COMPILE_OPTIONS "-fno-tree-forwprop;-fpeel-loops")
endif()
# GCC 12: without this pass a step takes fewer cycles and less memory (hal/stm32/bench/README.md).
target_compile_options(engine_step PRIVATE -fno-tree-forwprop)

set(checks ${PROJECT_SOURCE_DIR}/tools/checks)
set(run_python ${CMAKE_COMMAND} -E env PYTHONPATH=${PROJECT_SOURCE_DIR}/tools PYTHONDONTWRITEBYTECODE=1
    ${Python3_EXECUTABLE} -m)

# Before anything is compiled: nothing that could be flashed is left of pins that are wrong.
add_custom_command(OUTPUT pins.stamp
    COMMAND ${run_python} checks.board_pins ${board_header}
    COMMAND ${CMAKE_COMMAND} -E touch pins.stamp
    DEPENDS ${board_header} ${checks}/board_pins.py
        ${PROJECT_SOURCE_DIR}/tools/rkm04_tools/board_form.py ${PROJECT_SOURCE_DIR}/tools/rkm04_tools/board_header.py
    VERBATIM COMMENT "Checking pins")
add_custom_target(board_pins DEPENDS pins.stamp)
add_dependencies(hal_stm32 board_pins)

# firmware_add_image(<target> <name> <library> <source>...): a main and the library that it needs, for the board.
function(firmware_add_image target name library)
    add_executable(${target} ${ARGN})
    add_dependencies(${target} board_pins)
    set_target_properties(${target} PROPERTIES OUTPUT_NAME ${name} SUFFIX .elf LINK_DEPENDS "${script};${unit_script}")
    set_target_properties(${target} PROPERTIES sram_data 0 flat 0)
    target_link_libraries(${target} PRIVATE ${library} hal hal_stm32 warnings)
    # Relocations stay in the image (-q): they tell the checks what refers to what. No segment has the file's headers
    # (--nmagic): the first one is not in the flash.
    target_link_options(${target} PRIVATE -nostartfiles --specs=nano.specs
        -Wl,--defsym=stm32_loader_bytes=${loader_bytes} -Wl,--defsym=stm32_stack_bytes=${stack_bytes}
        -Wl,--defsym=stm32_sram_data=$<TARGET_PROPERTY:${target},sram_data>
        -Wl,--defsym=stm32_flat=$<TARGET_PROPERTY:${target},flat> -T ${script}
        -L ${PROJECT_SOURCE_DIR}/firmware/${FIRMWARE_UNIT}/image
        -Wl,--gc-sections -Wl,-q -Wl,--nmagic -Wl,--fatal-warnings
        -Wl,-Map=${CMAKE_RUNTIME_OUTPUT_DIRECTORY}/${name}.map)
endfunction()
firmware_add_image(unit_image ${image} ${FIRMWARE_UNIT} firmware/${FIRMWARE_UNIT}/main.c)
if(FIRMWARE_UNIT STREQUAL rkm04)
    firmware_add_image(bench_image ${image}-bench rkm04 hal/stm32/bench/bench_main.c)
    firmware_add_image(paths_image ${image}-paths rkm04 hal/stm32/bench/path_main.c)
    target_link_libraries(paths_image PRIVATE engine_group)

    # What a new board is tried with; it speaks as the RKM04 unit does.
    set(bringup bringup-${FIRMWARE_BOARD})
    set(bringup_output ${CMAKE_RUNTIME_OUTPUT_DIRECTORY}/${bringup})
    file(GLOB bringup_sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/hal/stm32/bringup/*.c)
    firmware_add_image(bringup_image ${bringup} engine_step ${bringup_sources})
    set_property(TARGET bringup_image PROPERTY sram_data 8K) # parts that have less memory are told, not silent
    target_link_libraries(bringup_image PRIVATE base)
    target_include_directories(bringup_image PRIVATE ${PROJECT_SOURCE_DIR}/hal/stm32/boards/${FIRMWARE_BOARD}
        ${PROJECT_SOURCE_DIR}/firmware/${FIRMWARE_UNIT}/image)
    # The tool that walks through it knows by this whether both have the same header.
    file(SHA1 ${board_header} header_sum)
    string(SUBSTRING ${header_sum} 0 8 header_sum)
    target_compile_definitions(bringup_image PRIVATE
        BRINGUP_BOARD="${FIRMWARE_BOARD}" BRINGUP_HEADER="${header_sum}")
endif()

# For the tests that ask for them.
firmware_add_image(take_back_image ${image}-take-back engine_step tests/vboard/images/take_back_main.c)
firmware_add_image(step_acts_image ${image}-step-acts engine_step tests/vboard/images/step_acts_main.c)
firmware_add_image(seam_image ${image}-seam base tests/vboard/images/seam_main.c)
firmware_add_image(flat_image ${image}-flat ${FIRMWARE_UNIT} firmware/${FIRMWARE_UNIT}/main.c)
set_target_properties(flat_image PROPERTIES sram_data 56K flat 1) # for an emulator that has no memory but SRAM
target_link_libraries(take_back_image PRIVATE base)
target_link_libraries(step_acts_image PRIVATE base)
set_target_properties(take_back_image step_acts_image seam_image flat_image PROPERTIES EXCLUDE_FROM_ALL ON)

set(suffix ${PROJECT_SOURCE_DIR}/tools/rkm04_tools/image_suffix.py)
add_custom_command(OUTPUT ${output}.hex ${output}.bin
    COMMAND ${CMAKE_OBJCOPY} -O ihex ${elf} ${output}.hex
    COMMAND ${CMAKE_OBJCOPY} -O binary ${elf} ${output}.bin
    COMMAND ${run_python} rkm04_tools.image_suffix ${image} ${output}.bin
    DEPENDS unit_image ${suffix} VERBATIM COMMENT "Files for flashing")
set(files ${output}.hex ${output}.bin)
if(TARGET bringup_image)
    add_custom_command(OUTPUT ${bringup_output}.hex ${bringup_output}.bin
        COMMAND ${CMAKE_OBJCOPY} -O ihex $<TARGET_FILE:bringup_image> ${bringup_output}.hex
        COMMAND ${CMAKE_OBJCOPY} -O binary $<TARGET_FILE:bringup_image> ${bringup_output}.bin
        COMMAND ${run_python} rkm04_tools.image_suffix ${bringup} ${bringup_output}.bin
        DEPENDS bringup_image ${suffix} VERBATIM COMMENT "Files for flashing, to try the board")
    list(APPEND files ${bringup_output}.hex ${bringup_output}.bin)
endif()
if(TARGET paths_image)
    set(check_paths COMMAND ${run_python} checks.ram_code ${FIRMWARE_UNIT} $<TARGET_FILE:paths_image>)
endif()
add_custom_command(OUTPUT checked.stamp
    COMMAND ${run_python} checks.ram_code ${FIRMWARE_UNIT} ${elf}
    ${check_paths}
    COMMAND ${CMAKE_COMMAND} -E touch checked.stamp
    DEPENDS unit_image $<TARGET_NAME_IF_EXISTS:paths_image> ${checks}/ram_code.py
    VERBATIM COMMENT "Checking what runs from RAM")
# All of a board, and nothing that only other units have.
add_custom_target(board_files ALL DEPENDS ${files} checked.stamp)
if(TARGET bench_image)
    add_dependencies(board_files bench_image)
endif()
if(small)
    add_dependencies(board_files arm_check)
endif()
