// The thin lens: where a point out of focus is spread over the image, and what stays sharp.
//
// The rays of a lens of radius a through one point of the image meet at the focus distance s. A point at depth d is
// seen from lens point l through the image point (in metres at 1 m depth)
//     p / d + l (d - s) / (d s),
// so it becomes a disc of radius a |d - s| / (d s) about its pinhole image, evenly lit as the lens is.
#include <gtest/gtest.h>

#include "tests/pathtracer/closed_forms.h"
#include "tests/pathtracer/effects_scenes.h"

namespace plumb {
namespace {

using closed_form::pi;

View lens_view(float aperture_radius, float focus_distance, int size) {
    Camera camera = Camera::look_at("lens", {0, 0, 0}, {0, 0, -1}, 2.0f * std::atan(0.25f));
    camera.near_plane = 1e-3f, camera.far_plane = 100.0f;
    camera.aperture_radius = aperture_radius, camera.focus_distance = focus_distance;
    return View(camera, size, size);
}

// A square of radiance 1 that faces the camera, `half` pixels to each side of the image point `at` (pixels).
Scene glowing_square(const View& view, double depth, double half, const glm::dvec2& at) {
    const double metres = depth / view.pixels_per_metre();
    const glm::dvec3 centre((at.x - 0.5 * view.width()) * metres, (0.5 * view.height() - at.y) * metres, -depth);
    const glm::dvec3 x(half * metres, 0, 0), y(0, half * metres, 0);
    Scene scene;
    add_polygon(scene, add_material(scene, glm::vec3(0.0f), glm::vec3(1.0f)),
                {centre - x - y, centre + x - y, centre + x + y, centre - x + y});
    return scene;
}

TEST(ThinLens, SpreadsAPointEvenlyOverItsCircleOfConfusion) {
    constexpr int size = 20;
    constexpr double half = 1.25, focus = 2.0, radius = 7.0;
    const glm::dvec2 at(10.3, 9.8);
    for (const double depth : {1.5, 3.0}) {  // before and behind the focus
        const double per_metre = lens_view(0.0f, 1.0f, size).pixels_per_metre();
        const double aperture = radius / per_metre * depth * focus / std::abs(depth - focus);
        const View view = lens_view(static_cast<float>(aperture), static_cast<float>(focus), size);
        const Scene scene = glowing_square(view, depth, half, at);
        auto settings = settings_for({"emission"}, 12288);
        settings.antialias = true;
        const Frame frame = PathTracer(scene).render(view, settings).frame;
        const Image& image = frame.plane("emission");
        double sum = 0.0, variance = 0.0;
        struct {
            double sum = 0.0, variance = 0.0;
            int pixels = 0;
        } inner, outer;
        glm::dvec2 first(0.0), second(0.0);
        for (int y = 0; y < size; ++y) {
            for (int x = 0; x < size; ++x) {
                const double value = image.at(x, y);
                const glm::dvec2 offset = glm::dvec2(x + 0.5, y + 0.5) - at;
                const double distance = glm::length(offset);
                sum += value, first += value * offset, second += value * offset * offset;
                const double pixel_variance = frame.plane("variance.emission").at(x, y);
                variance += pixel_variance;
                // The square and the pixel reach half and 0.5 to each side of their centres.
                constexpr double margin = (half + 0.5) * 1.4142136;
                if (distance > radius + margin) {
                    EXPECT_EQ(value, 0.0) << x << ", " << y;
                }
                if (distance > radius - margin) continue;
                auto& part = distance < 0.4 * radius ? inner : outer;
                part.sum += value, part.variance += pixel_variance, ++part.pixels;
            }
        }
        const std::string what = "depth " + std::to_string(depth);
        const double area = 4.0 * half * half;
        const double error = 4.0 * std::sqrt(variance);
        EXPECT_LT(error, 0.01 * area) << what << ": too noisy to prove anything";
        EXPECT_NEAR(sum, area, error) << what << ": a lens takes no light away";
        // A disc's points have the mean square radius^2 / 4 along each axis, a square's half^2 / 3, a pixel's 1 / 12.
        // The error of second moments is below that of the sum times the disc's largest square.
        const double spread = 0.25 * radius * radius + half * half / 3.0 + 1.0 / 12.0;
        for (int axis = 0; axis < 2; ++axis) {
            EXPECT_NEAR(first[axis] / sum, 0.0, error / area * radius) << what;
            EXPECT_NEAR(second[axis] / sum, spread, 0.01 * spread) << what << ": the radius is off by 0.5 %";
        }
        const double level = area / (pi * radius * radius);
        for (const auto& part : {inner, outer}) {
            const double part_error = 4.0 * std::sqrt(part.variance) / part.pixels;
            EXPECT_GT(part.pixels, 20);
            EXPECT_LT(part_error, 0.03 * level) << what << ": too noisy to prove anything";
            EXPECT_NEAR(part.sum / part.pixels, level, part_error) << what << ": unevenly lit";
        }
    }
}

TEST(ThinLens, ShowsWhatIsInFocusAsAPinholeDoes) {
    const View lens = lens_view(0.3f, 2.5f, 24), pinhole = lens_view(0.0f, 2.5f, 24);
    const Scene scene = glowing_square(lens, 2.5, 5.2, {11.9, 12.4});
    for (const bool antialias : {false, true}) {
        constexpr int samples = 256;
        auto settings = settings_for({"emission"}, samples);
        settings.antialias = antialias;
        const Frame sharp = PathTracer(scene).render(pinhole, settings).frame;
        const Frame through_lens = PathTracer(scene).render(lens, settings).frame;
        int lit = 0;
        for (int y = 0; y < 24; ++y) {
            for (int x = 0; x < 24; ++x) {
                // The same points of the pixel in both; where one lies on an edge to within rounding it may count on
                // either side.
                const double allowed = antialias ? 1.0 / samples + 1e-6 : 0.0;
                EXPECT_NEAR(through_lens.plane("emission").at(x, y), sharp.plane("emission").at(x, y), allowed);
                lit += sharp.plane("emission").at(x, y) > 0.0f ? 1 : 0;
            }
        }
        EXPECT_GT(lit, 80);
    }
}

// Out of focus the mean over the lens is over surface points as well: light that falls off across a wall.
TEST(ThinLens, AveragesWhatEachOfItsRaysSees) {
    const View lens = lens_view(0.1f, 1.0f, 4);
    constexpr double depth = 2.0;
    Scene scene;
    add_quads(scene, add_material(scene, glm::vec3(0.5f)), {{{-9, -9, -2}, {9, -9, -2}, {9, 9, -2}, {-9, 9, -2}}});
    const glm::dvec3 light(0.1, 0.05, -1.5);
    scene.point_lights.push_back({"lamp", glm::vec3(light), glm::vec3(1.0f)});
    const Frame frame = PathTracer(scene).render(lens, settings_for({"direct"}, 1024, 0)).frame;
    expect_mean(frame, "direct", [&](int x, int y) {
        // The wall's points that the lens sees through a pixel's centre: a disc of radius a (d - s) / s.
        const PixelRay ray(lens_view(0.0f, 1.0f, 4), x, y);
        const glm::dvec3 centre = ray.on_plane({0, 0, 1}, -depth);
        double sum = 0.0;
        constexpr int steps = 100;
        for (int i = 0; i < steps; ++i) {
            for (int j = 0; j < steps; ++j) {
                const double radius = 0.1 * std::sqrt((i + 0.5) / steps), angle = 2.0 * pi * (j + 0.5) / steps;
                const glm::dvec3 offset =
                    light - centre - glm::dvec3(radius * std::cos(angle), radius * std::sin(angle), 0.0);
                const double squared = glm::dot(offset, offset);
                sum += 0.5 / pi * offset.z / (squared * std::sqrt(squared));
            }
        }
        return sum / steps / steps;
    });
}

}  // namespace
}  // namespace plumb
