// A parameter that changes no pixel is refused, and one that is refused changes none: some of all pairs
// (parameter_pairs_sweep_test.cpp goes through all).
#include "parameter_pairs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "experiments/method_file.h"
#include "parameter_pictures.h"
#include "tests/busy_scene.h"

namespace plumb {
namespace {

using testing::IsEmpty;

// Each read off a shader: the picture must agree.
TEST(ParameterPairs, WhatIsRefusedBesideAnotherValueChangesNoPixel) {
    struct Pair {
        const char* name;
        std::vector<std::string> beside;
    };
    const std::vector<Pair> named = {{"antialias.clamp", {"antialias.alpha=0"}},
                                     {"antialias.reprojection", {"antialias.alpha=0"}},
                                     {"antialias.dilate", {"antialias.alpha=0"}},
                                     {"antialias.lookup", {"antialias.alpha=0"}},
                                     {"antialias.dilate", {"antialias.reprojection=false"}},
                                     {"antialias.lookup", {"antialias.reprojection=false"}},
                                     {"radiosity.mip_offset", {"radiosity.minimum_mip_level=5"}},
                                     {"radiosity.blur.monotonic", {"radiosity.blur.radius=1"}},
                                     {"ao.blur.monotonic", {"ao.blur.radius=1"}},
                                     {"reflections.step", {"reflections.max_steps=1"}},
                                     {"ao.samples", {"ao.intensity=0"}},
                                     {"ao.estimator", {"ao.intensity=0"}},
                                     {"ao.blur.radius", {"ao.intensity=0"}},
                                     {"ao.temporal.alpha", {"ao.intensity=0"}},
                                     {"ao.samples", {"ao.estimator=alchemy2011", "ao.exponent=0"}},
                                     {"ao.intensity", {"ao.estimator=nielsen2015", "ao.exponent=0"}}};
    const std::unique_ptr<GlContext> context = GlContext::create();
    const Scene scene = make_busy_scene();
    for (const Pair& pair : named) {
        Method method = small_method(pair.name);
        set_method_parameters(method, pair.beside);
        const std::vector<std::string> planes = telling_planes(pair.name);
        EXPECT_NE(reason_without_effect(method, pair.name, &planes), "") << pair.name;
        const PairVerdicts verdicts =
            judge_pairs(*context, scene, {{pair.name, pair.beside.back(), std::move(method), planes}});
        EXPECT_THAT(verdicts.slander, IsEmpty());
        EXPECT_EQ(verdicts.compared, 1u) << pair.name;
    }
}

TEST(ParameterPairs, ChangeAPixelUnlessTheyAreRefused) {
    const std::unique_ptr<GlContext> context = GlContext::create();
    const Scene scene = make_busy_scene();
    std::vector<ParameterPair> pairs = pairs_with_planes();
    for (const std::string& group : parameter_groups()) {
        const std::vector<ParameterPair> within = pairs_within(group);
        pairs.insert(pairs.end(), within.begin(), within.end());
    }
    // A prime, so that other parameters are met beside other values all the time.
    const PairVerdicts verdicts = judge_pairs(*context, scene, pairs, 0, 211);
    EXPECT_THAT(verdicts.silent, IsEmpty()) << "of " << verdicts.compared;
    EXPECT_THAT(verdicts.slander, IsEmpty()) << "of " << verdicts.compared;
    EXPECT_GT(verdicts.compared, pairs.size() / 422) << "most are neither excepted nor refused by the pipeline";
}

}  // namespace
}  // namespace plumb
