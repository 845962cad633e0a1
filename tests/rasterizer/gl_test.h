// Base of the tests that draw: each runs once through EGL and once through OSMesa.
#pragma once

#include <map>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "rasterizer/gl_context.h"

namespace plumb {

// One context of each kind for the whole process, with debug output, so that every GL error throws at once. They end
// with the last test, not with the process: Mesa's own threads are gone by then.
class TestContexts final : public testing::Environment {
public:
    GlContext& get(GlBackend backend) {
        std::unique_ptr<GlContext>& context = contexts_[backend];
        if (!context) context = GlContext::create(backend, true);
        context->make_current();
        return *context;
    }
    void TearDown() override { contexts_.clear(); }

private:
    std::map<GlBackend, std::unique_ptr<GlContext>> contexts_;
};
inline TestContexts* const test_contexts =
    static_cast<TestContexts*>(testing::AddGlobalTestEnvironment(new TestContexts));

inline GlContext& test_context(GlBackend backend) { return test_contexts->get(backend); }

class GlTest : public testing::TestWithParam<GlBackend> {
protected:
    GlContext& context() { return test_context(GetParam()); }
};

inline std::string backend_name(const testing::TestParamInfo<GlBackend>& parameter) {
    return std::string(to_string(parameter.param));
}

// Runs a GlTest suite through both kinds of context.
#define PLUMBLINE_BOTH_BACKENDS(suite) \
    INSTANTIATE_TEST_SUITE_P(Backend, suite, testing::Values(GlBackend::egl, GlBackend::osmesa), backend_name)

}  // namespace plumb
