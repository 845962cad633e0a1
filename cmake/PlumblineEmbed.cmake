# plumbline_embed(TARGET NAMESPACE files...)
# Compiles text files (shaders, the report page's script) into TARGET. The generated header "embedded/NAMESPACE.h"
# declares `std::string_view plumb::embedded::NAMESPACE::find(std::string_view file_name)`, which returns the file's text
# and throws std::out_of_range for a name that was not embedded. Files keep their base names, which must be unique.
add_custom_target(plumbline_generated_headers)  # what scripts/lint.sh needs without building anything
function(plumbline_embed target namespace)
    set(directory ${CMAKE_BINARY_DIR}/generated/${target})
    set(header ${directory}/embedded/${namespace}.h)
    set(source ${directory}/${namespace}.cpp)
    set(files)
    foreach(file ${ARGN})
        get_filename_component(path ${file} ABSOLUTE)
        list(APPEND files ${path})
    endforeach()
    add_custom_command(
        OUTPUT ${header} ${source}
        COMMAND ${CMAKE_COMMAND} "-DNAMESPACE=${namespace}" "-DHEADER=${header}" "-DSOURCE=${source}" "-DFILES=${files}"
                -P ${CMAKE_SOURCE_DIR}/cmake/EmbedFiles.cmake
        DEPENDS ${files} ${CMAKE_SOURCE_DIR}/cmake/EmbedFiles.cmake
        COMMENT "Embedding the files of ${target} (${namespace})" VERBATIM)
    target_sources(${target} PRIVATE ${source} ${header})
    add_custom_target(${target}_${namespace}_header DEPENDS ${header})
    add_dependencies(plumbline_generated_headers ${target}_${namespace}_header)
    target_include_directories(${target} PRIVATE ${directory})
endfunction()
