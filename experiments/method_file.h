// Methods as text: read from TOML files, set from command lines, printed, hashed and told apart.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/config.h"
#include "experiments/method_parameters.h"
#include "experiments/parameter_effects.h"

namespace plumb {

// Methods that others can be based on, in the order of their definition.
using MethodList = std::vector<Method>;
const Method* find_method(const MethodList& methods, std::string_view name);

// Methods that come with the program (experiments/methods/*.toml).
MethodList builtin_methods();

// A parameter that a table sets, and where.
struct ParameterSetting {
    std::string name;
    int line = 0;
};
// What to throw for a setting in a file that changes nothing; to the reason that reason_without_effect() gives.
ConfigError without_effect(const std::string& source, const ParameterSetting& setting, const std::string& method,
                           const std::string& reason);
std::vector<ParameterSetting> parameter_settings(const ConfigValue& table);

// A method table: `name`, optional `base` (a method of `known`), and parameters; what is not set comes from the base or
// is the default. Throws ConfigError for unknown keys and values out of range.
Method read_method(const ConfigValue& table, const std::string& source, const MethodList& known);
// Throws ConfigError for stages that read more layers than the G-buffer holds and that `planes` show.
void require_layers(const Method& method, const std::string& source, int line,
                    const std::vector<std::string>* planes = nullptr);
// Both; throws ConfigError for keys that would have no effect on `planes`, too (parameter_effects.h).
Method parse_method(const ConfigValue& table, const std::string& source, const MethodList& known,
                    const std::vector<std::string>* planes = nullptr);
// Of a file that other experiments may use as well, with other planes.
Method parse_shared_method(const ConfigValue& table, const std::string& source, const MethodList& known,
                           const std::vector<std::string>& planes);
// A built-in method's name, or the path of a TOML file.
Method load_method(const std::string& name_or_path);

// Sets parameters from texts as a command line gives them ("ao.samples=6"): first all of them, so that their order
// means nothing. Throws ConfigError for unknown names, values out of range, one parameter set twice, and what would
// have no effect then on `planes` of `scene`.
void set_method_parameters(Method& method, const std::vector<std::string>& assignments,
                           const std::vector<std::string>* planes = nullptr, const Scene* scene = nullptr);
void set_method_parameter(Method& method, const std::string& assignment,
                          const std::vector<std::string>* planes = nullptr);
// Sets those parameters of `table` that have an effect on `method` once all are set; the others are left (a scene's
// overrides apply to methods of many kinds). Throws ConfigError for unknown names and values out of range.
void override_method(Method& method, const ConfigValue& table, const std::string& source);
// Throws ConfigError for a parameter of such a table that has an effect on none of `methods`.
void require_effective_overrides(const MethodList& methods, const ConfigValue& table, const std::string& source,
                                 const std::vector<std::string>* planes = nullptr, const Scene* scene = nullptr);

// The whole method as TOML, one "name = value" a line, in the order of method_parameters; parse_method takes it back.
std::string print_method(const Method& method);
// Over all parameters that have an effect; not over the name.
std::uint64_t method_hash(const Method& method);

struct MethodDifference {
    std::string parameter, first, second;
};
std::vector<MethodDifference> diff_methods(const Method& first, const Method& second);

}  // namespace plumb
