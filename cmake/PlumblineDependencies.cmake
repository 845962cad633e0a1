# Every dependency is found on the system (scripts/install-dependencies.sh brings them on Debian), none is downloaded.

find_package(Threads REQUIRED)
find_package(glm REQUIRED)
find_package(Imath REQUIRED)
find_package(OpenEXR REQUIRED)
find_package(OpenImageIO REQUIRED)
# Debian's OpenImageIO names the folder of a package that using it does not need; only the folders that exist are kept.
get_target_property(directories OpenImageIO::OpenImageIO INTERFACE_INCLUDE_DIRECTORIES)
foreach(directory ${directories})
    if(NOT EXISTS ${directory})
        list(REMOVE_ITEM directories ${directory})
    endif()
endforeach()
set_target_properties(OpenImageIO::OpenImageIO PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "${directories}")
find_package(assimp REQUIRED)
find_package(fmt REQUIRED)
find_package(ZLIB REQUIRED)
find_package(TBB REQUIRED)
find_package(CLI11 REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(tomlplusplus REQUIRED)
find_package(embree 4 QUIET)
if(NOT embree_FOUND)
    find_package(embree 3 REQUIRED)
endif()
find_package(OpenGL REQUIRED COMPONENTS EGL)

find_path(XXHASH_INCLUDE_DIR xxhash.h REQUIRED)
find_library(XXHASH_LIBRARY xxhash REQUIRED)
add_library(plumbline_xxhash INTERFACE)
target_include_directories(plumbline_xxhash SYSTEM INTERFACE ${XXHASH_INCLUDE_DIR})
target_link_libraries(plumbline_xxhash INTERFACE ${XXHASH_LIBRARY})

# Draws figures as PNG.
find_package(PkgConfig REQUIRED)
pkg_check_modules(RSVG REQUIRED IMPORTED_TARGET librsvg-2.0)

# GLAD 2 generates the OpenGL loader at build time. Debian's package serves Debian's python3, which need not be the
# first one on the path.
find_program(PLUMBLINE_PYTHON python3 PATHS /usr/bin NO_DEFAULT_PATH)
if(NOT PLUMBLINE_PYTHON)
    find_program(PLUMBLINE_PYTHON python3 REQUIRED)
endif()
execute_process(COMMAND ${PLUMBLINE_PYTHON} -c "import glad" RESULT_VARIABLE glad_missing ERROR_QUIET)
if(glad_missing)
    message(FATAL_ERROR "GLAD 2 is missing: ${PLUMBLINE_PYTHON} cannot import glad (Debian package python3-glad)")
endif()
set(GLAD_DIR ${CMAKE_BINARY_DIR}/glad)
add_custom_command(
    OUTPUT ${GLAD_DIR}/src/gl.c ${GLAD_DIR}/include/glad/gl.h
    COMMAND ${PLUMBLINE_PYTHON} -m glad --reproducible --quiet --out-path ${GLAD_DIR} --api gl:core=4.5
            --extensions GL_ARB_shader_viewport_layer_array,GL_KHR_debug,GL_ARB_gpu_shader_int64 c --mx
    COMMENT "Generating the OpenGL loader" VERBATIM)
add_custom_target(plumbline_glad_header DEPENDS ${GLAD_DIR}/include/glad/gl.h)
add_library(plumbline_glad STATIC ${GLAD_DIR}/src/gl.c)
target_include_directories(plumbline_glad SYSTEM PUBLIC ${GLAD_DIR}/include)
