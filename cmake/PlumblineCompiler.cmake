# Compiler settings for our own code: warnings are errors, one instruction set for all rooms, optional sanitizers.
#
#   PLUMBLINE_ARCH      value of -march ("x86-64-v3" by default; "native"; empty for the compiler's own baseline)
#   PLUMBLINE_SANITIZE  value of -fsanitize (set by the sanitizer presets)
#   PLUMBLINE_BATCHES   on: compiles rooms whose time goes to their headers by the batch, at a third of the time from
#                       nothing; names in anonymous namespaces must then differ within a room. Off: each file alone.

if(NOT CMAKE_BUILD_TYPE)
    set(CMAKE_BUILD_TYPE Release CACHE STRING "Release, Debug or RelWithDebInfo" FORCE)
endif()

find_program(CCACHE ccache)
if(CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
    set(CMAKE_C_COMPILER_LAUNCHER ${CCACHE})
    # Without this it leaves alone what is compiled with precompiled headers.
    set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_SLOPPINESS=pch_defines,time_macros ${CCACHE})
endif()

if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
    set(PLUMBLINE_ARCH "x86-64-v3" CACHE STRING "Value of -march; empty for the compiler's baseline")
else()
    set(PLUMBLINE_ARCH "" CACHE STRING "Value of -march; empty for the compiler's baseline")
endif()
option(PLUMBLINE_BATCHES "Compile files by the batch" ON)
set(PLUMBLINE_SANITIZE "" CACHE STRING "Value of -fsanitize; empty for none")

add_library(plumbline_compiler INTERFACE)
target_compile_options(plumbline_compiler INTERFACE
    -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Wcast-align -Woverloaded-virtual -Werror)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    target_compile_options(plumbline_compiler INTERFACE -fpch-preprocess)  # for ccache
endif()
if(PLUMBLINE_ARCH)
    target_compile_options(plumbline_compiler INTERFACE -march=${PLUMBLINE_ARCH})
endif()
if(PLUMBLINE_SANITIZE)
    # Instrumented code makes GCC 12 warn of uninitialised values inside the standard library's own <regex>.
    target_compile_options(plumbline_compiler INTERFACE -fsanitize=${PLUMBLINE_SANITIZE} -fno-omit-frame-pointer
                           -Wno-maybe-uninitialized)
    target_link_options(plumbline_compiler INTERFACE -fsanitize=${PLUMBLINE_SANITIZE})
endif()

# plumbline_room(NAME sources... [LIBRARIES libs...] [BATCHES])
# One static library per room, called plumbline_NAME; files include each other as "room/file.h". BATCHES is for rooms
# that hold no hot code: who is compiled together decides what is inlined.
function(plumbline_room name)
    cmake_parse_arguments(ROOM "BATCHES" "" "LIBRARIES" ${ARGN})
    add_library(plumbline_${name} STATIC ${ROOM_UNPARSED_ARGUMENTS})
    target_include_directories(plumbline_${name} PUBLIC ${CMAKE_SOURCE_DIR})
    target_link_libraries(plumbline_${name} PUBLIC ${ROOM_LIBRARIES} PRIVATE plumbline_compiler)
    if(ROOM_BATCHES AND PLUMBLINE_BATCHES)
        set_target_properties(plumbline_${name} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 8)
    endif()
endfunction()
