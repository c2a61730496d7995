# Looks into the objects of the firmware for what must not be there. A build without a board always does: it makes all
# as those of a fast image are made. One of a board looks at what its unit may have.
find_package(Python3 3.11 REQUIRED COMPONENTS Interpreter)

set(arguments "")
set(libraries "")
set(stages ${FIRMWARE_STAGES})
if(FIRMWARE_BOARD)
    set(others rkm04 gve134 positioning)
    list(REMOVE_ITEM others ${FIRMWARE_UNIT})
    list(JOIN others | others)
    list(FILTER stages EXCLUDE REGEX "^(${others})(/|$)")
endif()
foreach(stage IN LISTS stages)
    string(REPLACE / _ library ${stage})
    list(APPEND libraries ${library})
    list(APPEND arguments --stage ${stage} $<TARGET_OBJECTS:${library}>)
endforeach()

if(libraries)
    add_custom_command(OUTPUT arm_check.txt
        COMMAND ${CMAKE_COMMAND} -E env PYTHONPATH=${PROJECT_SOURCE_DIR}/tools PYTHONDONTWRITEBYTECODE=1
                ${Python3_EXECUTABLE} -P -m checks.arm_check --report arm_check.txt ${arguments}
        DEPENDS ${libraries} tools/checks/arm_check.py tools/rkm04_tools/objects.py
        COMMAND_EXPAND_LISTS VERBATIM
        COMMENT "Checking the objects for Cortex-M4")
    add_custom_target(arm_check DEPENDS arm_check.txt)
    if(NOT FIRMWARE_BOARD)
        set_target_properties(arm_check PROPERTIES EXCLUDE_FROM_ALL OFF)
    endif()
endif()
