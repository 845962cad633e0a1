#include "experiments/gate.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>

#include <fmt/format.h>

#include "experiments/config.h"
#include "experiments/sequence_comparison.h"
#include "metrics/comparison.h"
#include "metrics/gbuffer_fidelity.h"
#include "metrics/regions.h"

namespace plumb {
namespace {

// All that limits can be set on.
std::vector<std::string> all_measures() {
    std::vector<std::string> names = measure_names();
    names.insert(names.end(), stability_names().begin(), stability_names().end());
    names.insert(names.end(), fidelity_names().begin(), fidelity_names().end());
    return names;
}

Limit parse_limit(const std::string& part, bool fails_above) {
    const auto equals = part.find('=');
    const std::string name = part.substr(0, equals);
    const auto at = name.find('@');
    Limit limit{name.substr(0, at), at == std::string::npos ? "" : name.substr(at + 1), 0.0, fails_above};
    const auto known = all_measures();
    if (std::ranges::find(known, limit.measure) == known.end()) {
        throw ConfigError(fmt::format("limit '{}': unknown measure; {}", part, name_hint(limit.measure, known)));
    }
    if (at != std::string::npos && std::ranges::find(region_names(), limit.region) == region_names().end()) {
        throw ConfigError(fmt::format("limit '{}': unknown region; {}", part, name_hint(limit.region, region_names())));
    }
    const bool of_regions = std::ranges::find(measure_names(), limit.measure) != measure_names().end() ||
                            std::ranges::find(stability_names(), limit.measure) != stability_names().end();
    if (!limit.region.empty() && !of_regions) {
        throw ConfigError(fmt::format("limit '{}': {} is only measured over whole images; write it without '@{}'", part,
                                      limit.measure, limit.region));
    }
    const std::string value = equals == std::string::npos ? "" : part.substr(equals + 1);
    const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), limit.value);
    if (error != std::errc() || end != value.data() + value.size() || std::isnan(limit.value)) {
        throw ConfigError(fmt::format("limit '{}': write it as measure=number, such as rmse=0.01", part));
    }
    return limit;
}

bool has_measure(const MeasuredThing& thing, const std::string& measure) {
    return std::ranges::any_of(thing.measures, [&](const auto& named) { return named.first == measure; });
}

}  // namespace

std::string Limit::name() const { return region.empty() ? measure : fmt::format("{}@{}", measure, region); }

std::vector<Limit> parse_limits(const std::string& text, bool fails_above) {
    std::vector<Limit> limits;
    std::istringstream stream(text);
    for (std::string part; std::getline(stream, part, ',');) limits.push_back(parse_limit(part, fails_above));
    return limits;
}

std::vector<std::string> breaches(const std::vector<MeasuredThing>& things, const std::vector<Limit>& limits) {
    std::vector<std::string> lines;
    for (const Limit& limit : limits) {
        bool measured = false;
        for (const MeasuredThing& thing : things) {
            if (thing.region != limit.region || !has_measure(thing, limit.measure)) continue;
            measured = true;
            const double value = thing.measure(limit.measure);
            if (std::isnan(value)) {
                lines.push_back(fmt::format("{}: {} does not exist for these images, so its limit cannot be kept",
                                            thing.name, limit.name()));
            } else if (limit.fails_above ? value > limit.value : value < limit.value) {
                lines.push_back(fmt::format("{}: {} = {:.6g} is {} {:.6g}", thing.name, limit.name(), value,
                                            limit.fails_above ? "above" : "below", limit.value));
            }
        }
        if (!measured) {
            lines.push_back(
                fmt::format("{} does not exist for these images, so its limit cannot be kept", limit.name()));
        }
    }
    return lines;
}

}  // namespace plumb
