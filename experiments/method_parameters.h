// Every parameter of a method by its name ("ao.samples"), with its range.
#pragma once

#include <functional>
#include <string>
#include <variant>
#include <vector>

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

// The value as TOML has it.
std::string print_parameter(const MethodParameter& parameter);

}  // namespace plumb
