# Part of every cross build: looks into the objects of the firmware for what must not be there.
find_package(Python3 3.11 REQUIRED COMPONENTS Interpreter)

set(arguments "")
set(libraries "")
foreach(stage IN LISTS RKM04_STAGES ITEMS unit)
    get_target_property(type rkm04_${stage} TYPE)
    if(type STREQUAL STATIC_LIBRARY)
        list(APPEND libraries rkm04_${stage})
        list(APPEND arguments --stage ${stage} $<TARGET_OBJECTS:rkm04_${stage}>)
    endif()
endforeach()

if(libraries)
    add_custom_command(OUTPUT arm_check.txt
        COMMAND ${Python3_EXECUTABLE} ${PROJECT_SOURCE_DIR}/tools/checks/arm_check.py
                --report arm_check.txt ${arguments}
        DEPENDS ${libraries} tools/checks/arm_check.py
        COMMAND_EXPAND_LISTS VERBATIM
        COMMENT "Checking the objects for Cortex-M4")
    add_custom_target(arm_check ALL DEPENDS arm_check.txt)
endif()
