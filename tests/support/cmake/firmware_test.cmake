set(cmock_config ${CMAKE_CURRENT_LIST_DIR}/cmock.yml)

# firmware_add_mock(<header>): the library mock_<header>, CMock's stand-in for hal/include/<header>.h.
function(firmware_add_mock header)
    if(TARGET mock_${header})
        return()
    endif()
    set(folder ${PROJECT_BINARY_DIR}/mocks)
    set(original ${PROJECT_SOURCE_DIR}/hal/include/${header}.h)
    add_custom_command(
        OUTPUT ${folder}/mock_${header}.c ${folder}/mock_${header}.h
        COMMAND ${TEST_RUBY} --disable=gems ${CMOCK_DIR}/lib/cmock.rb
                -o${cmock_config} --mock_path=${folder} ${original}
        DEPENDS ${original} ${cmock_config}
        VERBATIM)
    add_library(mock_${header} STATIC ${folder}/mock_${header}.c)
    target_include_directories(mock_${header} SYSTEM PUBLIC ${folder})
    target_compile_options(mock_${header} PRIVATE -w)
    target_link_libraries(mock_${header} PUBLIC cmock hal)
endfunction()

# All test programs, for a preset that needs nothing else.
add_custom_target(all-tests)

# firmware_add_test(<group> <library> <source>): a test program with a generated runner; it sees the
# library and what that sees.
#
# It runs on the host backend, unless it includes a mock_hal_*.h: then those mocks are its backend.
# Arguments after these: what follows the program's name, and definitions that it is compiled with.
function(firmware_add_test group library source)
    cmake_path(GET source STEM stem)
    string(REGEX REPLACE "^test_" "" module ${stem})
    set(definitions ${ARGN})
    list(POP_FRONT definitions suffix)
    set(name ${group}.${module}${suffix})
    set(runner ${CMAKE_CURRENT_BINARY_DIR}/${name}.runner.c)
    add_custom_command(
        OUTPUT ${runner}
        COMMAND ${TEST_RUBY} --disable=gems ${CMOCK_DIR}/vendor/unity/auto/generate_test_runner.rb
                --mock_prefix=mock_ --use_param_tests=1 ${source} ${runner}
        DEPENDS ${source}
        VERBATIM)

    add_executable(${name} ${source} ${runner})
    target_compile_definitions(${name} PRIVATE ${definitions})
    set_target_properties(${name} PROPERTIES
        RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/tests/${group})
    # The prototypes of the test functions are in the runner; the runner is not ours. A test takes
    # longer to optimize than to run.
    set_source_files_properties(${source} PROPERTIES COMPILE_OPTIONS "-Wno-missing-prototypes;-O0")
    set_source_files_properties(${runner} PROPERTIES COMPILE_OPTIONS "-w;-O0")
    get_target_property(deps ${library} DEPS)
    if(NOT deps)
        set(deps "")
    endif()
    target_link_libraries(${name} PRIVATE ${library} ${deps} test_support warnings)

    # The includes decide what is linked, so a change of them has to be seen here.
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${source})
    file(STRINGS ${source} mocks REGEX "^#include \"mock_hal_.*\\.h\"")
    foreach(line IN LISTS mocks)
        string(REGEX REPLACE ".*\"mock_(.*)\\.h\".*" "\\1" header ${line})
        firmware_add_mock(${header})
        target_link_libraries(${name} PRIVATE mock_${header})
    endforeach()
    if(NOT mocks)
        target_link_libraries(${name} PRIVATE hal_host)
    endif()

    add_test(NAME ${name} COMMAND ${name})
    add_dependencies(all-tests ${name})
endfunction()

# firmware_add_tests(<group> <library> <folder>): every test_*.c of a folder. Those on a rig that
# lays pulses are made a second time, <group>.<module>_ahead, with several pulses laid ahead.
function(firmware_add_tests group library folder)
    file(GLOB sources CONFIGURE_DEPENDS ${folder}/test_*.c)
    foreach(source IN LISTS sources)
        firmware_add_test(${group} ${library} ${source})
        file(STRINGS ${source} rigs REGEX "^#include \"(channel|laid|late)_rig\\.h\"")
        if(rigs)
            firmware_add_test(${group} ${library} ${source} _ahead LAID_AHEAD=7)
        endif()
    endforeach()
endfunction()
