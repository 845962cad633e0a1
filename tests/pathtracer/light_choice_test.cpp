// The choice among lights and of points on them, and the densities per solid angle that the samples carry.
#include <gtest/gtest.h>

#include "chi_square.h"
#include "direction_cells.h"
#include "pathtracer/light_table.h"
#include "pathtracer/luminance.h"
#include "test_scenes.h"

namespace plumb {
namespace {

struct Triangle {
    glm::dvec3 a, b, c;
    double power;  // relative

    double area() const { return 0.5 * glm::length(glm::cross(b - a, c - a)); }

    // Where a ray from the origin meets the plane (Moller, Trumbore 1997): barycentric weights of b and c, distance.
    glm::dvec3 meet(const glm::dvec3& direction) const {
        const glm::dvec3 e1 = b - a, e2 = c - a, p = glm::cross(direction, e2), q = glm::cross(-a, e1);
        return glm::dvec3(glm::dot(-a, p), glm::dot(direction, q), glm::dot(e2, q)) / glm::dot(e1, p);
    }
    // Whether it meets the triangle, or would if that reached a little further.
    static bool is_met(const glm::dvec3& at, double margin = 0.0) {
        return at.x >= -margin && at.y >= -margin && at.x + at.y <= 1.0 + margin && at.z > 0.0;
    }

    // Density per solid angle of points that are uniform over the triangle: d^2 / (area |cosine|), and 0 beside it.
    double density(const glm::dvec3& direction) const {
        const glm::dvec3 at = meet(direction), normal = glm::normalize(glm::cross(b - a, c - a));
        return is_met(at) ? at.z * at.z / (area() * std::abs(glm::dot(normal, direction))) : 0.0;
    }
};

// Three lamps around the origin, none before another, each a quad of two triangles; and a wide sun.
struct Lamps {
    Scene scene;
    std::vector<Triangle> triangles;
    static constexpr float sun_radius = 0.2f;
    double sun_power = 0.0;

    Lamps() {
        add({{-1, 2, -1}, {1, 2, -1}, {1, 2, 1}, {-1, 2, 1}}, {1, 1, 1}, false);      // above, facing down
        add({{2, 0, -2}, {2, 1, -2}, {2, 1, 0}, {2, 0, 0}}, {4, 1, 2}, true);         // right
        add({{-3, -1, 0}, {-3, 1, 1}, {-2, 1, 2}, {-2, -1, 1}}, {0.5f, 2, 1}, true);  // left, skew
        DirectionalLight sun;
        sun.direction = glm::normalize(glm::vec3(1, -3, 6));
        sun.irradiance = glm::vec3(0.4f), sun.angular_radius = sun_radius;
        scene.directional_lights.push_back(sun);
        const double radius = 0.5 * scene.bounds().diagonal();
        sun_power = luminance(sun.irradiance) * glm::pi<double>() * radius * radius;
    }

    void add(const std::vector<glm::vec3>& quad, const glm::vec3& emission, bool two_sided) {
        add_quads(scene, add_material(scene, glm::vec3(0.5f), emission, two_sided), {quad});
        for (const auto& [second, third] : {std::pair(1, 2), std::pair(2, 3)}) {
            Triangle triangle{quad[0], quad[second], quad[third], 0.0};
            triangle.power = glm::pi<double>() * triangle.area() * luminance(emission) * (two_sided ? 2.0 : 1.0);
            triangles.push_back(triangle);
        }
    }

    double power() const {
        double sum = sun_power;
        for (const Triangle& triangle : triangles) sum += triangle.power;
        return sum;
    }

