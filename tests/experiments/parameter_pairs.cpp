#include "parameter_pairs.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include <fmt/format.h>

#include "experiments/method_file.h"
#include "parameter_pictures.h"
#include "rasterizer/gl_error.h"

namespace plumb {
namespace {

// Pairs of which this small scene cannot tell, with the reason. `beside`: how what is beside them begins.
struct PairException {
    std::vector<std::string> names, beside;
    std::string reason;
};
const std::vector<PairException> pair_exceptions = {
    {{"gbuffer.guard_band"},
     {"depth", "motion", "layer2.depth"},
     "changes the last bits: a pixel's centre has other coordinates in the wider image"},
    {{"gbuffer.separation_unit"},
     {"gbuffer.minimum_separation = 0.0"},
     "decides whether an experiment puts the scene's separation in its place"},
    {{"gbuffer.minimum_separation", "gbuffer.generation"},
     {"gbuffer.separation_unit = \"frustum\""},
     "no two surfaces lie a tenth of the frustum apart"},
    {{"gbuffer.minimum_separation"}, {"ao", "direct"}, "what lies in between of the two separations obscures nothing"},
    {{"gbuffer.position"},
     {"direct", "total"},
     "rounds ambient visibility otherwise, of which half floats keep nothing"},
    {{"ao.blur.normal_sharpness", "ao.blur.plane_sharpness"},
     {"direct", "indirect", "irradiance", "total"},
     "tells in ambient visibility alone: of the little that it dims, half floats keep nothing"},
    {{"ao.enabled"}, {"ao.intensity = 0.0"}, "decides whether ambient visibility can be asked for"},
    {{"ao.blur.depth_sharpness"},
     {"ao.blur.depth_key_bits = 8"},
     "a tenth more of it tells nothing of the few depths that there are"},
    {{"reflections.test_hit_normal", "reflections.layers"},
     {"reflections.max_steps = 1"},
     "within a pixel nothing turns its back to the ray, and nothing lies behind"},
    {{"radiosity.carry"}, {"radiosity.damping = 1.0"}, "each is what gives the other an effect"},
};

bool is_excepted(const ParameterPair& pair) {
    if (parameters_without_pixels().contains(pair.name)) return true;
    // Of so small a picture one texel is left there, which sends no light to anything.
    if (pair.beside == "radiosity.minimum_mip_level = 5") return true;
    return std::ranges::any_of(pair_exceptions, [&](const PairException& exception) {
        return std::ranges::find(exception.names, pair.name) != exception.names.end() &&
               std::ranges::any_of(exception.beside,
                                   [&](const std::string& start) { return pair.beside.starts_with(start); });
    });
}

std::string group_of(const std::string& name) { return name.substr(0, name.find('.')); }

// Stores each value of the parameter that may leave others nothing to do - all or nothing, and each choice - and calls
// `use` with the method.
template <class Use>
void for_each_value(const Method& start, const std::string& name, const Use& use) {
    Method method = start;
    std::vector<MethodParameter> parameters = method_parameters(method);
    const MethodParameter& parameter = *std::ranges::find(parameters, name, &MethodParameter::name);
    const std::string before = print_parameter(parameter);
    const auto tell = [&] {
        const std::string now = print_parameter(parameter);
        if (now != before) use(method, fmt::format("{} = {}", name, now));
    };
    if (bool* const* truth = std::get_if<bool*>(&parameter.value)) {
        **truth = !**truth;
        tell();
    } else if (int* const* whole = std::get_if<int*>(&parameter.value)) {
        constexpr double few = 8.0;  // ends far away leave others something to do, and take their time
        for (const double end : {parameter.least, parameter.most}) {
            if (end > few) continue;
            **whole = static_cast<int>(end);
            tell();
        }
    } else if (float* const* number = std::get_if<float*>(&parameter.value)) {
        for (const float end : {0.0f, 1.0f}) {
            if (end != static_cast<float>(parameter.least) && end != static_cast<float>(parameter.most)) continue;
            **number = end;
            tell();
        }
    } else {
        const auto& choice = std::get<MethodChoice>(parameter.value);
        for (int i = 0; i < static_cast<int>(choice.names.size()); ++i) {
            choice.set(i);
            tell();
        }
    }
}

// Null where a pipeline refuses the method.
std::optional<Frame> try_to_render(GlContext& context, const Scene& scene, const Method& method,
                                   const std::vector<std::string>& planes, const PictureSize& size) {
    try {
        return render_busy_frames(context, scene, method, planes, size);
    } catch (const std::exception&) {
        return std::nullopt;
    }
}

// Whether it refuses small pictures.
bool wants_many_lines(const Method& method) { return method.ao.normals == ObscuranceNormals::g3d_demo; }

}  // namespace

std::vector<std::string> parameter_groups() {
    std::vector<std::string> groups;
    for (const std::string& name : method_parameter_names()) {
        if (std::ranges::find(groups, group_of(name)) == groups.end()) groups.push_back(group_of(name));
    }
    return groups;
}

std::vector<ParameterPair> pairs_within(const std::string& group) {
    std::vector<ParameterPair> pairs;
    for (const std::string& name : method_parameter_names()) {
        if (group_of(name) != group) continue;
        for (const std::string& other : method_parameter_names()) {
            if (group_of(other) != group || other == name) continue;
            for_each_value(small_method(name), other, [&](const Method& method, const std::string& value) {
                pairs.push_back({name, value, method, telling_planes(name)});
            });
        }
    }
    return pairs;
}

std::vector<ParameterPair> pairs_with_planes() {
    std::vector<ParameterPair> pairs;
    for (const std::string& name : method_parameter_names()) {
        for (const char* plane : {"ao", "direct", "indirect", "indirect.1", "irradiance", "reflection", "emission",
                                  "total", "depth", "normal", "motion", "layer2.depth", "layer2.normal"})
            pairs.push_back({name, plane, small_method(name), {plane}});
    }
    return pairs;
}

PairVerdicts judge_pairs(GlContext& context, const Scene& scene, const std::vector<ParameterPair>& pairs,
                         std::size_t first, std::size_t stride) {
    PairVerdicts verdicts;
    std::map<std::string, std::optional<Frame>> rendered;  // small pictures
    for (std::size_t i = first; i < pairs.size(); i += stride) {
        const ParameterPair& pair = pairs[i];
        if (is_excepted(pair)) continue;
        Method changed = pair.method;
        use_another_value(changed, pair.name);
        const auto render = [&](const Method& method, const PictureSize& size) {
            return try_to_render(context, scene, method, pair.planes, size);
        };
        // Null where a picture is refused.
        const auto same_in_larger_ones = [&]() -> std::optional<bool> {
            const std::optional<Frame> before = render(pair.method, larger_picture),
                                       after = render(changed, larger_picture);
            if (!before || !after) return std::nullopt;
            return same_pixels(*before, *after, pair.planes);
        };
        const auto same_in_small_ones = [&]() -> std::optional<bool> {
            const std::string key = fmt::format("{:016x} {}", method_hash(pair.method), pair.planes.front());
            if (!rendered.contains(key)) rendered[key] = render(pair.method, {});
            const std::optional<Frame>& before = rendered.at(key);
            if (!before) return std::nullopt;
            const std::optional<Frame> after = render(changed, {});
            if (!after) return std::nullopt;
            return same_pixels(*before, *after, pair.planes);
        };
        // What turns a stage off is without effect where that stage, on, would have none.
        const std::string reason = reason_without_effect(pair.method, pair.name, &pair.planes, &scene);
        std::optional<bool> found;
        if (wants_many_lines(pair.method) || wants_many_lines(changed)) {
            found = same_in_larger_ones();
        } else {
            found = same_in_small_ones();
            if (found && *found && reason.empty()) found = same_in_larger_ones();
        }
        if (!found) continue;
        const bool same = *found;
        const std::string text = fmt::format("{} beside {}", pair.name, pair.beside);
        if (same && reason.empty()) verdicts.silent.push_back(text);
        if (!same && !reason.empty()) verdicts.slander.push_back(fmt::format("{}: {}", text, reason));
        ++verdicts.compared;
    }
    return verdicts;
}

}  // namespace plumb
