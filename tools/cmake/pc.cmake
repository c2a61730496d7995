# Programs for a PC of another kind: tools/wheels names the system, the processor and zig's name of both.
set(CMAKE_SYSTEM_NAME ${PC_SYSTEM})
set(CMAKE_SYSTEM_PROCESSOR ${PC_PROCESSOR})
include(${CMAKE_CURRENT_LIST_DIR}/zig.cmake)
set(CMAKE_C_COMPILER_TARGET ${PC_TARGET})
list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES PC_SYSTEM PC_PROCESSOR PC_TARGET)
