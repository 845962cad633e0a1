#include "rasterizer/shader.h"

#include <algorithm>
#include <charconv>
#include <regex>
#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "embedded/rasterizer.h"
#include "rasterizer/gl_error.h"

namespace plumb {

std::string_view embedded_shader(std::string_view file) { return embedded::rasterizer::find(file); }

std::string shader_literal(float value) {
    // Nine digits name every float; the exponent makes it a float also where there is no decimal point.
    return fmt::format("{:.8e}", value);
}

namespace {

// `#include "file"`, or an empty view.
std::string_view included_file(std::string_view line) {
    const std::size_t start = line.find_first_not_of(" \t");
    constexpr std::string_view directive = "#include \"";
    if (start == std::string_view::npos || !line.substr(start).starts_with(directive)) return {};
    const std::string_view rest = line.substr(start + directive.size());
    return rest.substr(0, rest.find('"'));
}

void append_file(ShaderText& shader, const std::string& file, std::string_view included_from,
                 const ShaderLookup& lookup) {
    std::string_view text;
    try {
        text = lookup(file);
    } catch (const std::out_of_range&) {
        throw GlError(fmt::format("shader file '{}' {}is not there; list it among the embedded files", file,
                                  included_from.empty() ? "" : fmt::format("(included from {}) ", included_from)));
    }
    const std::size_t number = shader.files.size();
    shader.files.push_back(file);
    shader.text += fmt::format("#line 1 {}\n", number);
    int line_number = 0;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        const std::string_view line = text.substr(0, end);
        text.remove_prefix(std::min(end + 1, text.size()));
        ++line_number;
        const std::string_view included = included_file(line);
        if (included.empty()) {
            shader.text.append(line).push_back('\n');
            continue;
        }
        if (std::ranges::find(shader.files, included) == shader.files.end()) {
            append_file(shader, std::string(included), fmt::format("{}:{}", file, line_number), lookup);
        }
        shader.text += fmt::format("#line {} {}\n", line_number + 1, number);
    }
}

GLenum stage_of(std::string_view file) {
    const std::string_view extension = file.substr(std::min(file.rfind('.'), file.size()));
    if (extension == ".vert") return GL_VERTEX_SHADER;
    if (extension == ".frag") return GL_FRAGMENT_SHADER;
    if (extension == ".tesc") return GL_TESS_CONTROL_SHADER;
    if (extension == ".tese") return GL_TESS_EVALUATION_SHADER;
    if (extension == ".geom") return GL_GEOMETRY_SHADER;
    if (extension == ".comp") return GL_COMPUTE_SHADER;
    throw GlError(fmt::format("shader file '{}' must end in .vert, .tesc, .tese, .geom, .frag or .comp", file));
}

GLuint create_program(GlContext& context) {
    context.make_current();
    return context.gl.CreateProgram();
}

}  // namespace

ShaderText assemble_shader(std::string_view file, const ShaderDefines& defines, const ShaderLookup& lookup) {
    ShaderText shader;
    shader.text = "#version 450 core\n";
    for (const auto& [name, value] : defines) shader.text += fmt::format("#define {} {}\n", name, value);
    append_file(shader, std::string(file), {}, lookup);
    return shader;
}

std::string readable_log(std::string_view log, const std::vector<std::string>& files) {
    // Mesa "0:12(3): error", NVIDIA "0(12) : error", AMD and ANGLE "ERROR: 0:12:".
    static const std::regex position(R"(^((?:ERROR|WARNING): )?(\d+)[:(](\d+)\)?)");
    std::istringstream lines{std::string(log)};
    std::string readable;
    for (std::string line; std::getline(lines, line);) {
        std::smatch match;
        if (std::regex_search(line, match, position)) {
            const std::size_t number = std::stoul(match[2].str());
            const std::string file = number < files.size() ? files[number] : match[2].str();
            line = fmt::format("{}{}:{}{}", match[1].str(), file, match[3].str(), match.suffix().str());
        }
        readable += line + '\n';
    }
    return readable;
}

