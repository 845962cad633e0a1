// Which passes run: those whose outputs are wanted, and those that feed them.
#pragma once

#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "rasterizer/pass.h"
#include "rasterizer/pipeline.h"

namespace plumb {

struct PassPlan {
    std::vector<std::size_t> order;           // indices of the declarations that run
    std::vector<PassDecision> decisions;      // one per declaration
    std::set<std::string, std::less<>> read;  // every plane that a running pass reads or that is wanted
    PlaneLifetimes lifetimes;
};

// `declarations` are in the order of execution: a pass comes after those that it reads. Throws MethodError for a wanted
// plane that no pass gives, with the reason of the pass that would.
PassPlan plan_passes(const std::vector<PassDeclaration>& declarations, const std::vector<std::string>& wanted);

// Why no pass that runs reads the method's parameter `name` for a plane that somebody reads; empty: one does. `plan` is
// that of the declarations.
std::string reason_unread(const std::vector<PassDeclaration>& declarations, const PassPlan& plan,
                          std::string_view name);

}  // namespace plumb
