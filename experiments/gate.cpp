#include "experiments/gate.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>

#include <fmt/format.h>

#include "experiments/config.h"

namespace plumb {

std::vector<Limit> parse_limits(const std::string& text, bool fails_above) {
    std::vector<Limit> limits;
    std::istringstream stream(text);
    for (std::string part; std::getline(stream, part, ',');) {
        const auto equals = part.find('=');
        Limit limit;
        limit.fails_above = fails_above;
        limit.measure = part.substr(0, equals);
        if (std::ranges::find(measure_names(), limit.measure) == measure_names().end()) {
            throw ConfigError(
                fmt::format("limit '{}': unknown measure; {}", part, name_hint(limit.measure, measure_names())));
        }
        const std::string value = equals == std::string::npos ? "" : part.substr(equals + 1);
        const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), limit.value);
        if (error != std::errc() || end != value.data() + value.size() || std::isnan(limit.value)) {
            throw ConfigError(fmt::format("limit '{}': write it as measure=number, such as rmse=0.01", part));
        }
        limits.push_back(std::move(limit));
    }
    return limits;
}

std::vector<std::string> breaches(const FrameComparison& comparison, const std::vector<Limit>& limits) {
    std::vector<std::string> lines;
    for (const PlaneComparison& plane : comparison.planes) {
        for (const Limit& limit : limits) {
            const double value = plane.measure(limit.measure);
            if (std::isnan(value)) {
                lines.push_back(fmt::format("{}: {} does not exist for these images, so its limit cannot be kept",
                                            plane.plane, limit.measure));
            } else if (limit.fails_above ? value > limit.value : value < limit.value) {
                lines.push_back(fmt::format("{}: {} = {:.6g} is {} {:.6g}", plane.plane, limit.measure, value,
                                            limit.fails_above ? "above" : "below", limit.value));
            }
        }
    }
    return lines;
}

}  // namespace plumb
