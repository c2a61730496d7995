set(cmock_config ${CMAKE_CURRENT_LIST_DIR}/cmock.yml)

# rkm04_add_mock(<header>): the library mock_<header>, CMock's stand-in for hal/include/<header>.h.
function(rkm04_add_mock header)
    if(TARGET mock_${header})
        return()
    endif()
    set(folder ${PROJECT_BINARY_DIR}/mocks)
    set(original ${PROJECT_SOURCE_DIR}/hal/include/${header}.h)
    add_custom_command(
        OUTPUT ${folder}/mock_${header}.c ${folder}/mock_${header}.h
        COMMAND ${RKM04_RUBY} -W0 ${CMOCK_DIR}/lib/cmock.rb -o${cmock_config} --mock_path=${folder} ${original}
        DEPENDS ${original} ${cmock_config}
        VERBATIM)
    add_library(mock_${header} STATIC ${folder}/mock_${header}.c)
    target_include_directories(mock_${header} SYSTEM PUBLIC ${folder})
    target_compile_options(mock_${header} PRIVATE -w)
    target_link_libraries(mock_${header} PUBLIC cmock rkm04_hal)
endfunction()

# All test programs, for a preset that needs nothing else.
add_custom_target(rkm04-tests)

# rkm04_add_test(<group> <library> <source>): a test program with a generated runner.
#
# It runs on the host backend, unless it includes a mock_hal_*.h: then those mocks are its backend.
function(rkm04_add_test group library source)
    cmake_path(GET source STEM stem)
    string(REGEX REPLACE "^test_" "" module ${stem})
    set(name ${group}.${module})
    set(runner ${CMAKE_CURRENT_BINARY_DIR}/${name}.runner.c)
    add_custom_command(
        OUTPUT ${runner}
        COMMAND ${RKM04_RUBY} -W0 ${CMOCK_DIR}/vendor/unity/auto/generate_test_runner.rb
                ${cmock_config} ${source} ${runner}
        DEPENDS ${source} ${cmock_config}
        VERBATIM)

    add_executable(${name} ${source} ${runner})
    set_target_properties(${name} PROPERTIES
        RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/tests/${group})
    # The prototypes of the test functions are in the runner; the runner is not ours.
    set_source_files_properties(${source} PROPERTIES COMPILE_OPTIONS -Wno-missing-prototypes)
    set_source_files_properties(${runner} PROPERTIES COMPILE_OPTIONS -w)
    target_link_libraries(${name} PRIVATE ${library} rkm04_test_support rkm04_warnings)

    # The includes decide what is linked, so a change of them has to be seen here.
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${source})
    file(STRINGS ${source} mocks REGEX "^#include \"mock_hal_.*\\.h\"")
    foreach(line IN LISTS mocks)
        string(REGEX REPLACE ".*\"mock_(.*)\\.h\".*" "\\1" header ${line})
        rkm04_add_mock(${header})
        target_link_libraries(${name} PRIVATE mock_${header})
    endforeach()
    if(NOT mocks)
        target_link_libraries(${name} PRIVATE rkm04_hal_host)
    endif()

    add_test(NAME ${name} COMMAND ${name})
    add_dependencies(rkm04-tests ${name})
endfunction()

# rkm04_add_tests(<group> <library> <folder>): every test_*.c of a folder.
function(rkm04_add_tests group library folder)
    file(GLOB sources CONFIGURE_DEPENDS ${folder}/test_*.c)
    foreach(source IN LISTS sources)
        rkm04_add_test(${group} ${library} ${source})
    endforeach()
endfunction()
