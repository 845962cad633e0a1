#include "rasterizer/pass_plan.h"

#include <algorithm>
#include <array>

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

bool touches(const std::vector<std::string>& planes, const std::string& base) {
    return std::ranges::any_of(planes, [&](const std::string& plane) { return split_layer(plane).base == base; });
}

// Whether the output may overwrite the input: it must be of no use to anyone else, in this frame and the next. A chain
// leaves its finest level as it is, for whoever reads it.
bool can_be_in_place(const PassDeclaration::InPlace& pair, const std::vector<PassDeclaration>& declarations,
                     const std::vector<std::size_t>& order, const std::vector<std::string>& wanted,
                     const PlaneLifetimes& lifetimes) {
    if (!lifetimes.within_frame.contains(pair.input) || !lifetimes.within_frame.contains(pair.output)) return false;
    if (pair.is_chain) return true;
    if (touches(wanted, pair.input)) return false;
    return std::ranges::none_of(order, [&](std::size_t index) {
        const PassDeclaration& pass = declarations[index];
        return touches(pass.inputs, pair.input) && pass.in_place != pair;
    });
}

// The positions of the passes that make a plane, and that use each of its layers last.
struct PlaneUse {
    std::size_t first = 0;
    std::array<std::size_t, most_layers> last{};
};

PlaneLifetimes find_lifetimes(const std::vector<PassDeclaration>& declarations, const std::vector<std::size_t>& order,
                              const std::vector<std::string>& wanted) {
    PlaneLifetimes lifetimes;
    std::map<std::string, PlaneUse> uses;
    const auto use = [&](const std::string& plane, std::size_t position) {
        const auto [layer, base] = split_layer(plane);
        const auto [found, is_new] = uses.try_emplace(base);
        if (is_new) {  // layers that nobody names end with the pass that makes them
            found->second.first = position;
            found->second.last.fill(position);
        }
        found->second.last.at(static_cast<std::size_t>(layer)) = position;
    };
    for (std::size_t i = 0; i < order.size(); ++i) {
        const PassDeclaration& pass = declarations[order[i]];
        for (const auto* planes : {&pass.inputs, &pass.outputs, &pass.scratch}) {
            for (const std::string& plane : *planes) use(plane, i);
        }
    }
    for (const auto& [plane, last] : uses) lifetimes.within_frame.insert(plane);
    for (const std::size_t index : order) {
        for (const std::string& plane : declarations[index].kept) lifetimes.within_frame.erase(plane);
    }
    const std::size_t read_back = order.size();
    for (const std::string& plane : wanted) use(plane, read_back);
    for (const std::size_t index : order) {
        const std::optional<PassDeclaration::InPlace>& pair = declarations[index].in_place;
        if (!pair || !can_be_in_place(*pair, declarations, order, wanted, lifetimes)) continue;
        if (!lifetimes.in_place.emplace(pair->output, pair->input).second) continue;  // as another layer has it
        if (pair->is_chain) lifetimes.chained.insert(pair->input);
        for (std::size_t layer = 0; layer < most_layers; ++layer) {  // they end as one
            std::size_t &end = uses.at(pair->input).last.at(layer), &other = uses.at(pair->output).last.at(layer);
            end = other = std::max(end, other);
        }
    }
    lifetimes.ended_after.resize(order.size());
    for (const auto& [plane, times] : uses) {
        if (!lifetimes.within_frame.contains(plane)) continue;
        // From the last layer on, as the first ones may be needed longer.
        std::size_t end = times.first;
        for (int layer = most_layers; layer >= 0; --layer) {
            const bool is_whole = layer == 0;
            const std::size_t of_one_more =
                is_whole ? end : std::max(end, times.last.at(static_cast<std::size_t>(layer) - 1));
            if ((is_whole || of_one_more > end) && end < read_back)
                lifetimes.ended_after[end].push_back({plane, layer});
            end = of_one_more;
        }
    }
    return lifetimes;
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
    plan.lifetimes = find_lifetimes(declarations, plan.order, wanted);
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
