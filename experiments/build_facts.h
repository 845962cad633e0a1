// What this program was built from, so that a result can be traced to it.
#pragma once

#include <string_view>

namespace plumb {

struct BuildFacts {
    std::string_view version;       // of the project
    std::string_view git_describe;  // "unknown" outside a git checkout
    std::string_view compiler;
    std::string_view build_type;
    std::string_view integrator_hash;  // over the source files that decide a reference's pixels
};

const BuildFacts& build_facts();

}  // namespace plumb