    double density(const glm::dvec3& direction) const {
        double sum = 0.0;
        for (const Triangle& triangle : triangles) sum += triangle.power * triangle.density(direction);
        const double cosine = -glm::dot(direction, glm::dvec3(scene.directional_lights[0].direction));
        if (cosine >= std::cos(sun_radius)) {
            sum += sun_power / (glm::two_pi<double>() * (1.0 - std::cos(static_cast<double>(sun_radius))));
        }
        return sum / power();
    }
};

constexpr LightReceiver receiver{glm::vec3(0.0f), glm::vec3(0.0f, 1.0f, 0.0f), glm::vec3(0.0f, 1.0f, 0.0f)};

// Cells: each triangle in eight parts of equal area, and the sun's disc in eight.
int lamp_cell(const Lamps& lamps, const glm::vec3& direction) {
    // Rounding puts a few points of an edge beside it; the lamps lie further apart than this.
    constexpr double margin = 1e-5;
    for (std::size_t i = 0; i < lamps.triangles.size(); ++i) {
        const glm::dvec3 at = lamps.triangles[i].meet(direction);
        if (!Triangle::is_met(at, margin)) continue;
        // With s = x + y: s^2 and y / s are uniform over a triangle.
        const double s = at.x + at.y;
        const int band = std::clamp(static_cast<int>(2.0 * s * s), 0, 1);
        return 8 * static_cast<int>(i) + 4 * band + std::clamp(static_cast<int>(4.0 * at.y / s), 0, 3);
    }
    glm::vec3 tangent, bitangent;
    complete_basis(-lamps.scene.directional_lights[0].direction, tangent, bitangent);
    return 48 + octant(glm::dot(direction, tangent), glm::dot(direction, bitangent));
}

TEST(LightChoice, PointsAreChosenByPowerAndUniformlyByArea) {
    const Lamps lamps;
    const TracedScene traced(lamps.scene);
    const EnvironmentDistribution none(lamps.scene);
    const LightTable lights(traced, none, EmitterSampling::both);
    std::vector<double> probabilities;
    for (const Triangle& triangle : lamps.triangles) probabilities.resize(probabilities.size() + 8, triangle.power);
    probabilities.resize(probabilities.size() + 8, lamps.sun_power);
    for (double& probability : probabilities) probability /= 8.0 * lamps.power();
    // Half of what tilts the places on one lamp is averaged within its eight cells.
    constexpr double kept = 0.5;
    const auto cell = [&](float x, float y) {
        return lamp_cell(lamps, lights.sample_extended(receiver, x, y).direction);
    };
    expect_density(
        "choice of the lamp and first number of the point", probabilities, Rejection::never,
        [&](glm::vec2 u) { return cell(u.x, u.y); }, Uses::both, kept);
}

TEST(LightChoice, SamplesCarryTheirDensity) {
    const Lamps lamps;
    const TracedScene traced(lamps.scene);
    const EnvironmentDistribution none(lamps.scene);
    const LightTable lights(traced, none, EmitterSampling::both);
    int at_edges = 0;
    for (int i = 0; i < 20000; ++i) {
        const glm::vec2 u = IndependentNumbers(5, i).u;
        const LightSample sample = lights.sample_extended(receiver, u.x, u.y);
        const double expected = lamps.density(sample.direction);
        // Directions within rounding of an edge may be found on neither side of it, or on both.
        const double error = std::abs(sample.density - expected) / sample.density;
        if (error > 0.4) {
            ++at_edges;
        } else {
            // The chain of float operations: distance squared, cosine, area, probability.
            EXPECT_LT(error, 1e-5) << "sample " << i << ": " << sample.density << " for " << expected;
        }
    }
    EXPECT_LE(at_edges, 2);  // 1e-6 of an area lies that near to an edge
}

// Half of the samples go to an environment image, the rest to the lamps by power.
TEST(LightChoice, SharesWithAnEnvironmentImage) {
    Lamps lamps;
    Texture sky;
    sky.width = 4, sky.height = 2, sky.wrap_v = TextureWrap::clamp;
    for (int i = 0; i < 8; ++i) sky.texels.insert(sky.texels.end(), {half(1.0f), half(2.0f), half(0.5f), half(1.0f)});
    lamps.scene.textures.push_back(sky);
    lamps.scene.environment = {glm::vec3(1.0f), 0, 0.0f};
    const TracedScene traced(lamps.scene);
    const EnvironmentDistribution environment(lamps.scene);
    const LightTable lights(traced, environment, EmitterSampling::both);
    // Cells: the six triangles, whose shadow rays end; all else. The sun's directions lie within the sky's.
    std::vector<double> probabilities;
    for (const Triangle& triangle : lamps.triangles) probabilities.push_back(0.5 * triangle.power / lamps.power());
    probabilities.push_back(0.5 * lamps.sun_power / lamps.power() + 0.5);
    expect_density(
        "lamps and sky", probabilities, Rejection::never,
        [&](glm::vec2 u) {
            const LightSample sample = lights.sample_extended(receiver, u.x, u.y);
            if (sample.farthest != 1.0f) return 6;
            return lamp_cell(lamps, sample.direction) / 8;
        },
        Uses::first);
}

}  // namespace
}  // namespace plumb
