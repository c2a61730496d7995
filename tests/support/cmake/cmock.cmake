# CMock and Unity, sources and generators: Debian's package, else the same release from its authors.
find_program(TEST_RUBY ruby REQUIRED)
list(APPEND TEST_RUBY -W0 --disable=gems) # starts in half the time

find_path(CMOCK_DIR lib/cmock.rb PATHS /usr/share/cmock NO_DEFAULT_PATH)
if(NOT CMOCK_DIR)
    include(FetchContent)
    FetchContent_Declare(cmock
        GIT_REPOSITORY https://github.com/ThrowTheSwitch/CMock.git
        GIT_TAG v2.5.3
        GIT_SUBMODULES vendor/unity vendor/c_exception
        GIT_SHALLOW ON)
    FetchContent_Populate(cmock)
    set(CMOCK_DIR ${cmock_SOURCE_DIR})
endif()

add_library(unity STATIC ${CMOCK_DIR}/vendor/unity/src/unity.c)
target_include_directories(unity SYSTEM PUBLIC ${CMOCK_DIR}/vendor/unity/src)
target_compile_definitions(unity PUBLIC UNITY_INCLUDE_DOUBLE UNITY_USE_FLUSH_STDOUT)
target_compile_options(unity PUBLIC "-DTEST_CASE(...)=") # read by the runner generator only

add_library(cmock STATIC ${CMOCK_DIR}/src/cmock.c)
target_include_directories(cmock SYSTEM PUBLIC ${CMOCK_DIR}/src)
target_link_libraries(cmock PUBLIC unity)
