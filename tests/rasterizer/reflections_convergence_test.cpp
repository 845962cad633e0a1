// Rays spread over the lobe come to its integral over the hemisphere, by brute force, of what the layers hold.
#include <cmath>

#include <fmt/format.h>

#include "gl_test.h"
#include "reflection_scenes.h"

namespace plumb {
namespace {

// Mean error of the rays' mean over pixels and channels, as a share of the mean of what they reflect.
class LobeIntegrals {
public:
    LobeIntegrals(GlContext& context, const std::vector<counterpart::Pixel>& pixels, float roughness, int order)
        : context_(context),
          view_(slanted_view(120, 80)),
          layers_(reflected_room(view_)),
          pixels_(pixels),
          gloss_(gloss_at(pixels, even_gloss(view_, glm::vec3(0.6f), 1.0f, roughness))) {
        // What the passes see: normals as their encoding leaves them.
        layers_ = ReflectionRun(context_, layers_, gloss_, method_of(settings(1)), reflection_alone, sky_).layers();
        const counterpart::ReflectionTracer tracer(layers_, gloss_, request_of(settings(1), reflection_alone, sky_));
        for (const counterpart::Pixel& pixel : pixels_) integrals_.push_back(tracer.integrate(pixel, order));
    }

    double error(int rays) const {
        ReflectionRun run(context_, layers_, gloss_, method_of(settings(rays)), reflection_alone, sky_);
        const Image reflection = run.render();
        double error = 0.0, reflected = 0.0;
        for (std::size_t i = 0; i < pixels_.size(); ++i) {
            for (int c = 0; c < 3; ++c) {
                error += std::abs(reflection.at(pixels_[i].x, view_.height() - 1 - pixels_[i].y, c) - integrals_[i][c]);
                reflected += integrals_[i][c];
            }
        }
        return error / reflected;
    }

private:
    static ReflectionSettings settings(int rays) {
        return {.roughness = ReflectionRoughness::samples,
                .samples = rays,
                .step = 1.0f,
                .fallback = ReflectionFallback::environment};
    }

    GlContext& context_;
    View view_;
    glm::vec3 sky_{0.3f, 0.6f, 0.9f};
    counterpart::Layers layers_;
    std::vector<counterpart::Pixel> pixels_;
    counterpart::Gloss gloss_;
    std::vector<glm::dvec3> integrals_;
};

using ReflectionsConvergenceTest = GlTest;
PLUMBLINE_BOTH_BACKENDS(ReflectionsConvergenceTest);

TEST_P(ReflectionsConvergenceTest, SamplesConvergeToTheLobesIntegral) {
    // 25600 directions of a midpoint rule, and 4096 of the sequence, across the edges of a few objects.
    EXPECT_LT(LobeIntegrals(context(), {{60, 12}, {30, 20}}, 0.6f, 160).error(4096), 0.01);
}

// Through EGL alone: they are the same rays. Narrow lobes take a finer rule to integrate.
TEST(ReflectionsConvergence, SamplesConvergeOverPixelsAndRoughnesses) {
    std::vector<counterpart::Pixel> pixels;
    for (const int y : {6, 14, 22, 30}) {
        for (const int x : {20, 60, 100}) pixels.push_back({x, y});
    }
    for (const auto& [roughness, order] : {std::pair{0.4f, 280}, std::pair{0.7f, 160}, std::pair{1.0f, 120}}) {
        SCOPED_TRACE(testing::Message() << "roughness " << roughness);
        const LobeIntegrals integrals(test_context(GlBackend::egl), pixels, roughness, order);
        const double few = integrals.error(64), more = integrals.error(512), many = integrals.error(4096);
        fmt::print("roughness {}: errors {:.4f}, {:.4f} and {:.4f} of 64, 512 and 4096 rays\n", roughness, few, more,
                   many);
        // A sequence of N points misses edges by some N^(-3/4): an eighth of the error for 16 times the rays, until
        // what the midpoint rule misses is left.
        EXPECT_LT(many, 0.01);
        EXPECT_LT(many, few / 4.0);
        EXPECT_LT(more, few);
    }
}

}  // namespace
}  // namespace plumb
