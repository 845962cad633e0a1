#include "rasterizer/shader.h"

#include <stdexcept>

#include <gmock/gmock.h>

#include "gl_test.h"
#include "rasterizer/fullscreen.h"
#include "rasterizer/gl_error.h"
#include "rasterizer/texture_transfer.h"

namespace plumb {
namespace {

using testing::HasSubstr;
using testing::Not;
using ShaderTest = GlTest;
PLUMBLINE_BOTH_BACKENDS(ShaderTest);

ShaderLookup files(std::map<std::string, std::string, std::less<>> texts) {
    return [texts = std::move(texts)](std::string_view file) -> std::string_view {
        const auto found = texts.find(file);
        if (found == texts.end()) throw std::out_of_range("unknown");
        return found->second;
    };
}

std::string error_of(GlContext& context, const std::string& file, const ShaderLookup& lookup) {
    try {
        const Program program(context, {file}, {}, lookup);
    } catch (const GlError& error) {
        return error.what();
    }
    return "no error";
}

TEST_P(ShaderTest, CompileErrorNamesItsOwnFileAndLine) {
    const ShaderLookup lookup =
        files({{"main.frag", "#include \"part.glsl\"\nvoid main() {\n    gibberish_in_main;\n}\n"},
               {"part.glsl", "float one() { return 1.0; }\n"}});
    EXPECT_THAT(error_of(context(), "main.frag", lookup), HasSubstr("main.frag:3"));
}

TEST_P(ShaderTest, CompileErrorInAnIncludeNamesTheInclude) {
    const ShaderLookup lookup =
        files({{"main.frag", "#include \"part.glsl\"\nvoid main() {}\n"},
               {"part.glsl", "// a comment\n#include \"deep.glsl\"\nfloat one() { return gibberish; }\n"},
               {"deep.glsl", "float two() { return 2.0; }\n"}});
    const std::string message = error_of(context(), "main.frag", lookup);
    EXPECT_THAT(message, HasSubstr("part.glsl:3"));
    EXPECT_THAT(message, Not(HasSubstr("deep.glsl:")));
}

TEST_P(ShaderTest, MissingIncludeNamesTheIncludingLine) {
    const ShaderLookup lookup = files({{"main.frag", "// first\n#include \"nowhere.glsl\"\nvoid main() {}\n"}});
    EXPECT_THAT(error_of(context(), "main.frag", lookup), HasSubstr("'nowhere.glsl' (included from main.frag:2)"));
}

TEST_P(ShaderTest, MisspeltUniformThrows) {
    const ShaderLookup lookup = files({{"any.vert", "uniform float used;\nvoid main() { gl_Position = vec4(used); }\n"},
                                       {"any.frag", "void main() {}\n"}});
    const Program program(context(), {"any.vert", "any.frag"}, {}, lookup);
    EXPECT_NO_THROW(program.set("used", 1.0f));
    EXPECT_THROW(program.set("usd", 1.0f), GlError);
}

TEST(ShaderText, IncludesAFileOnce) {
    const ShaderLookup lookup = files({{"main.frag", "#include \"a.glsl\"\n#include \"b.glsl\"\n"},
                                       {"a.glsl", "#include \"b.glsl\"\nfloat a;\n"},
                                       {"b.glsl", "float b;\n"}});
    const ShaderText shader = assemble_shader("main.frag", {{"COUNT", "3"}}, lookup);
    EXPECT_EQ(shader.text,
              "#version 450 core\n#define COUNT 3\n#line 1 0\n#line 1 1\n#line 1 2\nfloat b;\n#line 2 1\nfloat a;\n"
              "#line 2 0\n#line 3 0\n");
    EXPECT_EQ(shader.files, (std::vector<std::string>{"main.frag", "a.glsl", "b.glsl"}));
}

TEST(ShaderText, LogsOfAllDriversAreRead) {
    const std::vector<std::string> names{"main.frag", "part.glsl"};
    EXPECT_EQ(readable_log("1:12(3): error: oops", names), "part.glsl:12(3): error: oops\n");     // Mesa
    EXPECT_EQ(readable_log("1(12) : error C1: oops", names), "part.glsl:12 : error C1: oops\n");  // NVIDIA
    EXPECT_EQ(readable_log("ERROR: 0:7: oops", names), "ERROR: main.frag:7: oops\n");             // AMD
}

TEST(ShaderText, LiteralsReadBackAsTheSameFloat) {
    for (const float value : {0.1f, 1.0f, 3.14159274f, 1e-20f, 123456789.0f}) {
        EXPECT_EQ(std::stof(shader_literal(value)), value);
    }
}

}  // namespace
}  // namespace plumb
