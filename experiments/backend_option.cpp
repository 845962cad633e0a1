#include "experiments/backend_option.h"

#include <string>

#include <CLI/CLI.hpp>

namespace plumb {

void add_backend_option(CLI::App& command, GlBackend& backend) {
    const auto assign = [&backend](const std::string& name) {
        backend = name == "egl" ? GlBackend::egl : name == "osmesa" ? GlBackend::osmesa : GlBackend::automatic;
    };
    command.add_option_function<std::string>("--backend", assign, "How OpenGL starts")
        ->check(CLI::IsMember({"auto", "egl", "osmesa"}))
        ->default_str("auto");
}

}  // namespace plumb
