#include "rasterizer/falloff.h"

#include <string>

namespace plumb {

ShaderDefines falloff_defines(Falloff falloff) {
    const auto value = [](Falloff of) { return std::to_string(static_cast<int>(of)); };
    return {{"HARD", value(Falloff::hard)},
            {"QUADRATIC", value(Falloff::quadratic)},
            {"CUBIC", value(Falloff::cubic)},
            {"FALLOFF", value(falloff)}};
}

}  // namespace plumb
