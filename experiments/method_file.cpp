#include "experiments/method_file.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <functional>

#include <fmt/format.h>
#include <fmt/ranges.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

#include "embedded/methods.h"

namespace plumb {
namespace {

constexpr std::array embedded_method_files = {"one_layer.toml", "two_layers.toml", "nielsen2015.toml",
                                              "mara2016_demo.toml"};

// Parameters with their values.
using Leaves = std::vector<std::pair<std::string, const ConfigValue*>>;

// The members of a table with their dotted names; `name` and `base` are the method's own.
void collect_leaves(const ConfigMembers& members, const std::string& prefix, Leaves& leaves) {
    for (const auto& [key, value] : members) {
        const std::string name = prefix.empty() ? key : fmt::format("{}.{}", prefix, key);
        if (const auto* table = std::get_if<ConfigMembers>(&value.value)) {
            collect_leaves(*table, name, leaves);
        } else if (!prefix.empty() || (key != "name" && key != "base")) {
            leaves.emplace_back(name, &value);
        }
    }
}

// Stores `value` in the parameter; returns what is wrong with it, or nothing.
std::string store(const MethodParameter& parameter, const ConfigValue& value) {
    const auto in_range = [&](double number) { return number >= parameter.least && number <= parameter.most; };
    const auto range_text = [&](double number) {
        return fmt::format("is {}, but must be {} to {}", number, parameter.least, parameter.most);
    };
    if (bool* const* target = std::get_if<bool*>(&parameter.value)) {
        const bool* boolean = std::get_if<bool>(&value.value);
        if (!boolean) return fmt::format("must be true or false, but is {}", value.type_name());
        **target = *boolean;
    } else if (int* const* whole = std::get_if<int*>(&parameter.value)) {
        const auto* integer = std::get_if<std::int64_t>(&value.value);
        if (!integer) return fmt::format("must be a whole number, but is {}", value.type_name());
        if (!in_range(static_cast<double>(*integer))) return range_text(static_cast<double>(*integer));
        **whole = static_cast<int>(*integer);
    } else if (float* const* floating = std::get_if<float*>(&parameter.value)) {
        double number = 0.0;
        if (const auto* integer = std::get_if<std::int64_t>(&value.value)) {
            number = static_cast<double>(*integer);
        } else if (const auto* given = std::get_if<double>(&value.value)) {
            number = *given;
        } else {
            return fmt::format("must be a number, but is {}", value.type_name());
        }
        if (!in_range(number)) return range_text(number);
        **floating = static_cast<float>(number);
    } else {
        const auto& choice = std::get<MethodChoice>(parameter.value);
        const auto* text = std::get_if<std::string>(&value.value);
        if (!text)
            return fmt::format("must be one of \"{}\", but is {}", fmt::join(choice.names, "\", \""),
                               value.type_name());
        const auto found = std::ranges::find(choice.names, *text);
        if (found == choice.names.end())
            return fmt::format("unknown value \"{}\"; {}", *text, name_hint(*text, choice.names));
        choice.set(static_cast<int>(found - choice.names.begin()));
    }
    return "";
}

void store_leaf(Method& method, const std::string& name, const ConfigValue& value, const std::string& source) {
    for (const MethodParameter& parameter : method_parameters(method)) {
        if (parameter.name != name) continue;
        const std::string problem = store(parameter, value);
        if (!problem.empty()) throw ConfigError(fmt::format("{}:{}: {}: {}", source, value.line, name, problem));
        return;
    }
    throw ConfigError(fmt::format("{}:{}: {}: unknown method parameter; {}", source, value.line, name,
                                  name_hint(name, method_parameter_names())));
}

Leaves leaves_of(const ConfigValue& table) {
    Leaves leaves;
    collect_leaves(std::get<ConfigMembers>(table.value), "", leaves);
    return leaves;
}

Method with_leaves(const Method& method, const Leaves& leaves, const std::string& source) {
    Method changed = method;
    for (const auto& [name, value] : leaves) store_leaf(changed, name, *value, source);
    return changed;
}

// Stores what a command line's text says; returns the parameter's name.
std::string store_assignment(Method& method, const std::string& assignment) {
    const auto equals = assignment.find('=');
    if (equals == std::string::npos) {
        throw ConfigError(fmt::format("'{}': write a parameter as name=value, such as ao.samples=16", assignment));
    }
    std::string name = assignment.substr(0, equals);
    std::string value = assignment.substr(equals + 1);
    // A shell eats quotes, so a bare word that is not TOML's own counts as a text.
    const bool word = !value.empty() && std::isalpha(static_cast<unsigned char>(value[0])) && value != "true" &&
                      value != "false" && value != "inf" && value != "nan";
    if (word) value = fmt::format("\"{}\"", value);
    const std::string source = fmt::format("'{}'", assignment);
    const ConfigValue parsed = parse_config("value = " + value, source);
    store_leaf(method, name, std::get<ConfigMembers>(parsed.value).front().value, source);
    return name;
}

// Throws ConfigError for a parameter of the table for which `reason_of` has one.
void require_effects(const Method& method, const ConfigValue& table, const std::string& source,
                     const std::function<std::string(const std::string&)>& reason_of) {
    for (const ParameterSetting& setting : parameter_settings(table)) {
        const std::string reason = reason_of(setting.name);
        if (!reason.empty()) throw without_effect(source, setting, method.name, reason);
    }
}

}  // namespace

const Method* find_method(const MethodList& methods, std::string_view name) {
    const auto found = std::ranges::find(methods, name, &Method::name);
    return found == methods.end() ? nullptr : &*found;
}

MethodList builtin_methods() {
    MethodList methods;
    for (const char* file : embedded_method_files) {
        methods.push_back(parse_method(parse_config(embedded::methods::find(file), file), file, methods));
    }
    return methods;
}

ConfigError without_effect(const std::string& source, const ParameterSetting& setting, const std::string& method,
                           const std::string& reason) {
    return ConfigError(fmt::format("{}:{}: {}: has no effect in method '{}', because {}; remove it", source,
                                   setting.line, setting.name, method, reason));
}

std::vector<ParameterSetting> parameter_settings(const ConfigValue& table) {
    std::vector<ParameterSetting> settings;
    for (const auto& [name, value] : leaves_of(table)) settings.push_back({name, value->line});
    return settings;
}

Method read_method(const ConfigValue& table, const std::string& source, const MethodList& known) {
    ConfigReader reader(table, source, "method");
    Method method;
    const std::string base = reader.text("base", "");
    if (!base.empty()) {
        const Method* found = find_method(known, base);
        if (!found) {
            std::vector<std::string> names;
            for (const Method& candidate : known) names.push_back(candidate.name);
            reader.fail("base",
                        fmt::format("no method '{}' is defined before this one; {}", base, name_hint(base, names)));
        }
        method = *found;
    }
    method.name = reader.required_text("name");

    return with_leaves(method, leaves_of(table), source);
}

void require_layers(const Method& method, const std::string& source, int line, const std::vector<std::string>* planes) {
    for (const auto& [name, layers] :
         {std::pair{"ao", method.ao.enabled ? method.ao.layers : 1},
          std::pair{"radiosity", method.radiosity.enabled ? method.radiosity.layers : 1}}) {
        const std::string parameter = fmt::format("{}.layers", name);
        if (layers > method.gbuffer.layers && reason_without_effect(method, parameter, planes).empty()) {
            throw ConfigError(
                fmt::format("{}:{}: {} = {} cannot be combined with gbuffer.layers = {} (method '{}'); "
                            "lower the one or raise the other",
                            source, line, parameter, layers, method.gbuffer.layers, method.name));
        }
    }
}

Method parse_method(const ConfigValue& table, const std::string& source, const MethodList& known,
                    const std::vector<std::string>* planes) {
    Method method = read_method(table, source, known);
    require_effects(method, table, source,
                    [&](const std::string& name) { return reason_without_effect(method, name, planes); });
    require_layers(method, source, table.line, planes);
    return method;
}

Method parse_shared_method(const ConfigValue& table, const std::string& source, const MethodList& known,
                           const std::vector<std::string>& planes) {
    Method method = read_method(table, source, known);
    require_effects(method, table, source,
                    [&](const std::string& name) { return reason_without_effect_of_shared(method, name, planes); });
    require_layers(method, source, table.line, &planes);
    return method;
}

Method load_method(const std::string& name_or_path) {
    const MethodList builtin = builtin_methods();
    if (const Method* found = find_method(builtin, name_or_path)) return *found;
    if (std::filesystem::exists(name_or_path)) return parse_method(read_config(name_or_path), name_or_path, builtin);
    std::vector<std::string> names;
    for (const Method& method : builtin) names.push_back(method.name);
    throw ConfigError(fmt::format("method '{}': neither a file nor a method that comes with the program; {}",
                                  name_or_path, name_hint(name_or_path, names)));
}

void set_method_parameters(Method& method, const std::vector<std::string>& assignments,
                           const std::vector<std::string>* planes, const Scene* scene) {
    std::vector<std::string> names;
    for (const std::string& assignment : assignments) {
        const std::string name = store_assignment(method, assignment);
        const auto before = std::ranges::find(names, name);
        if (before != names.end()) {
            throw ConfigError(
                fmt::format("'{}': has no effect, because '{}' sets the same parameter again; leave one out",
                            assignments[static_cast<std::size_t>(before - names.begin())], assignment));
        }
        names.push_back(name);
    }
    for (std::size_t i = 0; i < names.size(); ++i) {
        const std::string reason = reason_without_effect(method, names[i], planes, scene);
        if (!reason.empty()) throw ConfigError(fmt::format("'{}': has no effect, because {}", assignments[i], reason));
    }
}

void set_method_parameter(Method& method, const std::string& assignment, const std::vector<std::string>* planes) {
    set_method_parameters(method, {assignment}, planes);
}

void override_method(Method& method, const ConfigValue& table, const std::string& source) {
    const ConfigReader reader(table, source, "method");  // checks that it is a table
    Leaves leaves = leaves_of(table);
    const Method all = with_leaves(method, leaves, source);
    std::erase_if(leaves, [&](const auto& leaf) { return !reason_without_effect(all, leaf.first).empty(); });
    method = with_leaves(method, leaves, source);
}

void require_effective_overrides(const MethodList& methods, const ConfigValue& table, const std::string& source,
                                 const std::vector<std::string>* planes, const Scene* scene) {
    const Leaves leaves = leaves_of(table);
    for (const auto& [name, value] : leaves) {
        std::vector<std::string> reasons;
        for (const Method& method : methods) {
            const std::string reason = reason_without_effect(with_leaves(method, leaves, source), name, planes, scene);
            if (reason.empty()) break;
            reasons.push_back(fmt::format("in '{}' because {}", method.name, reason));
        }
        if (methods.empty() || reasons.size() < methods.size()) continue;
        throw ConfigError(fmt::format("{}:{}: method.{}: has no effect in any of the methods ({}); remove it", source,
                                      value->line, name, reasons.front()));
    }
}

std::string print_method(const Method& method) {
    Method copy = method;
    std::string text = fmt::format("name = \"{}\"\n", method.name);
    for (const MethodParameter& parameter : method_parameters(copy)) {
        const std::string line = fmt::format("{} = {}\n", parameter.name, print_parameter(parameter));
        // A parameter without effect is printed as a comment, so that the text can be parsed again.
        const std::string reason = reason_without_effect(copy, parameter.name);
        text += reason.empty() ? line : fmt::format("# {}", line);
    }
    return text;
}

std::uint64_t method_hash(const Method& method) {
    Method copy = method;
    std::string text;
    for (const MethodParameter& parameter : method_parameters(copy)) {
        if (!reason_without_effect(copy, parameter.name).empty()) continue;
        text += fmt::format("{} = {}\n", parameter.name, print_parameter(parameter));
    }
    return XXH3_64bits(text.data(), text.size());
}

std::vector<MethodDifference> diff_methods(const Method& first, const Method& second) {
    Method a = first, b = second;
    const auto of_first = method_parameters(a), of_second = method_parameters(b);
    std::vector<MethodDifference> differences;
    for (std::size_t i = 0; i < of_first.size(); ++i) {
        MethodDifference difference{of_first[i].name, print_parameter(of_first[i]), print_parameter(of_second[i])};
        if (difference.first != difference.second) differences.push_back(std::move(difference));
    }
    return differences;
}

}  // namespace plumb
