#include "experiments/system_facts.h"

#include <array>
#include <fstream>
#include <thread>

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/utsname.h>
#include <tbb/info.h>
#include <unistd.h>

#include "pathtracer/embree_api.h"

namespace plumb {
namespace {

// The value of the first line "name : value" in a file of /proc.
std::string proc_value(const char* file, std::string_view name) {
    std::ifstream stream(file);
    for (std::string line; std::getline(stream, line);) {
        if (!line.starts_with(name)) continue;
        const auto colon = line.find(':');
        if (colon == std::string::npos) continue;
        const auto start = line.find_first_not_of(" \t", colon + 1);
        return start == std::string::npos ? "" : line.substr(start);
    }
    return "";
}

std::uint64_t memory_value(std::string_view name) {
    const std::string text = proc_value("/proc/meminfo", name);
    return text.empty() ? 0 : std::stoull(text) * 1024;
}

long positive(long value) { return value > 0 ? value : 0; }

std::string describe_embree() {
    RTCDevice device = rtcNewDevice(nullptr);
    if (!device) return "does not start";
    const auto property = [&](RTCDeviceProperty name) { return static_cast<int>(rtcGetDeviceProperty(device, name)); };
    // Embree picks the widest instruction set that it was built for and the CPU has; the native packets tell which.
    const char* instructions = property(RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED)  ? "AVX-512"
                               : property(RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED) ? "AVX or AVX2"
                                                                                     : "SSE";
    std::string text = fmt::format("{}.{}.{}, {}", property(RTC_DEVICE_PROPERTY_VERSION_MAJOR),
                                   property(RTC_DEVICE_PROPERTY_VERSION_MINOR),
                                   property(RTC_DEVICE_PROPERTY_VERSION_PATCH), instructions);
    rtcReleaseDevice(device);
    return text;
}

}  // namespace

SystemFacts read_system_facts() {
    SystemFacts facts;
    facts.cpu = proc_value("/proc/cpuinfo", "model name");
    if (facts.cpu.empty()) facts.cpu = "unknown CPU";
    facts.logical_cores = static_cast<int>(std::thread::hardware_concurrency());
    facts.worker_threads = tbb::info::default_concurrency();
    facts.memory_bytes = memory_value("MemTotal");
    facts.available_bytes = memory_value("MemAvailable");
    facts.level1_bytes = positive(sysconf(_SC_LEVEL1_DCACHE_SIZE));
    facts.level2_bytes = positive(sysconf(_SC_LEVEL2_CACHE_SIZE));
    facts.level3_bytes = positive(sysconf(_SC_LEVEL3_CACHE_SIZE));
    utsname name{};
    if (uname(&name) == 0) facts.operating_system = fmt::format("{} {} {}", name.sysname, name.release, name.machine);
    facts.embree = describe_embree();
    return facts;
}

std::string utc_now() { return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr))); }

std::string print_bytes(std::uint64_t bytes) {
    constexpr std::array units = {"B", "KiB", "MiB", "GiB", "TiB"};
    double value = static_cast<double>(bytes);
    std::size_t unit = 0;
    while (value >= 1024.0 && unit + 1 < units.size()) value /= 1024.0, ++unit;
    return fmt::format("{:.{}f} {}", value, unit == 0 ? 0 : 1, units[unit]);
}

}  // namespace plumb
