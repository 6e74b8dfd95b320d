# qray::qray, the library, and
#   qray_scene(target scene.nff [NUMBER q32] [SIZE 64x48] [SAMPLES 4] [ADAPTIVE 2] [DEPTH 5] [CUTOFF 0.01] [NAME scene]
#              [MOVING camera,spheres] [WITHIN x,y,z,x,y,z])
# which compiles a scene for #include "scene.hpp" in the target's sources, and again when it changes (NAME is its
# namespace), and
#   qray_object(target scene.nff [FORMAT Rgb565Big] [as above])
# which makes an object library of a scene for targets in C or older C++: qray_c.h says what they call.
if(NOT TARGET qray::qray)
    add_library(qray::qray INTERFACE IMPORTED GLOBAL)
    target_include_directories(qray::qray INTERFACE ${CMAKE_CURRENT_LIST_DIR}/src)
    target_compile_features(qray::qray INTERFACE cxx_std_20)
    target_compile_options(qray::qray INTERFACE $<$<COMPILE_LANGUAGE:CXX>:-ffp-contract=off>)
endif()

set(QRAY_C ${CMAKE_CURRENT_LIST_DIR}/c CACHE INTERNAL "")

# The command of the machine that builds, whatever it builds for.
find_program(QRAY_COMMAND qray HINTS ${CMAKE_CURRENT_LIST_DIR}/bin NO_CMAKE_FIND_ROOT_PATH)

function(qray_scene target scene)
    cmake_parse_arguments(PARSE_ARGV 2 QRAY "" "NUMBER;SIZE;SAMPLES;ADAPTIVE;DEPTH;CUTOFF;NAME;MOVING;WITHIN" "")
    if(QRAY_UNPARSED_ARGUMENTS)
        message(FATAL_ERROR "qray_scene(${target} ${scene}): unknown: ${QRAY_UNPARSED_ARGUMENTS}")
    endif()
    if(NOT QRAY_COMMAND)
        message(FATAL_ERROR "qray_scene(${target} ${scene}): there is no qray command: set QRAY_COMMAND to its path")
    endif()
    get_filename_component(path ${scene} ABSOLUTE)
    get_filename_component(folder ${path} DIRECTORY)
    get_filename_component(name ${path} NAME_WE)
    set(options)
    foreach(option NUMBER=-n SIZE=-s SAMPLES=-r ADAPTIVE=-a DEPTH=-d CUTOFF=--cutoff NAME=--name
            MOVING=--moving WITHIN=--within)
        string(REPLACE "=" ";" pair ${option})
        list(GET pair 0 key)
        list(GET pair 1 flag)
        if(DEFINED QRAY_${key})
            list(APPEND options ${flag} ${QRAY_${key}})
        endif()
    endforeach()
    set(out ${CMAKE_CURRENT_BINARY_DIR}/qray/${target})
    file(MAKE_DIRECTORY ${out})
    file(GLOB beside ${folder}/*.bmp ${folder}/*.ppm ${folder}/*.obj)
    add_custom_command(OUTPUT ${out}/${name}.hpp
        COMMAND ${QRAY_COMMAND} compile ${options} -o ${out}/${name}.hpp ${path}
        DEPENDS ${path} ${beside} ${QRAY_COMMAND} VERBATIM)
    target_sources(${target} PRIVATE ${out}/${name}.hpp)
    target_include_directories(${target} PRIVATE ${out})
endfunction()

function(qray_object target scene)
    cmake_parse_arguments(PARSE_ARGV 2 OBJECT "" "FORMAT" "")
    get_filename_component(name ${scene} NAME_WE)
    add_library(${target} OBJECT ${QRAY_C}/qray_c.cpp)
    target_link_libraries(${target} PRIVATE qray::qray)
    target_include_directories(${target} PUBLIC ${QRAY_C})
    target_compile_options(${target} PRIVATE -fno-exceptions -fno-rtti)
    target_compile_definitions(${target} PRIVATE QRAY_SCENE_HEADER="${name}.hpp")
    if(OBJECT_FORMAT)
        target_compile_definitions(${target} PRIVATE "QRAY_FORMAT=${OBJECT_FORMAT}")
    endif()
    if("MOVING" IN_LIST OBJECT_UNPARSED_ARGUMENTS)
        target_compile_definitions(${target} PRIVATE QRAY_MOVING)
    endif()
    qray_scene(${target} ${scene} ${OBJECT_UNPARSED_ARGUMENTS})
endfunction()
