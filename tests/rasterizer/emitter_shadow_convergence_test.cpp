// What the shadow of an emissive surface comes to with more and more points: its light without occluders times the
// share of it that rays see, and how far that is from the integral of what they see.
#include <fmt/format.h>

#include "gl_test.h"
#include "shadow_rays.h"

namespace plumb {
namespace {

// An emissive quad above two balls in a corner.
struct EmissiveQuad {
    glm::dvec3 corner{-0.5, 2.2, -0.3}, u{1.0, 0.0, 0.0}, v{0.0, 0.0, 1.0}, radiance{6.0, 5.0, 4.0};
};

Scene make_balls_under(const EmissiveQuad& quad) {
    Scene scene = make_shadow_scene();
    Material light;
    light.emission = glm::vec3(quad.radiance);
    scene.materials.push_back(light);
    add_quad(scene, static_cast<int>(scene.materials.size()) - 1, glm::vec3(quad.corner), glm::vec3(quad.u),
             glm::vec3(quad.v));
    return scene;
}

// Irradiance from the quad at a point, in units of its radiance.
struct AreaLight {
    double unoccluded = 0.0, occluded = 0.0;  // integrals without and with occluders
    double seen = 0.0;                        // share of the area
};

AreaLight integrate(const RayCaster& caster, const EmissiveQuad& quad, int instance, const glm::dvec3& p,
                    const glm::dvec3& n) {
    constexpr int order = 24;
    const glm::dvec3 vector_area = glm::cross(quad.u, quad.v);
    AreaLight light;
    for (int i = 0; i < order; ++i) {
        for (int j = 0; j < order; ++j) {
            const glm::dvec3 q = quad.corner + (i + 0.5) / order * quad.u + (j + 0.5) / order * quad.v, way = q - p;
            const double square = glm::dot(way, way);
            const double factor = std::max(0.0, glm::dot(n, way)) * std::max(0.0, -glm::dot(vector_area, way)) /
                                  (square * square * order * order);
            const bool blocked = caster.occluded(p + 1e-5 * n, q, instance);
            light.unoccluded += factor;
            if (blocked) continue;
            light.occluded += factor;
            light.seen += 1.0 / (order * order);
        }
    }
    return light;
}

// Through EGL alone, as the other convergences.
TEST(EmitterShadowConvergence, MorePointsConvergeToTheShareOfTheEmitterThatIsSeen) {
    const EmissiveQuad quad;
    const Scene scene = make_balls_under(quad);
    const int instance = static_cast<int>(scene.instances.size()) - 1;
    const RayCaster caster(scene);
    const View view = corner_view();
    GlContext& context = test_context(GlBackend::egl);
    struct Receiver {
        int x, y;
        double unshadowed, expected, true_light;  // red, reflected
    };
    std::vector<Receiver> receivers;
    const auto render_points = [&](int points) {
        Method method = plain_method();
        method.direct.shadow.emitter_samples = points;
        method.direct.shadow.emitter_size = 256;
        return render(context, scene, view, {"direct", "position", "normal", "albedo", "depth"}, method);
    };
    const Frame one = render_points(1);
    for (int y = 1; y < view.height(); y += 3) {
        for (int x = 1; x < view.width(); x += 3) {
            if (std::isinf(one.plane("depth").at(x, y))) continue;
            const glm::dvec3 p = vector_at(one.plane("position"), x, y), n = vector_at(one.plane("normal"), x, y);
            const AreaLight light = integrate(caster, quad, instance, p, n);
            const double reflected = one.plane("albedo").at(x, y, 0) / glm::pi<double>() * quad.radiance.x;
            if (light.unoccluded == 0.0) continue;
            receivers.push_back({x, y, reflected * light.unoccluded, reflected * light.unoccluded * light.seen,
                                 reflected * light.occluded});
        }
    }
    const auto error = [&](const Frame& frame) {
        double sum = 0.0, whole = 0.0;
        for (const Receiver& r : receivers) {
            sum += std::abs(frame.plane("direct").at(r.x, r.y, 0) - r.expected);
            whole += r.expected;
        }
        return sum / whole;
    };
    double separated = 0.0, whole = 0.0, shadowed = 0.0;
    for (const Receiver& r : receivers) {
        separated += std::abs(r.expected - r.true_light);
        whole += r.true_light;
        shadowed += r.unshadowed - r.true_light;
    }
    const double hard = error(one), few = error(render_points(16)), more = error(render_points(64)),
                 most = error(render_points(256));
    fmt::print(
        "emitter shadows: errors {:.4f}, {:.4f}, {:.4f} and {:.4f} of 1, 16, 64 and 256 points; separating "
        "visibility {:.4f}, shadows take {:.4f}\n",
        hard, few, more, most, separated / whole, shadowed / whole);
    EXPECT_GT(receivers.size(), 300u);
    EXPECT_GT(shadowed, 0.02 * whole);
    EXPECT_LT(few, hard / 2.0);
    EXPECT_LT(more, few);
    EXPECT_LT(most, more);
    // The quadrature of 24 by 24 points, and texels of the maps along the edges of 256 shadows.
    EXPECT_LT(most, 0.01);
    // What the mean visibility leaves out: that the parts of the emitter do not all send as much.
    EXPECT_LT(separated, 0.01 * whole);
}

}  // namespace
}  // namespace plumb
