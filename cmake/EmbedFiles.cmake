# Script behind plumbline_embed: writes HEADER and SOURCE for FILES. Bytes go out as hexadecimal, so that any text passes.
set(entries "")
foreach(file ${FILES})
    get_filename_component(name ${file} NAME)
    string(MAKE_C_IDENTIFIER ${name} identifier)
    file(READ ${file} hex HEX)
    string(REGEX REPLACE "([0-9a-f][0-9a-f])" "'\\\\x\\1'," bytes "${hex}")
    string(APPEND arrays "constexpr char ${identifier}[] = {${bytes}'\\0'};\n")
    string(APPEND entries "    if (file_name == \"${name}\") return {${identifier}, sizeof(${identifier}) - 1};\n")
endforeach()
file(WRITE ${HEADER} "#pragma once\n#include <string_view>\nnamespace plumb::embedded::${NAMESPACE} {
std::string_view find(std::string_view file_name);\n}\n")
file(WRITE ${SOURCE} "#include \"embedded/${NAMESPACE}.h\"\n#include <stdexcept>\n#include <string>\n\nnamespace plumb::embedded::${NAMESPACE} {
namespace {\n${arrays}}  // namespace\n\nstd::string_view find(std::string_view file_name) {\n${entries}    throw std::out_of_range(\"no embedded file '\" + std::string(file_name) + \"'\");\n}
}  // namespace plumb::embedded::${NAMESPACE}\n")
