// The machine that a result was measured on.
#pragma once

#include <cstdint>
#include <string>

namespace plumb {

struct SystemFacts {
    std::string cpu;
    int logical_cores = 0;
    int worker_threads = 0;  // what TBB uses by default: cores that this process may run on
    std::uint64_t memory_bytes = 0, available_bytes = 0;
    long level1_bytes = 0, level2_bytes = 0, level3_bytes = 0;  // data caches; 0 where the system does not tell
    std::string operating_system;
    std::string embree;  // version and the ray packets that it runs natively
};

SystemFacts read_system_facts();

// "2026-01-31T23:59:59Z"
std::string utc_now();

// "1.5 GiB"
std::string print_bytes(std::uint64_t bytes);

}  // namespace plumb
