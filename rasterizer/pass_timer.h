// How long each pass takes: timer queries where a GPU draws, glFinish and the steady clock where the CPU does (a
// software rasteriser runs behind the caller's back, and its timer queries do not cover its threads).
#pragma once

#include <chrono>
#include <string_view>
#include <vector>

#include "rasterizer/gl_objects.h"

namespace plumb {

// What times the passes, for reports: "GPU timer queries" or "glFinish and the steady clock".
std::string_view timer_description(bool software);

class PassTimer {
public:
    PassTimer(GlContext& context, std::size_t passes);
    void begin(std::size_t pass);
    void end(std::size_t pass);
    // Of the last frame; waits for the GPU.
    std::vector<double> milliseconds() const;

private:
    GlContext& context_;
    std::vector<GlQuery> queries_;  // GPU only
    std::vector<double> clocked_;   // software only, milliseconds
    std::chrono::steady_clock::time_point start_;
};

}  // namespace plumb
