#include "rasterizer/pass_plan.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "rasterizer/gl_error.h"

namespace plumb {
namespace {

bool contains(const std::vector<std::string>& names, const std::string& name) {
    return std::ranges::find(names, name) != names.end();
}

// Throws unless an enabled pass gives `plane`.
void require_source(const std::vector<PassDeclaration>& declarations, const std::string& plane,
                    const std::string& reader) {
    std::vector<std::string> available;
    std::string disabled;
    for (const PassDeclaration& pass : declarations) {
        if (contains(pass.outputs, plane)) {
            if (pass.disabled.empty()) return;
            disabled = fmt::format("; pass '{}' would give it, but {}", pass.name, pass.disabled);
        } else if (pass.disabled.empty()) {
            available.insert(available.end(), pass.outputs.begin(), pass.outputs.end());
        }
    }
    throw MethodError(fmt::format("{} needs the plane '{}', which this method does not give{}; it gives: {}", reader,
                                  plane, disabled, fmt::join(available, ", ")));
}

}  // namespace

PassPlan plan_passes(const std::vector<PassDeclaration>& declarations, const std::vector<std::string>& wanted) {
    PassPlan plan;
    plan.decisions.resize(declarations.size());
    std::map<std::string, std::string> readers;  // plane to the first reader, for the reasons
    for (const std::string& plane : wanted) {
        require_source(declarations, plane, "the experiment");
        plan.read.insert(plane);
        readers.emplace(plane, "the experiment");
    }
    for (std::size_t i = declarations.size(); i-- > 0;) {
        const PassDeclaration& pass = declarations[i];
        PassDecision& decision = plan.decisions[i];
        decision.pass = pass.name;
        if (!pass.disabled.empty()) {
            decision.reason = pass.disabled;
            continue;
        }
        const auto output =
            std::ranges::find_if(pass.outputs, [&](const std::string& plane) { return plan.read.contains(plane); });
        if (output == pass.outputs.end()) {
            decision.reason = fmt::format("nobody reads {}", fmt::join(pass.outputs, ", "));
            continue;
        }
        decision.runs = true;
        decision.reason =
            fmt::format("{} reads {}{}{}", readers.at(*output), *output, pass.remark.empty() ? "" : "; ", pass.remark);
        plan.order.push_back(i);
        for (const std::string& plane : pass.inputs) {
            require_source(declarations, plane, fmt::format("pass '{}'", pass.name));
            plan.read.insert(plane);
            readers.emplace(plane, fmt::format("pass '{}'", pass.name));
        }
    }
    std::ranges::reverse(plan.order);
    return plan;
}

std::string reason_unread(const std::vector<PassDeclaration>& declarations, const PassPlan& plan,
                          std::string_view name) {
    std::string reason = "no pass reads it";
    for (std::size_t i = 0; i < declarations.size(); ++i) {
        const PassDeclaration& pass = declarations[i];
        for (const ParameterUse& use : pass.parameters) {
            const bool is_group = use.name.ends_with('.');
            if (is_group ? !name.starts_with(use.name) : name != use.name) continue;
            if (!plan.decisions[i].runs) {
                reason =
                    fmt::format("pass '{}', which reads it, does not run: {}", pass.name, plan.decisions[i].reason);
            } else if (use.planes.empty() || std::ranges::any_of(use.planes, [&](const std::string& plane) {
                           return plan.read.contains(plane);
                       })) {
                return "";
            } else {
                reason = fmt::format("nobody reads {}", fmt::join(use.planes, ", "));
            }
        }
    }
    return reason;
}

}  // namespace plumb
