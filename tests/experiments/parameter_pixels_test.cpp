// Where a parameter is said to have an effect, another value of it changes a pixel.
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "experiments/method_file.h"
#include "parameter_pictures.h"
#include "tests/busy_scene.h"

namespace plumb {
namespace {

TEST(ParameterPixels, AnotherValueChangesAPixelWhereverTheParameterIsSaidToMatter) {
    const std::unique_ptr<GlContext> context = GlContext::create();
    const Scene scene = make_busy_scene();
    std::map<std::string, Frame> with_defaults;
    for (const std::string& name : method_parameter_names()) {
        SCOPED_TRACE(name);
        const Method method = small_method(name);
        const std::vector<std::string> planes = telling_planes(name);
        EXPECT_EQ(reason_without_effect(method, name, &planes, &scene), "");
        if (parameters_without_pixels().contains(name)) continue;
        const std::string key = print_method(method) + planes.front();
        if (!with_defaults.contains(key)) with_defaults[key] = render_busy_frames(*context, scene, method, planes);
        Method changed = method;
        use_another_value(changed, name);
        ASSERT_NE(method_hash(changed), method_hash(method));
        EXPECT_FALSE(same_pixels(with_defaults.at(key), render_busy_frames(*context, scene, changed, planes), planes))
            << "no pixel of " << planes.front() << " changes";
    }
}

}  // namespace
}  // namespace plumb
