// Between which passes the contents of planes matter; names without a layer's prefix.
#pragma once

#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace plumb {

struct PlaneLifetimes {
    // The layers of a plane from `first_layer` on, counted from 0; 0: all of it.
    struct Ended {
        std::string plane;
        int first_layer = 0;
        bool operator==(const Ended&) const = default;
    };

    // Planes that no frame takes over from the one before.
    std::set<std::string, std::less<>> within_frame = {};
    // Planes that overwrite another one, with that other one.
    std::map<std::string, std::string, std::less<>> in_place = {};
    // Those that are the finest level of their own MIP chain.
    std::set<std::string, std::less<>> chained = {};
    // For each pass that runs: what nobody needs once it has.
    std::vector<std::vector<Ended>> ended_after = {};
};

}  // namespace plumb
