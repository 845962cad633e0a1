// Shader programs from embedded files.
//
// Shaders lie beside their pass (*.vert, *.tesc, *.tese, *.geom, *.frag, *.comp, shared parts *.glsl) and are compiled
// into the library. The loader writes the `#version` line and the defines, and resolves `#include "file.glsl"` (each
// file once per shader) with #line directives, so that a compile error names the very file and line.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <glm/glm.hpp>

#include "rasterizer/gl_objects.h"

namespace plumb {

// Finds a shader file's text; throws std::out_of_range for a name it does not know.
using ShaderLookup = std::function<std::string_view(std::string_view file)>;
std::string_view embedded_shader(std::string_view file);

// Constants that C++ and shader share: written as `#define name value`.
using ShaderDefines = std::vector<std::pair<std::string, std::string>>;

// A float literal for a define that reads back as the same float.
std::string shader_literal(float value);

struct ShaderText {
    std::string text;
    std::vector<std::string> files;  // files[i] is source string number i in #line directives and messages
};
// Throws GlError for an include that is not found, with the including file and line.
ShaderText assemble_shader(std::string_view file, const ShaderDefines& defines, const ShaderLookup& lookup);
// A driver's log with source string numbers replaced by file names.
std::string readable_log(std::string_view log, const std::vector<std::string>& files);

class Program : public GlObject {
public:
    Program() = default;
    // Stages are told by extension. Throws GlError with the driver's log, files and lines named.
    Program(GlContext& context, const std::vector<std::string>& files, const ShaderDefines& defines = {},
            const ShaderLookup& lookup = embedded_shader);

    void use() const;
    // Throw GlError for a name that is not an active uniform: a misspelling would otherwise pass unseen.
    void set(std::string_view uniform, int value) const;
    void set(std::string_view uniform, float value) const;
    void set(std::string_view uniform, const glm::vec2& value) const;
    void set(std::string_view uniform, const glm::vec3& value) const;
    void set(std::string_view uniform, const glm::vec4& value) const;
    void set(std::string_view uniform, const glm::ivec2& value) const;
    void set(std::string_view uniform, const glm::mat4& value) const;
    // The first elements of an array.
    void set(std::string_view uniform, std::span<const glm::vec3> values) const;

private:
    GLint location(std::string_view uniform) const;

    std::string name_;
    std::map<std::string, GLint, std::less<>> locations_;
};

// Programs by files and defines, so that passes that differ only in their targets share one.
class ProgramCache {
public:
    // `common` is defined in every shader.
    explicit ProgramCache(GlContext& context, ShaderDefines common = {})
        : context_(context), common_(std::move(common)) {}
    const Program& get(const std::vector<std::string>& files, const ShaderDefines& defines = {});

private:
    GlContext& context_;
    ShaderDefines common_;
    std::map<std::string, std::unique_ptr<Program>> programs_;
};

}  // namespace plumb
