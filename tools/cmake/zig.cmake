# The compiler of zig, from the Python package ziglang of build/venv, for whatever target.
file(GLOB folders ${CMAKE_CURRENT_LIST_DIR}/../../build/venv/lib/python3*/site-packages/ziglang)
find_program(ZIG zig HINTS ${folders} REQUIRED)
set(CMAKE_C_COMPILER ${ZIG} cc)
set(CMAKE_AR ${ZIG})
set(CMAKE_USER_MAKE_RULES_OVERRIDE ${CMAKE_CURRENT_LIST_DIR}/zig_archive.cmake)
