// Looks through all parameters for a method that takes more of OpenGL's memory than the one that is taken to be the
// dearest: so that it stays the dearest when parameters are added.
#include <algorithm>
#include <cmath>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "demanding_method.h"
#include "experiments/method_file.h"

namespace plumb {
namespace {

// Parameters that say how many texels or pixels something has, or how often something is there: any bound can be
// exceeded with them.
bool is_size(const std::string& name) {
    return name.ends_with("size") || name == "gbuffer.guard_band" || name == "direct.shadow.emitter_samples" ||
           name == "gbuffer.layers" || name == "radiosity.bounces";
}

// Formats of more bytes than by default, each of which fits alone, but not all of them at once
// (method_memory_test.cpp).
const std::set<std::string> wide_formats = {"gbuffer.position=stored", "gbuffer.position=stored_16",
                                            "gbuffer.normal_format=rgb16f", "gbuffer.normal_format=rgb32f",
                                            "gbuffer.radiance_format=rgba32f"};

// Values that may switch something on or off: all where there are few of them, else the ends of the range.
std::vector<std::string> values_of(const std::string& name) {
    Method method;
    const std::vector<MethodParameter> parameters = method_parameters(method);
    const MethodParameter& parameter = *std::ranges::find(parameters, name, &MethodParameter::name);
    if (std::holds_alternative<bool*>(parameter.value)) return {"false", "true"};
    if (const auto* choice = std::get_if<MethodChoice>(&parameter.value)) return choice->names;
    const bool whole = std::holds_alternative<int*>(parameter.value);
    std::vector<std::string> values;
    for (const double value : {parameter.least, 2.0 * parameter.least, parameter.most}) {
        if (value >= parameter.least && value <= parameter.most && std::isfinite(value))
            values.push_back(whole ? fmt::format("{:.0f}", value) : fmt::format("{}", value));
    }
    return values;
}

// Changes one parameter after the other to the value that takes the most memory, until none takes more.
double most_mebibytes(GlContext& context, const Scene& scene, Method best) {
    double most = mebibytes_of(context, scene, best);
    for (bool better = true; better;) {
        better = false;
        for (const std::string& name : method_parameter_names()) {
            if (is_size(name)) continue;
            for (const std::string& value : values_of(name)) {
                const std::string assignment = fmt::format("{}={}", name, value);
                if (wide_formats.contains(assignment)) continue;
                Method changed = best;
                double now = 0.0;
                try {
                    set_method_parameter(changed, assignment);
                    now = mebibytes_of(context, scene, changed);
                } catch (const std::runtime_error&) {
                    continue;  // without effect, or cannot be combined with the rest
                }
                if (now <= most) continue;
                fmt::print("{}: {:.1f} MiB more\n", assignment, now - most);
                most = now, best = changed, better = true;
            }
        }
    }
    return most;
}

TEST(DearestMethod, NoParameterMakesItDearer) {
    const std::unique_ptr<GlContext> context = GlContext::create();
    const Scene scene = make_demanding_scene();
    const double dearest = mebibytes_of(*context, scene, dearest_method());
    const double found = most_mebibytes(*context, scene, dearest_method());
    EXPECT_LT(found, 400.0);
    EXPECT_EQ(found, dearest) << "change dearest_method() to what was found";
}

TEST(DearestMethod, NoParameterMakesItDearerThanFitsWithAWideFormat) {
    const std::unique_ptr<GlContext> context = GlContext::create();
    const Scene scene = make_demanding_scene();
    for (const std::string& assignment : wide_formats) {
        Method method = dearest_method();
        set_method_parameter(method, assignment);
        const double found = most_mebibytes(*context, scene, method);
        fmt::print("{}: at most {:.1f} MiB\n", assignment, found);
        EXPECT_LT(found, 400.0) << assignment;
    }
}

}  // namespace
}  // namespace plumb
