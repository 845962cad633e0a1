#include "experiments/tune.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "experiments/method_file.h"

namespace plumb {
namespace {

constexpr double contraction = 0.6;
constexpr double geometric_from = 10.0;  // ratio of a range's ends

bool is_whole(const Method& method, const std::string& name) {
    Method copy = method;
    const auto parameters = method_parameters(copy);
    const auto found = std::ranges::find(parameters, name, &MethodParameter::name);
    return found != parameters.end() && std::holds_alternative<int*>(found->value);
}

double parse_bound(const std::string& text, const std::string& whole) {
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
        throw ConfigError(fmt::format("'{}': '{}' is no number; write a range as name=low..high", whole, text));
    return value;
}

std::vector<std::string> split(std::string_view text, char separator) {
    std::vector<std::string> parts;
    while (true) {
        const auto place = text.find(separator);
        parts.emplace_back(text.substr(0, place));
        if (place == std::string_view::npos) return parts;
        text.remove_prefix(place + 1);
    }
}

bool is_geometric(const FreeParameter& parameter) {
    return parameter.low > 0.0 && parameter.high / parameter.low >= geometric_from;
}

std::string value_text(const FreeParameter& parameter, double value) {
    return parameter.whole ? fmt::format("{:.0f}", value) : fmt::format("{:.6g}", value);
}

// A range that narrows, in the space in which its values are evenly spaced.
struct SearchRange {
    double low, high;
    bool geometric;

    explicit SearchRange(const FreeParameter& parameter)
        : low(parameter.low), high(parameter.high), geometric(is_geometric(parameter)) {
        if (geometric) low = std::log(low), high = std::log(high);
    }
    double value(int step, int steps) const {
        const double place = std::lerp(low, high, static_cast<double>(step) / (steps - 1));
        return geometric ? std::exp(place) : place;
    }
    // Around the value, within the range of the start.
    void contract(double around, const SearchRange& whole) {
        const double place = geometric ? std::log(around) : around, width = contraction * (high - low);
        low = std::clamp(place - 0.5 * width, whole.low, whole.high - width);
        high = low + width;
    }
};

class Search {
public:
    Search(const std::vector<FreeParameter>& parameters, const TuningSettings& settings,
           const std::function<TuningCost(const Method&)>& evaluate)
        : parameters_(parameters), settings_(settings), evaluate_(evaluate) {}

    TuningResult run(const Method& start) {
        result_.start = result_.best = trial(start);
        if (!result_.start.cost.told()) {
            throw ConfigError(fmt::format(
                "nothing can be tuned, because the error of '{}' itself cannot be told: {}; raise 'samples' in "
                "the experiment's [reference]",
                start.name, result_.start.cost.refusal));
        }
        std::vector<SearchRange> ranges;
        for (const FreeParameter& parameter : parameters_) ranges.emplace_back(parameter);
        for (int pass = 0; pass < settings_.passes; ++pass) {
            for (std::size_t i = 0; i < parameters_.size(); ++i) {
                const FreeParameter& parameter = parameters_[i];
                if (!parameter.choices.empty()) {
                    for (const std::string& choice : parameter.choices) try_value(parameter, choice);
                    continue;
                }
                for (int step = 0; step < settings_.steps; ++step)
                    try_value(parameter, value_text(parameter, ranges[i].value(step, settings_.steps)));
                ranges[i].contract(
                    std::clamp(value_of(result_.best.method, parameter.name), parameter.low, parameter.high),
                    SearchRange(parameter));
            }
        }
        return std::move(result_);
    }

private:
    static double value_of(const Method& method, const std::string& name) {
        Method copy = method;
        for (const MethodParameter& parameter : method_parameters(copy)) {
            if (parameter.name == name) return std::stod(print_parameter(parameter));
        }
        return 0.0;  // cannot happen: the name was parsed
    }

    void try_value(const FreeParameter& parameter, const std::string& value) {
        Method method = result_.best.method;
        set_method_parameter(method, fmt::format("{}={}", parameter.name, value));
        const TuningTrial tried = trial(method);
        if (is_better(tried, result_.best)) result_.best = tried;
    }

    static bool is_better(const TuningTrial& a, const TuningTrial& b) {
        if (!a.cost.told()) return false;
        if (a.within_budget != b.within_budget) return a.within_budget;
        return a.within_budget ? a.cost.error < b.cost.error : a.cost.milliseconds < b.cost.milliseconds;
    }

    TuningTrial trial(const Method& method) {
        const auto [place, is_new] = known_.try_emplace(method_hash(method));
        if (is_new) {
            const TuningCost cost = evaluate_(method);
            const bool within = settings_.budget <= 0.0 || cost.milliseconds <= settings_.budget;
            place->second = {method, cost, within};
            result_.trials.push_back(place->second);
        }
        return place->second;
    }

    const std::vector<FreeParameter>& parameters_;
    const TuningSettings& settings_;
    const std::function<TuningCost(const Method&)>& evaluate_;
    std::map<std::uint64_t, TuningTrial> known_;
    TuningResult result_;
};

}  // namespace

FreeParameter parse_free_parameter(const std::string& text, const Method& method,
                                   const std::vector<std::string>* planes) {
    const auto equals = text.find('=');
    if (equals == std::string::npos) {
        throw ConfigError(fmt::format("'{}': write a free parameter as name=low..high, or name=this|that", text));
    }
    FreeParameter parameter;
    parameter.name = text.substr(0, equals);
    const std::string values = text.substr(equals + 1);
    std::vector<std::string> ends;
    if (const auto dots = values.find(".."); dots != std::string::npos) {
        ends = {values.substr(0, dots), values.substr(dots + 2)};
        parameter.low = parse_bound(ends[0], text), parameter.high = parse_bound(ends[1], text);
        parameter.whole = is_whole(method, parameter.name);
        if (!(parameter.low < parameter.high))
            throw ConfigError(fmt::format("'{}': the range is empty; its first end has to be the lower one", text));
    } else {
        ends = parameter.choices = split(values, '|');
        if (ends.size() < 2)
            throw ConfigError(fmt::format("'{}': name two values at least, or a range low..high", text));
    }
    for (const std::string& end : ends) {
        Method probe = method;  // throws for unknown names, values out of range, and what would change nothing
        set_method_parameter(probe, fmt::format("{}={}", parameter.name, end), planes);
    }
    return parameter;
}

TuningResult tune(const Method& start, const std::vector<FreeParameter>& parameters, const TuningSettings& settings,
                  const std::function<TuningCost(const Method&)>& evaluate) {
    if (parameters.empty()) throw ConfigError("nothing to tune: name at least one free parameter");
    if (settings.steps < 3 || settings.passes < 1)
        throw ConfigError(
            fmt::format("{} steps and {} passes: at least 3 and 1 are needed", settings.steps, settings.passes));
    return Search(parameters, settings, evaluate).run(start);
}

}  // namespace plumb
