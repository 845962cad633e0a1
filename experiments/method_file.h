// Methods as text: every parameter has a name ("ao.samples"), a range and a place in a TOML file, so that it can be
// set, printed, hashed, swept and told apart.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "experiments/config.h"
#include "rasterizer/method.h"

namespace plumb {

// An enumeration by the names of its values, in their order.
struct MethodChoice {
    std::vector<std::string> names;
    std::function<int()> get;
    std::function<void(int)> set;
};

struct MethodParameter {
    std::string name;  // dotted, as in the TOML file
    std::variant<bool*, int*, float*, MethodChoice> value;
    double least = 0.0, most = 0.0;  // of whole and other numbers
};

// The parameters of `method`, pointing into it: the one list that everything below goes through.
std::vector<MethodParameter> method_parameters(Method& method);
std::vector<std::string> method_parameter_names();

// Methods that others can be based on, in the order of their definition.
using MethodList = std::vector<Method>;
const Method* find_method(const MethodList& methods, std::string_view name);

// Methods that come with the program (experiments/methods/*.toml).
MethodList builtin_methods();

// A method table: `name`, optional `base` (a method of `known`), and parameters; what is not set comes from the base or
// is the default. Throws ConfigError for unknown keys, values out of range, and keys that would have no effect.
Method parse_method(const ConfigValue& table, const std::string& source, const MethodList& known);
// A built-in method's name, or the path of a TOML file.
Method load_method(const std::string& name_or_path);

// Sets one parameter from text as a command line gives it ("ao.samples=6"). Throws ConfigError.
void set_method_parameter(Method& method, const std::string& assignment);
// Sets those parameters of `table` that have an effect on `method`; the others are left (a scene's overrides apply to
// methods of many kinds). Throws ConfigError for unknown names and values out of range.
void override_method(Method& method, const ConfigValue& table, const std::string& source);

// Why parameter `name` changes nothing in `method`; empty where it matters.
std::string reason_without_effect(const Method& method, std::string_view name);

// The whole method as TOML, one "name = value" a line, in the order of method_parameters; parse_method takes it back.
std::string print_method(const Method& method);
std::string print_parameter(const MethodParameter& parameter);
// Over all parameters that have an effect; not over the name.
std::uint64_t method_hash(const Method& method);

struct MethodDifference {
    std::string parameter, first, second;
};
std::vector<MethodDifference> diff_methods(const Method& first, const Method& second);

}  // namespace plumb
