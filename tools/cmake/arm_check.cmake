# Looks into the objects of the firmware for what must not be there. A build without a board always does: it makes all
# as those of a fast image are made.
find_package(Python3 3.11 REQUIRED COMPONENTS Interpreter)

set(arguments "")
set(libraries "")
foreach(stage IN LISTS FIRMWARE_STAGES)
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
