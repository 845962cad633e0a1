// What was measured of one thing, as a list of named numbers: what tables, JSON files and gates read.
#pragma once

#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace plumb {

struct MeasuredThing {
    std::string name;    // a plane, or a layer of a G-buffer
    std::string region;  // the pixels that it was measured over (metrics/regions.h); empty: all
    std::vector<std::pair<std::string, double>> measures;

    // NaN where there is no measure of that name.
    double measure(std::string_view measure_name) const {
        for (const auto& [known, value] : measures) {
            if (known == measure_name) return value;
        }
        return std::numeric_limits<double>::quiet_NaN();
    }
    // "ao", "ao@silhouettes"
    std::string full_name() const {
        std::string text = name;
        if (!region.empty()) text.append("@").append(region);
        return text;
    }
};

struct MeasuredFrame {
    std::string name;  // of its file
    std::vector<MeasuredThing> things;
};

}  // namespace plumb
