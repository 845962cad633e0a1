#include "experiments/gate_options.h"

#include <CLI/CLI.hpp>

namespace plumb {

void GateOptions::add_to(CLI::App& command) {
    command
        .add_option("--fail-above", fail_above,
                    "Exit with 1 where a measure is above: rmse=0.01,p95=0.05,rmse@silhouettes=0.1")
        ->type_name("LIMITS");
    command.add_option("--fail-below", fail_below, "Exit with 1 where a measure is below: psnr=35,ssim=0.95")
        ->type_name("LIMITS");
}

std::vector<Limit> GateOptions::limits() const {
    std::vector<Limit> limits = parse_limits(fail_above, true);
    const std::vector<Limit> below = parse_limits(fail_below, false);
    limits.insert(limits.end(), below.begin(), below.end());
    return limits;
}

}  // namespace plumb
