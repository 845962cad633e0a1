#include "rasterizer/pass_timer.h"

namespace plumb {

std::string_view timer_description(bool software) {
    return software ? "glFinish and the steady clock" : "GPU timer queries";
}

PassTimer::PassTimer(GlContext& context, std::size_t passes) : context_(context), clocked_(passes) {
    if (context.info().software) return;
    for (std::size_t pass = 0; pass < passes; ++pass) queries_.emplace_back(context);
}

void PassTimer::begin(std::size_t pass) {
    if (!queries_.empty()) {
        queries_[pass].begin();
        return;
    }
    context_.gl.Finish();
    start_ = std::chrono::steady_clock::now();
}

void PassTimer::end(std::size_t pass) {
    if (!queries_.empty()) {
        queries_[pass].end();
        return;
    }
    context_.gl.Finish();
    clocked_[pass] = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start_).count();
}

std::vector<double> PassTimer::milliseconds() const {
    if (queries_.empty()) return clocked_;
    std::vector<double> result;
    for (const GlQuery& query : queries_) result.push_back(query.milliseconds());
    return result;
}

}  // namespace plumb
