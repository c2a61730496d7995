# The image of the board RKM04_BOARD: <board>.elf, .hex and .bin in bin/, checked.
find_package(Python3 3.11 REQUIRED COMPONENTS Interpreter)

set(image ${RKM04_BOARD})
set(script ${PROJECT_SOURCE_DIR}/hal/stm32/stm32f405.ld)
set(elf $<TARGET_FILE:rkm04_image>)
set(output ${CMAKE_RUNTIME_OUTPUT_DIRECTORY}/${image})

# rkm04_add_image(<target> <name> <main>): the unit with a main, for the board.
function(rkm04_add_image target name main)
    add_executable(${target} ${main})
    set_target_properties(${target} PROPERTIES OUTPUT_NAME ${name} SUFFIX .elf LINK_DEPENDS ${script})
    target_link_libraries(${target} PRIVATE rkm04_unit rkm04_hal_stm32 rkm04_warnings)
    # Relocations stay in the image (-q): they tell the checks what refers to what.
    target_link_options(${target} PRIVATE -nostartfiles --specs=nano.specs -T ${script}
        -Wl,--gc-sections -Wl,-q -Wl,--fatal-warnings -Wl,-Map=${CMAKE_RUNTIME_OUTPUT_DIRECTORY}/${name}.map)
endfunction()
rkm04_add_image(rkm04_image ${image} firmware/main.c)
rkm04_add_image(rkm04_bench ${image}-bench hal/stm32/bench/bench_main.c)

# For a test that asks for it.
rkm04_add_image(rkm04_disarm ${image}-disarm tests/vboard/images/disarm_main.c)
set_target_properties(rkm04_disarm PROPERTIES EXCLUDE_FROM_ALL ON)

set(checks ${PROJECT_SOURCE_DIR}/tools/checks)
set(board_header ${PROJECT_SOURCE_DIR}/hal/stm32/boards/${RKM04_BOARD}/board.h)
set(run_check ${CMAKE_COMMAND} -E env PYTHONPATH=${PROJECT_SOURCE_DIR}/tools PYTHONDONTWRITEBYTECODE=1
    ${Python3_EXECUTABLE} -m)
add_custom_command(OUTPUT ${output}.hex ${output}.bin
    COMMAND ${CMAKE_OBJCOPY} -O ihex ${elf} ${output}.hex
    COMMAND ${CMAKE_OBJCOPY} -O binary ${elf} ${output}.bin
    DEPENDS rkm04_image VERBATIM COMMENT "Files for flashing")
add_custom_command(OUTPUT checked.stamp
    COMMAND ${run_check} checks.board_pins ${board_header}
    COMMAND ${run_check} checks.ram_code ${elf}
    COMMAND ${CMAKE_COMMAND} -E touch checked.stamp
    DEPENDS rkm04_image ${board_header} ${checks}/board_pins.py ${checks}/ram_code.py
    VERBATIM COMMENT "Checking pins, and what runs from RAM")
add_custom_target(rkm04_board ALL DEPENDS ${output}.hex ${output}.bin checked.stamp)