Program::Program(GlContext& context, const std::vector<std::string>& files, const ShaderDefines& defines,
                 const ShaderLookup& lookup)
    : GlObject(context, Kind::program, create_program(context), 0), name_(fmt::format("{}", fmt::join(files, " + "))) {
    const GladGLContext& gl = context.gl;
    for (const std::string& file : files) {
        const ShaderText shader = assemble_shader(file, defines, lookup);
        const GLuint stage = gl.CreateShader(stage_of(file));
        const char* text = shader.text.c_str();
        gl.ShaderSource(stage, 1, &text, nullptr);
        gl.CompileShader(stage);
        GLint compiled = GL_FALSE, length = 0;
        gl.GetShaderiv(stage, GL_COMPILE_STATUS, &compiled);
        gl.GetShaderiv(stage, GL_INFO_LOG_LENGTH, &length);
        std::string log(static_cast<std::size_t>(std::max(length, 1)), '\0');
        gl.GetShaderInfoLog(stage, length, nullptr, log.data());
        gl.AttachShader(id(), stage);
        gl.DeleteShader(stage);  // lives on as long as it is attached
        if (compiled == GL_FALSE) {
            throw GlError(
                fmt::format("shader '{}' does not compile:\n{}", file, readable_log(log.c_str(), shader.files)));
        }
    }
    gl.LinkProgram(id());
    GLint linked = GL_FALSE, length = 0;
    gl.GetProgramiv(id(), GL_LINK_STATUS, &linked);
    gl.GetProgramiv(id(), GL_INFO_LOG_LENGTH, &length);
    if (linked == GL_FALSE) {
        std::string log(static_cast<std::size_t>(std::max(length, 1)), '\0');
        gl.GetProgramInfoLog(id(), length, nullptr, log.data());
        throw GlError(fmt::format("program '{}' does not link:\n{}", name_, log.c_str()));
    }
    GLint count = 0;
    gl.GetProgramInterfaceiv(id(), GL_UNIFORM, GL_ACTIVE_RESOURCES, &count);
    for (GLint i = 0; i < count; ++i) {
        std::string uniform(256, '\0');
        GLsizei written = 0;
        gl.GetProgramResourceName(id(), GL_UNIFORM, static_cast<GLuint>(i), static_cast<GLsizei>(uniform.size()),
                                  &written, uniform.data());
        uniform.resize(static_cast<std::size_t>(written));
        locations_.emplace(uniform, gl.GetUniformLocation(id(), uniform.c_str()));
    }
}

void Program::use() const { context().gl.UseProgram(id()); }

GLint Program::location(std::string_view uniform) const {
    const auto found = locations_.find(uniform);
    if (found == locations_.end()) {
        throw GlError(fmt::format("program '{}' has no active uniform '{}'", name_, uniform));
    }
    return found->second;
}

void Program::set(std::string_view uniform, int value) const {
    context().gl.ProgramUniform1i(id(), location(uniform), value);
}
void Program::set(std::string_view uniform, float value) const {
    context().gl.ProgramUniform1f(id(), location(uniform), value);
}
void Program::set(std::string_view uniform, const glm::vec2& value) const {
    context().gl.ProgramUniform2fv(id(), location(uniform), 1, &value.x);
}
void Program::set(std::string_view uniform, const glm::vec3& value) const {
    context().gl.ProgramUniform3fv(id(), location(uniform), 1, &value.x);
}
void Program::set(std::string_view uniform, const glm::vec4& value) const {
    context().gl.ProgramUniform4fv(id(), location(uniform), 1, &value.x);
}
void Program::set(std::string_view uniform, const glm::ivec2& value) const {
    context().gl.ProgramUniform2iv(id(), location(uniform), 1, &value.x);
}
void Program::set(std::string_view uniform, const glm::mat4& value) const {
    context().gl.ProgramUniformMatrix4fv(id(), location(uniform), 1, GL_FALSE, &value[0][0]);
}

void Program::set(std::string_view uniform, std::span<const glm::vec3> values) const {
    context().gl.ProgramUniform3fv(id(), location(fmt::format("{}[0]", uniform)), static_cast<GLsizei>(values.size()),
                                   &values.front().x);
}

const Program& ProgramCache::get(const std::vector<std::string>& files, const ShaderDefines& defines) {
    std::string key = fmt::format("{}", fmt::join(files, "+"));
    for (const auto& [name, value] : defines) key += fmt::format("|{}={}", name, value);
    std::unique_ptr<Program>& program = programs_[key];
    if (!program) {
        ShaderDefines all = common_;
        all.insert(all.end(), defines.begin(), defines.end());
        program = std::make_unique<Program>(context_, files, all);
    }
    return *program;
}

}  // namespace plumb
