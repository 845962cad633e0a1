#include "experiments/method_files.h"

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

namespace plumb {

bool MethodFileReader::is_file(const std::string& name) { return name.ends_with(".toml"); }

Method MethodFileReader::load(const std::string& name) {
    const std::filesystem::path file = std::filesystem::path(reader_.source()).parent_path() / name;
    if (const auto kept = kept_.find(name); kept != kept_.end()) {
        files_[name] = kept->second;
    } else if (std::filesystem::is_regular_file(file)) {
        files_[name] = read_config_text(file);
    } else {
        reader_.fail(
            "methods",
            fmt::format("no method file '{}' (looked for '{}'); its path starts at the folder of the "
                        "experiment's file, and 'plumbline tune' or 'plumbline render --print-method' write one",
                        name, file.string()));
    }
    return parse_shared_method(parse_config(files_[name], file.string()), file.string(), builtin_methods(), planes_);
}

void MethodFileReader::add_base(const ConfigValue& table, MethodList& known) {
    const auto* members = std::get_if<ConfigMembers>(&table.value);
    if (!members) return;
    const auto base = std::ranges::find(*members, "base", &ConfigMember::key);
    if (base == members->end()) return;
    const auto* name = std::get_if<std::string>(&base->value.value);
    if (!name || !is_file(*name) || find_method(known, *name)) return;
    Method method = load(*name);
    method.name = *name;
    known.push_back(std::move(method));
}

}  // namespace plumb
